//! Random trials: a small rig, a program in a random tree order, and what goes wrong with them.

use super::hinges::{Physics, Specimen, any, heated};
use super::mishaps;
use crate::run::Trial;
use serde_json::{Value, json};
use std::fmt::Write;
use zygote_deployment::{CentiCelsius, Motion, ReadError, Rig, RigError, Schedule};
use zygote_protocol::Millis;
use zygote_sim::Chance;
use zygote_sim::plant::{Config, SupplyConfig};

/// Most hinges of a rig.
const MOST_HINGES: usize = 8;
/// The host must have ended by then: all hinges one after the other, and some.
const MOST: Millis = Millis(600_000);
/// A calibration takes minutes, and more where pulses that were cut short are driven again.
const MOST_MEASURING: Millis = Millis(3_600_000);
/// An undisturbed one takes longer than this, ms.
const MEASURING_MS: usize = 150_000;
/// Most hinges of a rig that is calibrated.
const MOST_MEASURED: usize = 3;
const AFTERWARDS: Millis = Millis(2_000);

/// A trial that the generator of trials made wrong.
#[derive(Debug, thiserror::Error)]
pub enum TrialError {
    /// Its rig.
    #[error("the campaign made a rig that can't be")]
    Rig(#[from] RigError),
    /// Its schedule.
    #[error("the campaign made a schedule that can't be read")]
    Schedule(#[from] ReadError),
}

/// The trial of a number in the campaign of a seed.
///
/// # Errors
/// [`TrialError`], a fault of this program.
pub fn trial(seed: u64, number: u64) -> Result<Trial, TrialError> {
    // Two streams that share no numbers for neighbouring seeds: the seed is mixed before the number goes in.
    let mut chance = Chance::new(Chance::new(seed).bits() ^ number);
    let supply = SupplyConfig {
        open_circuit_v: chance.between(4.8, 5.5),
        source_ohm: chance.between(0.02, 0.08),
        ..SupplyConfig::default()
    };
    let ambient_c = chance.between(15.0, 30.0);
    let count = 1 + chance.below(MOST_HINGES);
    let hinges: Vec<Specimen> = (0..count).map(|_| any(&mut chance, &supply, ambient_c)).collect();
    let limit_ma = supply_limit_ma(&mut chance, &hinges);
    let rig = Rig::read("campaign", &rig_text(&mut chance, &hinges, &supply, ambient_c, limit_ma))?;
    let schedule = Schedule::from_json(&schedule_json(&mut chance, &hinges, limit_ma))?;
    let plant = plant(&hinges, supply, ambient_c, chance.bits());
    let causes = mishaps::causes(&mut chance, &schedule, &plant);
    let line = mishaps::line(&mut chance);
    let seed = chance.bits();
    Ok(Trial { rig, schedule, plant, causes, line, seed, most: MOST, afterwards: AFTERWARDS, log: false })
}

/// The trial of a number in which the host calibrates. Its hinges are of shape-memory alloy, of whose limits the rig file tells what a careful
/// person would write there; the schedule is what the witness goes by, and isn't run.
///
/// # Errors
/// [`TrialError`], a fault of this program.
pub(super) fn calibrated(seed: u64, number: u64) -> Result<Trial, TrialError> {
    let mut chance = Chance::new(Chance::new(!seed).bits() ^ number);
    let supply = SupplyConfig {
        open_circuit_v: chance.between(4.8, 5.5),
        source_ohm: chance.between(0.02, 0.08),
        ..SupplyConfig::default()
    };
    let ambient_c = chance.between(15.0, 30.0);
    let count = 1 + chance.below(MOST_MEASURED);
    let hinges: Vec<Specimen> = (0..count).map(|_| heated(&mut chance, &supply, ambient_c)).collect();
    let limit_ma = supply_limit_ma(&mut chance, &hinges);
    let mut text = rig_text(&mut chance, &hinges, &supply, ambient_c, limit_ma);
    let schedule = Schedule::from_json(&schedule_json(&mut chance, &hinges, limit_ma))?;
    for step in &schedule.steps {
        if let Motion::Sma(sma) = step.motion {
            let celsius = |centi: CentiCelsius| f64::from(centi.0) / 100.0;
            let (target_c, most_c) = (celsius(sma.target), celsius(sma.max_temperature));
            // A string takes all.
            let entry = format!("hinge = {}\nkind = \"sma\"\n", step.hinge);
            let own = format!(
                "{entry}sma = {{ target = \"{target_c:.2} degC\", max_temperature = \"{most_c:.2} degC\" }}\n"
            );
            text = text.replace(&entry, &own);
        }
    }
    let rig = Rig::read("campaign", &text)?;
    let plant = plant(&hinges, supply, ambient_c, chance.bits());
    let mut causes = mishaps::causes(&mut chance, &schedule, &plant);
    // Any pulse may be struck, not the probes alone.
    let later = Millis(u32::try_from(chance.below(MEASURING_MS)).unwrap_or(0));
    for cause in &mut causes {
        cause.after.0 += later.0;
    }
    let line = mishaps::line(&mut chance);
    let seed = chance.bits();
    Ok(Trial {
        rig,
        schedule,
        plant,
        causes,
        line,
        seed,
        most: MOST_MEASURING,
        afterwards: AFTERWARDS,
        log: false,
    })
}

/// At least what any one hinge draws while all servos hold; at most what all draw together.
fn supply_limit_ma(chance: &mut Chance, hinges: &[Specimen]) -> u64 {
    let hold: u64 = hinges.iter().map(|hinge| hinge.hold_current_ma).sum();
    let most = hinges.iter().map(|hinge| hinge.current_ma).max().unwrap_or(0) + hold;
    let all: u64 = hinges.iter().map(|hinge| hinge.current_ma).sum::<u64>() + hold;
    let spare = usize::try_from(all.saturating_sub(most)).unwrap_or(0);
    // A rig file's own defaults need an ampere.
    (most + chance.below(spare + 1) as u64).max(1_000)
}

fn rig_text(
    chance: &mut Chance,
    hinges: &[Specimen],
    supply: &SupplyConfig,
    ambient_c: f64,
    limit_ma: u64,
) -> String {
    let count = |kind| hinges.iter().filter(|hinge| hinge.kind() == kind).count();
    let timeout_ms = 500 + 100 * chance.below(16);
    let mut text = format!(
        "version = 1\n[rig]\nid = \"campaign\"\nambient = \"{ambient_c:.3} degC\"\n\
         [supply]\nvoltage = \"{:.3} V\"\nlimit = \"{limit_ma} mA\"\nresistance = \"{:.6} ohm\"\n\
         [link]\ntimeout = \"{timeout_ms} ms\"\n\
         [[node]]\nname = \"simulated\"\nheaters = {}\nservos = {}\nsprings = {}\n",
        supply.open_circuit_v,
        supply.source_ohm,
        count("sma"),
        count("servo"),
        count("spring"),
    );
    for (number, hinge) in hinges.iter().enumerate() {
        // A string takes all.
        write!(text, "[[hinge]]\nhinge = {number}\nkind = \"{}\"\n", hinge.kind()).ok();
    }
    text
}

fn schedule_json(chance: &mut Chance, hinges: &[Specimen], limit_ma: u64) -> Value {
    let one_by_one = chance.happens(0.3);
    let mut channels = [0_u16; 3];
    let steps: Vec<Value> = hinges
        .iter()
        .enumerate()
        .map(|(at, hinge)| {
            let channel = &mut channels[match hinge.physics {
                Physics::Sma(_) => 0,
                Physics::Servo(_) => 1,
                Physics::Spring(_) => 2,
            }];
            let own = *channel;
            *channel += 1;
            json!({
                "hinge": at,
                "node": 0,
                "channel": own,
                "after": after(chance, at, one_by_one),
                "from_opening_deg": 0,
                "opening_deg": hinge.opening_deg,
                "start_ms": 0,
                "duration_ms": 1_000,
                "current_ma": hinge.current_ma,
                "hold_current_ma": hinge.hold_current_ma,
                "motion": hinge.motion,
            })
        })
        .collect();
    json!({
        "version": 2,
        "rig": "campaign",
        "plan_crc64": "0000000000000000",
        "order_crc64": "0000000000000000",
        "one_servo_a_node": false,
        "supply_limit_ma": limit_ma,
        "peak_current_ma": limit_ma,
        "makespan_ms": 1_000,
        "lower_bound_ms": 1_000,
        "steps": steps,
    })
}

/// Up to two steps before this one, rising.
fn after(chance: &mut Chance, at: usize, one_by_one: bool) -> Vec<usize> {
    if at == 0 {
        return Vec::new();
    }
    if one_by_one {
        return vec![at - 1];
    }
    let mut before: Vec<usize> = (0..chance.below(3)).map(|_| chance.below(at)).collect();
    before.sort_unstable();
    before.dedup();
    before
}

fn plant(hinges: &[Specimen], supply: SupplyConfig, ambient_c: f64, seed: u64) -> Config {
    let mut plant = Config { ambient_c, supply, seed, ..Config::default() };
    for hinge in hinges {
        match hinge.physics {
            Physics::Sma(sma) => plant.heaters.push(sma),
            Physics::Servo(servo) => plant.servos.push(servo),
            Physics::Spring(spring) => plant.springs.push(spring),
        }
    }
    plant
}
