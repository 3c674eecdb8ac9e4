//! K parts of exactly equal size: by halves, then pair by pair once more.

use super::bisect::{bisect, refine};
use super::{Held, Numbering, Weights, part_of};
use crate::adjacency::Adjacency;
use crate::random::Random;
use std::collections::BTreeSet;
use std::ops::Range;

/// Up to so many parts slices are tried.
const MOST_SLICES: usize = 8;
/// Up to so many panels, too: slices take longer than halves.
const MOST_SLICED: usize = 20_000;
/// Rounds of moving all borders, at most.
const ROUNDS: usize = 4;

/// Splits the members into `count` parts of equal size, each in one piece; none where no cut left them so. Of two ways the one
/// that cuts fewer edges: by halves, or part after part from an end, which suits long shapes.
pub(crate) fn split(
    neighbours: &Adjacency,
    members: &[usize],
    count: usize,
    random: &mut Random,
) -> Option<Vec<Vec<usize>>> {
    let by_halves = split_by(neighbours, members, count, |count| count / 2, &Held::none(), random);
    if !(3..=MOST_SLICES).contains(&count) || members.len() > MOST_SLICED {
        return by_halves;
    }
    let slices = split_by(neighbours, members, count, |_| 1, &Held::none(), random);
    let cut = |parts: &Vec<Vec<usize>>| Weights::between(parts, neighbours).total();
    by_halves.into_iter().chain(slices).min_by_key(cut)
}

/// Splits all panels into `count` parts of equal size by halves, each with the panels that it holds.
pub(crate) fn split_held(
    neighbours: &Adjacency,
    count: usize,
    held: &Held,
    random: &mut Random,
) -> Option<Vec<Vec<usize>>> {
    let all: Vec<usize> = (0..neighbours.len()).collect();
    split_by(neighbours, &all, count, |count| count / 2, held, random)
}

fn split_by(
    neighbours: &Adjacency,
    members: &[usize],
    count: usize,
    first_of: impl Fn(usize) -> usize,
    held: &Held,
    random: &mut Random,
) -> Option<Vec<Vec<usize>>> {
    let mut numbering = Numbering::new(neighbours.len());
    let mut parts = Vec::with_capacity(count);
    // The first of the parts that members make, and the one after the last; parts come out in their order.
    let mut waiting: Vec<(Vec<usize>, Range<usize>)> = vec![(members.to_vec(), 0..count)];
    while let Some((members, Range { start, end })) = waiting.pop() {
        if end - start == 1 {
            parts.push(members);
            continue;
        }
        let graph = numbering.within(neighbours, &members);
        let half = first_of(end - start);
        let held = held.halves(&members, |part| part >= start + half);
        let beyond = bisect(&graph, members.len() / (end - start) * half, &held, random)?;
        let of_half = |half: bool| members.iter().zip(&beyond).filter(move |(_, beyond)| **beyond == half);
        let [first, second] = [false, true].map(|half| of_half(half).map(|(panel, _)| *panel).collect());
        waiting.push((second, start + half..end));
        waiting.push((first, start..start + half));
    }
    if count > 2 {
        polish(neighbours, &mut parts, held, &mut numbering, random);
    }
    for part in &mut parts {
        part.sort_unstable();
    }
    Some(parts)
}

/// Moves the border between every two parts that touch, where that cuts fewer edges.
fn polish(
    neighbours: &Adjacency,
    parts: &mut [Vec<usize>],
    held: &Held,
    numbering: &mut Numbering,
    random: &mut Random,
) {
    let part_of = part_of(parts, neighbours.len());
    let touching = |a: usize| neighbours[a].iter().map(move |b| (a, *b));
    let pairs: BTreeSet<(usize, usize)> = (0..neighbours.len())
        .flat_map(touching)
        .map(|(a, b)| (part_of[a], part_of[b]))
        .filter(|(a, b)| a < b && *b != usize::MAX)
        .collect();
    // A pair is looked at again only when one of the two changed.
    let mut changed = vec![true; parts.len()];
    for _ in 0..ROUNDS {
        let before = std::mem::replace(&mut changed, vec![false; parts.len()]);
        for &(a, b) in &pairs {
            if (before[a] || before[b] || changed[a] || changed[b])
                && polish_pair(neighbours, parts, [a, b], held, numbering, random)
            {
                changed[a] = true;
                changed[b] = true;
            }
        }
        if !changed.contains(&true) {
            break;
        }
    }
}

/// The same for two parts; says whether it did.
fn polish_pair(
    neighbours: &Adjacency,
    parts: &mut [Vec<usize>],
    [a, b]: [usize; 2],
    held: &Held,
    numbering: &mut Numbering,
    random: &mut Random,
) -> bool {
    let members: Vec<usize> = parts[a].iter().chain(&parts[b]).copied().collect();
    let graph = numbering.within(neighbours, &members);
    let first = parts[a].len();
    let mut beyond: Vec<bool> = (0..members.len()).map(|node| node >= first).collect();
    let cut = |beyond: &[bool]| {
        let crossing = |node: usize| graph[node].iter().filter(move |other| beyond[**other] != beyond[node]);
        (0..graph.len()).map(|node| crossing(node).count()).sum::<usize>() / 2
    };
    let before = cut(&beyond);
    let held = held.halves(&members, |part| part == b);
    let bettered = refine(&graph, first, &mut beyond, &held, random).is_some_and(|after| after < before);
    if bettered {
        for (number, half) in [(a, false), (b, true)] {
            let of_half = members.iter().zip(&beyond).filter(|(_, beyond)| **beyond == half);
            parts[number] = of_half.map(|(panel, _)| *panel).collect();
        }
    }
    bettered
}
