//! Samples of a session: all channels of interest ten times a second, with the news in between.

use crate::Transport;
use crate::inbox::Notice;
use crate::session::{RequestError, Session};
use std::collections::BTreeMap;
use zygote_protocol::{Micros, Millis};

/// Time between two samples.
pub(crate) const EVERY: Millis = Millis(100);

/// One channel at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Look {
    /// By the clock of the records.
    pub(crate) t_s: f64,
    /// None where the thermistor can't be believed.
    pub(crate) reading_c: Option<f64>,
    /// Share of full power, 0 to 1.
    pub(crate) duty: f64,
    pub(crate) supply_v: f64,
    /// All currents together.
    pub(crate) sum_a: f64,
}

/// Samples on one time axis, whatever the MCU's clock does.
#[derive(Debug)]
pub(crate) struct Sampler {
    /// What the MCU's time is behind that of the records.
    ahead_s: f64,
    due: Micros,
}

impl Sampler {
    /// Records go on from `last_s`; the MCU's time is now `now`.
    pub(crate) fn new(last_s: Option<f64>, now: Micros) -> Self {
        /// Between an interrupted calibration and the next: any time will do.
        const GAP_S: f64 = 60.0;
        let ahead_s = last_s.map_or(0.0, |last_s| last_s + GAP_S - seconds(now));
        Self { ahead_s, due: Micros(0) }
    }

    /// A moment of the MCU on the records' axis.
    pub(crate) fn at_s(&self, at: Micros) -> f64 {
        self.ahead_s + seconds(at)
    }

    /// Waits for the next sample's time, giving out the news until then.
    ///
    /// # Errors
    /// The session ended.
    pub(crate) fn wait<T: Transport>(
        &mut self,
        session: &mut Session<T>,
    ) -> Result<Vec<Notice>, RequestError> {
        let now = session.now();
        if self.due.plus(EVERY) < now {
            self.due = now;
        }
        let mut news = Vec::new();
        while let Some(notice) = session.notice(self.due)? {
            if !matches!(notice, Notice::Telemetry(_)) {
                news.push(notice);
            }
        }
        self.due = self.due.plus(EVERY);
        Ok(news)
    }

    /// Looks at channels; those that the board doesn't have are left out.
    ///
    /// # Errors
    /// The session ended.
    pub(crate) fn look<T: Transport>(
        &self,
        session: &mut Session<T>,
        channels: &[u16],
    ) -> Result<BTreeMap<u16, Look>, RequestError> {
        let mut looks = BTreeMap::new();
        let mut first_sum_a = None;
        let mut sorted = channels.to_vec();
        sorted.sort_unstable();
        for channel in &sorted {
            if looks.contains_key(channel) {
                continue;
            }
            let readings = session.readings(*channel)?;
            // With more channels than fit one answer, heaters go on and off in between: all that are on count for the first sum,
            // or were on at the look before.
            let sum_a = *first_sum_a.get_or_insert(f64::from(readings.current.0) / 1e3);
            for (channel, reading) in (readings.first..).zip(&readings.channels) {
                let look = Look {
                    t_s: self.at_s(readings.at),
                    reading_c: reading.temperature.map(|temperature| f64::from(temperature.0) / 100.0),
                    duty: f64::from(reading.duty) / 1e3,
                    supply_v: f64::from(readings.supply.0) / 1e3,
                    sum_a,
                };
                looks.insert(channel, look);
            }
        }
        looks.retain(|channel, _| sorted.binary_search(channel).is_ok());
        Ok(looks)
    }
}

pub(crate) fn seconds(at: Micros) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "exact for 285 years")]
    let micros = at.0 as f64;
    micros / 1e6
}
