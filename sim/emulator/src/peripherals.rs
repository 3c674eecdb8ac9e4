//! The chip's peripherals behind their addresses, and what they say to the interrupt controller.
//!
//! An access to something that isn't modelled is refused and remembered: a program that needs more than there is here
//! is told so, with the address, and doesn't run on with made-up values.

use crate::adc::{Adc, Analog};
use crate::exti::Exti;
use crate::flash::Flash;
use crate::gpio::Gpio;
use crate::i2c::I2c;
use crate::pca9685::Pca9685;
use crate::pins::{ACTUATORS, Drive, PwmTimers, SELECT, STOP, drive};
use crate::plain::Plain;
use crate::rcc::{Bus, Rcc, Reset};
use crate::time::Clock;
use crate::timers::{self, Kind, Timer};
use crate::usart::Usart;
use crate::watchdog::Watchdog;

/// Interrupt numbers of the STM32F446 (RM0390, table 38).
const ADC_IRQ: u16 = 18;
const EXTI9_5_IRQ: u16 = 23;
const USART2_IRQ: u16 = 38;
const EXTI15_10_IRQ: u16 = 40;

/// A timer's place: address, bus and bit of its clock, its interrupt.
struct TimerPlace(u32, Bus, u32, u16, Kind);

const TIMERS: [TimerPlace; 8] = [
    TimerPlace(0x4001_0000, Bus::Apb2, 0, 25, Kind::Advanced), // TIM1
    TimerPlace(0x4000_0400, Bus::Apb1, 1, 29, Kind::General),  // TIM3
    TimerPlace(0x4000_0800, Bus::Apb1, 2, 30, Kind::General),  // TIM4
    TimerPlace(0x4001_0400, Bus::Apb2, 1, 44, Kind::Advanced), // TIM8
    TimerPlace(0x4000_0000, Bus::Apb1, 0, 28, Kind::Wide),     // TIM2
    TimerPlace(0x4000_0c00, Bus::Apb1, 3, 50, Kind::Wide),     // TIM5
    TimerPlace(0x4000_1000, Bus::Apb1, 4, 54, Kind::General),  // TIM6
    TimerPlace(0x4000_1400, Bus::Apb1, 5, 55, Kind::General),  // TIM7
];
/// Those that drive heaters come first.
const PWM_TIMERS: usize = 4;

/// A program that reads a counter more often than this, and nothing else meanwhile, waits for it.
const POLLS: u32 = 3;

/// The converter's channel behind the multiplexer.
const THERMISTORS: u32 = 0;

/// An access that nothing here answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Unmodelled {
    pub(crate) address: u32,
    pub(crate) write: bool,
}

/// What an access is to be followed by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum After {
    /// Nothing.
    Go,
    /// Interrupts and the next event have to be looked at.
    Look,
}

#[derive(Debug)]
pub(crate) struct Peripherals {
    pub(crate) clock: Clock,
    pub(crate) analog: Analog,
    pub(crate) usart: Usart,
    pub(crate) drive: Drive,
    pub(crate) refused: Option<Unmodelled>,
    pub(crate) flash: Flash,
    /// When rounds of readings began, in picoseconds, if somebody wants to know.
    pub(crate) rounds: Option<Vec<u64>>,
    rcc: Rcc,
    ports: [Gpio; 3],
    timers: [Timer; 8],
    adc: Adc,
    exti: Exti,
    plain: Plain,
    watchdog: Watchdog,
    i2c: I2c,
    servos: Pca9685,
    /// How often a counter was read since anything else was touched.
    polls: u32,
}

impl Peripherals {
    /// The numbers of all interrupts that can be raised here.
    pub(crate) const INTERRUPTS: [u16; 12] = [
        ADC_IRQ,
        EXTI9_5_IRQ,
        USART2_IRQ,
        EXTI15_10_IRQ,
        TIMERS[0].3,
        TIMERS[1].3,
        TIMERS[2].3,
        TIMERS[3].3,
        TIMERS[4].3,
        TIMERS[5].3,
        TIMERS[6].3,
        TIMERS[7].3,
    ];

