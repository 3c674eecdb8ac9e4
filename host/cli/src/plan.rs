//! `zygote plan`: a model into a plan file.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use crate::plan_choice;
use anyhow::{Context, anyhow};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};
use zygote_deployment::motion::{Ground, Plates};
use zygote_stacking::{
    Bridges, Figures, Model, Partition, Plan, PlanError, Quality, Report, Request, Resolution, fold, quality,
};

/// Arguments of `zygote plan`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The shape: voxels (.txt, .vox), a quad mesh on the integer lattice (.obj), or with --voxel or --panels a
    /// closed mesh (.stl, .obj, .ply, .off, .gltf, .glb)
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
    /// How the piles are made
    #[arg(long, value_enum, default_value_t = PartitionArgument::Auto)]
    partition: PartitionArgument,
    /// How many bridges join the piles [default: most, or with --free base]
    #[arg(long, value_enum)]
    bridges: Option<BridgesArgument>,
    /// Cells in x and in y that the piles must find room on [default: as few cells as can be]
    #[arg(long, value_name = "WxH", value_parser = grid)]
    grid: Option<[usize; 2]>,
    /// Seed of every random choice
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Look for a plan whose flattened net has no overlapping panels
    #[arg(long)]
    net: bool,
    /// Look for a plan that moves few hinges of this one; as many panels and piles, on cells that lie alike
    #[arg(long, value_name = "A.fold", conflicts_with = "net")]
    like: Option<PathBuf>,
    /// Look for a plan that opens without a collision, with seeds from --seed on
    #[arg(long, value_name = "PANELS", value_enum, conflicts_with_all = ["net", "like"])]
    free: Option<PlatesArgument>,
    /// With --free, let nothing pass the plane that the stack lies on; the root is chosen to fit
    #[arg(long, requires = "free")]
    ground: bool,
    /// With --ground, the rig whose gravity says where down is [default: against z, so the ground is a table]
    #[arg(long, value_name = "RIG.toml", requires = "ground")]
    rig: Option<PathBuf>,
    /// With --free, try at most so many plans
    #[arg(long, value_name = "N", default_value_t = 40, requires = "free", value_parser = clap::value_parser!(u64).range(1..))]
    tries: u64,
}

/// What a motion is checked with.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum PlatesArgument {
    /// Panels without thickness
    Ideal,
    /// Panels as thick as the plan says; their edges may touch
    Thick,
}

impl From<PlatesArgument> for Plates {
    fn from(argument: PlatesArgument) -> Self {
        match argument {
            PlatesArgument::Ideal => Self::Ideal,
            PlatesArgument::Thick => Self::Thick,
        }
    }
}

impl Arguments {
    fn ground(&self) -> Result<Option<Ground>, Failure> {
        if !self.ground {
            return Ok(None);
        }
        let rig = self.rig.as_deref().map(input::rig).transpose()?;
        Ok(Some(rig.map_or(Ground::TABLE, |rig| Ground::under(&rig.gravity))))
    }

    fn bridges(&self) -> BridgesArgument {
        let default = if self.free.is_some() { BridgesArgument::Base } else { BridgesArgument::Most };
        self.bridges.unwrap_or(default)
    }
}

/// `--partition`.
#[derive(Clone, Copy, ValueEnum)]
enum PartitionArgument {
    /// Parts with few edges between them
    Mincut,
    /// Equal arcs of one strip
    Arcs,
    /// Whichever of both comes out better
    Auto,
}

/// `--bridges`.
#[derive(Clone, Copy, ValueEnum)]
enum BridgesArgument {
    /// One less than piles
    Least,
    /// As many as can be; each one too many breaks a fold
    Most,
    /// One less than piles, in one plane of the target: nothing that moves is wider than a cell
    Base,
}

fn grid(text: &str) -> Result<[usize; 2], String> {
    let sides = text.split_once('x').and_then(|(x, y)| Some([x.parse().ok()?, y.parse().ok()?]));
    let told = || format!("'{text}', expected cells in x and y from 1 to 9999, as in 4x4");
    sides.filter(|sides| sides.iter().all(|side| (1..10_000).contains(side))).ok_or_else(told)
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
    let like = arguments.like.as_deref().map(plan_choice::Like::read).transpose()?;
    let piles = arguments.piles.or(like.as_ref().map(plan_choice::Like::piles)).unwrap_or(1);
    let request = Request {
        piles,
        root: arguments.root,
        thickness: arguments.thickness,
        panel_length_mm: arguments.panel_length,
        seed: arguments.seed,
        partition: match arguments.partition {
            PartitionArgument::Mincut => Partition::MinCut,
            PartitionArgument::Arcs => Partition::Arcs,
            PartitionArgument::Auto => Partition::Auto,
        },
        bridges: match arguments.bridges() {
            BridgesArgument::Least => Bridges::Least,
            BridgesArgument::Most => Bridges::Most,
            BridgesArgument::Base => Bridges::Base,
        },
        grid: arguments.grid,
    };
    let (plan, told) = match like {
        Some(like) => like.plan(&arguments.model, &model, &request)?,
        None if arguments.net => plan_choice::with_net(&arguments.model, &model, &request)?,
        None if arguments.free.is_some() => {
            let free = plan_choice::Free {
                plates: arguments.free.map_or(Plates::Ideal, Plates::from),
                ground: arguments.ground()?,
                tries: arguments.tries,
            };
            plan_choice::that_opens_freely(&arguments.model, &model, &request, free)?
        }
        None => (zygote_stacking::plan(&model, &request).map_err(refused(&arguments.model))?, Vec::new()),
    };
    let (bytes, report) = checked(&plan)?;
    write_file(&arguments.output, &bytes)?;
    say(format_args!("{}: {}", arguments.output.display(), summary(&report.figures)));
    let Quality { depth, cut, beside, beside_bound, bridge_bound, .. } = quality(&model, &plan);
    say(format_args!(
        "breaks: {}, depth of the tree path: {depth}, cut edges: {cut}, of which between neighbouring piles: {beside} \
         of at most {beside_bound} (of these piles at most {bridge_bound} can be bridges)",
        report.figures.breaks
    ));
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
            PlanError::Indivisible { .. }
            | PlanError::Root { .. }
            | PlanError::Length { .. }
            | PlanError::Grid { .. } => Failure::BadInput(told),
            PlanError::NoStrip(_)
            | PlanError::NoLayout { .. }
            | PlanError::NoMatch(_)
            | PlanError::NoBase(_)
            | PlanError::NeitherWay { .. } => Failure::Failed(told),
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
