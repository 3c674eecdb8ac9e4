//! Every actuator off, by registers alone (S1, S9). Called before anything else at boot, and by whatever ends
//! the program. It needs no clock set-up, no driver and no memory but the board's table, and may be repeated at any
//! time.

use core::cell::Cell;
use critical_section::Mutex;
use embassy_stm32::pac::{
    RCC,
    gpio::{Gpio, vals::Moder},
};

/// Ports A to E: all that a board may use for actuators.
const PORTS: u32 = 0b1_1111;

/// The level at which a pin energises nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// As for what is on while high.
    Low,
    /// As for an enable pin that is on while low.
    High,
}

/// A pin that moves or heats something, or lets it.
#[derive(Clone, Copy)]
pub struct Held {
    /// Its port.
    pub port: Gpio,
    /// Its number within the port.
    pub pin: u8,
    /// The level that energises nothing.
    pub off: Level,
    /// A plain output on which others depend: the main switch, the servos' enable pin. The stop button sets it at once.
    pub is_switch: bool,
}

impl Held {
    /// A pin that is on while high.
    pub const fn low(port: Gpio, pin: u8) -> Self {
        Self { port, pin, off: Level::Low, is_switch: false }
    }

    /// A plain output that takes the supply or the signal from others.
    pub const fn switch(port: Gpio, pin: u8, off: Level) -> Self {
        Self { port, pin, off, is_switch: true }
    }
}

/// The board's table; empty until its first instruction.
static PINS: Mutex<Cell<&'static [Held]>> = Mutex::new(Cell::new(&[]));

/// Says which pins there are. To be called before anything else.
pub(crate) fn declare(pins: &'static [Held]) {
    critical_section::with(|token| PINS.borrow(token).set(pins));
}

/// Takes the actuator pins from whoever drives them and holds them off.
pub(crate) fn all_off() {
    RCC.ahb1enr().modify(|enable| enable.0 |= PORTS);
    for held in table() {
        // The level first: a pin that becomes an output shows it at once.
        set_off(held);
        held.port.moder().modify(|mode| mode.set_moder(held.pin.into(), Moder::OUTPUT));
    }
}

/// Cuts supply and servo signals, and leaves every pin with its driver; the core follows in its next tick.
pub(crate) fn cut() {
    table().iter().filter(|held| held.is_switch).for_each(set_off);
}

fn table() -> &'static [Held] {
    critical_section::with(|token| PINS.borrow(token).get())
}

fn set_off(held: &Held) {
    held.port.bsrr().write(|set| match held.off {
        Level::Low => set.set_br(held.pin.into(), true),
        Level::High => set.set_bs(held.pin.into(), true),
    });
}
