//! A shape-memory hinge: film heater, nitinol foil, panels, thermistor.
//!
//! ```text
//!   power --> film --coupling--> foil --panel--> ambient
//!              |                  |
//!             air                air
//! ```
//!
//! Two thermal nodes, because the film is hotter than the foil, by some 10 K at 1 W with the
//! defaults: one node would open the hinge too early and hide what the glue and the panels next to the film bear.
//! Within the foil one node is enough: 0.125 mm of nitinol evens out across its thickness in a millisecond.

use super::error::{Hinge, Place, PlantError, finite, not_negative, positive, within};
use super::thermistor::{Condition, Thermistor, ThermistorConfig};
use super::transformation::{Alloy, Transformation};

/// A shape-memory hinge with its heater and thermistor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmaConfig {
    /// Angle before it is heated: 0 for a fold hinge, 180 for a bridge.
    pub start_deg: f64,
    /// Angle of its end stop.
    pub opening_deg: f64,
    /// Shape set into the foil, as a multiple of the way from start to end stop: above 1 it presses on the stop.
    pub overdrive: f64,
    /// Torque of the austenite held at the start angle; it falls to 0 at the memory angle.
    pub blocked_torque_mn_m: f64,
    /// Torque that the hinge works against.
    pub load_mn_m: f64,
    /// What the foil is made of.
    pub alloy: Alloy,
    /// Foil along the fold.
    pub foil_width_m: f64,
    /// Foil across the fold.
    pub foil_length_m: f64,
    /// Thickness of the foil.
    pub foil_thickness_m: f64,
    /// Resistance of the film heater.
    pub heater_ohm: f64,
    /// Heat capacity of the film heater and its glue.
    pub film_j_per_k: f64,
    /// Conductance from the film to the foil.
    pub coupling_w_per_k: f64,
    /// Loss to still air from the free face of the film and from that of the foil.
    pub convection_w_per_m2_k: f64,
    /// Conductance from the foil through its glued ends into the panels.
    pub panel_w_per_k: f64,
    /// The thermistor on the foil.
    pub thermistor: ThermistorConfig,
}

impl SmaConfig {
    /// A fold hinge that opens from 0° to `opening_deg`.
    ///
    /// * Foil 5 mm x 10 mm x 0.125 mm: the SMA sheets of the zygote paper (experimental section). Its end stop
    ///   is a second, folded sheet there; 5 % of overdrive makes it press on the stop, a choice.
    /// * Torque 34 mN m: the published X-shaped nitinol hinge of Robogami (0.1 mm foil, about 180°, 0.5 W).
    /// * Heater 25 Ohm, so 1 W at 5 V: twice what that hinge was run at, to be past Af within about 5 s.
    /// * Film 12 mJ/K: 50 mm^2 of 0.15 mm polyimide laminate at 1420 kg/m^3 and 1090 J/(kg K) (polyimide film
    ///   data sheet). Coupling 75 mW/K: 50 um of polyimide at 0.12 W/(m K) and 50 um of glue at 0.2 W/(m K).
    /// * Air 45 W/(m^2 K): small plates in still air, radiation included, range 20 to 70. Panels 4 mW/K: two
    ///   glued ends on 1 mm of plastic at 0.2 W/(m K), 10 mm^2 each. Together a time constant of 5.4 s.
    pub fn opening(opening_deg: f64) -> Self {
        Self {
            start_deg: 0.0,
            opening_deg,
            overdrive: 1.05,
            blocked_torque_mn_m: 34.0,
            load_mn_m: 0.0,
            alloy: Alloy::LOW_TEMPERATURE,
            foil_width_m: 5.0e-3,
            foil_length_m: 10.0e-3,
            foil_thickness_m: 0.125e-3,
            heater_ohm: 25.0,
            film_j_per_k: 0.012,
            coupling_w_per_k: 0.075,
            convection_w_per_m2_k: 45.0,
            panel_w_per_k: 0.004,
            thermistor: ThermistorConfig::default(),
        }
    }

    /// One face of the foil, which is also one of the film.
    fn face_m2(&self) -> f64 {
        self.foil_width_m * self.foil_length_m
    }

    /// Mass of the foil.
    pub fn foil_kg(&self) -> f64 {
        self.face_m2() * self.foil_thickness_m * self.alloy.density_kg_per_m3
    }

    /// Heat capacity of the foil without its latent heat.
    pub fn foil_j_per_k(&self) -> f64 {
        self.foil_kg() * self.alloy.specific_heat_j_per_kg_k
    }

    /// Latent heat of the whole foil.
    pub fn latent_j(&self) -> f64 {
        self.foil_kg() * self.alloy.latent_j_per_kg
    }

    /// Conductance from the film straight to the air.
    pub fn film_loss_w_per_k(&self) -> f64 {
        self.face_m2() * self.convection_w_per_m2_k
    }

