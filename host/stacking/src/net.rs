//! The net: all panels in one plane, every hinge of the tree path opened flat. Panels may come to lie on each other (paper, Fig.
//! 2k and l): a stack doesn't need a net that could be cut from a sheet. `zygote net` prints the counts and draws it.

use crate::plan::Plan;
use std::collections::BTreeMap;

/// A plan's net.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Net {
    /// The corners of every panel, counter-clockwise; the root lies on the square from (0, 0) to (1, 1).
    pub squares: Vec<[[i32; 2]; 4]>,
}

/// How the panels of a net lie on each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Overlaps {
    /// Panels that share their square with another.
    pub panels: usize,
    /// Pairs of panels on one square.
    pub pairs: usize,
    /// Of these, pairs of one pile.
    pub pairs_in_a_pile: usize,
    /// Most panels on one square.
    pub most: usize,
}

impl Net {
    /// Flattens a plan along its hinges.
    pub fn of(plan: &Plan) -> Self {
        let mut at_panel = vec![Vec::new(); plan.panels()];
        for hinge in &plan.hinges {
            let ([a, b], [e, f]) = (hinge.panels, hinge.edges);
            at_panel[a].push((b, e, f));
            at_panel[b].push((a, f, e));
        }
        let mut squares = vec![[[0; 2]; 4]; plan.panels()];
        let mut reached = vec![false; plan.panels()];
        squares[plan.root] = [[0, 0], [1, 0], [1, 1], [0, 1]];
        reached[plan.root] = true;
        let mut open = vec![plan.root];
        while let Some(panel) = open.pop() {
            for &(other, e, f) in &at_panel[panel] {
                if !std::mem::replace(&mut reached[other], true) {
                    squares[other] = beside(&squares[panel], e, f);
                    open.push(other);
                }
            }
        }
        Self { squares }
    }

    /// The panels on each square that has any, by the square's least corner.
    pub fn on_squares(&self) -> BTreeMap<[i32; 2], Vec<usize>> {
        let mut on_squares: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for (panel, square) in self.squares.iter().enumerate() {
            let least = [0, 1].map(|axis| square[0][axis].min(square[2][axis]));
            on_squares.entry(least).or_default().push(panel);
        }
        on_squares
    }

    /// Counts the panels that lie on each other.
    pub fn overlaps(&self, plan: &Plan) -> Overlaps {
        let places = plan.places();
        let mut overlaps = Overlaps::default();
        for panels in self.on_squares().values() {
            overlaps.most = overlaps.most.max(panels.len());
            if panels.len() > 1 {
                overlaps.panels += panels.len();
            }
            let mut in_pile: BTreeMap<usize, usize> = BTreeMap::new();
            for panel in panels {
                *in_pile.entry(places[*panel].0).or_default() += 1;
            }
            overlaps.pairs += pairs(panels.len());
            overlaps.pairs_in_a_pile += in_pile.values().copied().map(pairs).sum::<usize>();
        }
        overlaps
    }

    /// The sides of the net's box.
    pub fn bounds(&self) -> [i32; 2] {
        [0, 1].map(|axis| {
            let values = || self.squares.iter().flatten().map(|corner| corner[axis]);
            values().max().unwrap_or(0) - values().min().unwrap_or(0)
        })
    }
}

fn pairs(count: usize) -> usize {
    count * count.saturating_sub(1) / 2
}

/// The square beyond edge `e` of a square, with its own edge `f` there.
fn beside(square: &[[i32; 2]; 4], e: usize, f: usize) -> [[i32; 2]; 4] {
    let (start, end) = (square[(e + 1) % 4], square[e]);
    let inside = square[(e + 2) % 4];
    let out = [start[0] - inside[0], start[1] - inside[1]];
    let further = |p: [i32; 2]| [p[0] + out[0], p[1] + out[1]];
    let mut beside = [start; 4];
    for (step, point) in [start, end, further(end), further(start)].into_iter().enumerate() {
        beside[(f + step) % 4] = point;
    }
    beside
}
