//! Changes a plan without touching its bridges: the panels between two breaks of a pile, a piece, may come in any order in which
//! each is the neighbour of the next, as long as those with a bridge stay where they are and lie as they lay.

use super::{Slot, SlotKind};
use crate::folding_map::Facing;
use crate::hinges;
use crate::plan::{HingeKind, Pile, Plan};
use crate::planner::Request;
use crate::random::Random;
use crate::readers::Model;
use crate::sequence::Mounted;
use crate::strip_changes::{self, Neighbours, Schedule};
use crate::tree_path;
use std::collections::BTreeMap;

/// Panels that all changes of all plans look at together.
const STEPS: u64 = 3_000_000_000;
/// Most changes of a piece.
const CHANGES: u64 = 1_000_000;
/// So freely does the search begin.
const HOTTEST: u64 = 50_000;
/// What a hinge costs that moves, where one that opens otherwise costs 1.
const MOVED: usize = 3;
/// Panels of a closed piece that is tried from each of its panels on.
const LONGEST_RING: usize = 5000;

/// A plan after the changes.
pub(super) struct Improved {
    pub(super) plan: Plan,
    pub(super) changes: u64,
}

/// Brings the folds of a plan, one of so many, nearer to the hinges that are wanted.
pub(super) fn improve(
    plan: &Plan,
    model: &Model,
    request: &Request,
    wanted: &BTreeMap<Slot, Mounted>,
    plans: usize,
) -> Improved {
    let places = plan.places();
    let mut has_bridge = vec![false; plan.panels()];
    let mut is_folded = vec![false; plan.panels()];
    for hinge in &plan.hinges {
        match hinge.kind {
            HingeKind::Bridge => hinge.panels.iter().for_each(|panel| has_bridge[*panel] = true),
            HingeKind::Fold => is_folded[hinge.panels[0]] = true,
        }
    }
    let schedule =
        Schedule { rounds: CHANGES.min(STEPS / (plans * plan.panels()).max(1) as u64), hottest: HOTTEST };
    let mut random = Random::new(request.seed, 1 << 34);
    let mut improved = Improved { plan: plan.clone(), changes: 0 };
    for (number, pile) in plan.piles.iter().enumerate() {
        let mut bottom = 0;
        for panels in pile.panels.chunk_by(|lower, _| is_folded[*lower]) {
            let height = bottom;
            bottom += panels.len();
            let Some(piece) = Piece::new(plan, pile, height, panels, &has_bridge, model, wanted) else {
                continue;
            };
            let (order, quarters, changes) = piece.search(schedule, &mut random);
            improved.changes += changes;
            let facings = piece.facings(&order);
            for (along, (panel, facing)) in order.iter().zip(facings).enumerate() {
                let panel = panels[*panel];
                improved.plan.piles[number].panels[height + along] = panel;
                improved.plan.zygote[panel] = facing.turned(quarters).corners(pile.cell);
            }
        }
    }
    rehinge(&mut improved.plan, plan, model, &places, &is_folded);
    if request.root.is_none() {
        let joined = tree_path::joined(plan.panels(), &improved.plan.hinges);
        improved.plan.root = tree_path::centre(&joined).0;
    }
    improved
}

/// Makes the folds anew, in the place of those that joined the same heights.
fn rehinge(plan: &mut Plan, old: &Plan, model: &Model, places: &[(usize, usize)], is_folded: &[bool]) {
    for hinge in &mut plan.hinges {
        let (number, height) = places[hinge.panels[0]];
        if hinge.kind == HingeKind::Bridge || !is_folded[old.piles[number].panels[height]] {
            continue;
        }
        let pile = &plan.piles[number];
        let [a, b] = [pile.panels[height], pile.panels[height + 1]];
        let facing = Facing::with_corners(height, pile.cell, &plan.zygote[a]);
        // Neighbours in a piece are neighbours in the graph, and every panel lies on its cell.
        if let (Some(edges), Some(facing)) = (model.dual.common_edges(a, b), facing) {
            let side = facing.side(edges[0]);
            *hinge = hinges::hinge(HingeKind::Fold, [a, b], edges, side, height, &plan.target);
        }
    }
}

/// Consecutive panels of a pile with folds between them, numbered from the lowest.
struct Piece {
    neighbours: Neighbours,
    /// By panel and edge, where the neighbour there leads to.
    bends: Vec<[i16; 4]>,
    /// Height of its lowest panel.
    bottom: usize,
    /// What is wanted over each height.
    wanted: Vec<Option<Mounted>>,
    /// Places that keep their panel, and how it lies.
    anchors: Vec<(usize, Facing)>,
    /// Whether the last panel is a neighbour of the first and nothing is anchored.
    is_ring: bool,
}