    pub(crate) fn new(flash: Flash) -> Self {
        let rcc = Rcc::new(Reset::Power);
        let mut ports = ['A', 'B', 'C'].map(Gpio::new);
        // The board pulls the stop button up.
        ports[2].apply(STOP, true);
        Self {
            clock: Clock::new(rcc.core_hz()),
            analog: Analog::default(),
            usart: Usart::new(),
            drive: Drive::OFF,
            refused: None,
            flash,
            rounds: None,
            rcc,
            ports,
            timers: TIMERS.map(|TimerPlace(.., kind)| Timer::new(kind)),
            adc: Adc::new(),
            exti: Exti::default(),
            plain: Plain::default(),
            watchdog: Watchdog::new(),
            i2c: I2c::new(),
            servos: Pca9685::new(),
            polls: 0,
        }
    }

    /// A reset of the chip: everything as after power-on but for the flags that say why.
    pub(crate) fn reset(&mut self, reset: Reset, now: u64) {
        self.rcc.reset(reset);
        self.clock.set_rate(now, self.rcc.core_hz());
        for (port, letter) in self.ports.iter_mut().zip(['A', 'B', 'C']) {
            port.reset(letter);
        }
        self.timers.iter_mut().for_each(Timer::reset);
        self.adc.reset();
        self.usart.reset();
        self.i2c.reset();
        self.flash.reset();
        self.exti = Exti::default();
        self.plain = Plain::default();
        self.watchdog = Watchdog::new();
        self.follow_clocks(now);
        self.look_at_pins();
    }

    /// Presses or releases the stop button, which is low when pressed.
    pub(crate) fn press_stop(&mut self, pressed: bool) {
        let before = self.ports[2].level(STOP);
        self.ports[2].apply(STOP, !pressed);
        if before == pressed {
            self.exti.edge(2, STOP, !pressed);
        }
    }

    pub(crate) fn read(&mut self, address: u32, now: u64) -> Option<(u32, After)> {
        let word = address & !3;
        let offset = word & 0x3ff;
        if let Some(at) = timer_at(word) {
            let on = self.timer_is_on(at);
            return Some((if on { self.timers[at].read(offset, now) } else { 0 }, After::Go));
        }
        let go = |value| Some((value, After::Go));
        match word {
            0x4000_3000..0x4000_3400 => go(self.watchdog.read(offset)),
            0x4000_4400..0x4000_4800 if self.rcc.enabled(Bus::Apb1, 17) => {
                Some((self.usart.read(offset, now), After::Look))
            }
            0x4000_5800..0x4000_5c00 if self.rcc.enabled(Bus::Apb1, 22) => {
                let value = self.i2c.read(offset, now, &mut self.servos);
                Some((value, self.look_at_pins()))
            }
            0x4001_2000..0x4001_2400 if self.rcc.enabled(Bus::Apb2, 8) => go(self.adc.read(offset, now)),
            0x4001_3800..0x4001_3c00 => go(self.exti.read_system(offset)),
            0x4001_3c00..0x4001_4000 => go(self.exti.read(offset)),
            0x4002_0000..0x4002_0c00 => {
                let port = (word >> 10 & 3) as usize;
                let on = self.rcc.enabled(Bus::Ahb1, word >> 10 & 3);
                go(if on { self.ports[port].read(offset) } else { 0 })
            }
            0x4002_3800..0x4002_3c00 => go(self.rcc.read(offset)),
            0x4002_3c00..0x4002_4000 => go(self.flash.read(offset)),
            // Without a clock they read as nothing.
            0x4000_4400..0x4000_4800 | 0x4000_5800..0x4000_5c00 | 0x4001_2000..0x4001_2400 => go(0),
            _ if Plain::holds(word) => go(self.plain.read(word)),
            _ => {
                self.refuse(address, false);
                None
            }
        }
    }

