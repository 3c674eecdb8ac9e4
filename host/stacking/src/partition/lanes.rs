//! Lanes along the borders of parts. Where two parts run side by side for a while, both cycles should run along the border:
//! then all panels of that run come to equal heights at once, and each pair of them can be a bridge.

use super::part_of;
use crate::dual::Dual;
use std::collections::{BTreeMap, BTreeSet};

/// Most panels around a lattice corner; more than any surface has.
const AROUND: usize = 12;

/// Which part every panel is in.
pub(crate) struct Borders<'a> {
    dual: &'a Dual,
    part_of: Vec<usize>,
}

impl<'a> Borders<'a> {
    pub(crate) fn of(dual: &'a Dual, parts: &[Vec<usize>]) -> Self {
        Self { dual, part_of: part_of(parts, parts.iter().map(Vec::len).sum()) }
    }

    /// The lanes of a part along its borders with the parts that are wanted: rows of neighbours of three panels at least,
    /// no panel in two of them. Two neighbours belong to a lane when they follow each other around a corner at which the
    /// part meets the other one.
    pub(crate) fn lanes(&self, part: &[usize], wanted: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let mut along: BTreeMap<usize, BTreeMap<usize, BTreeSet<usize>>> = BTreeMap::new();
        for &panel in part {
            let own = self.part_of[panel];
            for corner in 0..4 {
                let around = self.around(panel, corner);
                let Some(&next) = around.get(1).filter(|next| self.part_of[**next] == own) else { continue };
                let others = around.iter().map(|panel| self.part_of[*panel]);
                for other in others.filter(|other| *other != own && wanted(*other)) {
                    let border = along.entry(other).or_default();
                    border.entry(panel).or_default().insert(next);
                    border.entry(next).or_default().insert(panel);
                }
            }
        }
        let mut borders: Vec<BTreeMap<usize, BTreeSet<usize>>> = along.into_values().collect();
        // The long ones first: they take the panels where borders meet.
        borders.sort_by_key(|border| std::cmp::Reverse(border.len()));
        let mut taken = BTreeSet::new();
        borders.iter().flat_map(|border| rows(border, &mut taken)).collect()
    }

    /// The panels around a corner of a panel, one after the other; at the rim of a sheet only those up to it.
    fn around(&self, panel: usize, corner: usize) -> Vec<usize> {
        let mut around = vec![panel];
        let mut at = (panel, corner);
        while around.len() < AROUND {
            let Some(across) = self.dual.across(at.0, at.1) else { break };
            if across.panel == panel {
                break;
            }
            around.push(across.panel);
            at = (across.panel, (across.edge + 1) % 4);
        }
        around
    }
}

/// Cuts a border into rows of panels without branches, leaving out panels that are taken and taking those it uses.
fn rows(border: &BTreeMap<usize, BTreeSet<usize>>, taken: &mut BTreeSet<usize>) -> Vec<Vec<usize>> {
    let mut rows = Vec::new();
    // Ends of rows first, then what is left: rings, which are cut anywhere.
    let ends = border.keys().filter(|panel| border[*panel].len() == 1);
    let starts: Vec<usize> = ends.chain(border.keys()).copied().collect();
    for start in starts {
        let mut row = Vec::new();
        let mut here = Some(start).filter(|panel| !taken.contains(panel));
        while let Some(panel) = here {
            taken.insert(panel);
            row.push(panel);
            here = border[&panel].iter().copied().find(|next| !taken.contains(next));
        }
        if row.len() >= 3 {
            rows.push(row);
        } else {
            for panel in row {
                taken.remove(&panel);
            }
        }
    }
    rows
}
