//! Reads the files that several verbs take: a plan, a rig, a schedule that stands in the plan or beside it.

use crate::failure::{Failure, OrFail};
use anyhow::{Context, anyhow};
use std::fs;
use std::path::Path;
use zygote_deployment::{Rig, Schedule};
use zygote_stacking::{Plan, fold};

/// A plan that keeps every rule.
pub(crate) fn plan(path: &Path) -> Result<Plan, Failure> {
    let name = path.display();
    let bytes = fs::read(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    fold::read(&bytes).with_context(|| format!("{name}: no plan")).or_bad_input()
}

/// A rig file.
pub(crate) fn rig(path: &Path) -> Result<Rig, Failure> {
    let name = path.display().to_string();
    let text = fs::read_to_string(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    Rig::read(&name, &text).or_bad_input()
}

/// The schedule in `beside`, else the plan's own; verified against plan and rig.
pub(crate) fn schedule(
    plan_path: &Path,
    plan: &Plan,
    rig: &Rig,
    beside: Option<&Path>,
) -> Result<Schedule, Failure> {
    let (name, schedule) = match (beside, &plan.schedule) {
        (Some(path), _) => {
            let name = path.display().to_string();
            let text =
                fs::read_to_string(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
            (name.clone(), Schedule::from_text(&text).context(name).or_bad_input()?)
        }
        (None, Some(value)) => {
            let name = plan_path.display().to_string();
            (name.clone(), Schedule::from_json(value).context(name).or_bad_input()?)
        }
        (None, None) => {
            let name = plan_path.display();
            let error =
                anyhow!("{name}: has no schedule; make it with `zygote schedule {name} --rig RIG.toml`");
            return Err(Failure::BadInput(error));
        }
    };
    schedule.verify(plan, rig).context(name).or_bad_input()?;
    Ok(schedule)
}
