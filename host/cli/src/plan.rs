//! `zygote plan`: a model into a plan file.

use crate::failure::{Failure, OrFail};
use crate::output::{say, write_file};
use anyhow::{Context, anyhow};
use clap::Args;
use std::path::PathBuf;
use zygote_stacking::{Figures, Model, PlanError, Request, Resolution, fold};

/// Arguments of `zygote plan`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The shape: voxels (.txt, .vox), a quad mesh on the integer lattice (.obj), or with --voxel or --panels a
    /// closed mesh (.stl, .obj, .ply, .off, .gltf, .glb)
    model: PathBuf,
    /// Number of piles; it divides the number of panels
    #[arg(long, value_name = "K", default_value_t = 1)]
    piles: usize,
    /// Where to write the plan
    #[arg(short, long, value_name = "PLAN.fold")]
    output: PathBuf,
    /// Cut a mesh into voxels of this edge, in units of the mesh
    #[arg(long, value_name = "SIZE")]
    voxel: Option<f64>,
    /// Cut a mesh into voxels so that it has exactly so many panels
    #[arg(long, value_name = "N", conflicts_with = "voxel")]
    panels: Option<usize>,
    /// The panel that stays fixed [default: the middle of the tree path]
    #[arg(long, value_name = "PANEL")]
    root: Option<usize>,
    /// Panel thickness over panel length
    #[arg(long, value_name = "T/L", default_value_t = 0.01)]
    thickness: f64,
    /// Panel length in millimetres
    #[arg(long, value_name = "MM", default_value_t = 90.0)]
    panel_length: f64,
    /// Seed of every random choice
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

/// Plans, checks the plan as it will stand in the file, and writes it.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let resolution = arguments.voxel.map(Resolution::Voxel).or(arguments.panels.map(Resolution::Panels));
    let model = Model::read(&arguments.model, resolution).or_bad_input()?;
    for repair in model.repairs() {
        say(format_args!("{}: {repair}", arguments.model.display()));
    }
    if let (Some(size), Some(distance)) = (model.voxel_size(), model.distance()) {
        say(format_args!(
            "{}: voxels of {size}; distance to the mesh: {distance}",
            arguments.model.display()
        ));
    }
    let request = Request {
        piles: arguments.piles,
        root: arguments.root,
        thickness: arguments.thickness,
        panel_length_mm: arguments.panel_length,
        seed: arguments.seed,
    };
    let plan = zygote_stacking::plan(&model, &request).map_err(|error| {
        let told = anyhow!("{}: {error}", arguments.model.display());
        match error {
            PlanError::Indivisible { .. } | PlanError::Root { .. } | PlanError::Length { .. } => {
                Failure::BadInput(told)
            }
            PlanError::NoStrip(_) | PlanError::NoLayout { .. } => Failure::Failed(told),
        }
    })?;
    let bytes = fold::write(&plan).context("the plan can't be written as JSON").or_failed()?;
    let report = fold::check(&bytes).or_failed()?;
    if !report.is_valid() {
        let lines = report.lines(3).join("\n  ");
        return Err(Failure::Failed(anyhow!(
            "a fault of this program: its own plan breaks rules\n  {lines}"
        )));
    }
    write_file(&arguments.output, &bytes)?;
    say(format_args!("{}: {}", arguments.output.display(), summary(&report.figures)));
    say(format_args!("root: panel {}", plan.root));
    Ok(())
}

/// What a plan amounts to, in two lines.
pub(crate) fn summary(figures: &Figures) -> String {
    let Figures { panels, piles, height, grid: [across, along], bridges, high_degree_panels, .. } = figures;
    let [by_90, by_180, by_270] = figures.openings;
    format!(
        "N = {panels} panels, K = {piles} piles, {height} high, on {across} x {along} cells\n\
         bridges: {bridges}, high-degree panels: {high_degree_panels}, package-volume ratio: {:.1}, \
         hinges opening by 90/180/270 degrees: {by_90}/{by_180}/{by_270}",
        figures.expansion_ratio
    )
}
