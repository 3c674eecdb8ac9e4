//! A pulse of the plan as a step of the wire, with everything that the MCU is to hold it against.

use super::hinge::Hinge;
use zygote_calibration::Pulse;
use zygote_protocol::{Action, CentiCelsius, Milliamps, Millis, Step};

/// Once a nominal hinge would be warmer by so much ..
const RISE_K: f64 = 25.0;
/// .. or at this share of the pulse, if that is earlier, it is looked whether this one is warmer at all ..
const WINDOW_SHARE: f64 = 0.6;
/// .. by this share of the nominal rise (S6). Later windows want a quarter of that, also where a hinge nearly settles.
const GAIN_SHARE: f64 = 0.08;
/// A pulse that ends below the rig's `cool_to` counts as cooled so far below its end.
const COOLED_K: f64 = 5.0;
/// A measured resistance may be off by so much, and the supply may be above what it says.
pub(crate) const CURRENT_MARGIN: f64 = 1.1;

/// The step of a hinge's pulse. `supply_v` is the supply without load, `heater_ohm` the best that is known of the heater.
pub(crate) fn step(hinge: &Hinge, pulse: &Pulse, supply_v: f64, heater_ohm: f64) -> Step {
    let (window_s, gain_k) = gain(hinge, pulse, supply_v, heater_ohm);
    let cool_c = hinge.settings.cool_to.0.min(pulse.until_c - COOLED_K);
    let action = Action::Pulse(zygote_protocol::Pulse {
        channel: hinge.channel,
        duty: whole(pulse.duty * 1e3).clamp(1, 1_000),
        duration: millis(pulse.longest_s),
        target: centi(pulse.until_c),
        max_temperature: centi(hinge.bounds.max_temperature_c),
        cool: centi(cool_c),
        rest: millis(hinge.bounds.min_rest_s),
        min_gain: CentiCelsius(centi(gain_k).0.max(1)),
        gain_window: millis(window_s),
        current: Milliamps(u32::from(whole((CURRENT_MARGIN * supply_v / heater_ohm * 1e3).ceil()))),
    });
    // A rig has fewer hinges than the wire has numbers.
    let number = u16::try_from(hinge.number).unwrap_or(u16::MAX);
    Step { hinge: number, after: heapless::Vec::new(), action }
}

/// When it is looked for a rise, and for what rise.
fn gain(hinge: &Hinge, pulse: &Pulse, supply_v: f64, heater_ohm: f64) -> (f64, f64) {
    let nominal = &hinge.nominal;
    let settled_k = pulse.duty * supply_v * supply_v / heater_ohm * nominal.thermal_resistance_k_per_w;
    // The film and the thermistor's lag delay it.
    let delay_s = 2.0 * nominal.lag_s;
    let longest_s = WINDOW_SHARE * pulse.longest_s;
    let window_s = if settled_k > RISE_K {
        (delay_s - nominal.time_constant_s * (1.0 - RISE_K / settled_k).ln()).min(longest_s)
    } else {
        longest_s
    };
    let risen = 1.0 - (-(window_s - delay_s).max(0.0) / nominal.time_constant_s).exp();
    (window_s, GAIN_SHARE * settled_k * risen)
}

fn millis(seconds: f64) -> Millis {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "limits are some minutes")]
    let ms = (seconds * 1e3).ceil().max(0.0) as u32;
    Millis(ms)
}

fn centi(celsius: f64) -> CentiCelsius {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "limits of a board are below 327 °C; beyond, it saturates"
    )]
    let centi = (celsius * 100.0).round() as i16;
    CentiCelsius(centi)
}

fn whole(value: f64) -> u16 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it saturates")]
    let whole = value.round() as u16;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use zygote_calibration::Purpose;
    use zygote_deployment::{Drive, Rig};
    use zygote_protocol::Limits;

    fn hinge() -> Hinge {
        let text = "version = 1\n[rig]\nid = \"r\"\n[supply]\nvoltage = \"5 V\"\nlimit = \"2 A\"\nresistance = \"50 mohm\"\n\
                    [[node]]\nname = \"n\"\nheaters = 2\n";
        let rig = Rig::read("rig.toml", text).unwrap();
        let fitting = rig.fit(2).unwrap()[1];
        let Drive::Sma(settings) = fitting.drive else { panic!("no SMA hinge") };
        let ceiling = Limits {
            max_temperature: CentiCelsius(11_000),
            max_on: Millis(15_000),
            min_rest: Millis(2_000),
            supply: Milliamps(2_000),
            link_timeout: Millis(1_000),
        };
        Hinge::new(1, fitting.channel, settings, &ceiling)
    }

    fn pulse(duty: f64, longest_s: f64, until_c: f64) -> zygote_protocol::Pulse {
        let pulse = Pulse {
            purpose: Purpose::Warm,
            duty,
            longest_s,
            until_c,
            rest_below_c: 24.0,
            longest_rest_s: 60.0,
        };
        match step(&hinge(), &pulse, 5.0, 20.0).action {
            Action::Pulse(pulse) => pulse,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_pulse_keeps_the_stricter_of_the_rigs_and_the_boards_limits() {
        let pulse = pulse(0.25, 15.0, 60.0);
        assert_eq!((pulse.channel, pulse.duty, pulse.duration), (1, 250, Millis(15_000)));
        assert_eq!((pulse.target, pulse.max_temperature), (CentiCelsius(6_000), CentiCelsius(11_000)));
        assert_eq!((pulse.cool, pulse.rest), (CentiCelsius(4_500), Millis(2_000)));
        assert_eq!(pulse.current, Milliamps(275), "5 V at 20 ohm, and a tenth");
    }

    #[test]
    fn s6_the_gain_is_looked_at_early_where_power_is_high_and_stays_below_what_a_sound_hinge_shows() {
        let (weak, strong) = (pulse(0.02, 15.0, 60.0), pulse(1.0, 15.0, 90.0));
        assert_eq!(weak.gain_window, Millis(9_000), "it never gets that warm");
        assert!(strong.gain_window < Millis(2_000), "{}", strong.gain_window);
        for (pulse, duty) in [(weak, 0.02), (strong, 1.0)] {
            let settled = duty * 25.0 / 20.0 * 115.0;
            let risen = settled * (1.0 - (-f64::from(pulse.gain_window.0) / 1e3 / 5.5).exp());
            let least = f64::from(pulse.min_gain.0) / 100.0;
            assert!(least > 0.02 * risen && least < 0.1 * risen, "{least} K of {risen} K");
        }
    }

    #[test]
    fn a_pulse_that_ends_lukewarm_counts_as_cooled_below_its_end() {
        let pulse = pulse(0.25, 1.5, 42.0);
        assert_eq!(pulse.cool, CentiCelsius(3_700));
        assert!(pulse.gain_window <= pulse.duration);
    }
}
