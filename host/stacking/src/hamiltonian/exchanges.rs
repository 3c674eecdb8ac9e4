//! Joins the cycles that are left: alternating closed walks from the shortest cycles, removing two to six edges and adding
//! as many, taken when the number of cycles falls. Where none helps, a walk that changes nothing in the number is taken
//! nearby, or a detour of any length out of the cycle, and the search goes on from there.

use super::cover::Cover;
use super::cycles::Cycles;
use super::graph::Graph;
use super::trails::Trails;
use crate::random::Random;
use std::collections::BTreeSet;

/// Most edges that one exchange removes.
const LONGEST: usize = 6;
/// Nodes of a cycle from which walks are tried in one round.
const STARTS: usize = 24;
/// Steps of walks tried from one node.
const STEPS: usize = 6000;
/// How far from the cycle in question a kick may begin, in panels.
const KICK_DISTANCE: usize = 8;
/// Panels that the first detour may look at; each later one that is needed looks at four times as many.
const NEAR: usize = 64;
/// Panels that all detours together may look at, in units of all panels.
const EFFORT: usize = 100;

type Edges = Vec<(usize, usize)>;

/// Joins cycles as far as possible and returns how many are left. Gives up after so many kicks without a fall in their number.
pub(super) fn merge(graph: &Graph<'_>, cover: &mut Cover, most_kicks: usize, random: &mut Random) -> usize {
    let mut cycles = Cycles::of(cover);
    let mut trails = Trails::new(graph.nodes());
    // Cycles by how often they resisted, then by length; names of cycles that are gone are passed over.
    let mut queue: BTreeSet<(usize, usize, usize)> =
        cycles.by_length().map(|(length, name)| (0, length, name)).collect();
    let (mut fewest, mut kicks) = (cycles.count(), 0);
    while cycles.count() > 1 && kicks < most_kicks && trails.steps() < EFFORT * graph.nodes() {
        let Some((resisted, length, name)) = queue.pop_first() else { break };
        let Some((_, member)) = cycles.length_and_member(name) else { continue };
        queue.insert((resisted + 1, length, name));
        // The longest of all is what the others join.
        if cycles.by_length().next_back() == Some((length, name)) {
            continue;
        }
        let starts = starts(graph, cover, &cycles, member, length, random);
        let joined = (2..=LONGEST.min(4 + resisted)).find_map(|longest| {
            starts.iter().find_map(|start| Walk::new(graph, cover, &cycles, longest).falling(*start))
        });
        let resisted = if joined.is_some() { 0 } else { resisted + 1 };
        let exchange = joined.or_else(|| {
            kicks += 1;
            if resisted % 2 == 1 {
                let reach = NEAR << (2 * resisted.min(8));
                detour(graph, cover, &mut trails, *starts.first()?, reach, random)
            } else {
                let start = stroll(graph, member, random);
                Walk::new(graph, cover, &cycles, 2 + random.below(3)).level(start, random)
            }
        });
        if let Some((removed, added)) = exchange {
            cover.exchange(&removed, &added);
            for name in cycles.renew(&removed, &added) {
                if let Some((length, _)) = cycles.length_and_member(name) {
                    queue.insert((resisted, length, name));
                }
            }
        }
        if cycles.count() < fewest {
            (fewest, kicks) = (cycles.count(), 0);
        }
    }
    cycles.count()
}

/// An exchange that takes an edge out of a node's cycle, whatever that does elsewhere; sought among so many panels.
fn detour(
    graph: &Graph<'_>,
    cover: &mut Cover,
    trails: &mut Trails,
    node: usize,
    reach: usize,
    random: &mut Random,
) -> Option<(Edges, Edges)> {
    let near: Vec<usize> = graph.neighbours(node).iter().copied().filter(|n| !cover.has(node, *n)).collect();
    if near.is_empty() {
        return None;
    }
    let other = near[random.below(near.len())];
    let mut mate_of = |node: usize| cover.mates(node).nth(random.below(2));
    let (from, to) = (mate_of(node)?, mate_of(other)?);
    if from == to {
        return None;
    }
    let (cut, joined) = ([(node, from), (other, to)], [(node, other)]);
    cover.exchange(&cut, &joined);
    let trail = trails.from(graph, cover, from, Some(joined[0]), reach, random);
    cover.exchange(&joined, &cut);
    let (mut removed, mut added) = trail?;
    removed.extend(cut);
    added.extend(joined);
    let both: Edges = removed.iter().filter(|(u, v)| holds(&added, *u, *v)).copied().collect();
    removed.retain(|(u, v)| !holds(&both, *u, *v));
    added.retain(|(u, v)| !holds(&both, *u, *v));
    Some((removed, added))
}

