//! The neighbours among some panels, numbered from 0: all of a surface, or those of a piece of a pile.

use crate::dual::Dual;

/// Panels, numbered, and who is whose neighbour.
pub(crate) struct Neighbours {
    /// By number and edge: the neighbour's number and its edge there.
    across: Vec<[Option<(usize, usize)>; 4]>,
}

impl Neighbours {
    /// Among these panels, numbered in the order given.
    pub(crate) fn among(panels: &[usize], dual: &Dual) -> Self {
        let numbers: std::collections::BTreeMap<usize, usize> =
            panels.iter().enumerate().map(|(number, panel)| (*panel, number)).collect();
        let beyond = |panel, edge| {
            let across = dual.across(panel, edge)?;
            Some((*numbers.get(&across.panel)?, across.edge))
        };
        Self { across: panels.iter().map(|panel| [0, 1, 2, 3].map(|edge| beyond(*panel, edge))).collect() }
    }

    /// The neighbours of a panel.
    pub(crate) fn of(&self, panel: usize) -> impl Iterator<Item = usize> + use<'_> {
        self.across[panel].iter().flatten().map(|(panel, _)| *panel)
    }

    /// Whether two panels are neighbours.
    pub(crate) fn joins(&self, a: usize, b: usize) -> bool {
        self.edges(a, b).is_some()
    }

    /// The edges of two neighbours that are their common one.
    pub(crate) fn edges(&self, a: usize, b: usize) -> Option<[usize; 2]> {
        (0..4).find_map(|edge| {
            self.across[a][edge].filter(|(panel, _)| *panel == b).map(|(_, other)| [edge, other])
        })
    }
}
