//! Parts exchange panels across their borders until cheap tests find nothing that keeps them from having a cycle each. The
//! colours of a chess board are the usual matter: a cut as short as can be seldom leaves as many dark panels as light ones.

use super::sound::defects;
use super::{Neighbours, Numbering};
use crate::random::Random;

/// Panels looked at in all exchanges together, and the least and most exchanges that makes.
const EFFORT: usize = 400_000;
const FEWEST: usize = 8;
const MOST: usize = 200;

/// Exchanges panels between parts that touch while they have defects, and once at least where they are to stray.
pub(super) fn settle(
    neighbours: &Neighbours,
    parts: &mut [Vec<usize>],
    stray: bool,
    numbering: &mut Numbering,
    random: &mut Random,
) {
    let mut of_part: Vec<usize> =
        parts.iter().map(|part| defects(&numbering.within(neighbours, part))).collect();
    let height = parts.first().map_or(1, Vec::len);
    let mut strays = if stray { 1 + random.below(3) } else { 0 };
    for _ in 0..(EFFORT / height.max(1)).clamp(FEWEST, MOST) {
        if of_part.iter().all(|defects| *defects == 0) && strays == 0 {
            break;
        }
        let Some((a, b, [of_a, of_b])) = exchange(neighbours, parts, &of_part, random) else { continue };
        let old = [std::mem::replace(&mut parts[a], of_a), std::mem::replace(&mut parts[b], of_b)];
        let new = [a, b].map(|part| defects(&numbering.within(neighbours, &parts[part])));
        if new[0] + new[1] <= of_part[a] + of_part[b] {
            (of_part[a], of_part[b]) = (new[0], new[1]);
            strays = strays.saturating_sub(1);
        } else {
            [parts[a], parts[b]] = old;
        }
    }
}

/// Two parts that touch, one of them with defects if any has, and their panels after two have changed places.
fn exchange(
    neighbours: &Neighbours,
    parts: &[Vec<usize>],
    of_part: &[usize],
    random: &mut Random,
) -> Option<(usize, usize, [Vec<usize>; 2])> {
    let faulty: Vec<usize> = (0..parts.len()).filter(|part| of_part[*part] > 0).collect();
    let a = if faulty.is_empty() { random.below(parts.len()) } else { faulty[random.below(faulty.len())] };
    let part_with = |panel: usize| (0..parts.len()).find(|part| parts[*part].binary_search(&panel).is_ok());
    let border: Vec<(usize, usize)> = parts[a]
        .iter()
        .flat_map(|panel| neighbours[*panel].iter().map(move |other| (*panel, *other)))
        .filter_map(|(panel, other)| part_with(other).filter(|part| *part != a).map(|part| (panel, part)))
        .collect();
    if border.is_empty() {
        return None;
    }
    let (leaves, b) = border[random.below(border.len())];
    let touches =
        |panel: &&usize| neighbours[**panel].iter().any(|near| parts[a].binary_search(near).is_ok());
    let coming: Vec<usize> = parts[b].iter().filter(touches).copied().collect();
    let comes = coming[random.below(coming.len())];
    let swapped = |part: &[usize], out: usize, new: usize| {
        let mut part: Vec<usize> = part.iter().copied().filter(|panel| *panel != out).collect();
        let at = part.partition_point(|panel| *panel < new);
        part.insert(at, new);
        part
    };
    Some((a, b, [swapped(&parts[a], leaves, comes), swapped(&parts[b], comes, leaves)]))
}
