//! What the board's actuator pins do, as wired: which pin is which heater, spring, and switch. The same table as in
//! `docs/src/board-nucleo-f446re.md`, read from the rig's side.

use crate::gpio::{Gpio, Pin};
use crate::pca9685::Pca9685;
use crate::timers::Timer;
use zygote_core::{Duty, PulseMicros};

/// Heaters on timer outputs.
pub(crate) const HEATERS: usize = 16;
/// Springs on plain outputs.
pub(crate) const SPRINGS: usize = 4;

/// What drives the rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Drive {
    /// Share of the time that each heater's pin is high.
    pub heaters: [Duty; HEATERS],
    /// Levels of the springs' pins.
    pub springs: [bool; SPRINGS],
    /// Level of the main switch's pin.
    pub main_switch: bool,
    /// Pulses that reach the servos.
    pub servos: [Option<PulseMicros>; 16],
}

impl Drive {
    /// Nothing is driven.
    pub const OFF: Self = Self {
        heaters: [Duty::OFF; HEATERS],
        springs: [false; SPRINGS],
        main_switch: false,
        servos: [None; 16],
    };
}

/// Ports by number, as the chip counts them.
const A: usize = 0;
const B: usize = 1;
const C: usize = 2;

/// Pins of each port that move or heat something.
pub(crate) const ACTUATORS: [u32; 3] = [0x0fc0, 0xf3c3, 0x0fc0];

/// Select pins of the multiplexer, and the stop button, on port C.
pub(crate) const SELECT: std::ops::Range<u8> = 0..4;
pub(crate) const STOP: u8 = 13;

/// A heater's pin: port, pin, alternate function, timer, channel from 0.
struct Heater(usize, u8, u8, PwmTimer, u32);

/// The timers behind heaters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PwmTimer {
    Tim1,
    Tim3,
    Tim4,
    Tim8,
}
use PwmTimer::{Tim1, Tim3, Tim4, Tim8};

const HEATER_PINS: [Heater; HEATERS] = [
    Heater(A, 8, 1, Tim1, 0),
    Heater(A, 9, 1, Tim1, 1),
    Heater(A, 10, 1, Tim1, 2),
    Heater(A, 11, 1, Tim1, 3),
    Heater(A, 6, 2, Tim3, 0),
    Heater(A, 7, 2, Tim3, 1),
    Heater(B, 0, 2, Tim3, 2),
    Heater(B, 1, 2, Tim3, 3),
    Heater(B, 6, 2, Tim4, 0),
    Heater(B, 7, 2, Tim4, 1),
    Heater(B, 8, 2, Tim4, 2),
    Heater(B, 9, 2, Tim4, 3),
    Heater(C, 6, 3, Tim8, 0),
    Heater(C, 7, 3, Tim8, 1),
    Heater(C, 8, 3, Tim8, 2),
    Heater(C, 9, 3, Tim8, 3),
];
const SPRING_PINS: [u8; SPRINGS] = [12, 13, 14, 15];
const MAIN_SWITCH: u8 = 10;
/// The servo driver's enable pin: pulses come out while it is driven low; a pull-up keeps it high.
const SERVOS_ENABLE: u8 = 11;

/// The timers that may drive a heater.
pub(crate) struct PwmTimers<'a> {
    pub(crate) tim1: &'a Timer,
    pub(crate) tim3: &'a Timer,
    pub(crate) tim4: &'a Timer,
    pub(crate) tim8: &'a Timer,
}

/// What the pins do now. A pin that nobody drives is low: every actuator has a pull-down.
pub(crate) fn drive(ports: &[Gpio; 3], timers: &PwmTimers<'_>, servos: &Pca9685) -> Drive {
    let heaters = HEATER_PINS.map(|Heater(port, pin, function, timer, channel)| {
        let timer = match timer {
            Tim1 => timers.tim1,
            Tim3 => timers.tim3,
            Tim4 => timers.tim4,
            Tim8 => timers.tim8,
        };
        match ports[port].pin(pin) {
            Pin::Level(true) => Duty::FULL,
            Pin::Alternate(number) if number == function => timer.duty(channel),
            Pin::Level(false) | Pin::Floating | Pin::Alternate(_) => Duty::OFF,
        }
    });
    let high = |port: usize, pin| ports[port].pin(pin) == Pin::Level(true);
    Drive {
        heaters,
        springs: SPRING_PINS.map(|pin| high(B, pin)),
        main_switch: high(C, MAIN_SWITCH),
        servos: if ports[C].pin(SERVOS_ENABLE) == Pin::Level(false) { servos.pulses() } else { [None; 16] },
    }
}
