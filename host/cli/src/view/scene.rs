//! All that the page knows of a plan, as JSON: its motion, what drives the hinges, what they bear, what collides.

use super::motion::Checked;
use crate::failure::{Failure, OrFail};
use anyhow::Context;
use serde::Serialize;
use std::path::Path;
use zygote_deployment::statics::{Load, Statics, Support};
use zygote_deployment::{Direction, Order, Playback, Rig, Schedule, Tree};
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
    /// What run the page shows; none where a plan is shown by itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    run: Option<Run>,
}

/// A run that is shown.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(tag = "from", rename_all = "snake_case")]
pub(crate) enum Run {
    /// It goes on, or may: the page opens a line to this program.
    Live {
        /// Which of those on offer.
        number: usize,
    },
    /// It was recorded: the page asks for `run.json`.
    Recording,
}

/// What is shown.
#[derive(Clone, Copy)]
pub(crate) struct SceneOf<'a> {
    /// The plan's file, for its name.
    pub(crate) path: &'a Path,
    pub(crate) plan: &'a Plan,
    pub(crate) schedule: Option<&'a Schedule>,
    pub(crate) rig: Option<&'a Rig>,
}

/// The worst load of a hinge.
#[derive(Clone, Serialize)]
struct Borne {
    torque_mnm: f64,
    rating_mnm: f64,
    factor: f64,
    role: &'static str,
}

impl SceneOf<'_> {
    /// The JSON of it.
    pub(crate) fn json(&self, run: Option<Run>) -> Result<Vec<u8>, Failure> {
        let &Self { path, plan, schedule, rig } = self;
        let name = path.display();
        let order = match schedule {
            Some(schedule) => schedule.hinges(),
            None => Order::of_tree(&Tree::new(plan).or_bad_input()?).hinges,
        };
        let scene = Scene {
            version: VERSION,
            program: concat!("zygote ", env!("CARGO_PKG_VERSION")),
            file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            playback: Playback::of(plan)
                .with_context(|| format!("{name}: cannot be shown"))
                .or_bad_input()?,
            drives: schedule.map(|schedule| drives(plan, schedule)),
            loads: rig.map(|rig| loads(path, plan, rig, &order)).transpose()?,
            checked: Checked::of(plan, schedule, &order)
                .with_context(|| format!("{name}: cannot be moved"))
                .or_bad_input()?,
            run,
        };
        serde_json::to_vec(&scene).or_failed()
    }

    /// The JSON of a run of it. What a run back passes through is what the way there does, so it is shown by its order alone; torques
    /// are shown where the rig says enough.
    pub(crate) fn of_run(&self, run: Run) -> Result<Vec<u8>, Failure> {
        let mut plan = self.plan.clone();
        let schedule = self.schedule.filter(|schedule| schedule.direction() == Direction::Deploy);
        plan.schedule = schedule.map(Schedule::to_json).transpose().or_failed()?;
        let scene = SceneOf { plan: &plan, schedule, ..*self };
        match scene.json(Some(run)) {
            Err(Failure::BadInput(_)) if scene.rig.is_some() => {
                SceneOf { rig: None, ..scene }.json(Some(run))
            }
            shown => shown,
        }
    }
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
