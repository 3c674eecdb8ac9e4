//! The cut edges of a plan that close in the target: pairs of panels that are neighbours there without a hinge.
//! `deployment` asks how far they gape when hinges are not exact.

use crate::dual::Dual;
use crate::plan::Plan;
use crate::surface::{Surface, SurfaceError};
use std::collections::BTreeSet;

/// Two panels that meet in the target without a hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CutEdge {
    /// The panels, the lower number first.
    pub panels: [usize; 2],
    /// The edge of each; they run in opposite directions.
    pub edges: [usize; 2],
}

impl Plan {
    /// The edges of the target at which two neighbours meet without a hinge; an open sheet's rim is none.
    ///
    /// # Errors
    /// A target that is no surface, which a plan that keeps the rules never has.
    pub fn cut_edges(&self) -> Result<Vec<CutEdge>, SurfaceError> {
        let dual = Dual::of(&Surface::new(self.target.clone(), Vec::new())?)?;
        let hinged: BTreeSet<(usize, usize)> = self
            .hinges
            .iter()
            .flat_map(|hinge| [(hinge.panels[0], hinge.edges[0]), (hinge.panels[1], hinge.edges[1])])
            .collect();
        let mut cut_edges = Vec::new();
        for panel in 0..self.panels() {
            for edge in 0..4 {
                let Some(across) = dual.across(panel, edge) else { continue };
                if panel < across.panel && !hinged.contains(&(panel, edge)) {
                    cut_edges.push(CutEdge { panels: [panel, across.panel], edges: [edge, across.edge] });
                }
            }
        }
        Ok(cut_edges)
    }
}
