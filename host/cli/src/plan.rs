//! `zygote plan`: a model into a plan file.

use crate::failure::{Failure, OrFail};
use crate::output::{say, write_file};
use crate::plan_choice;
use anyhow::{Context, anyhow};
use clap::Args;
use std::path::{Path, PathBuf};
use zygote_stacking::{Figures, Model, Plan, PlanError, Report, Request, Resolution, fold};

/// Arguments of `zygote plan`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The shape: voxels (.txt, .vox), a quad mesh on the integer lattice (.obj), or with --voxel a closed
    /// mesh (.stl, .obj, .ply, .off, .gltf, .glb)
    model: PathBuf,
    /// Number of piles; it divides the number of panels [default: 1, or with --like as many as there]
    #[arg(long, value_name = "K")]
    piles: Option<usize>,
    /// Where to write the plan
    #[arg(short, long, value_name = "PLAN.fold")]
    output: PathBuf,
    /// Cut a mesh into voxels of this edge, in units of the mesh
    #[arg(long, value_name = "SIZE")]
    voxel: Option<f64>,
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
    /// Look for a plan whose flattened net has no overlapping panels
    #[arg(long)]
    net: bool,
    /// Look for a plan that moves few hinges of this one; as many panels and piles, on cells that lie alike
    #[arg(long, value_name = "A.fold", conflicts_with = "net")]
    like: Option<PathBuf>,
}

/// Plans, checks the plan as it will stand in the file, and writes it.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let model = Model::read(&arguments.model, arguments.voxel.map(Resolution::Voxel)).or_bad_input()?;
    for repair in model.repairs() {
        say(format_args!("{}: {repair}", arguments.model.display()));
    }
    let like = arguments.like.as_deref().map(plan_choice::Like::read).transpose()?;
    let piles = arguments.piles.or(like.as_ref().map(plan_choice::Like::piles)).unwrap_or(1);
    let request = Request {
        piles,
        root: arguments.root,
        thickness: arguments.thickness,
        panel_length_mm: arguments.panel_length,
        seed: arguments.seed,
    };
    let (plan, told) = match like {
        Some(like) => like.plan(&arguments.model, &model, &request)?,
        None if arguments.net => plan_choice::with_net(&arguments.model, &model, &request)?,
        None => (zygote_stacking::plan(&model, &request).map_err(refused(&arguments.model))?, Vec::new()),
    };
    let (bytes, report) = checked(&plan)?;
    write_file(&arguments.output, &bytes)?;
    say(format_args!("{}: {}", arguments.output.display(), summary(&report.figures)));
    say(format_args!("root: panel {}", plan.root));
    for line in told {
        say(line);
    }
    Ok(())
}

/// What a planner's refusal means for the user, by the model's name.
pub(crate) fn refused(model: &Path) -> impl FnOnce(PlanError) -> Failure {
    let name = model.display().to_string();
    move |error| {
        let told = anyhow!("{name}: {error}");
        match error {
            PlanError::Indivisible { .. } | PlanError::Root { .. } | PlanError::Length { .. } => {
                Failure::BadInput(told)
            }
            PlanError::NoStrip(_) | PlanError::NoLayout { .. } => Failure::Failed(told),
        }
    }
}

/// A plan as it will stand in its file, and the report of a check of that.
pub(crate) fn checked(plan: &Plan) -> Result<(Vec<u8>, Report), Failure> {
    let bytes = fold::write(plan).context("the plan can't be written as JSON").or_failed()?;
    let report = fold::check(&bytes).or_failed()?;
    if !report.is_valid() {
        let lines = report.lines(3).join("\n  ");
        return Err(Failure::Failed(anyhow!(
            "a fault of this program: its own plan breaks rules\n  {lines}"
        )));
    }
    Ok((bytes, report))
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
