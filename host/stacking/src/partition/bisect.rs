//! Two connected halves of exact sizes with few edges between them: a first cut half way between two far nodes or by
//! breadth-first growth, refined as Fiduccia and Mattheyses do (DAC 1982), where only a state of exact sizes counts.

use super::pieces;
use crate::adjacency::Adjacency;
use crate::random::Random;

/// Degrees are four at most, so gains lie between -4 and 4.
const HIGHEST: usize = 4;
/// Moves past the best state after which a pass ends, at least.
const PATIENCE: usize = 60;
/// Passes over one cut, at most.
const PASSES: usize = 12;
/// Rounds of moving stray pieces to the other half.
const ROUNDS: usize = 4;
/// Nodes that are looked at in all first cuts together, and the least and most cuts that makes.
const EFFORT: usize = 24_000;
const FEWEST_CUTS: usize = 2;
const MOST_CUTS: usize = 8;

/// Splits a connected graph into a connected half of `first` nodes (false) and a connected rest (true); none where no cut
/// left both in one piece.
///
/// `held` has for every node the half that it must be in, or nothing at all.
pub(super) fn bisect(
    graph: &Adjacency,
    first: usize,
    held: &[Option<bool>],
    random: &mut Random,
) -> Option<Vec<bool>> {
    let tries = (EFFORT / graph.len().max(1)).clamp(FEWEST_CUTS, MOST_CUTS);
    let mut best: Option<(usize, Vec<bool>)> = None;
    for number in 0..tries {
        let order = match (held.is_empty(), number % 2) {
            (false, _) => from_held(graph, held),
            (true, 0) => between(graph, random),
            (true, _) => growth(graph, random),
        };
        let mut beyond = vec![true; graph.len()];
        for node in &order[..first] {
            beyond[*node] = false;
        }
        if let Some(size) = refine(graph, first, &mut beyond, held, random)
            && best.as_ref().is_none_or(|(least, _)| size < *least)
        {
            best = Some((size, beyond));
        }
    }
    best.map(|(_, beyond)| beyond)
}

/// Betters a cut until both halves are in one piece, `first` nodes in the half that is not beyond. Says how many edges are
/// cut; none where the halves did not come out whole.
pub(super) fn refine(
    graph: &Adjacency,
    first: usize,
    beyond: &mut [bool],
    held: &[Option<bool>],
    random: &mut Random,
) -> Option<usize> {
    let mut cut = Cut::of(graph, first, beyond);
    for (node, half) in held.iter().enumerate() {
        if half.is_some() {
            // A node that has moved stays where it is.
            cut.moved[node] = true;
        }
    }
    for _ in 0..ROUNDS {
        let mut size = usize::MAX;
        for _ in 0..PASSES {
            cut.pass(random);
            if cut.excess != 0 {
                return None;
            }
            if cut.size >= size {
                break;
            }
            size = cut.size;
        }
        let strays = [false, true].map(|half| cut.gather_strays(half));
        if strays == [0, 0] {
            let strayed = |(held, beyond): (&Option<bool>, &bool)| held.is_some_and(|held| held != *beyond);
            return (!held.iter().zip(&*cut.beyond).any(strayed)).then_some(cut.size);
        }
    }
    None
}

fn growth(graph: &Adjacency, random: &mut Random) -> Vec<usize> {
    let mut order = reached(graph, [random.below(graph.len())]).0;
    let far = order[order.len() - 1];
    order = reached(graph, [far]).0;
    order
}

/// The nodes in the order of their distance to one of two far nodes less that to the other.
fn between(graph: &Adjacency, random: &mut Random) -> Vec<usize> {
    let start = reached(graph, [random.below(graph.len())]).0;
    let (order, from_one) = reached(graph, [start[start.len() - 1]]);
    let (mut order, from_other) = reached(graph, [order[order.len() - 1]]);
    order.sort_by_key(|node| from_one[*node].cast_signed() - from_other[*node].cast_signed());
    order
}

/// The nodes in the order of their distance to what is held in the first half less that to what is held beyond; the held
/// ones themselves first and last.
fn from_held(graph: &Adjacency, held: &[Option<bool>]) -> Vec<usize> {
    let of_half = |half: bool| (0..graph.len()).filter(move |node| held[*node] == Some(half));
    let [near, far] = [false, true].map(|half| reached(graph, of_half(half)).1);
    let mut order: Vec<usize> = (0..graph.len()).collect();
    order.sort_by_key(|node| {
        let side = held[*node].map_or(0, |beyond| if beyond { 1 } else { -1 });
        (side, near[*node].cast_signed() - far[*node].cast_signed())
    });
    order
}

