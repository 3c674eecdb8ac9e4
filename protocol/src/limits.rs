//! The limits in force. A board has ceilings compiled in; a session may be stricter, never laxer (S13).

use crate::{CentiCelsius, Milliamps, Millis};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// What no hinge and no host may exceed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Limits {
    /// Highest temperature of any thermistor.
    pub max_temperature: CentiCelsius,
    /// Longest time that a heater may be on for one step.
    pub max_on: Millis,
    /// Shortest rest of a heater after it was on.
    pub min_rest: Millis,
    /// Highest sum of currents.
    pub supply: Milliamps,
    /// Longest silence of the host before everything goes off (S3).
    pub link_timeout: Millis,
}

/// A limit by name, in the order of [`Limits`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum LimitName {
    /// [`Limits::max_temperature`]
    MaxTemperature,
    /// [`Limits::max_on`]
    MaxOn,
    /// [`Limits::min_rest`]
    MinRest,
    /// [`Limits::supply`]
    Supply,
    /// [`Limits::link_timeout`]
    LinkTimeout,
}

impl Limits {
    /// The first limit in which `self` is laxer than `ceiling`, with the ceiling's value and ours.
    pub fn laxer_than(&self, ceiling: &Self) -> Option<(LimitName, i64, i64)> {
        let pairs = [
            (
                LimitName::MaxTemperature,
                i64::from(ceiling.max_temperature.0),
                i64::from(self.max_temperature.0),
            ),
            (LimitName::MaxOn, i64::from(ceiling.max_on.0), i64::from(self.max_on.0)),
            (LimitName::Supply, i64::from(ceiling.supply.0), i64::from(self.supply.0)),
            (LimitName::LinkTimeout, i64::from(ceiling.link_timeout.0), i64::from(self.link_timeout.0)),
        ];
        let rest = (LimitName::MinRest, i64::from(ceiling.min_rest.0), i64::from(self.min_rest.0));
        pairs.into_iter().find(|(_, most, ours)| ours > most).or((rest.2 < rest.1).then_some(rest))
    }
}