/// Nodes of a cycle to begin at: those that have a neighbour in another one, all or some of them.
fn starts(
    graph: &Graph<'_>,
    cover: &Cover,
    cycles: &Cycles,
    member: usize,
    length: usize,
    random: &mut Random,
) -> Vec<usize> {
    let own = cycles.cycle_of(member);
    let at_border = |node: &usize| {
        let crosses = |near: &usize| cycles.cycle_of(*near) != own;
        // An exchange through the apex may begin anywhere.
        graph.apex().is_some() || graph.neighbours(*node).iter().any(crosses)
    };
    let mut nodes: Vec<usize> = cover.walk(member).filter(at_border).collect();
    if length > STARTS {
        random.shuffle(&mut nodes);
        nodes.truncate(STARTS);
    }
    nodes
}

/// A node a few steps away.
fn stroll(graph: &Graph<'_>, from: usize, random: &mut Random) -> usize {
    let mut node = from;
    for _ in 0..random.below(KICK_DISTANCE) {
        let near = graph.neighbours(node);
        if !near.is_empty() {
            node = near[random.below(near.len())];
        }
    }
    node
}

/// An alternating walk under way: remove an edge, add one, remove one, ... until an added edge closes it.
struct Walk<'a> {
    graph: &'a Graph<'a>,
    cover: &'a Cover,
    cycles: &'a Cycles,
    longest: usize,
    removed: Edges,
    added: Edges,
    steps: usize,
    /// Exchanges that leave the number of cycles as it is, as far as they are asked for.
    level: Option<Vec<(Edges, Edges)>>,
}

impl<'a> Walk<'a> {
    fn new(graph: &'a Graph<'a>, cover: &'a Cover, cycles: &'a Cycles, longest: usize) -> Self {
        let (removed, added) = (Vec::with_capacity(longest), Vec::with_capacity(longest));
        Self { graph, cover, cycles, longest, removed, added, steps: STEPS, level: None }
    }

    /// An exchange from `start` that makes the cycles fewer.
    fn falling(mut self, start: usize) -> Option<(Edges, Edges)> {
        self.from(start).then_some((self.removed, self.added))
    }

    /// An exchange from `start` that leaves their number as it is (or makes them fewer, should one turn up).
    fn level(mut self, start: usize, random: &mut Random) -> Option<(Edges, Edges)> {
        self.level = Some(Vec::new());
        if self.from(start) {
            return Some((self.removed, self.added));
        }
        let mut found = self.level.unwrap_or_default();
        (!found.is_empty()).then(|| found.swap_remove(random.below(found.len())))
    }

    fn from(&mut self, start: usize) -> bool {
        self.cover.mates(start).any(|mate| {
            self.removed.push((start, mate));
            let found = self.extend(start, mate);
            if !found {
                self.removed.pop();
            }
            found
        })
    }

    fn free(&self, u: usize, v: usize) -> bool {
        self.graph.joins(u, v) && !self.cover.has(u, v) && !holds(&self.added, u, v)
    }

    /// Goes on from the end of the edge removed last: adds an edge and removes the next, or closes the walk.
    fn extend(&mut self, start: usize, end: usize) -> bool {
        if self.removed.len() >= 2 && self.free(end, start) {
            self.added.push((end, start));
            let change = self.cycles.change(&self.removed, &self.added);
            if change < 0 {
                return true;
            }
            if let Some(level) = self.level.as_mut().filter(|_| change == 0) {
                level.push((self.removed.clone(), self.added.clone()));
            }
            self.added.pop();
        }
        if self.removed.len() == self.longest {
            return false;
        }
        let apex = self.graph.apex();
        for &to in self.graph.neighbours(end) {
            if self.steps == 0 {
                return false;
            }
            self.steps -= 1;
            if !self.free(end, to) {
                continue;
            }
            self.added.push((end, to));
            for beyond in self.cover.mates(to) {
                // The apex neighbours all, so a walk that reaches it closes there or not at all.
                if !holds(&self.removed, to, beyond) && (Some(beyond) != apex || self.free(beyond, start)) {
                    self.removed.push((to, beyond));
                    if self.extend(start, beyond) {
                        return true;
                    }
                    self.removed.pop();
                }
            }
            self.added.pop();
        }
        false
    }
}

fn holds(edges: &[(usize, usize)], u: usize, v: usize) -> bool {
    edges.iter().any(|edge| *edge == (u, v) || *edge == (v, u))
}
