//! A hinge turned by a hobby servo.
//!
//! ```text
//!             no pulse, or no power
//!   any ------------------------------> Limp
//!   Limp, Holding -- target beyond the dead band --> Moving
//!   Moving -- target reached --> Holding
//!   Moving -- end stop or jam --> Stalled -- target within reach --> Moving or Holding
//! ```
//!
//! The motor turns; the hinge follows it with some backlash.

use zygote_core::PulseMicros;

use super::error::{Place, PlantError, finite, not_negative, positive};

/// A servo and the hinge on it. Angles are the hinge's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoConfig {
    /// Where it stands at the start.
    pub start_deg: f64,
    /// Shortest pulse, which commands `pulse_min_deg`; shorter ones do the same.
    pub pulse_min_us: f64,
    /// Longest pulse, which commands `pulse_max_deg`; longer ones do the same.
    pub pulse_max_us: f64,
    /// Angle commanded by the shortest pulse.
    pub pulse_min_deg: f64,
    /// Angle commanded by the longest pulse.
    pub pulse_max_deg: f64,
    /// The commanded angle lies so far above the straight line in the middle between the two pulses: a parabola.
    pub bow_deg: f64,
    /// Lower end stop of the hinge.
    pub stop_low_deg: f64,
    /// Upper end stop of the hinge.
    pub stop_high_deg: f64,
    /// Speed at `rated_v`; it goes with the voltage.
    pub slew_deg_per_s: f64,
    /// Error below which it does not move.
    pub dead_band_deg: f64,
    /// Play between motor and hinge: so much the motor turns before the hinge follows it back.
    pub backlash_deg: f64,
    /// Voltage that the speed is given at.
    pub rated_v: f64,
    /// Current while it stands still or is limp.
    pub idle_ma: f64,
    /// Current while it moves.
    pub moving_ma: f64,
    /// Current while it pushes and cannot move.
    pub stall_ma: f64,
}

impl Default for ServoConfig {
    /// A 270° metal-gear servo of the common 20 kg cm class at 5 V: 500 to 2500 us, 0.16 s per 60°, 3 us of dead
    /// band (0.4°), and 5 mA, some 100 to 200 mA and 1.8 A as such data sheets have them.
    fn default() -> Self {
        Self {
            start_deg: 0.0,
            pulse_min_us: 500.0,
            pulse_max_us: 2500.0,
            pulse_min_deg: 0.0,
            pulse_max_deg: 270.0,
            bow_deg: 0.0,
            stop_low_deg: 0.0,
            stop_high_deg: 270.0,
            slew_deg_per_s: 375.0,
            dead_band_deg: 0.4,
            backlash_deg: 0.0,
            rated_v: 5.0,
            idle_ma: 5.0,
            moving_ma: 180.0,
            stall_ma: 1800.0,
        }
    }
}

impl ServoConfig {
    /// The angle that `pulse` commands.
    pub fn angle_deg_from(&self, pulse: PulseMicros) -> f64 {
        let share = (f64::from(pulse.0) - self.pulse_min_us) / (self.pulse_max_us - self.pulse_min_us);
        let share = share.clamp(0.0, 1.0);
        let line_deg = self.pulse_min_deg + (self.pulse_max_deg - self.pulse_min_deg) * share;
        line_deg + 4.0 * self.bow_deg * share * (1.0 - share)
    }

    pub(super) fn check(&self, place: Place) -> Result<(), PlantError> {
        finite(place, "shortest pulse (us)", self.pulse_min_us)?;
        positive(place, "longest less shortest pulse (us)", self.pulse_max_us - self.pulse_min_us)?;
        finite(place, "angle of the shortest pulse (°)", self.pulse_min_deg)?;
        finite(place, "angle of the longest pulse (°)", self.pulse_max_deg)?;
        // Beyond a quarter of the way the parabola would turn back.
        let way_deg = (self.pulse_max_deg - self.pulse_min_deg).abs();
        positive(place, "way less four times the bow (°)", way_deg - 4.0 * self.bow_deg.abs())?;
        not_negative(place, "backlash (°)", self.backlash_deg)?;
        positive(place, "upper less lower end stop (°)", self.stop_high_deg - self.stop_low_deg)?;
        not_negative(place, "start above the lower end stop (°)", self.start_deg - self.stop_low_deg)?;
        not_negative(place, "start below the upper end stop (°)", self.stop_high_deg - self.start_deg)?;
        positive(place, "slew rate (°/s)", self.slew_deg_per_s)?;
        not_negative(place, "dead band (°)", self.dead_band_deg)?;
        positive(place, "rated voltage (V)", self.rated_v)?;
        not_negative(place, "idle current (mA)", self.idle_ma)?;
        not_negative(place, "moving current (mA)", self.moving_ma)?;
        not_negative(place, "stall current (mA)", self.stall_ma)
    }
}

