//! S4: how hot foils truly got.

use super::margin::margin_k;
use super::{Breach, seconds};
use crate::cause::What;
use crate::run::{Rehearsed, Trial};
use zygote_deployment::{Motion, Step};
use zygote_protocol::Micros;
use zygote_sim::CEILING;
use zygote_sim::plant::Fault;

pub(super) fn judge(trial: &Trial, rehearsed: &Rehearsed) -> Vec<Breach> {
    let mut breaches = Vec::new();
    for (step, hinge) in trial.schedule.steps.iter().zip(&rehearsed.witness.hinges) {
        let (Motion::Sma(motion), Some((hottest_c, at))) = (step.motion, hinge.hottest) else { continue };
        let limit_c = f64::from(motion.max_temperature.0) / 100.0;
        let Some(bound) = bound(trial, rehearsed, step, limit_c, at) else { continue };
        let most_c = limit_c + bound.margin_k;
        let breach = |what: String| Breach { heater: Some(hinge.channel), ..Breach::new("S4", at, what) };
        let truth = format!("hinge {} truly at {hottest_c:.1} °C", hinge.hinge);
        if hottest_c > most_c {
            let margin_k = bound.margin_k;
            breaches.push(breach(format!("{truth}, limit {limit_c:.1} °C + {margin_k:.1} K of physics")));
        }
        let ceiling_c = f64::from(CEILING.max_temperature.0) / 100.0 + bound.over_ceiling_k;
        if hottest_c > ceiling_c {
            breaches.push(breach(format!("{truth}, the board's ceiling is {ceiling_c:.1} °C")));
        }
    }
    breaches
}

struct Bound {
    margin_k: f64,
    /// By how much the ceiling may be passed: what nobody can know.
    over_ceiling_k: f64,
}

fn bound(trial: &Trial, rehearsed: &Rehearsed, step: &Step, limit_c: f64, at: Micros) -> Option<Bound> {
    let channel = usize::from(step.channel);
    let sma = trial.plant.heaters.get(channel)?;
    let supply = &trial.plant.supply;
    let (mut ohm, mut volts, mut colder_k, mut over_ceiling_k) =
        (sma.heater_ohm, supply.open_circuit_v, 0.0_f64, 0.0_f64);
    let (mut runs_away, mut blind) = (false, false);
    for (when, what) in rehearsed.script.happened() {
        let What::Break(fault) = *what else { continue };
        match fault {
            // A thermistor that reads colder than it is can't be known for one: the foil is hotter by just that.
            Fault::ThermistorDrifting { channel: of, kelvin_per_s } if of == channel => {
                colder_k += (-kelvin_per_s).max(0.0) * seconds(Micros(at.since(when)));
            }
            Fault::HeaterShorted { channel: of, ohm: left } if of == channel => {
                ohm = ohm.min(left);
                // A short below the supply's limit isn't known before the hinge is too hot, and then it heats on by physics.
                over_ceiling_k = margin_k(sma, volts, ohm, limit_c);
            }
            Fault::SupplySag { open_circuit_v, .. } => volts = volts.max(open_circuit_v),
            Fault::MosfetStuckOn(of) => runs_away |= of == channel,
            Fault::ThermistorFrozen(of) | Fault::ThermistorLoose(of) => blind |= of == channel,
            _ => {}
        }
    }
    // Two faults in one hinge, of which one hides the other: what remains is that it doesn't cool (S6), and the ceiling.
    let hidden_k = if runs_away && blind { f64::INFINITY } else { 0.0 };
    let margin_k = margin_k(sma, volts, ohm, limit_c) + colder_k + hidden_k;
    Some(Bound { margin_k, over_ceiling_k: over_ceiling_k + colder_k })
}
