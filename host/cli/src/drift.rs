//! `zygote drift`: holds the hinges of a recorded run against their calibration, and says which to calibrate again.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::{input, recording_file};
use anyhow::{Context, anyhow};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};
use zygote_controller::{DriftVerdict, HingeDrift};
use zygote_deployment::Rig;

/// Arguments of `zygote drift`.
#[derive(Args)]
#[command(
    after_help = "The rig file must name the calibration that is to be checked (`calibration` in its [rig]). Exit codes: 0 no hinge needs \
    another calibration, as far as the run shows it, 1 one does, 2 the input can't be used."
)]
pub(crate) struct Arguments {
    /// The recording
    #[arg(value_name = "RUN.mcap")]
    recording: PathBuf,
    /// The rig, with its calibration
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    /// Print the verdicts as JSON
    #[arg(long)]
    json: bool,
}

/// Prints the verdict on every hinge that was heated.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let name = arguments.recording.display().to_string();
    let recording = recording_file::read(&arguments.recording)?;
    let rig = input::rig(&arguments.rig)?;
    let calibration = calibration_of(&rig, &arguments.rig)?;
    if recording.rig.id != rig.id {
        let (found, expected) = (&recording.rig.id, &rig.id);
        return Err(Failure::BadInput(anyhow!("{name}: a run of rig {found:?}, expected {expected:?}")));
    }
    let hinges = recording.plan.hinges.len();
    let drift =
        recording.sightings().drift(&rig, calibration, hinges).context(name.clone()).or_bad_input()?;
    if arguments.json {
        let told = json!({ "recording": name, "rig": rig.id, "hinges": drift });
        say(serde_json::to_string_pretty(&told).or_failed()?);
    } else if drift.is_empty() {
        say("the run heated no hinge that has a calibration");
    } else {
        drift.iter().for_each(say);
    }
    let again: Vec<String> = to_recalibrate(&drift).map(|hinge| hinge.to_string()).collect();
    if again.is_empty() {
        return Ok(());
    }
    let command = command(&arguments.rig, &drift);
    Err(Failure::Failed(anyhow!("hinges {} aren't as they were measured: {command}", again.join(", "))))
}

fn calibration_of<'a>(rig: &'a Rig, path: &Path) -> Result<&'a zygote_deployment::Calibration, Failure> {
    rig.calibrated_by
        .as_ref()
        .with_context(|| {
            let rig = path.display();
            format!("{rig}: names no calibration in its [rig]; `zygote calibrate --rig {rig}` makes one")
        })
        .or_bad_input()
}

/// Hinges that need another calibration.
fn to_recalibrate(drift: &[HingeDrift]) -> impl Iterator<Item = usize> {
    drift.iter().filter(|hinge| hinge.verdict == DriftVerdict::Recalibrate).map(|hinge| hinge.hinge)
}

/// What calibrates them again; empty where none needs it.
pub(crate) fn command(rig: &Path, drift: &[HingeDrift]) -> String {
    let hinges: Vec<String> = to_recalibrate(drift).map(|hinge| format!("--hinge {hinge}")).collect();
    if hinges.is_empty() {
        return String::new();
    }
    format!("zygote calibrate --rig {} {}", rig.display(), hinges.join(" "))
}
