//! The seam between the core and what surrounds it: readings in, actuator commands out. A board joins these
//! to pins, the simulator to a plant.

use zygote_protocol::{Milliamps, Millivolts};

/// Full scale of an [`Inputs::thermistors`] reading: 12 bits.
pub const ADC_FULL_SCALE: u16 = 4095;

/// Heater power as a share of full, in per mille (0 to 1000).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Duty(u16);

impl Duty {
    /// Off.
    pub const OFF: Self = Self(0);
    /// Full power.
    pub const FULL: Self = Self(1000);

    /// A duty of `per_mille`, at most 1000.
    pub const fn new(per_mille: u16) -> Self {
        Self(if per_mille > 1000 { 1000 } else { per_mille })
    }

    /// The share of full power, 0 to 1000.
    pub const fn per_mille(self) -> u16 {
        self.0
    }
}

/// Width of a servo pulse in microseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PulseMicros(pub u16);

/// One reading of everything that a board senses.
#[derive(Debug, Clone, Copy)]
pub struct Inputs<'a> {
    /// Divider reading of each heater's thermistor, 0 to [`ADC_FULL_SCALE`], ratiometric: the thermistor lies
    /// between the input and ground, the pull-up between the input and the reference.
    pub thermistors: &'a [u16],
    /// Voltage of the actuator supply, behind the main switch's input.
    pub supply: Millivolts,
    /// Current drawn from the actuator supply.
    pub current: Milliamps,
    /// The emergency stop button is pressed (or its wire is cut).
    pub stop_pressed: bool,
    /// The servos don't get their pulses: their driver doesn't answer, for example.
    pub servos_lost: bool,
}

/// What every actuator is to do from now on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outputs<const HEATERS: usize, const SERVOS: usize, const SPRINGS: usize> {
    /// Power of each heater.
    pub heaters: [Duty; HEATERS],
    /// Pulse of each servo; `None` sends none, so the servo is limp.
    pub servos: [Option<PulseMicros>; SERVOS],
    /// Burn wire or latch of each spring is energised.
    pub springs: [bool; SPRINGS],
    /// The main switch of the actuator supply is closed.
    pub main_switch: bool,
}

impl<const HEATERS: usize, const SERVOS: usize, const SPRINGS: usize> Outputs<HEATERS, SERVOS, SPRINGS> {
    /// Everything off, the state from reset on (S1).
    pub const OFF: Self = Self {
        heaters: [Duty::OFF; HEATERS],
        servos: [None; SERVOS],
        springs: [false; SPRINGS],
        main_switch: false,
    };
}