/// The nodes in breadth-first order from one or more, and the distance of each.
fn reached(graph: &Adjacency, starts: impl IntoIterator<Item = usize>) -> (Vec<usize>, Vec<usize>) {
    let mut distance = vec![usize::MAX; graph.len()];
    let mut order = Vec::with_capacity(graph.len());
    order.extend(starts);
    for start in &order {
        distance[*start] = 0;
    }
    let mut next = 0;
    while next < order.len() {
        let node = order[next];
        for &other in &graph[node] {
            if distance[other] == usize::MAX {
                distance[other] = distance[node] + 1;
                order.push(other);
            }
        }
        next += 1;
    }
    (order, distance)
}

/// Nodes by half and gain. An entry counts only while it is true; moves leave stale ones behind.
struct Buckets {
    nodes: [[Vec<usize>; 2 * HIGHEST + 1]; 2],
}

impl Buckets {
    fn push(&mut self, half: bool, gain: isize, node: usize) {
        self.nodes[usize::from(half)][gain.saturating_add_unsigned(HIGHEST).cast_unsigned()].push(node);
    }

    /// The node of a half with the highest gain, left in its place.
    fn top(&mut self, half: bool, valid: impl Fn(usize, isize) -> bool) -> Option<(isize, usize)> {
        for (level, bucket) in self.nodes[usize::from(half)].iter_mut().enumerate().rev() {
            let gain = level.cast_signed().saturating_sub_unsigned(HIGHEST);
            while let Some(&node) = bucket.last() {
                if valid(node, gain) {
                    return Some((gain, node));
                }
                bucket.pop();
            }
        }
        None
    }
}

/// Two halves and the cut between them. A pass costs what moves, not the whole graph.
struct Cut<'a> {
    graph: &'a Adjacency,
    beyond: &'a mut [bool],
    /// Nodes in the first half, less those wanted there.
    excess: isize,
    /// How far that may stray while nodes move.
    slack: isize,
    /// How many edges are cut.
    size: usize,
    /// Of every node how many edges less are cut when it moves.
    gain: Vec<isize>,
    /// The nodes with a cut edge, rising.
    border: Vec<usize>,
    /// Whether a node moved in the pass that runs.
    moved: Vec<bool>,
}

impl<'a> Cut<'a> {
    fn of(graph: &'a Adjacency, first: usize, beyond: &'a mut [bool]) -> Self {
        let mut cut = Self {
            excess: beyond.iter().filter(|beyond| !**beyond).count().cast_signed() - first.cast_signed(),
            slack: (first.min(graph.len() - first) / 50).clamp(1, 64).cast_signed(),
            size: 0,
            gain: vec![0; graph.len()],
            border: Vec::new(),
            moved: vec![false; graph.len()],
            graph,
            beyond,
        };
        for node in 0..graph.len() {
            let outer = cut.outer(node);
            cut.gain[node] = 2 * outer.cast_signed() - graph[node].len().cast_signed();
            cut.size += outer;
            if outer > 0 {
                cut.border.push(node);
            }
        }
        cut.size /= 2;
        cut
    }

    fn outer(&self, node: usize) -> usize {
        self.graph[node].iter().filter(|other| self.beyond[**other] != self.beyond[node]).count()
    }

    /// Moves a node to the other half.
    fn flip(&mut self, node: usize) {
        let half = self.beyond[node];
        self.beyond[node] = !half;
        self.excess += if half { 1 } else { -1 };
        self.size = self.size.saturating_add_signed(-self.gain[node]);
        self.gain[node] = -self.gain[node];
        for &other in &self.graph[node] {
            self.gain[other] += if self.beyond[other] == half { 2 } else { -2 };
        }
    }

    /// Finds the border anew after some nodes moved.
    fn renew_border(&mut self, moved: &[usize]) {
        let near = moved.iter().flat_map(|node| &self.graph[*node]);
        let mut border: Vec<usize> = moved.iter().chain(near).chain(&self.border).copied().collect();
        border.sort_unstable();
        border.dedup();
        border.retain(|node| self.outer(*node) > 0);
        self.border = border;
    }