    pub(crate) fn write(&mut self, address: u32, value: u32, now: u64) -> Option<After> {
        self.polls = 0;
        let word = address & !3;
        let offset = word & 0x3ff;
        if let Some(at) = timer_at(word) {
            if self.timer_is_on(at) {
                self.timers[at].write(offset, value, now);
                if at < PWM_TIMERS {
                    self.look_at_pins();
                }
            }
            return Some(After::Look);
        }
        match word {
            0x4000_3000..0x4000_3400 => self.watchdog.write(offset, value, self.clock.ps(now)),
            0x4000_4400..0x4000_4800 => {
                if self.rcc.enabled(Bus::Apb1, 17) {
                    self.usart.write(offset, value, now);
                }
            }
            0x4000_5800..0x4000_5c00 => {
                if self.rcc.enabled(Bus::Apb1, 22) {
                    self.i2c.write(offset, value, now, &mut self.servos);
                    return Some(self.look_at_pins());
                }
                return Some(After::Go);
            }
            0x4001_2000..0x4001_2400 => {
                if self.rcc.enabled(Bus::Apb2, 8) {
                    let (analog, port) = (&self.analog, &self.ports[2]);
                    let before = self.adc.over();
                    self.adc.write(offset, value, now, |channel| input(analog, port, channel));
                    let first = self.adc.channel() == THERMISTORS && selected(port) == 0;
                    if let (true, Some(rounds)) = (first && self.adc.over() != before, &mut self.rounds) {
                        rounds.push(self.clock.ps(now));
                    }
                }
                return Some(After::Go);
            }
            0x4001_3800..0x4001_3c00 => self.exti.write_system(offset, value),
            0x4001_3c00..0x4001_4000 => self.exti.write(offset, value),
            0x4002_0000..0x4002_0c00 => {
                let port = (word >> 10 & 3) as usize;
                if self.rcc.enabled(Bus::Ahb1, word >> 10 & 3) {
                    self.ports[port].write(offset, value);
                    let only_others = offset == 0x18 && (value | value >> 16) & ACTUATORS[port] == 0;
                    if !only_others {
                        return Some(self.look_at_pins());
                    }
                }
                return Some(After::Go);
            }
            0x4002_3800..0x4002_3c00 => self.write_clocks(offset, value, now),
            0x4002_3c00..0x4002_4000 => self.flash.write(offset, value),
            _ if Plain::holds(word) => self.plain.write(word, value),
            _ => {
                self.refuse(address, true);
                return None;
            }
        }
        Some(After::Look)
    }

    /// Notes what has happened by now; the numbers of the interrupts with whether they are raised.
    pub(crate) fn interrupts(&mut self, now: u64) -> impl Iterator<Item = (u16, bool)> {
        self.usart.sync(now);
        let mut timers = [(0, false); TIMERS.len()];
        for ((line, timer), TimerPlace(.., irq, _)) in timers.iter_mut().zip(&mut self.timers).zip(&TIMERS) {
            timer.sync(now);
            *line = (*irq, timer.interrupts());
        }
        let others = [
            (ADC_IRQ, false),
            (EXTI9_5_IRQ, self.exti.interrupts(0x03e0)),
            (EXTI15_10_IRQ, self.exti.interrupts(0xfc00)),
            (USART2_IRQ, self.usart.interrupts()),
        ];
        timers.into_iter().chain(others)
    }

    /// The next cycle at which something happens by itself.
    pub(crate) fn next_event(&self) -> Option<u64> {
        let timers = self.timers.iter().filter_map(Timer::next_event);
        timers.chain(self.usart.next_event()).chain(self.watchdog_due()).min()
    }

    /// Writes to the flash's array.
    pub(crate) fn program(&mut self, address: u32, bytes: u32, value: u32) {
        self.flash.program(address, bytes, value);
    }

