//! How long a heater takes: a lumped heat capacity behind a thermal resistance, which takes up the latent
//! heat evenly between the start and the finish of the transformation. Estimates for a schedule; a run goes
//! by what its thermistors say.

use crate::rig::{Amps, Celsius, Kelvins, Rig, Seconds, SmaSettings};

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
    let mut seconds = 0.0;
    for (from, to, time_constant) in spans(sma) {
        let (from, to) = (from.max(rig.ambient.0), to.min(sma.target.0));
        if from < to {
            seconds += time_constant * ((settled - from) / (settled - to)).ln();
        }
    }
    Seconds(seconds)
}

/// The rise above the ambience within a time of heating.
pub(crate) fn gain(rig: &Rig, sma: &SmaSettings, within: Seconds) -> Kelvins {
    let settled = settled(rig, sma).0;
    let (mut temperature, mut left) = (rig.ambient.0, within.0);
    for (_, to, time_constant) in spans(sma) {
        if temperature >= to || temperature >= settled {
            continue;
        }
        let needed = if to < settled {
            time_constant * ((settled - temperature) / (settled - to)).ln()
        } else {
            f64::INFINITY
        };
        if needed > left {
            temperature = settled - (settled - temperature) * (-left / time_constant).exp();
            break;
        }
        (temperature, left) = (to, left - needed);
    }
    Kelvins(temperature - rig.ambient.0)
}

/// Temperatures between which the time constant is one, and that. Latent heat over a span of temperature is so much more heat
/// capacity; times the thermal resistance it is so much more time constant.
fn spans(sma: &SmaSettings) -> [(f64, f64, f64); 3] {
    let (start, finish) = (sma.austenite_start.0, sma.austenite_finish.0);
    let slowed = sma.time_constant.0 + sma.thermal_resistance.0 * sma.latent_heat.0 / (finish - start);
    [
        (f64::NEG_INFINITY, start, sma.time_constant.0),
        (start, finish, slowed),
        (finish, f64::INFINITY, sma.time_constant.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Drive;
    use crate::testing::rig_text;

    fn rig_and_sma(extra: &str) -> (Rig, SmaSettings) {
        let rig = Rig::read("rig.toml", &rig_text(&format!("[sma]\n{extra}"))).expect("a good rig");
        let Drive::Sma(sma) = rig.fit(1).expect("a heater")[0].drive else {
            panic!("the default kind is sma")
        };
        (rig, sma)
    }

    /// The same, integrated in steps of 0.1 ms.
    fn integrated(rig: &Rig, sma: &SmaSettings) -> f64 {
        let capacity = sma.time_constant.0 / sma.thermal_resistance.0;
        let span = sma.austenite_start.0..sma.austenite_finish.0;
        let power = rig.lowest_voltage().powi(2) / sma.heater_resistance.0;
        let (mut time, mut temperature) = (0.0, rig.ambient.0);
        while temperature < sma.target.0 {
            let latent =
                if span.contains(&temperature) { sma.latent_heat.0 / (span.end - span.start) } else { 0.0 };
            let loss = (temperature - rig.ambient.0) / sma.thermal_resistance.0;
            temperature += (power - loss) / (capacity + latent) * 1e-4;
            time += 1e-4;
        }
        time
    }

    #[test]
    fn the_time_of_heating_is_that_of_a_step_by_step_integration() {
        for extra in ["", "latent_heat = \"0 J\"\n", "latent_heat = \"2 J\"\ntarget = \"90 degC\"\n"] {
            let (rig, sma) = rig_and_sma(extra);
            let (closed, stepped) = (time_to_target(&rig, &sma).0, integrated(&rig, &sma));
            assert!((closed - stepped).abs() < 1e-2, "{closed} s in closed form, {stepped} s in steps");
        }
    }

    #[test]
    fn the_gain_within_a_time_is_what_takes_that_time() {
        for extra in ["", "latent_heat = \"0 J\"\n"] {
            let (rig, sma) = rig_and_sma(extra);
            for target in [30.0, 67.0, 70.0, 77.0, 80.0, 90.0] {
                let sma = SmaSettings { target: Celsius(target), ..sma };
                let gain = gain(&rig, &sma, time_to_target(&rig, &sma)).0;
                assert!((gain - (target - rig.ambient.0)).abs() < 1e-9, "{gain} K to {target} °C");
            }
            let settled = settled(&rig, &sma).0 - rig.ambient.0;
            assert!((gain(&rig, &sma, Seconds(1e6)).0 - settled).abs() < 1e-9);
            assert!(gain(&rig, &sma, Seconds(0.0)).0.abs() < 1e-9);
        }
    }

    #[test]
    fn latent_heat_takes_time() {
        let ((rig, with), (_, without)) = (rig_and_sma(""), rig_and_sma("latent_heat = \"0 J\"\n"));
        assert!(time_to_target(&rig, &with).0 > time_to_target(&rig, &without).0 + 1.0);
    }
}
