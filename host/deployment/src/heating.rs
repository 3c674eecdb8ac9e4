//! How long a heater takes: a lumped heat capacity behind a thermal resistance, which takes up the latent
//! heat evenly between the start and the finish of the transformation. Estimates for a schedule; a run goes
//! by what its thermistors say.

use crate::rig::{Amps, Celsius, Rig, Seconds, SmaSettings};

/// The most that one heater draws: the full voltage over its resistance.
pub(crate) fn current(rig: &Rig, sma: &SmaSettings) -> Amps {
    Amps(rig.supply.voltage.0 / sma.heater_resistance.0)
}

/// The temperature that the hinge would settle at, with the supply loaded to its limit.
pub(crate) fn settled(rig: &Rig, sma: &SmaSettings) -> Celsius {
    let power = rig.lowest_voltage().powi(2) / sma.heater_resistance.0;
    Celsius(rig.ambient.0 + power * sma.thermal_resistance.0)
}

/// The time from the ambience to the target; infinite if the target is never reached.
pub(crate) fn time_to_target(rig: &Rig, sma: &SmaSettings) -> Seconds {
    let settled = settled(rig, sma).0;
    if settled <= sma.target.0 {
        return Seconds(f64::INFINITY);
    }
    let (start, finish) = (sma.austenite_start.0, sma.austenite_finish.0);
    // Latent heat over a span of temperature is so much more heat capacity; times the thermal resistance
    // it is so much more time constant.
    let slowed = sma.time_constant.0 + sma.thermal_resistance.0 * sma.latent_heat.0 / (finish - start);
    let mut seconds = 0.0;
    for (from, to, time_constant) in [
        (f64::NEG_INFINITY, start, sma.time_constant.0),
        (start, finish, slowed),
        (finish, f64::INFINITY, sma.time_constant.0),
    ] {
        let (from, to) = (from.max(rig.ambient.0), to.min(sma.target.0));
        if from < to {
            seconds += time_constant * ((settled - from) / (settled - to)).ln();
        }
    }
    Seconds(seconds)
}
