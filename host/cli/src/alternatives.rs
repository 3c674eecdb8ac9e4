//! `zygote alternatives`: several plans of one shape, each with a coded sequence of its own.

use crate::failure::{Failure, OrFail};
use crate::output::{say, write_file};
use crate::plan::{checked, refused};
use anyhow::{Context, anyhow};
use clap::Args;
use std::fs;
use std::path::PathBuf;
use zygote_stacking::{Alternative, Model, Request, Resolution, alternatives};

/// Arguments of `zygote alternatives`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The shape, as of `zygote plan`
    model: PathBuf,
    /// How many plans
    #[arg(short = 'n', long, value_name = "N", default_value_t = 10)]
    number: usize,
    /// Number of piles; it divides the number of panels
    #[arg(long, value_name = "K", default_value_t = 1)]
    piles: usize,
    /// Write the plans into this folder; it is made if it isn't there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Cut a mesh into voxels of this edge, in units of the mesh
    #[arg(long, value_name = "SIZE")]
    voxel: Option<f64>,
    /// Panel thickness over panel length
    #[arg(long, value_name = "T/L", default_value_t = 0.01)]
    thickness: f64,
    /// Panel length in millimetres
    #[arg(long, value_name = "MM", default_value_t = 90.0)]
    panel_length: f64,
    /// The first seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

/// Looks for the plans, lists them, and writes them.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.number == 0 {
        return Err(Failure::BadInput(anyhow!("-n 0, expected at least 1")));
    }
    let model = Model::read(&arguments.model, arguments.voxel.map(Resolution::Voxel)).or_bad_input()?;
    for repair in model.repairs() {
        say(format_args!("{}: {repair}", arguments.model.display()));
    }
    let request = Request {
        piles: arguments.piles,
        thickness: arguments.thickness,
        panel_length_mm: arguments.panel_length,
        seed: arguments.seed,
        ..Request::default()
    };
    let all = alternatives(&model, &request, arguments.number).map_err(refused(&arguments.model))?;
    if let Some(folder) = &arguments.output {
        fs::create_dir_all(folder)
            .with_context(|| format!("{}: cannot be made", folder.display()))
            .or_failed()?;
    }
    let stem = arguments.model.file_stem().unwrap_or_default().to_string_lossy();
    let digits = all.found.len().to_string().len();
    say(format_args!(
        "{:>4} {:>6} {:>7} {:>6} {:>8} {:>9} {:>9}",
        "plan", "seed", "cells", "depth", "bridges", "volume", "overlaps"
    ));
    for (number, Alternative { plan, depth, overlaps }) in (1..).zip(&all.found) {
        let (bytes, report) = checked(plan)?;
        let [across, along] = plan.grid();
        let cells = format!("{across} x {along}");
        say(format_args!(
            "{number:>4} {:>6} {cells:>7} {depth:>6} {:>8} {:>9.1} {:>9}",
            plan.source.seed, report.figures.bridges, report.figures.expansion_ratio, overlaps.pairs
        ));
        if let Some(folder) = &arguments.output {
            write_file(&folder.join(format!("{stem}-{number:0digits$}.fold")), &bytes)?;
        }
    }
    say(
        "depth: hinges from the middle of the tree path to the farthest panel; volume: package-volume ratio; overlaps: pairs \
         of panels in the flattened net",
    );
    let found = all.found.len();
    let seeds = all.tried;
    let turns = if all.found.iter().any(|one| one.plan.height().is_multiple_of(2)) {
        "turned by quarter turns or upside down"
    } else {
        "turned by quarter turns"
    };
    if found < arguments.number {
        say(format_args!(
            "{found} plans only, expected {}: {seeds} seeds gave no more that differ otherwise than by a stack {turns}",
            arguments.number
        ));
    } else {
        say(format_args!("{found} plans from {seeds} seeds; none is another one's stack {turns}"));
    }
    Ok(())
}
