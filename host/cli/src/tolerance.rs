//! `zygote tolerance`: how far panels are off and cut edges gape when hinges aren't exact, for a plan and for the single strip
//! of the same shape.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use anyhow::Context;
use clap::Args;
use std::path::PathBuf;
use zygote_deployment::{Degrees, HingeErrors, Millimetres, Spread, Tolerance, picture, single_strip};
use zygote_stacking::Plan;

/// More would take days, and tell nothing new.
const MOST_SAMPLES: usize = 1_000_000;

/// Arguments of `zygote tolerance`.
#[derive(Args)]
#[command(
    after_help = "T is the tree of the plan, P a single strip through the same shape, its middle fixed. A panel's error \
    is how far its centre is from its place, with the root in its own; a gap is how far the two sides of a cut edge \
    are apart, as the root mean square of its two ends."
)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// Standard deviation of each hinge's opening angle, with its unit
    #[arg(long, value_name = "ANGLE", default_value = "1deg", value_parser = angle)]
    hinge_sigma: Degrees,
    /// Standard deviation of each hinge's offset in each direction, with its unit
    #[arg(long, value_name = "LENGTH", default_value = "0.1mm", value_parser = length)]
    gap: Millimetres,
    /// Samples of the Monte Carlo; 0 for first order alone
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = sample_count)]
    samples: usize,
    /// Seed of the samples
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Draw T and P here, every panel in the colour of its error
    #[arg(long, value_name = "FILE.svg")]
    svg: Option<PathBuf>,
}

fn angle(text: &str) -> Result<Degrees, String> {
    let angle: Degrees = text.parse().map_err(|error| format!("{error}"))?;
    if (0.0..=45.0).contains(&angle.0) { Ok(angle) } else { Err("expected an angle from 0 to 45 deg".into()) }
}

fn length(text: &str) -> Result<Millimetres, String> {
    let length: Millimetres = text.parse().map_err(|error| format!("{error}"))?;
    if length.0 >= 0.0 { Ok(length) } else { Err("expected a length of at least 0 mm".into()) }
}

fn sample_count(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| *count <= MOST_SAMPLES);
    count.ok_or_else(|| format!("expected a whole number, 0 to {MOST_SAMPLES}"))
}

/// Computes, prints side by side, draws.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let name = arguments.plan.display();
    let tree_plan = input::plan(&arguments.plan)?;
    let strip_plan = single_strip(&tree_plan)
        .with_context(|| format!("{name}: no single strip to compare with"))
        .or_failed()?;
    let of = |plan: &Plan| {
        let errors = HingeErrors {
            angle_rad: arguments.hinge_sigma.0.to_radians(),
            offset: arguments.gap.0 / plan.panel_length_mm,
        };
        Tolerance::of(plan, errors, arguments.samples, arguments.seed).or_bad_input()
    };
    let (tree, strip) = (of(&tree_plan)?, of(&strip_plan)?);
    if let Some(path) = &arguments.svg {
        let heads = ["Tree T", "Single strip P"];
        let svg = picture::tolerance(&[(&tree_plan, &tree, heads[0]), (&strip_plan, &strip, heads[1])]);
        write_file(path, svg.as_bytes())?;
    }
    say(format_args!(
        "{name}: hinges off by {} and {} (standard deviations), panels of {} mm, {} samples, seed {}",
        arguments.hinge_sigma, arguments.gap, tree_plan.panel_length_mm, arguments.samples, arguments.seed
    ));
    let piles = tree_plan.piles.len();
    say(format_args!("{:<28}{:>14}{:>14}{:>8}", "", format!("T, {piles} piles"), "P, one strip", "P/T"));
    let depths = format!("{:<28}{:>14}{:>14}", "depth in hinges", tree.depth, strip.depth);
    say(format_args!("{depths}{:>8.2}", ratio(tree.depth as f64, strip.depth as f64)));
    let scale = tree_plan.panel_length_mm;
    lines("panel off by, mm", tree.panels, strip.panels, scale, arguments.samples);
    if tree.cut_edges == 0 {
        say("no cut edges close in this shape: no gaps");
    } else {
        lines("gap at cut edges, mm", tree.gaps, strip.gaps, scale, arguments.samples);
    }
    Ok(())
}

fn ratio(tree: f64, strip: f64) -> f64 {
    if tree > 0.0 { strip / tree } else { 1.0 }
}

/// The lines about one kind of error, side by side.
fn lines(what: &str, tree: Spread, strip: Spread, scale: f64, samples: usize) {
    let figures = |spread: &Spread| {
        let Spread { first_order_rms, rms, median, percentile_95, greatest } = *spread;
        [first_order_rms, rms, median, percentile_95, greatest].map(|figure| figure * scale)
    };
    let names = ["first order, rms", "samples, rms", "  50th percentile", "  95th percentile", "  greatest"];
    let rows = names.into_iter().zip(figures(&tree).into_iter().zip(figures(&strip)));
    say(what);
    for (name, (t, p)) in rows.take(if samples == 0 { 1 } else { names.len() }) {
        say(format_args!("  {name:<26}{t:>14.3}{p:>14.3}{:>8.2}", ratio(t, p)));
    }
}