    /// Conductance from the foil to the air and the panels.
    pub fn foil_loss_w_per_k(&self) -> f64 {
        self.face_m2() * self.convection_w_per_m2_k + self.panel_w_per_k
    }

    /// The fastest rate at which either node changes, per second: what bounds the step of the integration.
    pub(super) fn fastest_rate_per_s(&self) -> f64 {
        let film = (self.coupling_w_per_k + self.film_loss_w_per_k()) / self.film_j_per_k;
        let foil = (self.coupling_w_per_k + self.foil_loss_w_per_k()) / self.foil_j_per_k();
        film + foil
    }

    pub(super) fn check(&self, channel: usize, ambient_c: f64) -> Result<(), PlantError> {
        let place = Place::Hinge(Hinge::Sma(channel));
        finite(place, "start angle (°)", self.start_deg)?;
        finite(place, "opening angle (°)", self.opening_deg)?;
        positive(place, "overdrive", self.overdrive)?;
        positive(place, "blocked torque (mN m)", self.blocked_torque_mn_m)?;
        not_negative(place, "load (mN m)", self.load_mn_m)?;
        self.alloy.check(place)?;
        positive(place, "foil width (m)", self.foil_width_m)?;
        positive(place, "foil length (m)", self.foil_length_m)?;
        positive(place, "foil thickness (m)", self.foil_thickness_m)?;
        positive(place, "heater (Ohm)", self.heater_ohm)?;
        positive(place, "heat capacity of the film (J/K)", self.film_j_per_k)?;
        positive(place, "film to foil (W/K)", self.coupling_w_per_k)?;
        not_negative(place, "convection (W/(m^2 K))", self.convection_w_per_m2_k)?;
        not_negative(place, "foil to panel (W/K)", self.panel_w_per_k)?;
        let cold = ambient_c <= self.alloy.as_c;
        within(cold, place, "ambient (°C)", ambient_c, "at most As, for it starts as martensite")?;
        self.thermistor.check(place)
    }
}

/// Temperatures of the two nodes and the phase of the foil.
#[derive(Debug, Clone, Copy)]
struct Nodes {
    film_c: f64,
    foil_c: f64,
    phase: Transformation,
    /// Heat that the foil takes up per kelvin, its latent heat included, as it was in the latest step.
    apparent_j_per_k: f64,
}

/// A shape-memory hinge at work.
#[derive(Debug, Clone)]
pub struct SmaHinge {
    config: SmaConfig,
    foil_j_per_k: f64,
    latent_j: f64,
    film_loss_w_per_k: f64,
    foil_loss_w_per_k: f64,
    nodes: Nodes,
    /// Share of the way from start to end stop, 0 to 1. One-way memory: it never falls.
    travel: f64,
    jammed: bool,
    /// Power of its heater in the latest step.
    heater_w: f64,
    /// What is left of the heater's resistance: the configured one, a short, or none that conducts.
    heater_ohm: f64,
    switch_stuck_on: bool,
    pub(super) thermistor: Thermistor,
}

impl SmaHinge {
    pub(super) fn new(config: SmaConfig, ambient_c: f64) -> Self {
        let nodes = Nodes {
            film_c: ambient_c,
            foil_c: ambient_c,
            phase: Transformation::MARTENSITE,
            apparent_j_per_k: config.foil_j_per_k(),
        };
        Self {
            config,
            foil_j_per_k: config.foil_j_per_k(),
            latent_j: config.latent_j(),
            film_loss_w_per_k: config.film_loss_w_per_k(),
            foil_loss_w_per_k: config.foil_loss_w_per_k(),
            nodes,
            travel: 0.0,
            jammed: false,
            heater_w: 0.0,
            heater_ohm: config.heater_ohm,
            switch_stuck_on: false,
            thermistor: Thermistor::new(config.thermistor, ambient_c),
        }
    }

    /// True temperature of the foil.
    pub fn temperature_c(&self) -> f64 {
        self.nodes.foil_c
    }

    /// True temperature of the film heater.
    pub fn film_c(&self) -> f64 {
        self.nodes.film_c
    }

    /// True temperature of the thermistor's bead.
    pub fn bead_c(&self) -> f64 {
        self.thermistor.bead_c()
    }

    /// True martensite fraction, 0 to 1.
    pub fn martensite(&self) -> f64 {
        self.nodes.phase.martensite()
    }

    /// True angle.
    pub fn angle_deg(&self) -> f64 {
        self.config.start_deg + (self.config.opening_deg - self.config.start_deg) * self.travel
    }

    /// What the heater weighs on the supply at `duty` (0 to 1): its mean over many PWM periods.
    pub(super) fn conductance_s(&self, duty: f64) -> f64 {
        let share = if self.switch_stuck_on { 1.0 } else { duty };
        // An open heater's resistance is infinite.
        share / self.heater_ohm
    }

