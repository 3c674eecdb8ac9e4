//! `zygote export`: a plan as a file of another program.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use anyhow::{Context, anyhow};
use clap::Args;
use std::path::PathBuf;
use zygote_deployment::scene;

/// Arguments of `zygote export`.
#[derive(Args)]
#[command(
    after_help = "FILE.glb: the deployment as an animated scene in glTF 2.0, at the times of the plan's schedule; without one hinge \
    after hinge, a second each."
)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// Where to write it; the ending says what
    #[arg(short, long, value_name = "FILE.glb")]
    output: PathBuf,
}

/// Writes the file that the ending asks for.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let output = arguments.output.display();
    let ending = arguments.output.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let plan = input::plan(&arguments.plan)?;
    let bytes = match ending.to_ascii_lowercase().as_str() {
        "glb" => scene::gltf(&plan)
            .with_context(|| format!("{}: cannot be exported", arguments.plan.display()))
            .or_bad_input()?,
        _ => return Err(Failure::BadInput(anyhow!("{output}: expected a file that ends with .glb"))),
    };
    write_file(&arguments.output, &bytes)?;
    say(format_args!("{output}: {} kB", bytes.len().div_ceil(1000)));
    Ok(())
}