    /// Cycles that the core has to stand still.
    pub(crate) fn take_stall(&mut self, now: u64) -> u64 {
        match self.flash.take_stall_us() {
            0 => 0,
            us => self.clock.cycles(self.clock.ps(now) + us * 1_000_000) - now,
        }
    }

    /// When the watchdog resets the chip.
    pub(crate) fn watchdog_due(&self) -> Option<u64> {
        self.watchdog.due().map(|due| self.clock.cycles(due))
    }

    /// Until when a program that reads here waits: for the end of the conversion under way, or for the next value of a counter
    /// that it has read again and again without touching anything else.
    pub(crate) fn awaited(&mut self, address: u32, now: u64) -> Option<u64> {
        let counter = timer_at(address).filter(|_| address & 0x3ff == timers::CNT);
        self.polls = if counter.is_some() { self.polls.saturating_add(1) } else { 0 };
        match counter {
            Some(timer) if self.polls > POLLS => self.timers[timer].next_count(now),
            Some(_) => None,
            None => (address == 0x4001_2000).then(|| self.adc.over()).flatten(),
        }
    }

    fn refuse(&mut self, address: u32, write: bool) {
        self.refused.get_or_insert(Unmodelled { address, write });
    }

    fn timer_is_on(&self, at: usize) -> bool {
        let TimerPlace(_, bus, bit, ..) = TIMERS[at];
        self.rcc.enabled(bus, bit)
    }

    fn write_clocks(&mut self, offset: u32, value: u32, now: u64) {
        self.rcc.write(offset, value);
        if let Some(bus) = Rcc::resets(offset) {
            let on = |bit: u32| value >> bit & 1 == 1;
            for (timer, TimerPlace(_, of, bit, ..)) in self.timers.iter_mut().zip(&TIMERS) {
                if *of == bus && on(*bit) {
                    timer.reset();
                }
            }
            match bus {
                Bus::Apb1 => {
                    if on(17) {
                        self.usart.reset();
                    }
                    if on(22) {
                        self.i2c.reset();
                    }
                }
                Bus::Apb2 if on(8) => self.adc.reset(),
                Bus::Ahb1 | Bus::Apb2 => {}
            }
            self.look_at_pins();
        }
        self.clock.set_rate(now, self.rcc.core_hz());
        self.follow_clocks(now);
    }

    fn follow_clocks(&mut self, now: u64) {
        for (timer, TimerPlace(_, bus, ..)) in self.timers.iter_mut().zip(&TIMERS) {
            timer.set_divisor(self.rcc.timer_divisor(*bus), now);
        }
        self.usart.set_divisor(self.rcc.divisor(Bus::Apb1));
        self.i2c.set_divisor(self.rcc.divisor(Bus::Apb1));
        self.adc.set_divisor(self.rcc.divisor(Bus::Apb2));
    }

    /// What the pins do now; a change is to be looked at.
    fn look_at_pins(&mut self) -> After {
        let [tim1, tim3, tim4, tim8, ..] = &self.timers;
        let timers = PwmTimers { tim1, tim3, tim4, tim8 };
        let before = self.drive;
        self.drive = drive(&self.ports, &timers, &self.servos);
        if self.drive == before { After::Go } else { After::Look }
    }
}

fn timer_at(word: u32) -> Option<usize> {
    TIMERS.iter().position(|TimerPlace(base, ..)| word & !0x3ff == *base)
}

/// What lies at a channel of the converter.
fn input(analog: &Analog, port: &Gpio, channel: u32) -> u16 {
    match channel {
        THERMISTORS => analog.thermistors[selected(port)],
        1 => analog.supply,
        4 => analog.current,
        _ => 0,
    }
}

/// The multiplexer's input that its select pins name.
fn selected(port: &Gpio) -> usize {
    SELECT.fold(0, |selected, bit| selected | usize::from(port.level(bit)) << bit)
}