    /// Power of its heater in the latest step.
    pub fn heater_w(&self) -> f64 {
        self.heater_w
    }

    /// Heats with `power_w` for `dt_s` by the midpoint rule, second order. It moves heat between the nodes
    /// without making or losing any, whatever the step.
    pub(super) fn advance(&mut self, dt_s: f64, power_w: f64, ambient_c: f64) {
        self.heater_w = power_w;
        let start = self.nodes;
        // The temperatures half-way only say how much heat flows, so a tangent will do for them.
        let (film_w, foil_w) = self.flows_w(start.film_c, start.foil_c, power_w, ambient_c);
        let midway_film_c = start.film_c + film_w * dt_s / (2.0 * self.config.film_j_per_k);
        let midway_foil_c = start.foil_c + foil_w * dt_s / (2.0 * start.apparent_j_per_k);
        let (film_w, foil_w) = self.flows_w(midway_film_c, midway_foil_c, power_w, ambient_c);
        self.nodes = self.foil_after(foil_w * dt_s);
        self.nodes.film_c = start.film_c + film_w * dt_s / self.config.film_j_per_k;
        self.thermistor.advance(dt_s, start.foil_c, self.nodes.foil_c, ambient_c);
        if !self.jammed {
            // The foil is a torsion spring whose rest angle grows with the austenite.
            let unopposed =
                self.nodes.phase.austenite() - self.config.load_mn_m / self.config.blocked_torque_mn_m;
            self.travel = self.travel.max((self.config.overdrive * unopposed).min(1.0));
        }
    }

    /// Heat that flows into the film and into the foil.
    fn flows_w(&self, film_c: f64, foil_c: f64, power_w: f64, ambient_c: f64) -> (f64, f64) {
        let across_w = self.config.coupling_w_per_k * (film_c - foil_c);
        let film_w = power_w - across_w - self.film_loss_w_per_k * (film_c - ambient_c);
        let foil_w = across_w - self.foil_loss_w_per_k * (foil_c - ambient_c);
        (film_w, foil_w)
    }

    /// The nodes after the foil took up `heat_j`: its temperature is the root of
    /// C (T' - T) + L (martensite turned) = heat, which grows steadily with T'. Solving for the enthalpy, rather than
    /// stepping with an effective heat capacity, loses no latent heat where the branch bends within a step.
    fn foil_after(&self, heat_j: f64) -> Nodes {
        const TOLERANCE_K: f64 = 1e-9;
        // Newton needs two or three; halving a step of some kelvins in every other round, this many.
        const MOST_ROUNDS: u32 = 100;
        let start = self.nodes;
        let alloy = &self.config.alloy;
        // Were nothing to transform, it would get this far; transforming, it stops short of it.
        let furthest_c = start.foil_c + heat_j / self.foil_j_per_k;
        let (mut low_c, mut high_c) = (start.foil_c.min(furthest_c), start.foil_c.max(furthest_c));
        let mut next = Nodes { foil_c: start.foil_c + heat_j / start.apparent_j_per_k, ..start };
        let mut previous_j = f64::INFINITY;
        for _ in 0..MOST_ROUNDS {
            next.phase = start.phase.moved(alloy, start.foil_c, next.foil_c);
            let turned = start.phase.martensite() - next.phase.martensite();
            // A phase that holds still has a slope only once it moves.
            let slope_per_k = if turned == 0.0 { 0.0 } else { next.phase.slope_per_k(alloy) };
            next.apparent_j_per_k = self.foil_j_per_k + self.latent_j * slope_per_k;
            let excess_j = self.foil_j_per_k * (next.foil_c - start.foil_c) + self.latent_j * turned - heat_j;
            if excess_j.abs() <= self.foil_j_per_k * TOLERANCE_K {
                break;
            }
            if excess_j > 0.0 {
                high_c = next.foil_c;
            } else {
                low_c = next.foil_c;
            }
            let newton_c = next.foil_c - excess_j / next.apparent_j_per_k;
            // From either side of a bend Newton can jump back and forth for ever: it must gain to be followed.
            let gains = excess_j.abs() <= previous_j / 2.0 && low_c <= newton_c && newton_c <= high_c;
            next.foil_c = if gains { newton_c } else { f64::midpoint(low_c, high_c) };
            previous_j = excess_j.abs();
        }
        next
    }

    pub(super) fn jam(&mut self) {
        self.jammed = true;
    }

    pub(super) fn break_heater(&mut self) {
        self.heater_ohm = f64::INFINITY;
    }

    pub(super) fn short_heater(&mut self, ohm: f64) {
        self.heater_ohm = ohm;
    }

    pub(super) fn stick_switch_on(&mut self) {
        self.switch_stuck_on = true;
    }

    pub(super) fn set_thermistor(&mut self, condition: Condition) {
        self.thermistor.set_condition(condition);
    }
}
