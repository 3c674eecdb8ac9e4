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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;

    fn defects(graph: &Adjacency, parts: &[Vec<usize>]) -> usize {
        let name_of = super::super::part_of(parts, graph.len());
        (0..parts.len()).map(|name| Part { graph, name_of: &name_of, name }.defects()).sum()
    }

    #[test]
    fn parts_that_settle_keep_their_sizes_and_never_have_more_defects() {
        let graph = Dual::of_sheet(6, 6).neighbours();
        // A bend in the border that leaves each part a panel with one neighbour.
        let mut before: Vec<Vec<usize>> =
            [0..3, 3..6].map(|xs| (0..36).filter(|panel| xs.contains(&(panel % 6))).collect()).to_vec();
        before[0].retain(|panel| *panel != 14);
        before[0].push(21);
        before[1].retain(|panel| *panel != 21);
        before[1].push(14);
        assert!(defects(&graph, &before) > 0);
        let mut sound = 0;
        for seed in 0..20 {
            let mut parts = before.clone();
            settle(
                &graph,
                &mut parts,
                false,
                &Held::none(),
                &mut Numbering::new(36),
                &mut Random::new(seed, 1),
            );
            let mut all = parts.concat();
            all.sort_unstable();
            assert!(all.iter().copied().eq(0..36), "{seed}: {all:?}");
            assert!(parts.iter().all(|part| part.len() == 18), "{seed}");
            assert!(defects(&graph, &parts) <= defects(&graph, &before), "{seed}");
            sound += usize::from(defects(&graph, &parts) == 0);
        }
        assert!(sound >= 10, "{sound} of 20 parts lost all defects");
    }

    #[test]
    fn panels_change_places_across_one_border_only() {
        let graph = Dual::of_sheet(6, 2).neighbours();
        // Three parts two wide side by side.
        let part_of: Vec<usize> = (0..12).map(|panel| panel % 6 / 2).collect();
        let mut random = Random::new(1, 1);
        let mut reached = std::collections::BTreeSet::new();
        for _ in 0..200 {
            let [leaves, comes] =
                exchange(&graph, &part_of, &vec![true; graph.len()], 1, &[], &mut random).unwrap();
            assert_eq!(part_of[leaves], 1);
            assert!(part_of[comes] != 1 && leaves % 6 / 2 != comes % 6 / 2);
            let near = |node: usize, part: usize| graph[node].iter().any(|near| part_of[*near] == part);
            assert!(near(leaves, part_of[comes]) && near(comes, 1), "{leaves} and {comes}");
            reached.insert((leaves, comes));
        }
        // Each of two borders has two panels a side, in any pairing.
        assert_eq!(reached.len(), 8);
    }
}
