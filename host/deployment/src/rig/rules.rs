//! The rules that a rig file keeps whatever the plan. Each refusal names the key that is to be changed.

use super::places::Place;
use super::quantity::{Amps, Celsius, Degrees, Seconds};
use super::rating::Rating;
use super::servo_curve::ServoCurve;
use super::settings::{Drive, Kind, SERVO_PULSES, ServoSettings, SmaSettings, SpringSettings};
use super::sim::{ServoPlant, SmaPlant};
use super::weight::Weight;
use super::{Entry, Rig, RigError};
use crate::heating;
use std::collections::BTreeSet;
use std::fmt::Display;

/// The wire has room for no more.
const ID_BYTES: usize = 32;
/// S3.
const LONGEST_TIMEOUT: Seconds = Seconds(5.0);
/// No motion of a hinge takes an hour; also keeps every time within the wire's 32 bits of milliseconds.
const LONGEST_TIME: Seconds = Seconds(3600.0);
/// Paper and plastic stand beside the hinges; nothing sane is set beyond.
const HOTTEST: Celsius = Celsius(250.0);
const COLDEST: Celsius = Celsius(-40.0);
/// A simulated servo that bows further would turn back.
const MOST_BOW: Degrees = Degrees(67.0);
/// No hinge has stops beyond.
const STOPS: (Degrees, Degrees) = (Degrees(-90.0), Degrees(360.0));

/// Holds the rules of one table against its keys' places.
pub(super) struct Rules<'a, P: Fn(&str) -> Place> {
    pub(super) place: P,
    pub(super) rig: &'a Rig,
}

impl Rig {
    pub(super) fn check(&self) -> Result<(), RigError> {
        let rules = Rules { place: |key: &str| self.places.of(key), rig: self };
        let id_fits = (1..=ID_BYTES).contains(&self.id.len());
        rules.hold(id_fits, "rig.id", &format!("1 to {ID_BYTES} bytes"), &format!("{}", self.id.len()))?;
        rules.between("rig.ambient", self.ambient, COLDEST, HOTTEST)?;
        rules.above_0("supply.voltage", self.supply.voltage.0, self.supply.voltage)?;
        rules.above_0("supply.limit", self.supply.limit.0, self.supply.limit)?;
        rules.at_least_0("supply.resistance", self.supply.resistance.0, self.supply.resistance)?;
        rules.hold(
            self.lowest_voltage() > 0.0,
            "supply.resistance",
            "a voltage that is left at the current limit",
            &format!("{} x {} of {}", self.supply.limit, self.supply.resistance, self.supply.voltage),
        )?;
        rules.time("link.timeout", self.link.timeout)?;
        rules.at_most("link.timeout", self.link.timeout, &"", LONGEST_TIMEOUT)?;
        rules.hold(self.link.baud > 0, "link.baud", "bits per second above 0", "0")?;
        rules.hold(!self.nodes.is_empty(), "node", "at least one [[node]]", "none")?;
        let mut names = BTreeSet::new();
        for (index, node) in self.nodes.iter().enumerate() {
            let once = names.insert(node.name.as_str());
            rules.hold(once, &format!("node[{index}].name"), "another name for every node", &node.name)?;
        }
        match &self.panel {
            None => {}
            Some(Weight::Each(mass)) => {
                rules.above_0("panel.mass", mass.0, mass)?;
                let both = self.places.of("panel.density").line.is_some();
                rules.hold(!both, "panel.density", "either a mass or a density", "both")?;
            }
            Some(Weight::PerArea(density)) => rules.above_0("panel.density", density.0, density)?,
        }
        let direction = self.gravity.direction;
        let direction_found = format!("{direction:?}");
        let is_direction = direction.iter().all(|x| x.is_finite()) && direction.iter().any(|x| *x != 0.0);
        rules.hold(
            is_direction,
            "gravity.direction",
            "three finite numbers, not all of them 0",
            &direction_found,
        )?;
        self.check_hinges()
    }