    /// One pass: every node moves once at most, the best first; then back to the best state with exact sizes. Where it met
    /// none, there is an excess.
    fn pass(&mut self, random: &mut Random) {
        let mut border = self.border.clone();
        random.shuffle(&mut border);
        let mut buckets = Buckets { nodes: Default::default() };
        for &node in &border {
            buckets.push(self.beyond[node], self.gain[node], node);
        }
        let mut moves = Vec::new();
        let mut best = (self.excess == 0).then_some((self.size, 0));
        let patience = PATIENCE.max(border.len());
        while best.is_none_or(|(_, at)| moves.len() < at + patience) {
            let Some(node) = self.choose(&mut buckets) else { break };
            self.moved[node] = true;
            self.flip(node);
            moves.push(node);
            for &other in &self.graph[node] {
                if !self.moved[other] {
                    buckets.push(self.beyond[other], self.gain[other], other);
                }
            }
            if self.excess == 0 && best.is_none_or(|(least, _)| self.size < least) {
                best = Some((self.size, moves.len()));
            }
        }
        for node in &moves {
            self.moved[*node] = false;
        }
        if let Some((_, kept)) = best {
            for node in &moves[kept..] {
                self.flip(*node);
            }
        }
        self.renew_border(&moves);
    }

    /// The node to move next: one with the highest gain, from the half that is too large by more than the slack.
    fn choose(&self, buckets: &mut Buckets) -> Option<usize> {
        let mut top = |half: bool| {
            buckets
                .top(half, |node, level| {
                    !self.moved[node] && self.beyond[node] == half && self.gain[node] == level
                })
                .map(|(gain, node)| (gain, node, half))
        };
        let choice = if self.excess >= self.slack {
            top(false)
        } else if self.excess <= -self.slack {
            top(true)
        } else {
            // Of equals the one that helps the sizes.
            let (near, far) = (top(false), top(true));
            near.into_iter().chain(far).max_by_key(|(gain, _, half)| (*gain, *half == (self.excess < 0)))
        };
        choice.map(|(_, node, _)| node)
    }

    /// Moves all pieces of a half but the largest to the other half; says how many nodes that are.
    fn gather_strays(&mut self, half: bool) -> usize {
        let mut of_half = pieces(self.graph, |node| self.beyond[node] == half);
        let Some(largest) = (0..of_half.len()).max_by_key(|number| of_half[*number].len()) else { return 0 };
        of_half.swap_remove(largest);
        let strays = of_half.concat();
        for node in &strays {
            self.flip(*node);
        }
        self.renew_border(&strays);
        strays.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(width: usize, depth: usize) -> Adjacency {
        let number = |x: usize, y: usize| y * width + x;
        let near = |x: usize, y: usize| {
            let mut near = Vec::new();
            near.extend((x > 0).then(|| number(x - 1, y)));
            near.extend((x + 1 < width).then(|| number(x + 1, y)));
            near.extend((y > 0).then(|| number(x, y - 1)));
            near.extend((y + 1 < depth).then(|| number(x, y + 1)));
            near
        };
        (0..depth).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| near(x, y)).collect()
    }

    #[test]
    fn the_best_cut_through_the_middle_of_a_sheet_is_found() {
        let graph = sheet(20, 8);
        let beyond = bisect(&graph, 80, &[], &mut Random::new(1, 1)).unwrap();
        assert_eq!(beyond.iter().filter(|beyond| !**beyond).count(), 80);
        let cut = |node: usize| graph[node].iter().filter(|other| beyond[**other] != beyond[node]).count();
        assert_eq!((0..160).map(cut).sum::<usize>() / 2, 8);
    }

    #[test]
    fn held_nodes_stay_in_their_halves() {
        let graph = sheet(12, 9);
        let mut held = vec![None; 108];
        // Two neighbours near a corner, where no short cut passes.
        held[15] = Some(false);
        held[27] = Some(true);
        let beyond = bisect(&graph, 54, &held, &mut Random::new(1, 1)).unwrap();
        assert_eq!((beyond[15], beyond[27]), (false, true));
        assert_eq!(beyond.iter().filter(|beyond| !**beyond).count(), 54);
        for half in [false, true] {
            assert_eq!(pieces(&graph, |node| beyond[node] == half).len(), 1);
        }
    }

    #[test]
    fn halves_of_any_sizes_are_exact_and_in_one_piece() {
        let graph = sheet(11, 9);
        for first in 1..99 {
            let beyond = bisect(&graph, first, &[], &mut Random::new(first as u64, 1)).unwrap();
            assert_eq!(beyond.iter().filter(|beyond| !**beyond).count(), first);
            for half in [false, true] {
                assert_eq!(pieces(&graph, |node| beyond[node] == half).len(), 1, "{first}");
            }
        }
    }
}
