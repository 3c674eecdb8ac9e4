//! All that the page knows of a plan, as JSON: its motion, what drives the hinges, what they bear, what collides.

use super::motion::Checked;
use crate::failure::{Failure, OrFail};
use anyhow::Context;
use serde::Serialize;
use std::path::Path;
use zygote_deployment::statics::{Load, Statics, Support};
use zygote_deployment::{Order, Playback, Rig, Schedule, Tree};
use zygote_stacking::Plan;

/// The one version of this JSON; the page is built into the same program, so it only guards against a cache.
const VERSION: u32 = 1;

#[derive(Serialize)]
struct Scene {
    version: u32,
    program: &'static str,
    /// File name of the plan.
    file: String,
    #[serde(flatten)]
    playback: Playback,
    /// Of every hinge what drives it, where a schedule says it.
    #[serde(skip_serializing_if = "Option::is_none")]
    drives: Option<Vec<&'static str>>,
    /// Of every hinge the worst load, where a rig says what panels weigh.
    #[serde(skip_serializing_if = "Option::is_none")]
    loads: Option<Vec<Borne>>,
    checked: Checked,
}

/// The worst load of a hinge.
#[derive(Clone, Serialize)]
struct Borne {
    torque_mnm: f64,
    rating_mnm: f64,
    factor: f64,
    role: &'static str,
}

/// The JSON of a plan.
pub(super) fn json(
    path: &Path,
    plan: &Plan,
    schedule: Option<&Schedule>,
    rig: Option<&Rig>,
) -> Result<Vec<u8>, Failure> {
    let name = path.display();
    let order = match schedule {
        Some(schedule) => schedule.hinges(),
        None => Order::of_tree(&Tree::new(plan).or_bad_input()?).hinges,
    };
    let scene = Scene {
        version: VERSION,
        program: concat!("zygote ", env!("CARGO_PKG_VERSION")),
        file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        playback: Playback::of(plan).with_context(|| format!("{name}: cannot be shown")).or_bad_input()?,
        drives: schedule.map(|schedule| drives(plan, schedule)),
        loads: rig.map(|rig| loads(path, plan, rig, &order)).transpose()?,
        checked: Checked::of(plan, schedule, &order)
            .with_context(|| format!("{name}: cannot be moved"))
            .or_bad_input()?,
    };
    serde_json::to_vec(&scene).or_failed()
}

fn drives(plan: &Plan, schedule: &Schedule) -> Vec<&'static str> {
    let mut drives = vec![""; plan.hinges.len()];
    for step in &schedule.steps {
        if let Some(drive) = drives.get_mut(step.hinge) {
            *drive = step.motion.kind().name();
        }
    }
    drives
}

/// Of every hinge the worse of what it bears turning and holding.
fn loads(path: &Path, plan: &Plan, rig: &Rig, order: &[usize]) -> Result<Vec<Borne>, Failure> {
    let statics = Statics::of(plan, rig, order, Support::Touching)
        .with_context(|| format!("{}: its hinges can't be weighed, leave out --rig", path.display()))
        .or_bad_input()?;
    let none = Borne { torque_mnm: 0.0, rating_mnm: 0.0, factor: 0.0, role: "" };
    let mut loads = vec![none; plan.hinges.len()];
    let borne = |load: &Load| Borne {
        torque_mnm: load.torque.0 * 1e3,
        rating_mnm: load.rating.0 * 1e3,
        factor: load.factor(),
        role: load.role.name(),
    };
    for load in statics.worst_first().iter().rev() {
        loads[load.hinge] = borne(load);
    }
    Ok(loads)
}
