//! Cheap proofs that there is no strip, or no closed one, before any search.

use super::NoStrip;
use crate::adjacency::Adjacency;
use std::cmp::Ordering;

/// Says whether a cycle is possible as far as these tests can tell.
///
/// # Errors
/// A proof that there is not even a path.
pub(super) fn look_for(neighbours: &Adjacency) -> Result<bool, NoStrip> {
    let dead_ends: Vec<usize> = (0..neighbours.len()).filter(|panel| neighbours[*panel].len() < 2).collect();
    if dead_ends.len() > 2 {
        return Err(NoStrip::DeadEnds { count: dead_ends.len(), first: dead_ends[..3].to_vec() });
    }
    let balance = colours(neighbours);
    if let Some((dark, light)) = balance
        && dark.abs_diff(light) > 1
    {
        return Err(NoStrip::Colours { dark, light });
    }
    Ok(dead_ends.is_empty() && balance.is_none_or(|(dark, light)| dark.cmp(&light) == Ordering::Equal))
}

/// How many panels of a connected graph get each of two colours when neighbours differ; none where that can't be.
fn colours(neighbours: &Adjacency) -> Option<(usize, usize)> {
    let mut colour = vec![None; neighbours.len()];
    colour[0] = Some(true);
    let mut reached = vec![0];
    while let Some(panel) = reached.pop() {
        let other = colour[panel].map(|dark: bool| !dark);
        for next in &neighbours[panel] {
            if colour[*next].is_none() {
                colour[*next] = other;
                reached.push(*next);
            } else if colour[*next] != other {
                return None;
            }
        }
    }
    let dark = colour.iter().filter(|colour| **colour == Some(true)).count();
    Some((dark, neighbours.len() - dark))
}
