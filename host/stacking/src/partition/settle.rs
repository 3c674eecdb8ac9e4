//! Parts exchange panels across their borders until cheap tests find nothing that keeps them from having a cycle each. The
//! colours of a chess board are the usual matter: a cut as short as can be seldom leaves as many dark panels as light ones.

use super::sound::Part;
use super::{Held, Numbering};
use crate::adjacency::Adjacency;
use crate::random::Random;

/// Panels looked at in all exchanges together, and the least and most exchanges that makes.
const EFFORT: usize = 400_000;
const FEWEST: usize = 8;
const MOST: usize = 80;

/// Exchanges panels between parts that touch while they have defects, and once at least where they are to stray.
pub(super) fn settle(
    neighbours: &Adjacency,
    parts: &mut [Vec<usize>],
    stray: bool,
    held: &Held,
    numbering: &mut Numbering,
    random: &mut Random,
) {
    let members: Vec<usize> = parts.iter().flatten().copied().collect();
    let graph = numbering.within(neighbours, &members);
    let free: Vec<bool> = members.iter().map(|panel| held.part_of(*panel).is_none()).collect();
    let mut part_of: Vec<usize> =
        parts.iter().enumerate().flat_map(|(name, part)| vec![name; part.len()]).collect();
    let defects = |part_of: &[usize], name: usize| Part { graph: &graph, name_of: part_of, name }.defects();
    let mut of_part: Vec<usize> = (0..parts.len()).map(|name| defects(&part_of, name)).collect();
    let mut strays = if stray { 1 + random.below(3) } else { 0 };
    for _ in 0..(EFFORT / members.len().max(1)).clamp(FEWEST, MOST) {
        if of_part.iter().all(|defects| *defects == 0) && strays == 0 {
            break;
        }
        let faulty: Vec<usize> = (0..of_part.len()).filter(|part| of_part[*part] > 0).collect();
        let part =
            if faulty.is_empty() { random.below(parts.len()) } else { faulty[random.below(faulty.len())] };
        let near = spots(Part { graph: &graph, name_of: &part_of, name: part });
        let Some([leaves, comes]) = exchange(&graph, &part_of, &free, part, &near, random) else { continue };
        let (a, b) = (part_of[leaves], part_of[comes]);
        part_of.swap(leaves, comes);
        let new = [a, b].map(|name| defects(&part_of, name));
        if new[0] + new[1] <= of_part[a] + of_part[b] {
            (of_part[a], of_part[b]) = (new[0], new[1]);
            strays = strays.saturating_sub(1);
        } else {
            part_of.swap(leaves, comes);
        }
    }
    for (name, part) in parts.iter_mut().enumerate() {
        let of_part = members.iter().zip(&part_of).filter(|(_, part)| **part == name);
        *part = of_part.map(|(panel, _)| *panel).collect();
        part.sort_unstable();
    }
}

/// The weak spots of a part and the panels around them.
fn spots(part: Part<'_>) -> Vec<usize> {
    let mut spots = part.weak_spots();
    for _ in 0..2 {
        let around: Vec<usize> = spots.iter().flat_map(|spot| &part.graph[*spot]).copied().collect();
        spots.extend(around);
        spots.sort_unstable();
        spots.dedup();
    }
    spots
}

/// Two free panels to change places, each at the border with the other's part; the first or the other near one of the spots, if
/// there are any at the border.
fn exchange(
    graph: &Adjacency,
    part_of: &[usize],
    free: &[bool],
    part: usize,
    spots: &[usize],
    random: &mut Random,
) -> Option<[usize; 2]> {
    let border: Vec<(usize, usize)> = (0..graph.len())
        .filter(|node| part_of[*node] == part)
        .flat_map(|node| graph[node].iter().map(move |other| (node, *other)))
        .filter(|(node, other)| part_of[*other] != part && free[*node] && free[*other])
        .collect();
    let is_near = |node: &usize| spots.binary_search(node).is_ok();
    let near: Vec<(usize, usize)> =
        border.iter().filter(|(node, other)| is_near(node) || is_near(other)).copied().collect();
    let first_from = if near.is_empty() { &border } else { &near };
    if first_from.is_empty() {
        return None;
    }
    let (node, beyond) = first_from[random.below(first_from.len())];
    let of_pair: Vec<(usize, usize)> =
        border.iter().filter(|(_, other)| part_of[*other] == part_of[beyond]).copied().collect();
    // One of them anywhere along the border, so that the sizes stay as they are.
    let node_anywhere = random.below(2) == 0;
    let lots = if node_anywhere { [of_pair.len(), 1] } else { [1, of_pair.len()] };
    let [lot, other_lot] = lots.map(|count| random.below(count));
    // Lots count from the last pair on: seeds keep their plans.
    let anywhere = of_pair[(lot + other_lot + of_pair.len() - 1) % of_pair.len()];
    Some(if node_anywhere { [anywhere.0, beyond] } else { [node, anywhere.1] })
}
