//! Chooses the bridges among the matches: a spanning tree of piles, or as many as can be. Each bridge beyond the spanning
//! ones closes a loop, so a fold on that loop is broken: bridges less breaks are always K - 1.

use super::border::{BorderEdge, borders, places};
use super::{Matched, align, turning};
use crate::adjacency::Adjacency;
use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::joint::Joint;
use crate::plan::Side;
use crate::planner::Bridges;
use crate::sets::Sets;
use crate::tree_path;
use std::collections::{BTreeSet, VecDeque};

/// Times that the tree path is grown anew from its middle.
const REGROWTHS: usize = 3;

/// Piles joined to one tree path.
#[derive(Debug, Clone)]
pub(crate) struct Bridged {
    /// Panels of every pile from the bottom up.
    pub(crate) piles: Vec<Vec<usize>>,
    /// Of every panel how it lies on its cell.
    pub(crate) facing: Vec<Facing>,
    /// Of every pile its cell.
    pub(crate) cells: Vec<[i32; 2]>,
    /// The bridges.
    pub(crate) bridges: Vec<Joint>,
    /// The panels of every broken fold, the lower one first.
    pub(crate) breaks: Vec<[usize; 2]>,
}

impl Bridged {
    /// How many hinges lie between the middle of the tree path and the panel farthest from it.
    pub(crate) fn depth(&self) -> usize {
        let broken: BTreeSet<[usize; 2]> = self.breaks.iter().copied().collect();
        let mut joined = Adjacency::without_edges(self.facing.len());
        for pair in self.piles.iter().flat_map(|pile| pile.windows(2)) {
            if !broken.contains(&[pair[0], pair[1]]) {
                joined.join(pair[0], pair[1]);
            }
        }
        for bridge in &self.bridges {
            joined.join(bridge.panels[0], bridge.panels[1]);
        }
        tree_path::centre(&joined).1
    }
}

impl Matched {
    /// Joined by bridges that are given, with no fold broken.
    pub(crate) fn with(self, bridges: Vec<Joint>) -> Bridged {
        let mut facing = self.facing;
        for (pile, turn) in self.piles.iter().zip(&self.turns) {
            for panel in pile {
                facing[*panel] = facing[*panel].turned(*turn);
            }
        }
        Bridged { piles: self.piles, facing, cells: self.cells, bridges, breaks: Vec::new() }
    }
}

/// Two neighbours at one height of piles that stand side by side: a bridge, if both piles are turned as it needs there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub(super) height: usize,
    pub(super) joint: Joint,
    /// The quarter turns that each pile needs.
    pub(super) turns: [usize; 2],
}

/// Joins matched piles; none where they don't hang together.
pub(crate) fn bridge(dual: &Dual, matched: Matched, wanted: Bridges) -> Option<Bridged> {
    if wanted == Bridges::Most {
        let mut aligned = matched.clone();
        align::align(dual, &mut aligned);
        // More matches may still be none where one held piles together.
        if let Some(bridged) = bridge_as_they_stand(dual, aligned, wanted) {
            return Some(bridged);
        }
    }
    bridge_as_they_stand(dual, matched, wanted)
}

fn bridge_as_they_stand(dual: &Dual, matched: Matched, wanted: Bridges) -> Option<Bridged> {
    let candidates = candidates(dual, &matched);
    let height = matched.piles.first().map_or(0, Vec::len);
    let turned = match wanted {
        Bridges::Least | Bridges::Base => matched.turns.iter().map(|turn| vec![*turn; height]).collect(),
        Bridges::Most => turning::choose(&candidates, &matched.turns, height),
    };
    let fits = |candidate: &&Candidate| {
        let [a, b] = candidate.joint.piles;
        [turned[a][candidate.height], turned[b][candidate.height]] == candidate.turns
    };
    let fitting: Vec<Candidate> = candidates.iter().filter(fits).copied().collect();
    let mut facing = matched.facing;
    for (pile, turns) in matched.piles.iter().zip(&turned) {
        for (panel, turn) in pile.iter().zip(turns) {
            facing[*panel] = facing[*panel].turned(*turn);
        }
    }
    let (bridges, breaks) = match wanted {
        Bridges::Least | Bridges::Base => (spanning(fitting, matched.piles.len(), height)?, Vec::new()),
        Bridges::Most => grown(&matched.piles, &turned, &fitting)?,
    };
    Some(Bridged { piles: matched.piles, facing, cells: matched.cells, bridges, breaks })
}

