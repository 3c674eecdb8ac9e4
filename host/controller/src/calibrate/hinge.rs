//! One hinge under calibration: what is known of it beforehand, what was measured, and what came of it.

use zygote_calibration::{
    Bounds, Fit, Next, Nominal, Record, RecordError, Refusal, Transformation, fit, next,
};
use zygote_deployment::SmaSettings;
use zygote_protocol::{Fault, FaultCode, Limits};

/// Nominal martensite start below austenite start, and martensite finish below that.
const HYSTERESIS_K: f64 = 16.0;
const MARTENSITE_SPAN_K: f64 = 10.0;

/// How a hinge's calibration ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ending {
    /// Everything was measured.
    Done,
    /// It must not be heated, or not any more.
    Refused(String),
    /// The MCU found a fault of its heater or thermistor.
    Fault(String),
}

/// A hinge.
#[derive(Debug, Clone)]
pub struct Hinge {
    /// Its number in the plan.
    pub number: usize,
    /// Heater and thermistor.
    pub channel: u16,
    /// What was measured, and is kept.
    pub record: Record,
    /// How it ended; not yet, where it goes on.
    pub ending: Option<Ending>,
    pub(crate) settings: SmaSettings,
    pub(crate) nominal: Nominal,
    pub(crate) bounds: Bounds,
    /// What comes next, until something new is measured.
    wish: Option<Next>,
    /// So much of the record is kept whatever happens to the pulse under way.
    kept: (usize, usize),
}

impl Hinge {
    /// A hinge of a rig, at a board with these ceilings.
    pub fn new(number: usize, channel: u16, settings: SmaSettings, ceiling: &Limits) -> Self {
        let bounds = Bounds {
            max_temperature_c: settings.max_temperature.0.min(f64::from(ceiling.max_temperature.0) / 100.0),
            max_on_s: settings.max_on.0.min(f64::from(ceiling.max_on.0) / 1e3),
            min_rest_s: settings.rest.0.max(f64::from(ceiling.min_rest.0) / 1e3),
        };
        Self {
            number,
            channel,
            record: Record::default(),
            ending: None,
            settings,
            nominal: nominal(&settings),
            bounds,
            wish: None,
            kept: (0, 0),
        }
    }

    /// With what an earlier run measured.
    pub(crate) fn resume(&mut self, record: Record, ending: Option<Ending>) {
        self.record = record;
        self.ending = ending;
        self.keep();
    }

    /// What it asks for next; nothing once it has ended.
    pub(crate) fn wish(&mut self) -> Option<Next> {
        if self.ending.is_some() {
            return None;
        }
        if self.wish.is_none() {
            match next(&self.record, &self.nominal, &self.bounds) {
                Ok(Next::Done) => self.ending = Some(Ending::Done),
                Ok(wish) => self.wish = Some(wish),
                Err(refusal) => self.refuse(&refusal),
            }
        }
        self.wish
    }

    fn refuse(&mut self, refusal: &Refusal) {
        self.ending = Some(Ending::Refused(refusal.to_string()));
    }

    /// What was measured since is kept.
    pub(crate) fn keep(&mut self) {
        self.kept = (self.record.samples.len(), self.record.drives.len());
        self.wish = None;
    }

    /// Nothing was measured since.
    pub(crate) fn is_as_it_was(&self) -> bool {
        self.kept == (self.record.samples.len(), self.record.drives.len())
    }

    /// What was measured since is thrown away: a pulse that was cut short.
    pub(crate) fn forget(&mut self) {
        self.record.samples.truncate(self.kept.0);
        self.record.drives.truncate(self.kept.1);
    }

    /// Ends with a fault of this hinge's own.
    pub(crate) fn fail(&mut self, fault: &Fault) {
        let Fault { code, value, limit, .. } = fault;
        self.ending = Some(Ending::Fault(format!("{code}: measured {value}, limit {limit}")));
    }

    /// Ends because its thermistor can't be believed any more while nothing is heated: the MCU minds that only under power.
    pub(crate) fn lose_thermistor(&mut self) {
        let why = "its thermistor gave no reading that can be believed while the heater was off";
        self.ending = Some(Ending::Fault(why.to_owned()));
    }

    /// Temperature at rest, before anything was heated.
    pub(crate) fn ambient_c(&self) -> Option<f64> {
        let mut readings: Vec<f64> = self.record.baseline().iter().map(|sample| sample.reading_c).collect();
        readings.sort_by(f64::total_cmp);
        readings.get(readings.len() / 2).copied()
    }

    /// What the record says of it.
    ///
    /// # Errors
    /// A record that contradicts itself.
    pub fn fit(&self) -> Result<Fit, RecordError> {
        fit(&self.record, &self.nominal)
    }
}

/// What a rig file says of a hinge.
pub(crate) fn nominal(settings: &SmaSettings) -> Nominal {
    let (as_c, af_c) = (settings.austenite_start.0, settings.austenite_finish.0);
    let ms_c = as_c - HYSTERESIS_K;
    Nominal {
        transformation: Transformation { mf_c: ms_c - MARTENSITE_SPAN_K, ms_c, as_c, af_c },
        heater_ohm: settings.heater_resistance.0,
        thermal_resistance_k_per_w: settings.thermal_resistance.0,
        time_constant_s: settings.time_constant.0,
        ..Nominal::default()
    }
}

/// A fault that lies in one hinge's thermistor or heater, so that others may go on without it.
pub(crate) fn is_of_one_hinge(code: FaultCode) -> bool {
    match code {
        FaultCode::SensorOpen
        | FaultCode::SensorShorted
        | FaultCode::SensorJumped
        | FaultCode::SensorFrozen
        | FaultCode::NoGain => true,
        FaultCode::LinkLost
        | FaultCode::Stopped
        | FaultCode::StopButton
        | FaultCode::SessionEnded
        | FaultCode::ArmExpired
        | FaultCode::OverTemperature
        | FaultCode::OnTooLong
        | FaultCode::UnexpectedHeat
        | FaultCode::OverCurrent
        | FaultCode::NoCooling
        | FaultCode::UnplannedCurrent
        | FaultCode::ServosLost => false,
    }
}
