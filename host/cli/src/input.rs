//! Reads the files that several verbs take: a plan, a rig, a schedule that stands in the plan or beside it.

use crate::failure::{Failure, OrFail};
use anyhow::{Context, anyhow};
use std::fs;
use std::path::Path;
use zygote_deployment::{Calibration, Rig, Schedule};
use zygote_stacking::{Plan, fold};

/// A plan that keeps every rule.
pub(crate) fn plan(path: &Path) -> Result<Plan, Failure> {
    let name = path.display();
    let bytes = fs::read(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    fold::read(&bytes).with_context(|| format!("{name}: no plan")).or_bad_input()
}

/// A rig file with its calibration, where it names one.
pub(crate) fn rig(path: &Path) -> Result<Rig, Failure> {
    Ok(rig_with_text(path)?.0)
}

/// A rig file with its calibration, and the file's text.
pub(crate) fn rig_with_text(path: &Path) -> Result<(Rig, String), Failure> {
    let (rig, text) = rig_as_written(path)?;
    Ok((calibrated(path, rig)?, text))
}

/// A rig file by itself: what a calibration begins with.
pub(crate) fn rig_as_written(path: &Path) -> Result<(Rig, String), Failure> {
    let name = path.display().to_string();
    let text = fs::read_to_string(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    Ok((Rig::read(&name, &text).or_bad_input()?, text))
}

/// The rig with the calibration file that it names, which stands beside it.
fn calibrated(rig_path: &Path, rig: Rig) -> Result<Rig, Failure> {
    let Some(file) = &rig.calibration else { return Ok(rig) };
    let path = rig_path.with_file_name(file);
    let name = path.display().to_string();
    let text = fs::read_to_string(&path)
        .with_context(|| {
            let rig = rig_path.display();
            format!("{rig}: rig.calibration: {name} cannot be read; `zygote calibrate --rig {rig}` makes one")
        })
        .or_bad_input()?;
    let calibration = Calibration::read(&text, &rig.id).with_context(|| name.clone()).or_bad_input()?;
    rig.calibrated(&name, &calibration).or_bad_input()
}

/// The schedule in `beside`, else the plan's own; verified against plan and rig.
pub(crate) fn schedule(
    plan_path: &Path,
    plan: &Plan,
    rig: &Rig,
    beside: Option<&Path>,
) -> Result<Schedule, Failure> {
    let (name, schedule) = unverified_schedule(plan_path, plan, beside)?;
    schedule.verify(plan, rig).context(name).or_bad_input()?;
    Ok(schedule)
}

/// What may be run: such a schedule, or the way back that `zygote fold` made of it.
pub(crate) fn run(
    plan_path: &Path,
    plan: &Plan,
    rig: &Rig,
    beside: Option<&Path>,
) -> Result<Schedule, Failure> {
    let (name, schedule) = unverified_schedule(plan_path, plan, beside)?;
    schedule.verify_either_way(plan, rig).context(name).or_bad_input()?;
    Ok(schedule)
}

/// A schedule for verbs that know no rig, with the name of its file: nothing is verified.
pub(crate) fn unverified_schedule(
    plan_path: &Path,
    plan: &Plan,
    beside: Option<&Path>,
) -> Result<(String, Schedule), Failure> {
    match (beside, &plan.schedule) {
        (Some(path), _) => {
            let name = path.display().to_string();
            let text =
                fs::read_to_string(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
            let schedule = Schedule::from_text(&text).with_context(|| name.clone()).or_bad_input()?;
            Ok((name, schedule))
        }
        (None, Some(value)) => {
            let name = plan_path.display().to_string();
            let schedule = Schedule::from_json(value).with_context(|| name.clone()).or_bad_input()?;
            Ok((name, schedule))
        }
        (None, None) => {
            let name = plan_path.display();
            let error =
                anyhow!("{name}: has no schedule; make it with `zygote schedule {name} --rig RIG.toml`");
            Err(Failure::BadInput(error))
        }
    }
}