fn candidates(dual: &Dual, matched: &Matched) -> Vec<Candidate> {
    let piles = || matched.piles.iter();
    let places = places(piles(), matched.facing.len());
    let borders = borders(dual, piles(), &places, &matched.cells);
    let candidate = |edge: &BorderEdge| {
        let [(pile, height), (other_pile, other_height)] =
            [edge.panel, edge.other].map(|panel| places[panel]);
        let sides =
            [matched.facing[edge.panel].side(edge.edge), matched.facing[edge.other].side(edge.other_edge)];
        let joint = Joint {
            panels: [edge.panel, edge.other],
            edges: [edge.edge, edge.other_edge],
            piles: [pile, other_pile],
            sides,
        };
        let turn = |towards: Side, side: Side| (towards as usize + 4 - side as usize) % 4;
        let turns = [turn(edge.towards, sides[0]), turn(edge.towards.opposite(), sides[1])];
        (pile < other_pile && height == other_height).then_some(Candidate { height, joint, turns })
    };
    let mut candidates: Vec<Candidate> = borders.iter().flatten().filter_map(candidate).collect();
    candidates.sort_by_key(|candidate| (candidate.height, candidate.joint.panels));
    candidates
}

/// A spanning tree of the piles, of bridges as near to half height as can be.
fn spanning(mut fitting: Vec<Candidate>, piles: usize, height: usize) -> Option<Vec<Joint>> {
    fitting.sort_by_key(|candidate| (2 * candidate.height + 1).abs_diff(height));
    let mut groups = Sets::new(piles);
    let mut bridges = Vec::with_capacity(piles);
    for candidate in fitting {
        let [a, b] = candidate.joint.piles;
        if groups.join(a, b) {
            bridges.push(candidate.joint);
        }
    }
    (bridges.len() + 1 == piles).then_some(bridges)
}

/// A tree path with all bridges but those that close a loop of bridges alone, grown breadth first so that it is shallow;
/// with the folds that it leaves out.
fn grown(
    piles: &[Vec<usize>],
    turned: &[Vec<usize>],
    fitting: &[Candidate],
) -> Option<(Vec<Joint>, Vec<[usize; 2]>)> {
    let panels = piles.iter().map(Vec::len).sum();
    let mut groups = Sets::new(panels);
    let mut across = Adjacency::without_edges(panels);
    let mut bridges = Vec::new();
    for candidate in fitting {
        let [a, b] = candidate.joint.panels;
        if groups.join(a, b) {
            bridges.push(candidate.joint);
            across.join(a, b);
        }
    }
    let mut folds = Adjacency::without_edges(panels);
    for (pile, turns) in piles.iter().zip(turned) {
        for (pair, turn) in pile.windows(2).zip(turns.windows(2)) {
            if turn[0] == turn[1] {
                folds.join(pair[0], pair[1]);
            }
        }
    }
    let mut start = piles[0][piles[0].len() / 2];
    let mut joined = Adjacency::without_edges(0);
    for _ in 0..REGROWTHS {
        joined = grow(start, &across, &folds)?;
        start = tree_path::centre(&joined).0;
    }
    let pairs = piles.iter().flat_map(|pile| pile.windows(2)).map(|pair| [pair[0], pair[1]]);
    let breaks = pairs.filter(|[a, b]| !joined[*a].contains(b)).collect();
    Some((bridges, breaks))
}

/// The tree from one panel: whoever is reached brings all panels along that bridges join it to.
fn grow(start: usize, across: &Adjacency, folds: &Adjacency) -> Option<Adjacency> {
    let mut joined = across.clone();
    let mut seen = vec![false; across.len()];
    seen[start] = true;
    let mut count = 1;
    let mut waiting = VecDeque::from([start]);
    let mut together = vec![start];
    loop {
        while let Some(panel) = together.pop() {
            for &other in &across[panel] {
                if !std::mem::replace(&mut seen[other], true) {
                    count += 1;
                    waiting.push_back(other);
                    together.push(other);
                }
            }
        }
        let Some(&panel) = waiting.front() else { break };
        let Some(&other) = folds[panel].iter().find(|other| !seen[**other]) else {
            waiting.pop_front();
            continue;
        };
        joined.join(panel, other);
        seen[other] = true;
        count += 1;
        waiting.push_back(other);
        together.push(other);
    }
    (count == across.len()).then_some(joined)
}