    fn check_hinges(&self) -> Result<(), RigError> {
        for kind in Kind::ALL {
            let prefix = kind.name();
            let rules = Rules { place: |key: &str| self.places.of(format!("{prefix}.{key}")), rig: self };
            // The defaults of a kind that the rig doesn't have may not suit its supply.
            if kind == self.default_kind || self.places.of(prefix).line.is_some() {
                rules.drive(&self.shared(kind))?;
            }
        }
        let mut seen = BTreeSet::new();
        for (index, entry) in self.entries.iter().enumerate() {
            let own = Rules { place: |key: &str| self.places.of(format!("hinge[{index}].{key}")), rig: self };
            let once = seen.insert(entry.hinge);
            own.hold(once, "hinge", "every hinge once", &format!("{} again", entry.hinge))?;
            self.check_node(index, entry)?;
            let kind = entry.drive.kind();
            for other in Kind::ALL.into_iter().filter(|other| *other != kind) {
                let place = (own.place)(other.name());
                let expected = format!("settings of its kind, {}", kind.name());
                let found = format!("settings of {}", other.name());
                own.hold(place.line.is_none(), other.name(), &expected, &found)?;
            }
            let prefix = kind.name();
            let place = |key: &str| {
                self.places.of_first(&[format!("hinge[{index}].{prefix}.{key}"), format!("{prefix}.{key}")])
            };
            Rules { place, rig: self }.drive(&entry.drive)?;
        }
        let (sma, servo) = self.sim.shared();
        Rules { place: |key: &str| self.places.of(format!("sim.sma.{key}")), rig: self }.sma_plant(sma)?;
        Rules { place: |key: &str| self.places.of(format!("sim.servo.{key}")), rig: self }
            .servo_plant(servo)?;
        for (hinge, plant) in self.sim.hinges() {
            let place = |key: &str| self.places.of(format!("sim.hinge (hinge {hinge}): sma.{key}"));
            Rules { place, rig: self }.sma_plant(plant)?;
        }
        for (hinge, plant) in self.sim.servos() {
            let place = |key: &str| self.places.of(format!("sim.hinge (hinge {hinge}): servo.{key}"));
            Rules { place, rig: self }.servo_plant(plant)?;
        }
        let rules = Rules { place: |key: &str| self.places.of(key), rig: self };
        rules.between("sim.ambient", self.sim.ambient, COLDEST, HOTTEST)
    }

    /// A hinge's node exists, and is named where its channel alone doesn't say which one it is of.
    fn check_node(&self, index: usize, entry: &Entry) -> Result<(), RigError> {
        let rules = Rules { place: |key: &str| self.places.of(format!("hinge[{index}].{key}")), rig: self };
        let names: Vec<_> = self.nodes.iter().map(|node| node.name.as_str()).collect();
        if let Some(name) = &entry.node {
            let known = names.contains(&name.as_str());
            return rules.hold(known, "node", &format!("one of the nodes {}", names.join(", ")), name);
        }
        let clear = entry.channel.is_none() || names.len() == 1;
        rules.hold(
            clear,
            "channel",
            &format!("a node beside it, one of {}", names.join(", ")),
            "a channel alone",
        )
    }

    /// The lowest voltage, in volts, that actuators see while the current is within its limit.
    pub(crate) fn lowest_voltage(&self) -> f64 {
        self.supply.voltage.0 - self.supply.limit.0 * self.supply.resistance.0
    }
}

