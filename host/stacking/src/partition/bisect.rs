//! Two connected halves of exact sizes with few edges between them: a first cut half way between two far nodes or by
//! breadth-first growth, refined as Fiduccia and Mattheyses do (DAC 1982), where only a state of exact sizes counts.

use super::{Neighbours, pieces};
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
pub(super) fn bisect(graph: &Neighbours, first: usize, random: &mut Random) -> Option<Vec<bool>> {
    let tries = (EFFORT / graph.len().max(1)).clamp(FEWEST_CUTS, MOST_CUTS);
    let mut best: Option<(usize, Vec<bool>)> = None;
    for number in 0..tries {
        let order = if number % 2 == 0 { between(graph, random) } else { growth(graph, random) };
        let mut beyond = vec![true; graph.len()];
        for node in &order[..first] {
            beyond[*node] = false;
        }
        if let Some(size) = refine(graph, first, &mut beyond, random)
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
    graph: &Neighbours,
    first: usize,
    beyond: &mut [bool],
    random: &mut Random,
) -> Option<usize> {
    for _ in 0..ROUNDS {
        let mut size = usize::MAX;
        for _ in 0..PASSES {
            let before = size;
            size = pass(graph, first, beyond, random)?;
            if size >= before {
                break;
            }
        }
        let mut strays = 0;
        for half in [false, true] {
            let mut of_half = pieces(graph, |node| beyond[node] == half);
            let Some(largest) = (0..of_half.len()).max_by_key(|number| of_half[*number].len()) else {
                continue;
            };
            of_half.swap_remove(largest);
            for node in of_half.iter().flatten() {
                beyond[*node] = !half;
                strays += 1;
            }
        }
        if strays == 0 {
            return Some(size);
        }
    }
    None
}

fn growth(graph: &Neighbours, random: &mut Random) -> Vec<usize> {
    let mut order = reached(graph, random.below(graph.len())).0;
    let far = order[order.len() - 1];
    order = reached(graph, far).0;
    order
}

/// The nodes in the order of their distance to one of two far nodes less that to the other.
fn between(graph: &Neighbours, random: &mut Random) -> Vec<usize> {
    let start = reached(graph, random.below(graph.len())).0;
    let (order, from_one) = reached(graph, start[start.len() - 1]);
    let (mut order, from_other) = reached(graph, order[order.len() - 1]);
    order.sort_by_key(|node| from_one[*node].cast_signed() - from_other[*node].cast_signed());
    order
}

/// The nodes in breadth-first order from one, and the distance of each.
fn reached(graph: &Neighbours, start: usize) -> (Vec<usize>, Vec<usize>) {
    let mut distance = vec![usize::MAX; graph.len()];
    distance[start] = 0;
    let mut order = Vec::with_capacity(graph.len());
    order.push(start);
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

/// One pass: every node moves once at most, the best first; then back to the best state with exact sizes. Says how many
/// edges that one cuts.
fn pass(graph: &Neighbours, first: usize, beyond: &mut [bool], random: &mut Random) -> Option<usize> {
    let slack = (first.min(graph.len() - first) / 50).clamp(1, 64).cast_signed();
    let outer = |beyond: &[bool], node: usize| {
        graph[node].iter().filter(|other| beyond[**other] != beyond[node]).count()
    };
    let gain_of = |outer: usize, node: usize| 2 * outer.cast_signed() - graph[node].len().cast_signed();
    let mut size = 0;
    let mut gain = vec![0; graph.len()];
    let mut border = Vec::new();
    for (node, gain) in gain.iter_mut().enumerate() {
        let cut = outer(beyond, node);
        *gain = gain_of(cut, node);
        size += cut;
        if cut > 0 {
            border.push(node);
        }
    }
    size /= 2;
    random.shuffle(&mut border);
    let mut buckets = Buckets { nodes: Default::default() };
    for &node in &border {
        buckets.push(beyond[node], gain[node], node);
    }
    let mut excess = beyond.iter().filter(|beyond| !**beyond).count().cast_signed() - first.cast_signed();
    let mut moved = vec![false; graph.len()];
    let mut moves = Vec::new();
    let mut best = (excess == 0).then_some((size, 0));
    let patience = PATIENCE.max(border.len());
    while best.is_none_or(|(_, at)| moves.len() < at + patience) {
        let mut top = |half: bool| {
            buckets
                .top(half, |node, level| !moved[node] && beyond[node] == half && gain[node] == level)
                .map(|(gain, node)| (gain, node, half))
        };
        let choice = if excess >= slack {
            top(false)
        } else if excess <= -slack {
            top(true)
        } else {
            // Of equals the one that helps the sizes.
            let (near, far) = (top(false), top(true));
            near.into_iter().chain(far).max_by_key(|(gain, _, half)| (*gain, *half == (excess < 0)))
        };
        let Some((won, node, half)) = choice else { break };
        moved[node] = true;
        beyond[node] = !half;
        excess += if half { 1 } else { -1 };
        size = size.saturating_add_signed(-won);
        moves.push(node);
        for &other in &graph[node] {
            gain[other] += if beyond[other] == half { 2 } else { -2 };
            if !moved[other] {
                buckets.push(beyond[other], gain[other], other);
            }
        }
        if excess == 0 && best.is_none_or(|(least, _)| size < least) {
            best = Some((size, moves.len()));
        }
    }
    let (size, kept) = best?;
    for node in moves.drain(kept..) {
        beyond[node] = !beyond[node];
    }
    Some(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(width: usize, depth: usize) -> Vec<Vec<usize>> {
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
        let beyond = bisect(&graph, 80, &mut Random::new(1, 1)).unwrap();
        assert_eq!(beyond.iter().filter(|beyond| !**beyond).count(), 80);
        let cut = |node: usize| graph[node].iter().filter(|other| beyond[**other] != beyond[node]).count();
        assert_eq!((0..160).map(cut).sum::<usize>() / 2, 8);
    }

    #[test]
    fn halves_of_any_sizes_are_exact_and_in_one_piece() {
        let graph = sheet(11, 9);
        for first in 1..99 {
            let beyond = bisect(&graph, first, &mut Random::new(first as u64, 1)).unwrap();
            assert_eq!(beyond.iter().filter(|beyond| !**beyond).count(), first);
            for half in [false, true] {
                assert_eq!(pieces(&graph, |node| beyond[node] == half).len(), 1, "{first}");
            }
        }
    }
}
