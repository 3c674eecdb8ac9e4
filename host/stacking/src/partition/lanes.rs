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

#[cfg(test)]
mod tests {
    use super::*;

    /// The left and the right half of a sheet eight wide and four deep.
    fn halves() -> Vec<Vec<usize>> {
        [0..4, 4..8].map(|xs| (0..32).filter(|panel| xs.contains(&(panel % 8))).collect()).to_vec()
    }

    #[test]
    fn the_lane_of_a_straight_border_is_the_row_of_panels_along_it() {
        let (dual, parts) = (Dual::of_sheet(8, 4), halves());
        let borders = Borders::of(&dual, &parts);
        for (part, x) in [(0, 3), (1, 4)] {
            let mut lanes = borders.lanes(&parts[part], |_| true);
            assert_eq!(lanes.len(), 1, "{lanes:?}");
            if lanes[0][0] != x {
                lanes[0].reverse();
            }
            assert_eq!(lanes[0], [x, x + 8, x + 16, x + 24]);
        }
    }

    #[test]
    fn borders_with_parts_that_are_not_wanted_have_no_lanes() {
        let (dual, parts) = (Dual::of_sheet(8, 4), halves());
        assert!(Borders::of(&dual, &parts).lanes(&parts[0], |other| other != 1).is_empty());
    }

    #[test]
    fn lanes_are_rows_of_three_neighbours_at_least_that_share_no_panel() {
        // Nine squares of nine panels: every border ends where two others cross it.
        let dual = Dual::of_sheet(9, 9);
        let part = |panel: usize| 3 * (panel / 27) + panel % 9 / 3;
        let parts: Vec<Vec<usize>> =
            (0..9).map(|name| (0..81).filter(|panel| part(*panel) == name).collect()).collect();
        let borders = Borders::of(&dual, &parts);
        let mut found = 0;
        for (name, members) in parts.iter().enumerate() {
            let lanes = borders.lanes(members, |_| true);
            let panels: BTreeSet<usize> = lanes.iter().flatten().copied().collect();
            assert_eq!(panels.len(), lanes.iter().map(Vec::len).sum::<usize>());
            assert!(panels.iter().all(|panel| part(*panel) == name));
            for lane in &lanes {
                assert!(lane.len() >= 3, "{lane:?}");
                assert!(
                    lane.windows(2).all(|pair| dual.common_edges(pair[0], pair[1]).is_some()),
                    "{lane:?}"
                );
            }
            found += lanes.len();
        }
        assert!(found >= 9, "{found}");
    }
}