/// What a servo does at this moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ServoActivity {
    /// No pulse or no power: stays where friction keeps it.
    Limp,
    /// At its commanded angle.
    Holding,
    /// On its way.
    Moving,
    /// Pushes against an end stop or a jam.
    Stalled,
}

/// A servo hinge at work.
#[derive(Debug, Clone)]
pub struct ServoHinge {
    config: ServoConfig,
    motor_deg: f64,
    /// The hinge: within half the backlash of the motor.
    angle_deg: f64,
    activity: ServoActivity,
    jammed: bool,
    stalled: bool,
}

impl ServoHinge {
    pub(super) fn new(config: ServoConfig) -> Self {
        Self {
            config,
            motor_deg: config.start_deg,
            angle_deg: config.start_deg,
            activity: ServoActivity::Limp,
            jammed: false,
            stalled: false,
        }
    }

    /// True angle.
    pub fn angle_deg(&self) -> f64 {
        self.angle_deg
    }

    /// What it does.
    pub fn activity(&self) -> ServoActivity {
        self.activity
    }

    /// Takes up the pulse that arrives now, and says what current it draws for it.
    pub(super) fn command(&mut self, pulse: Option<PulseMicros>, powered: bool) -> f64 {
        if !powered {
            self.activity = ServoActivity::Limp;
            return 0.0;
        }
        self.activity = match pulse {
            None => ServoActivity::Limp,
            Some(pulse) => {
                let target_deg = self.config.angle_deg_from(pulse);
                let room_deg = self.reachable(target_deg) - self.motor_deg;
                if self.stalled {
                    ServoActivity::Stalled
                } else if (target_deg - self.motor_deg).abs() <= self.config.dead_band_deg {
                    ServoActivity::Holding
                } else if self.jammed || room_deg == 0.0 {
                    ServoActivity::Stalled
                } else {
                    ServoActivity::Moving
                }
            }
        };
        let current_ma = match self.activity {
            ServoActivity::Limp | ServoActivity::Holding => self.config.idle_ma,
            ServoActivity::Moving => self.config.moving_ma,
            ServoActivity::Stalled => self.config.stall_ma,
        };
        current_ma / 1000.0
    }

    /// Turns for `dt_s` at `supply_v` towards what `pulse` commands, if [`ServoHinge::command`] found it moving.
    pub(super) fn advance(&mut self, dt_s: f64, supply_v: f64, pulse: Option<PulseMicros>) {
        if let (ServoActivity::Moving, Some(pulse)) = (self.activity, pulse) {
            let reach_deg = self.config.slew_deg_per_s * supply_v / self.config.rated_v * dt_s;
            let way_deg = self.reachable(self.config.angle_deg_from(pulse)) - self.motor_deg;
            self.motor_deg += way_deg.clamp(-reach_deg, reach_deg);
            let play_deg = self.play_deg();
            self.angle_deg = self.angle_deg.clamp(self.motor_deg - play_deg, self.motor_deg + play_deg);
        }
    }

    pub(super) fn jam(&mut self) {
        self.jammed = true;
    }

    /// Blocks the motor, which then pushes whatever it is asked for.
    pub(super) fn stall(&mut self) {
        self.stalled = true;
    }

    /// The stops are the hinge's: the motor gets half the backlash further.
    fn reachable(&self, target_deg: f64) -> f64 {
        let play_deg = self.play_deg();
        target_deg.clamp(self.config.stop_low_deg - play_deg, self.config.stop_high_deg + play_deg)
    }

    fn play_deg(&self) -> f64 {
        self.config.backlash_deg / 2.0
    }
}