impl Piece {
    /// Panels of a pile from a height up; none where the plan doesn't lie as the folding map says.
    fn new(
        plan: &Plan,
        pile: &Pile,
        bottom: usize,
        panels: &[usize],
        has_bridge: &[bool],
        model: &Model,
        wanted: &BTreeMap<Slot, Mounted>,
    ) -> Option<Self> {
        let neighbours = Neighbours::among(panels, &model.dual);
        let mut anchors = Vec::new();
        for (place, panel) in panels.iter().enumerate().filter(|(_, panel)| has_bridge[**panel]) {
            anchors.push((place, Facing::with_corners(bottom + place, pile.cell, &plan.zygote[*panel])?));
        }
        let bend = |panel: usize, edge: usize| {
            let across = model.dual.across(panel, edge)?;
            Some(hinges::bend(&plan.target[panel], &plan.target[across.panel], across.edge))
        };
        let slot = |height| Slot { cell: pile.cell, height, kind: SlotKind::Fold };
        Some(Self {
            bends: panels
                .iter()
                .map(|panel| [0, 1, 2, 3].map(|edge| bend(*panel, edge).unwrap_or(0)))
                .collect(),
            bottom,
            wanted: (bottom + 1..bottom + panels.len())
                .map(|above| wanted.get(&slot(above - 1)).copied())
                .collect(),
            is_ring: anchors.is_empty() && panels.len() > 2 && neighbours.joins(0, panels.len() - 1),
            anchors,
            neighbours,
        })
    }

    /// How the panels of an order lie, up to a turn of them all.
    fn facings(&self, order: &[usize]) -> Vec<Facing> {
        let mut facings = vec![Facing::square_on(self.bottom)];
        for (pair, along) in order.windows(2).zip(0..) {
            let below: Facing = facings[along];
            // Neighbours in an order are neighbours in the graph.
            let [edge, other] = self.neighbours.edges(pair[0], pair[1]).unwrap_or_default();
            facings.push(below.folded(edge, other));
        }
        facings
    }

    /// What an order costs, and how the piece is turned then; nothing where an anchor would have to move.
    fn cost(&self, order: &[usize]) -> Option<(usize, usize)> {
        if self.anchors.iter().any(|(place, _)| order[*place] != *place) {
            return None;
        }
        let mut facing = Facing::square_on(self.bottom);
        let mut costs = [0; 4];
        let mut anchors = self.anchors.iter().peekable();
        let mut quarters = None;
        for (along, panel) in order.iter().enumerate() {
            if let Some((_, anchored)) = anchors.next_if(|(place, _)| *place == along) {
                let turn = facing.quarters_to(*anchored);
                if quarters.replace(turn).is_some_and(|before| before != turn) {
                    return None;
                }
            }
            let Some(next) = order.get(along + 1) else { break };
            let [edge, other] = self.neighbours.edges(*panel, *next)?;
            if let Some(wanted) = self.wanted[along] {
                let turn = facing.side(edge) as usize;
                let right = (wanted.side as usize + 4 - turn) % 4;
                let bend = self.bends[*panel][edge];
                let over_odd = (self.bottom + along) % 2 == 1;
                let opening = 180 - 90 * if over_odd { -bend } else { bend };
                for cost in &mut costs {
                    *cost += MOVED;
                }
                costs[right] -= MOVED;
                costs[right] += usize::from(opening.unsigned_abs() != wanted.opening_deg);
            }
            facing = facing.folded(edge, other);
        }
        let quarters = quarters.or_else(|| (0..4).min_by_key(|quarters| costs[*quarters]))?;
        Some((costs[quarters], quarters))
    }

    /// The best order found, its turn, and the changes tried.
    fn search(&self, schedule: Schedule, random: &mut Random) -> (Vec<usize>, usize, u64) {
        let mut start: Vec<usize> = (0..self.bends.len()).collect();
        if self.is_ring && start.len() <= LONGEST_RING {
            let forwards = (0..start.len()).map(|first| rotated(&start, first));
            let backwards = forwards.clone().map(|mut order| {
                order.reverse();
                order
            });
            let best = forwards.chain(backwards).min_by_key(|order| self.cost(order).map(|(cost, _)| cost));
            start = best.unwrap_or(start);
        }
        let cost = |order: &[usize], _limit| self.cost(order).map(|(cost, _)| cost);
        let changed = strip_changes::anneal(start, &self.neighbours, schedule, random, cost);
        let quarters = self.cost(&changed.order).map_or(0, |(_, quarters)| quarters);
        (changed.order, quarters, changed.rounds)
    }
}

fn rotated(order: &[usize], first: usize) -> Vec<usize> {
    [&order[first..], &order[..first]].concat()
}