impl<P: Fn(&str) -> Place> Rules<'_, P> {
    fn hold(&self, holds: bool, key: &str, expected: &str, found: &str) -> Result<(), RigError> {
        if holds {
            return Ok(());
        }
        Err(RigError::Value {
            place: (self.place)(key),
            expected: expected.to_owned(),
            found: found.to_owned(),
        })
    }

    fn above_0(&self, key: &str, raw: f64, found: impl Display) -> Result<(), RigError> {
        self.hold(raw > 0.0, key, "more than 0", &found.to_string())
    }

    fn at_least_0(&self, key: &str, raw: f64, found: impl Display) -> Result<(), RigError> {
        self.hold(raw >= 0.0, key, "0 or more", &found.to_string())
    }

    /// `what` says where the limit is set, if not by this program.
    fn at_most<T: PartialOrd + Display + Copy>(
        &self,
        key: &str,
        value: T,
        what: &dyn Display,
        limit: T,
    ) -> Result<(), RigError> {
        self.hold(value <= limit, key, &format!("at most {what}{limit}"), &value.to_string())
    }

    fn between<T: PartialOrd + Display + Copy>(
        &self,
        key: &str,
        value: T,
        low: T,
        high: T,
    ) -> Result<(), RigError> {
        self.hold(value >= low && value <= high, key, &format!("{low} to {high}"), &value.to_string())
    }

    fn below<T: PartialOrd + Display + Copy>(
        &self,
        key: &str,
        value: T,
        what: &str,
        limit: T,
    ) -> Result<(), RigError> {
        self.hold(value < limit, key, &format!("less than {what} = {limit}"), &value.to_string())
    }

    fn time(&self, key: &str, value: Seconds) -> Result<(), RigError> {
        self.above_0(key, value.0, value)?;
        self.at_most(key, value, &"", LONGEST_TIME)
    }

    fn pause(&self, key: &str, value: Seconds) -> Result<(), RigError> {
        self.at_least_0(key, value.0, value)?;
        self.at_most(key, value, &"", LONGEST_TIME)
    }

    fn current(&self, key: &str, value: Amps) -> Result<(), RigError> {
        self.at_least_0(key, value.0, value)?;
        self.at_most(key, value, &"supply.limit = ", self.rig.supply.limit)
    }

    fn torque(&self, rating: &Rating) -> Result<(), RigError> {
        for (angle, torque) in rating.points() {
            self.above_0("torque", torque.0, torque)?;
            self.between("torque", *angle, Degrees(0.0), Degrees(270.0))?;
        }
        let rising = rating.points().windows(2).all(|pair| pair[0].0 < pair[1].0);
        self.hold(rising, "torque", "rising angles", "an angle that isn't above the one before it")
    }

    pub(super) fn drive(&self, drive: &Drive) -> Result<(), RigError> {
        self.torque(drive.torque())?;
        match drive {
            Drive::Sma(sma) => self.sma(sma),
            Drive::Servo(servo) => self.servo(servo),
            Drive::Spring(spring) => self.spring(spring),
        }
    }

    fn sma(&self, sma: &SmaSettings) -> Result<(), RigError> {
        self.between("max_temperature", sma.max_temperature, COLDEST, HOTTEST)?;
        self.below("target", sma.target, "max_temperature", sma.max_temperature)?;
        self.below("austenite_start", sma.austenite_start, "austenite_finish", sma.austenite_finish)?;
        self.below("austenite_finish", sma.austenite_finish, "target", sma.target)?;
        self.below("cool_to", sma.cool_to, "austenite_start", sma.austenite_start)?;
        self.hold(
            sma.cool_to > self.rig.ambient,
            "cool_to",
            &format!("more than rig.ambient = {}", self.rig.ambient),
            &sma.cool_to.to_string(),
        )?;
        self.pause("hold", sma.hold)?;
        self.time("max_on", sma.max_on)?;
        self.hold(
            sma.max_on > sma.hold,
            "max_on",
            &format!("more than hold = {}", sma.hold),
            &sma.max_on.to_string(),
        )?;
        self.pause("rest", sma.rest)?;
        self.above_0("min_gain", sma.min_gain.0, sma.min_gain)?;
        self.time("gain_window", sma.gain_window)?;
        self.hold(
            sma.gain_window <= sma.max_on,
            "gain_window",
            &format!("at most max_on = {}", sma.max_on),
            &sma.gain_window.to_string(),
        )?;
        self.above_0("heater_resistance", sma.heater_resistance.0, sma.heater_resistance)?;
        self.above_0("thermal_resistance", sma.thermal_resistance.0, sma.thermal_resistance)?;
        self.time("time_constant", sma.time_constant)?;
        self.at_least_0("latent_heat", sma.latent_heat.0, sma.latent_heat)?;
        let current = heating::current(self.rig, sma);
        let least = self.rig.supply.voltage.0 / self.rig.supply.limit.0;
        self.hold(
            current <= self.rig.supply.limit,
            "heater_resistance",
            &format!("{:.3} or more, so that it draws at most supply.limit", super::Ohms(least)),
            &format!("{}, which draws {current:.3}", sma.heater_resistance),
        )?;
        let settled = heating::settled(self.rig, sma);
        self.hold(
            settled > sma.target,
            "target",
            &format!("less than {settled:.1}, all that the heater reaches"),
            &sma.target.to_string(),
        )?;
        let on = Seconds(heating::time_to_target(self.rig, sma).0 + sma.hold.0);
        self.hold(
            on < sma.max_on,
            "max_on",
            &format!("more than {on:.1}, the expected time of heating and hold"),
            &sma.max_on.to_string(),
        )
    }

    fn servo(&self, servo: &ServoSettings) -> Result<(), RigError> {
        let (shortest, longest) = (servo.shortest_pulse, servo.longest_pulse);
        self.between("shortest_pulse", shortest, SERVO_PULSES.0, SERVO_PULSES.1)?;
        self.between("longest_pulse", longest, SERVO_PULSES.0, SERVO_PULSES.1)?;
        self.below("shortest_pulse", shortest, "longest_pulse", longest)?;
        self.between("pulse_0", servo.pulse_0, shortest, longest)?;
        self.between("pulse_270", servo.pulse_270, shortest, longest)?;
        for (angle, pulse) in servo.curve.iter().flat_map(ServoCurve::points) {
            self.between(&format!("pulse at {angle}"), *pulse, shortest, longest)?;
        }
        let differ = (servo.pulse_0.0 - servo.pulse_270.0).abs() > f64::EPSILON;
        self.hold(differ, "pulse_270", "another pulse than pulse_0", &servo.pulse_270.to_string())?;
        self.above_0("speed", servo.speed.0, servo.speed)?;
        self.time("speed", Seconds(270.0 / servo.speed.0))?;
        self.time("settle", servo.settle)?;
        self.current("current", servo.current)?;
        self.at_least_0("hold_current", servo.hold_current.0, servo.hold_current)?;
        self.at_most("hold_current", servo.hold_current, &"current = ", servo.current)
    }

    fn spring(&self, spring: &SpringSettings) -> Result<(), RigError> {
        self.time("pulse", spring.pulse)?;
        self.pause("settle", spring.settle)?;
        self.current("current", spring.current)
    }

    fn sma_plant(&self, plant: &SmaPlant) -> Result<(), RigError> {
        self.above_0("heater_resistance", plant.heater_resistance.0, plant.heater_resistance)?;
        self.above_0("convection", plant.convection.0, plant.convection)?;
        self.at_least_0("panel_conductance", plant.panel_conductance.0, plant.panel_conductance)?;
        self.below("martensite_finish", plant.martensite_finish, "martensite_start", plant.martensite_start)?;
        self.below("austenite_start", plant.austenite_start, "austenite_finish", plant.austenite_finish)?;
        self.below("martensite_finish", plant.martensite_finish, "austenite_start", plant.austenite_start)?;
        self.below("martensite_start", plant.martensite_start, "austenite_finish", plant.austenite_finish)?;
        self.at_least_0("load", plant.load.0, plant.load)
    }

    fn servo_plant(&self, plant: &ServoPlant) -> Result<(), RigError> {
        for (key, pulse) in [("pulse_0", plant.pulse_0.0), ("pulse_270", plant.pulse_270.0)] {
            if let Some(pulse) = pulse {
                self.between(key, pulse, SERVO_PULSES.0, SERVO_PULSES.1)?;
            }
        }
        let differ = plant.pulse_0.0.is_none() || plant.pulse_0 != plant.pulse_270;
        self.hold(differ, "pulse_270", "another pulse than pulse_0", "the same")?;
        self.between("bow", plant.bow, Degrees(-MOST_BOW.0), MOST_BOW)?;
        self.at_least_0("dead_band", plant.dead_band.0, plant.dead_band)?;
        self.at_least_0("backlash", plant.backlash.0, plant.backlash)?;
        self.between("stop_low", plant.stop_low, STOPS.0, STOPS.1)?;
        self.between("stop_high", plant.stop_high, STOPS.0, STOPS.1)?;
        self.below("stop_low", plant.stop_low, "stop_high", plant.stop_high)
    }
}
