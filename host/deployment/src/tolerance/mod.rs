//! How far the panels of a target are off, and how far its cut edges gape, when every hinge is a little off: the errors of the
//! hinges on the way from the root add up (paper, section 3). `zygote tolerance` prints it.
//!
//! A hinge has an error of its opening angle and an offset, the same on average for all hinges, normally distributed and
//! independent. First order gives the root mean square of each panel and each cut edge exactly for small errors;
//! Monte Carlo turns the panels fully and gives the distribution.

mod first_order;
mod histogram;
mod monte_carlo;
mod normal;

use crate::tree::{Tree, TreeError};
use glam::DVec3;
use zygote_stacking::{CutEdge, Model, Plan, PlanError, Request, Surface, SurfaceError};

/// How exact hinges are: standard deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HingeErrors {
    /// Of the opening angle, radians.
    pub angle_rad: f64,
    /// Of the child's offset from the parent in each direction of space, panel lengths.
    pub offset: f64,
}

/// What errors amount to, over all panels or all cut edges; panel lengths.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spread {
    /// Root mean square in first order.
    pub first_order_rms: f64,
    /// Root mean square of all samples.
    pub rms: f64,
    /// Half of all samples are below.
    pub median: f64,
    /// 95 of 100 samples are below.
    pub percentile_95: f64,
    /// The greatest of all samples.
    pub greatest: f64,
}

/// The tolerance of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// Hinges between the root and the panel farthest from it along the tree path.
    pub depth: usize,
    /// How far panel centres are from their place in the target; the root is in its place.
    pub panels: Spread,
    /// How far cut edges gape: root mean square of the distances at the two ends of each. All 0 if none closes.
    pub gaps: Spread,
    /// Of every panel the root mean square: of the samples if there are any, else in first order.
    pub panel_rms: Vec<f64>,
    /// Cut edges that close in the target.
    pub cut_edges: usize,
}

/// Why there is no tolerance.
#[derive(Debug, thiserror::Error)]
pub enum ToleranceError {
    /// The plan is no tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// The target is no surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}

/// Why a shape has no single strip to compare with.
#[derive(Debug, thiserror::Error)]
pub enum SingleStripError {
    /// The target is no surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The planner finds none.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

/// The same shape as one strip of panels, P of the paper, its root in the middle.
///
/// # Errors
/// What the planner says.
pub fn single_strip(plan: &Plan) -> Result<Plan, SingleStripError> {
    let model = Model::new(plan.source.model.clone(), Surface::new(plan.target.clone(), Vec::new())?)?;
    let request = Request {
        thickness: plan.thickness,
        panel_length_mm: plan.panel_length_mm,
        seed: plan.source.seed,
        ..Request::default()
    };
    Ok(zygote_stacking::plan(&model, &request)?)
}

impl Tolerance {
    /// The tolerance of a plan, by first order and `samples` seeded samples.
    ///
    /// # Errors
    /// A plan that breaks the rules: hinges that are no tree, a target that is no surface.
    pub fn of(plan: &Plan, errors: HingeErrors, samples: usize, seed: u64) -> Result<Self, ToleranceError> {
        let chain = Chain::new(plan, &Tree::new(plan)?);
        let cut_edges = plan.cut_edges()?;
        let first = first_order::propagate(&chain, &cut_edges, errors);
        let sampled = monte_carlo::sample(&chain, &cut_edges, errors, samples, seed);
        let spread =
            |mean_squares: &[f64], spread: Spread| Spread { first_order_rms: rms(mean_squares), ..spread };
        let squares = if samples == 0 { &first.panels } else { &sampled.panel_mean_squares };
        Ok(Self {
            depth: chain.depth,
            panels: spread(&first.panels, sampled.panels),
            gaps: spread(&first.gaps, sampled.gaps),
            panel_rms: squares.iter().map(|square| square.sqrt()).collect(),
            cut_edges: cut_edges.len(),
        })
    }
}

fn rms(mean_squares: &[f64]) -> f64 {
    if mean_squares.is_empty() {
        return 0.0;
    }
    (mean_squares.iter().sum::<f64>() / mean_squares.len() as f64).sqrt()
}

/// The hinges as they stand in the target, from the root out.
struct Chain {
    root: usize,
    joints: Vec<Joint>,
    corners: Vec<[DVec3; 4]>,
    depth: usize,
}

/// A hinge in the target.
struct Joint {
    parent: usize,
    child: usize,
    /// A point of its axis.
    anchor: DVec3,
    /// Unit vector along it.
    axis: DVec3,
}

impl Chain {
    fn new(plan: &Plan, tree: &Tree) -> Self {
        let corners: Vec<[DVec3; 4]> =
            plan.target.iter().map(|quad| quad.map(|at| DVec3::from_array(at.map(f64::from)))).collect();
        let mut depth = vec![0; corners.len()];
        let joints = tree.branches().iter().map(|branch| {
            let hinge = &plan.hinges[branch.hinge];
            let edge = hinge.edges[usize::from(hinge.panels[0] != branch.parent)];
            let [start, stop] = [edge % 4, (edge + 1) % 4].map(|corner| corners[branch.parent][corner]);
            depth[branch.child] = depth[branch.parent] + 1;
            Joint {
                parent: branch.parent,
                child: branch.child,
                anchor: start,
                axis: (stop - start).normalize(),
            }
        });
        let joints = joints.collect();
        Self { root: plan.root, joints, depth: depth.iter().copied().max().unwrap_or(0), corners }
    }

    fn centre(&self, panel: usize) -> DVec3 {
        (self.corners[panel][0] + self.corners[panel][2]) / 2.0
    }

    /// The two ends of a cut edge.
    fn ends(&self, cut_edge: &CutEdge) -> [DVec3; 2] {
        let ([panel, _], [edge, _]) = (cut_edge.panels, cut_edge.edges);
        [edge, (edge + 1) % 4].map(|corner| self.corners[panel][corner])
    }
}

#[cfg(test)]
mod tests;
