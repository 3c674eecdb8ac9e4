//! A ring through every part. Parts without one are cut anew together with a neighbour: far better than swapping single
//! panels, since most cuts are good and a bad one is seldom a panel away from a good one.

use super::settle::settle;
use super::shortened::Shortened;
use super::sound::Part;
use super::{Held, Numbering, part_of, split};
use crate::adjacency::Adjacency;
use crate::hamiltonian::{self, Strip};
use crate::random::Random;
use std::collections::BTreeMap;

/// Times that parts are cut anew, for each part, before the search gives up.
const RECUTS: usize = 8;
/// Cuts of a group of parts tried for one whose parts pass the cheap tests.
const CUTS: usize = 2;
/// Times that a part is mended by exchanging panels before it is cut anew.
const MENDINGS: usize = 3;

/// Lanes that are halved may not become shorter than this.
const SHORTEST_LANE: usize = 4;

/// How far a part is from a ring that can be opened anywhere.
fn lack(ring: Option<&Strip>) -> usize {
    ring.map_or(2, |ring| usize::from(!ring.closed))
}

/// Parts, and a ring of each where one was found at the first go.
pub(crate) struct Ringed {
    pub(crate) parts: Vec<Vec<usize>>,
    rings: Vec<Option<Strip>>,
}

impl Ringed {
    /// Looks for a ring in every part, without changing any.
    pub(crate) fn of(neighbours: &Adjacency, parts: Vec<Vec<usize>>, random: &mut Random) -> Self {
        let mut numbering = Numbering::new(neighbours.len());
        let rings = parts.iter().map(|part| ring(neighbours, part, &mut numbering, random)).collect();
        Self { parts, rings }
    }

    /// How far the parts are from rings that can all be opened anywhere.
    pub(crate) fn lack(&self) -> usize {
        self.rings.iter().map(|ring| lack(ring.as_ref())).sum()
    }
}

/// Recuts the parts that have no ring; none where that did not end well. Parts of an odd number of panels on a flat sheet have
/// no cycle whatever the cut, so there a path will do. Parts that hold panels are mended only.
pub(crate) fn rings(
    neighbours: &Adjacency,
    ringed: Ringed,
    held: &Held,
    random: &mut Random,
) -> Option<(Vec<Vec<usize>>, Vec<Strip>)> {
    let mut numbering = Numbering::new(neighbours.len());
    let Ringed { mut parts, rings: mut found } = ringed;
    let mut recuts = vec![0; parts.len()];
    let worst = |found: &[Option<Strip>], recuts: &[usize]| {
        let open = |part: &usize| lack(found[*part].as_ref()) > 0 && recuts[*part] < RECUTS;
        (0..recuts.len()).filter(open).min_by_key(|part| (recuts[*part], *part))
    };
    while parts.len() > 1
        && let Some(part) = worst(&found, &recuts)
    {
        recuts[part] += 1;
        let group = group(neighbours, &parts, part, 2 + recuts[part] / 4, random);
        let members: Vec<usize> = group.iter().flat_map(|number| parts[*number].iter().copied()).collect();
        let before: usize = group.iter().map(|number| lack(found[*number].as_ref())).sum();
        // First panels change places across the border as it is, then the border is drawn anew.
        let mut cut: Vec<Vec<usize>> = if recuts[part] <= MENDINGS || held.any() {
            group.iter().map(|number| parts[*number].clone()).collect()
        } else {
            let cuts = (0..CUTS).filter_map(|_| split(neighbours, &members, group.len(), random));
            let faults = |cut: &Vec<Vec<usize>>| -> usize {
                cut.iter().map(|part| defects(&numbering.within(neighbours, part))).sum()
            };
            let Some(best) = cuts.min_by_key(faults) else { continue };
            best
        };
        // Cuts are much alike, so they are strayed from even where they have no defects.
        settle(neighbours, &mut cut, recuts[part] > 1, held, &mut numbering, random);
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
    let rings: Option<Vec<Strip>> = found.into_iter().collect();
    Some((parts, rings?))
}

/// How a ring keeps to lanes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keeping {
    /// From end to end, where that leaves the rest a cycle: long runs, but short of ways to change them.
    Strictly,
    /// As far as it turns out.
    Loosely,
}

/// Another ring through the same part, that runs along lanes.
pub(crate) fn again(
    neighbours: &Adjacency,
    part: &[usize],
    lanes: &[Vec<usize>],
    keeping: Keeping,
    numbering: &mut Numbering,
    random: &mut Random,
) -> Option<Strip> {
    let graph = numbering.within(neighbours, part);
    let number = |panel: &usize| part.binary_search(panel).ok();
    let lanes: Vec<Vec<usize>> = lanes.iter().map(|lane| lane.iter().filter_map(number).collect()).collect();
    let kept = (keeping == Keeping::Strictly).then(|| lanes_kept(&graph, &lanes, random)).flatten();
    let edges: Vec<(usize, usize)> =
        lanes.iter().flat_map(|lane| lane.windows(2)).map(|pair| (pair[0], pair[1])).collect();
    let Strip { order, closed } = kept.or_else(|| search(&graph, &edges, random))?;
    Some(Strip { order: order.iter().map(|node| part[*node]).collect(), closed })
}

/// A cycle that runs along lanes from end to end: all of those that leave the rest without defects, or else halves of them.
fn lanes_kept(graph: &Adjacency, lanes: &[Vec<usize>], random: &mut Random) -> Option<Strip> {
    let mut kept: Vec<Vec<usize>> = Vec::new();
    let mut waiting: Vec<Vec<usize>> = lanes.iter().rev().cloned().collect();
    while let Some(lane) = waiting.pop() {
        let halves = lane.split_at(lane.len() / 2);
        kept.push(lane.clone());
        if defects(&Shortened::of(graph, &kept).graph) > 0 {
            kept.pop();
            if halves.0.len() >= SHORTEST_LANE {
                waiting.extend([halves.0.to_vec(), halves.1.to_vec()]);
            }
        }
    }
    if kept.is_empty() {
        return None;
    }
    let shortened = Shortened::of(graph, &kept);
    let strip = hamiltonian::find_in_part(&shortened.graph, &[], true, random.next())?;
    Some(shortened.lengthened(&strip))
}

fn ring(
    neighbours: &Adjacency,
    part: &[usize],
    numbering: &mut Numbering,
    random: &mut Random,
) -> Option<Strip> {
    let Strip { order, closed } = search(&numbering.within(neighbours, part), &[], random)?;
    Some(Strip { order: order.iter().map(|node| part[*node]).collect(), closed })
}

/// A cycle, or where none can be or is found, a path: thin branches and odd parts of flat sheets often have no more.
fn search(graph: &Adjacency, lanes: &[(usize, usize)], random: &mut Random) -> Option<Strip> {
    let mut found = None;
    if defects(graph) == 0 {
        found = hamiltonian::find_in_part(graph, lanes, true, random.next());
    }
    found.or_else(|| hamiltonian::find_in_part(graph, lanes, false, random.next()))
}

/// A part and so many less one around it, each chosen by the length of its border with those before.
fn group(
    neighbours: &Adjacency,
    parts: &[Vec<usize>],
    part: usize,
    count: usize,
    random: &mut Random,
) -> Vec<usize> {
    let part_of = part_of(parts, neighbours.len());
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

/// What keeps a part from having a cycle.
fn defects(graph: &Adjacency) -> usize {
    Part { graph, name_of: &vec![0; graph.len()], name: 0 }.defects()
}
