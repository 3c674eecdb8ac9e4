//! Hinges that are opened after their calibration, some of them changed since: which are said to need another one?

use crate::drive;
use crate::hinges::Subject;
use core::time::Duration;
use std::collections::BTreeMap;
use std::error::Error;
use zygote_calibration::{
    Bounds, Currents, Doing, Drift, Known, Look, Nominal, Quantity, Sighting, drift, fit, heaters,
};
use zygote_core::{Duty, NTC_10K};
use zygote_sim::Chance;
use zygote_sim::plant::{self, Fault, Plant, Readings, SmaConfig};

/// What has become of a hinge since.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Since {
    Nothing,
    HeaterUpTenPercent,
    ConvectionUpThirtyPercent,
    AlloyUpFiveKelvin,
    ThermistorDownTenPercent,
    ThermistorDrifts,
}

impl Since {
    pub(crate) const ALL: [Self; 6] = [
        Self::Nothing,
        Self::HeaterUpTenPercent,
        Self::ConvectionUpThirtyPercent,
        Self::AlloyUpFiveKelvin,
        Self::ThermistorDownTenPercent,
        Self::ThermistorDrifts,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::HeaterUpTenPercent => "heater resistance +10 %",
            Self::ConvectionUpThirtyPercent => "loss to the air +30 %",
            Self::AlloyUpFiveKelvin => "transformation +5 K, as by a load",
            Self::ThermistorDownTenPercent => "thermistor resistance -10 %",
            Self::ThermistorDrifts => "thermistor drifts by 0.3 K/s",
        }
    }

    pub(crate) fn change(self, hinge: &mut SmaConfig) {
        match self {
            Self::Nothing | Self::ThermistorDrifts => {}
            Self::HeaterUpTenPercent => hinge.heater_ohm *= 1.1,
            Self::ConvectionUpThirtyPercent => hinge.convection_w_per_m2_k *= 1.3,
            Self::AlloyUpFiveKelvin => {
                let alloy = &mut hinge.alloy;
                for celsius in [&mut alloy.mf_c, &mut alloy.ms_c, &mut alloy.as_c, &mut alloy.af_c] {
                    *celsius += 5.0;
                }
            }
            Self::ThermistorDownTenPercent => hinge.thermistor.r25_ohm *= 0.9,
        }
    }

    /// Of a heater or a thermistor that gives way while it is opened.
    fn fault(self) -> Option<Fault> {
        (self == Self::ThermistorDrifts)
            .then_some(Fault::ThermistorDrifting { channel: 0, kelvin_per_s: 0.3 })
    }
}

/// A hinge as its calibration has it: what was measured, and its heater.
pub(crate) struct Calibrated {
    pub(crate) known: Known,
    nominal: Nominal,
}

/// Calibrates a hinge; none where its calibration isn't whole.
pub(crate) fn calibrate(subject: &Subject, bounds: &Bounds) -> Result<Option<Calibrated>, Box<dyn Error>> {
    let session = drive::session(subject, bounds, None)?;
    if session.ended.is_some() {
        return Ok(None);
    }
    let fit = fit(&session.record, &subject.nominal)?;
    let known: BTreeMap<_, _> =
        Quantity::ALL.into_iter().filter_map(|quantity| Some((quantity, fit.value(quantity)?))).collect();
    let whole = known.contains_key(&Quantity::AusteniteFinish) && known.contains_key(&Quantity::FoilRise);
    Ok(whole.then_some(Calibrated { known: Known(known), nominal: subject.nominal }))
}

/// Opens a hinge some days after its calibration, in other air, and holds what is seen against that.
pub(crate) fn opened(
    subject: &Subject,
    calibrated: &Calibrated,
    since: Since,
    seed: u64,
) -> Result<Drift, Box<dyn Error>> {
    let mut chance = Chance::new(seed);
    let mut config = subject.config.clone();
    config.seed = chance.bits();
    config.ambient_c += chance.between(-4.0, 4.0);
    for hinge in &mut config.heaters {
        since.change(hinge);
    }
    let mut plant = Plant::new(&config)?;
    if let Some(fault) = since.fault() {
        plant.inject(fault)?;
    }
    let af_c = calibrated.known.0.get(&Quantity::AusteniteFinish).map_or(78.0, |af| af.value);
    let (sighting, currents) = run(&mut plant, af_c + 15.0)?;
    let ohm = calibrated.known.0.get(&Quantity::HeaterResistance).map_or(25.0, |heater| heater.value);
    let heater = heaters(&currents, &BTreeMap::from([(0, ohm)])).get(&0).copied();
    Ok(drift(&calibrated.known, &calibrated.nominal, &sighting, heater))
}

/// The firmware's thermostat, and its telemetry.
fn run(plant: &mut Plant, target_c: f64) -> Result<(Sighting, Vec<Currents>), Box<dyn Error>> {
    const TICK: Duration = Duration::from_millis(10);
    const BAND_K: f64 = 4.0;
    const HOLD_TICKS: u32 = 100;
    const MOST_TICKS: u32 = 2_000;
    const COOL_C: f64 = 45.0;
    let (mut sighting, mut currents) = (Sighting::default(), Vec::new());
    let (mut duty, mut reached, mut off) = (1.0, None, None::<u32>);
    for tick in 1..=6 * MOST_TICKS {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        let heaters = [Duty::new((duty * 1000.0_f64).round() as u16)];
        let drive = plant::Drive { heaters: &heaters, servos: &[], springs: &[], main_switch: true };
        plant.advance(TICK, &drive)?;
        let Readings { thermistors, supply, current } = plant.sense();
        let counts = thermistors.first().copied().ok_or("a plant without a heater")?;
        let reading_c = f64::from(NTC_10K.temperature(counts).0) / 100.0;
        let t_s = f64::from(tick) * TICK.as_secs_f64();
        if reading_c >= target_c {
            reached.get_or_insert(tick);
        }
        if reached.is_some_and(|at| tick >= at + HOLD_TICKS) && off.is_none() {
            off = Some(tick);
            sighting.opened_s = Some(t_s);
        }
        let doing = match (reached, off) {
            (_, Some(_)) => Doing::Cooling,
            (Some(_), None) => Doing::Holding,
            (None, None) => Doing::Heating,
        };
        let before = duty;
        duty = match doing {
            Doing::Heating | Doing::Holding => (1.0 - (reading_c - target_c) / BAND_K).clamp(0.0, 1.0),
            Doing::Cooling => 0.0,
        };
        if tick % 10 == 1 {
            let voltage_v = f64::from(supply.0) / 1000.0;
            sighting.looks.push(Look { t_s, doing, reading_c, duty, voltage_v });
            if (duty - before).abs() < 1e-9 {
                let sum_a = f64::from(current.0) / 1000.0;
                currents.push(Currents { sum_a, voltage_v, duties: vec![(0, duty)] });
            }
        }
        let cool = doing == Doing::Cooling && reading_c < COOL_C;
        if cool || (reached.is_none() && tick >= MOST_TICKS) {
            break;
        }
    }
    Ok((sighting, currents))
}
