//! `zygote picture`: a plan as an SVG picture.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use anyhow::{Context, anyhow};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use zygote_deployment::picture;

/// Stages of a film unless said otherwise.
const STAGES: usize = 6;
/// More would make no picture that anyone could open.
const MOST_FRAMES: usize = 2000;

/// Arguments of `zygote picture`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// Where to write the picture
    #[arg(short, long, value_name = "FILE.svg")]
    output: PathBuf,
    /// What to show
    #[arg(long, value_enum, default_value_t = View::Both)]
    view: View,
    /// Stages of a film [default: 6] or frames of an animation [default: as many as keep the file small]
    #[arg(long, value_name = "N", value_parser = frame_count)]
    frames: Option<usize>,
}

fn frame_count(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (2..=MOST_FRAMES).contains(count));
    count.ok_or_else(|| format!("expected a whole number, 2 to {MOST_FRAMES}"))
}

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum View {
    /// The shape
    Target,
    /// The stack
    Zygote,
    /// Both, side by side
    Both,
    /// Stages of the deployment in a row
    Film,
    /// The deployment, playing
    Animation,
    /// The schedule, a row a hinge, with the current that it draws
    Gantt,
}

/// Draws a plan.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.frames.is_some() && !matches!(arguments.view, View::Film | View::Animation) {
        return Err(Failure::BadInput(anyhow!(
            "--frames is for --view film or animation, found {:?}",
            arguments.view
        )));
    }
    let plan = input::plan(&arguments.plan)?;
    let place = || format!("{}: cannot be drawn", arguments.plan.display());
    let svg = match arguments.view {
        View::Target => picture::target(&plan),
        View::Zygote => picture::zygote(&plan).with_context(place).or_bad_input()?,
        View::Both => picture::both(&plan).with_context(place).or_bad_input()?,
        View::Film => {
            picture::film(&plan, arguments.frames.unwrap_or(STAGES)).with_context(place).or_bad_input()?
        }
        View::Gantt => {
            let (name, schedule) = input::unverified_schedule(&arguments.plan, &plan, None)?;
            picture::gantt(&plan, &schedule).context(name).or_bad_input()?
        }
        View::Animation => picture::animation(&plan, arguments.frames).with_context(place).or_bad_input()?,
    };
    write_file(&arguments.output, svg.as_bytes())?;
    say(format_args!("{}: {} kB", arguments.output.display(), svg.len().div_ceil(1000)));
    Ok(())
}
