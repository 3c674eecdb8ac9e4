//! A ring through every part. Parts without one are cut anew together with a neighbour: far better than swapping single
//! panels, since most cuts are good and a bad one is seldom a panel away from a good one.

use super::settle::settle;
use super::sound::defects;
use super::{Neighbours, Numbering, split};
use crate::hamiltonian::{self, Strip};
use crate::random::Random;
use std::collections::BTreeMap;

/// Times that parts are cut anew, for each part, before the search gives up.
const RECUTS: usize = 6;
/// Cuts of a group of parts tried for one whose parts pass the cheap tests.
const CUTS: usize = 8;

/// How far a part is from a ring that can be opened anywhere.
fn lack(ring: Option<&Strip>) -> usize {
    ring.map_or(2, |ring| usize::from(!ring.closed))
}

/// Finds a ring for every part and recuts the parts that have none; none where that did not end well. Parts of an odd number
/// of panels on a flat sheet have no cycle whatever the cut, so there a path will do.
pub(crate) fn rings(
    neighbours: &Neighbours,
    parts: &mut [Vec<usize>],
    random: &mut Random,
) -> Option<Vec<Strip>> {
    let mut numbering = Numbering::new(neighbours.len());
    let mut found: Vec<Option<Strip>> =
        parts.iter().map(|part| ring(neighbours, part, &mut numbering, random)).collect();
    let mut recuts = vec![0; parts.len()];
    let worst = |found: &[Option<Strip>], recuts: &[usize]| {
        let open = |part: &usize| lack(found[*part].as_ref()) > 0 && recuts[*part] < RECUTS;
        (0..recuts.len()).filter(open).min_by_key(|part| (recuts[*part], *part))
    };
    while parts.len() > 1
        && let Some(part) = worst(&found, &recuts)
    {
        recuts[part] += 1;
        let group = group(neighbours, parts, part, 2 + recuts[part] / 4, random);
        let members: Vec<usize> = group.iter().flat_map(|number| parts[*number].iter().copied()).collect();
        let before: usize = group.iter().map(|number| lack(found[*number].as_ref())).sum();
        let mut best: Option<(usize, Vec<Vec<usize>>)> = None;
        for _ in 0..CUTS {
            let Some(cut) = split(neighbours, &members, group.len(), random) else { continue };
            let defects = cut.iter().map(|part| defects(&numbering.within(neighbours, part))).sum();
            if best.as_ref().is_none_or(|(least, _)| defects < *least) {
                best = Some((defects, cut));
            }
            if defects == 0 {
                break;
            }
        }
        let Some((_, mut cut)) = best else { continue };
        // Cuts are much alike, so the later recuts stray from them even where they have no defects.
        settle(neighbours, &mut cut, recuts[part] > 2, &mut numbering, random);
        let made: Vec<Option<Strip>> =
            cut.iter().map(|part| ring(neighbours, part, &mut numbering, random)).collect();
        // Another cut that is as bad is taken too: it is another chance.
        if made.iter().map(|ring| lack(ring.as_ref())).sum::<usize>() <= before {
            for ((number, part), ring) in group.into_iter().zip(cut).zip(made) {
                parts[number] = part;
                found[number] = ring;
            }
        }
    }
    found.into_iter().collect()
}

/// Another ring through the same part, that keeps to lanes as far as they can be kept.
pub(crate) fn again(
    neighbours: &Neighbours,
    part: &[usize],
    lanes: &[(usize, usize)],
    numbering: &mut Numbering,
    random: &mut Random,
) -> Option<Strip> {
    let graph = numbering.within(neighbours, part);
    let number = |panel: &usize| part.binary_search(panel).ok();
    let lanes: Vec<(usize, usize)> =
        lanes.iter().filter_map(|(u, v)| Some((number(u)?, number(v)?))).collect();
    search(&graph, part, &lanes, random)
}

fn ring(
    neighbours: &Neighbours,
    part: &[usize],
    numbering: &mut Numbering,
    random: &mut Random,
) -> Option<Strip> {
    search(&numbering.within(neighbours, part), part, &[], random)
}

/// A cycle, or where none can be or is found, a path: thin branches and odd parts of flat sheets often have no more.
fn search(
    graph: &Neighbours,
    part: &[usize],
    lanes: &[(usize, usize)],
    random: &mut Random,
) -> Option<Strip> {
    let mut found = None;
    if defects(graph) == 0 {
        found = hamiltonian::find_in_part(graph, lanes, true, random.next());
    }
    let Strip { order, closed } =
        found.or_else(|| hamiltonian::find_in_part(graph, lanes, false, random.next()))?;
    Some(Strip { order: order.iter().map(|node| part[*node]).collect(), closed })
}

/// A part and so many less one around it, each chosen by the length of its border with those before.
fn group(
    neighbours: &Neighbours,
    parts: &[Vec<usize>],
    part: usize,
    count: usize,
    random: &mut Random,
) -> Vec<usize> {
    let mut part_of = vec![usize::MAX; neighbours.len()];
    for (number, part) in parts.iter().enumerate() {
        for panel in part {
            part_of[*panel] = number;
        }
    }
    let mut group = vec![part];
    while group.len() < count.min(parts.len()) {
        let mut border: BTreeMap<usize, usize> = BTreeMap::new();
        for panel in group.iter().flat_map(|number| &parts[*number]) {
            for other in &neighbours[*panel] {
                if !group.contains(&part_of[*other]) {
                    *border.entry(part_of[*other]).or_default() += 1;
                }
            }
        }
        let all: usize = border.values().sum();
        if all == 0 {
            break;
        }
        let mut lot = random.below(all);
        for (number, length) in border {
            if lot < length {
                group.push(number);
                break;
            }
            lot -= length;
        }
    }
    group
}
