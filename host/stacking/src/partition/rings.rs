//! A ring through every part. Parts without one are cut anew together with a neighbour: far better than swapping single
//! panels, since most cuts are good and a bad one is seldom a panel away from a good one.

use super::sound::may_have_cycle;
use super::{Neighbours, Numbering, split};
use crate::hamiltonian;
use crate::random::Random;
use std::collections::BTreeMap;

/// Times that parts are cut anew, for each part, before the search gives up.
const RECUTS: usize = 12;
/// Cuts of a group of parts tried for one whose parts pass the cheap tests.
const CUTS: usize = 8;

/// The panels of a part in the order of a Hamiltonian path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Ring {
    /// The panels.
    pub(crate) order: Vec<usize>,
    /// Whether the last panel is a neighbour of the first: then it can be opened anywhere.
    pub(crate) closed: bool,
}

/// How far a part is from a ring that can be opened anywhere.
fn lack(ring: Option<&Ring>) -> usize {
    ring.map_or(2, |ring| usize::from(!ring.closed))
}

/// Finds a ring for every part and recuts the parts that have none; none where that did not end well. Parts of an odd number
/// of panels on a flat sheet have no cycle whatever the cut, so there a path will do.
pub(crate) fn rings(
    neighbours: &Neighbours,
    parts: &mut [Vec<usize>],
    random: &mut Random,
) -> Option<Vec<Ring>> {
    let mut numbering = Numbering::new(neighbours.len());
    let mut found: Vec<Option<Ring>> =
        parts.iter().map(|part| ring(neighbours, part, &mut numbering, random)).collect();
    let mut recuts = vec![0; parts.len()];
    let worst = |found: &[Option<Ring>], recuts: &[usize]| {
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
            let sound = |part: &&Vec<usize>| may_have_cycle(&numbering.within(neighbours, part));
            let unsound = cut.len() - cut.iter().filter(sound).count();
            if best.as_ref().is_none_or(|(least, _)| unsound < *least) {
                best = Some((unsound, cut));
            }
            if unsound == 0 {
                break;
            }
        }
        let Some((_, cut)) = best else { continue };
        let made: Vec<Option<Ring>> =
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

/// Another ring through the same part.
pub(crate) fn again(neighbours: &Neighbours, part: &[usize], random: &mut Random) -> Option<Ring> {
    ring(neighbours, part, &mut Numbering::new(neighbours.len()), random)
}

fn ring(
    neighbours: &Neighbours,
    part: &[usize],
    numbering: &mut Numbering,
    random: &mut Random,
) -> Option<Ring> {
    let graph = numbering.within(neighbours, part);
    // Of an even number a part without a cycle is cut anew, not searched for a path: paths seldom match.
    if part.len() > 2 && part.len().is_multiple_of(2) && !may_have_cycle(&graph) {
        return None;
    }
    let strip = hamiltonian::find(&graph, random.next()).ok()?;
    Some(Ring { order: strip.order.iter().map(|node| part[*node]).collect(), closed: strip.closed })
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
