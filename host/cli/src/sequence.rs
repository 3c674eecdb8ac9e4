//! `zygote sequence`: the coded sequence of a plan, printed, compared with a text, or read back into a plan.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use crate::plan::summary;
use anyhow::{Context, anyhow};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use zygote_stacking::{Sequence, SequenceText, check, fold};

/// Differences that are listed.
const SHOWN: usize = 20;
/// Broken rules that are listed, of each.
const SHOWN_PER_RULE: usize = 3;
/// As `zygote plan` has them.
const THICKNESS: f64 = 0.01;
const PANEL_LENGTH_MM: f64 = 90.0;

/// Arguments of `zygote sequence`.
#[derive(Args)]
#[command(
    after_help = "A line a pile, a word a panel from the bottom up. `(0,0): E270 *[N90]W180 / S90 .` is the pile on \
    cell (0,0): a hinge on the east side of the bottom panel that opens by 270 degrees; above it the panel that stays fixed, \
    with a bridge to the pile on its north side and a hinge on its west side; then a panel without a hinge above it, one \
    with a hinge on its south side, and the top."
)]
pub(crate) struct Arguments {
    /// The plan whose sequence is printed
    #[arg(value_name = "PLAN.fold", required_unless_present = "parse", conflicts_with = "parse")]
    plan: Option<PathBuf>,
    /// Compare this text with the plan's sequence: exit code 0 if they are the same
    #[arg(long, value_name = "FILE.seq", requires = "plan", conflicts_with = "output")]
    compare: Option<PathBuf>,
    /// Read this text and make a plan of it
    #[arg(long, value_name = "FILE.seq", requires = "output")]
    parse: Option<PathBuf>,
    /// Where to write the sequence, or with --parse the plan
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// With --parse: panel thickness over panel length [default: 0.01]
    #[arg(long, value_name = "T/L", requires = "parse", value_parser = above_0)]
    thickness: Option<f64>,
    /// With --parse: panel length in millimetres [default: 90]
    #[arg(long, value_name = "MM", requires = "parse", value_parser = above_0)]
    panel_length: Option<f64>,
}

fn above_0(text: &str) -> Result<f64, String> {
    let length = text.parse().ok().filter(|length: &f64| length.is_finite() && *length > 0.0);
    length.ok_or_else(|| "expected a number above 0".to_owned())
}

/// Prints, compares or builds.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match (&arguments.plan, &arguments.parse, &arguments.output) {
        (_, Some(text), Some(output)) => build(arguments, text, output),
        (Some(plan), _, _) => {
            let sequence = Sequence::of(&input::plan(plan)?);
            match (&arguments.compare, &arguments.output) {
                (Some(text), _) => compare(plan, &sequence, text),
                (None, Some(output)) => {
                    write_file(output, sequence.to_string().as_bytes())?;
                    let (panels, piles) = (sequence.panels(), sequence.columns.len());
                    say(format_args!("{}: {panels} panels in {piles} piles", output.display()));
                    Ok(())
                }
                (None, None) => {
                    say(sequence.to_string().trim_end());
                    Ok(())
                }
            }
        }
        _ => Err(Failure::BadInput(anyhow!("give a plan, or --parse FILE.seq with -o PLAN.fold"))),
    }
}

fn read(path: &Path) -> Result<SequenceText, Failure> {
    let name = path.display();
    let text = fs::read_to_string(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    SequenceText::parse(&text).with_context(|| format!("{name}: no coded sequence")).or_bad_input()
}

fn compare(plan: &Path, sequence: &Sequence, text: &Path) -> Result<(), Failure> {
    let differences = read(text)?.differences(sequence);
    let (plan, text) = (plan.display(), text.display());
    if differences.is_empty() {
        say(format_args!("{text}: the sequence of {plan}"));
        return Ok(());
    }
    for difference in differences.iter().take(SHOWN) {
        say(format_args!("{text}: {difference}"));
    }
    if differences.len() > SHOWN {
        say(format_args!("... and {} more", differences.len() - SHOWN));
    }
    Err(Failure::Failed(anyhow!("{text}: differs from {plan} in {} places", differences.len())))
}

fn build(arguments: &Arguments, text: &Path, output: &Path) -> Result<(), Failure> {
    let name = text.file_name().unwrap_or_default().to_string_lossy();
    let plan = read(text)?.build(
        &name,
        arguments.thickness.unwrap_or(THICKNESS),
        arguments.panel_length.unwrap_or(PANEL_LENGTH_MM),
    );
    let bytes = fold::write(&plan).context("the plan can't be written as JSON").or_failed()?;
    let report = check(&fold::parse(&bytes).or_failed()?);
    if !report.is_valid() {
        let lines = report.lines(SHOWN_PER_RULE).join("\n  ");
        let text = text.display();
        return Err(Failure::Failed(anyhow!(
            "{text}: the shape that this sequence unfolds into breaks rules of a plan; panels are numbered pile by pile \
             from the bottom up, in the order of the lines\n  {lines}"
        )));
    }
    write_file(output, &bytes)?;
    say(format_args!("{}: {}", output.display(), summary(&report.figures)));
    Ok(())
}
