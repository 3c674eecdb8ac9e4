//! Makes the voxels of a mesh one solid whose surface is in one piece: cavities are filled, pieces joined, crumbs dropped.
//!
//! Solid voxels hang together by their sides. Empty ones hang together by sides and edges, since at an edge where two solid
//! voxels touch each keeps its own surface. So the surface is in one piece when the solid is one and the empty space is one.

use super::{Mesh, Repair};
use crate::readers::ModelProblem;
use crate::square::Point;
use crate::voxels::Voxels;
use std::collections::VecDeque;

/// Pieces may be joined through voxels whose centre is so near to the mesh, in voxels: near half a voxel's diagonal, so that
/// the mesh passes through them.
const THROUGH: f64 = 0.75;

/// All crumbs together have at most this share of the voxels.
const CRUMB_SHARE: f64 = 0.02;

/// How many pieces a message lists.
const PIECES_SHOWN: usize = 5;

const UNSEEN: u32 = u32::MAX;

/// The ways to the neighbours by sides, and by sides and edges.
pub(super) const BY_SIDE: [Point; 6] = [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]];
pub(super) const BY_EDGE: [Point; 12] = [
    [-1, -1, 0],
    [-1, 1, 0],
    [1, -1, 0],
    [1, 1, 0],
    [-1, 0, -1],
    [-1, 0, 1],
    [1, 0, -1],
    [1, 0, 1],
    [0, -1, -1],
    [0, -1, 1],
    [0, 1, -1],
    [0, 1, 1],
];

/// Makes the solid one. The box has at least one empty layer around it, and keeps it.
///
/// # Errors
/// Pieces that can't be joined and are no crumbs.
pub(super) fn make(voxels: &mut Voxels, mesh: &Mesh, voxel_size: f64) -> Result<Vec<Repair>, ModelProblem> {
    let mut repairs = Vec::new();
    let (mut cavities, mut filled) = fill_cavities(voxels);
    let (pieces, put) = join(voxels, mesh, voxel_size);
    if pieces > 0 {
        let (more, voxels) = fill_cavities(voxels);
        (cavities, filled) = (cavities + more, filled + voxels);
    }
    let dropped = drop_crumbs(voxels, mesh, voxel_size)?;
    if cavities > 0 {
        repairs.push(Repair::Filled { cavities, voxels: filled });
    }
    if pieces > 0 {
        repairs.push(Repair::Joined { pieces, voxels: put });
    }
    repairs.extend(dropped);
    Ok(repairs)
}

/// Fills what can't be reached from outside; gives the number of cavities and of their voxels.
fn fill_cavities(voxels: &mut Voxels) -> (usize, usize) {
    let ways: Vec<isize> = BY_SIDE.iter().chain(&BY_EDGE).map(|way| voxels.stride(*way)).collect();
    let mut seen: Vec<bool> = (0..voxels.len()).map(|number| voxels.solid(number)).collect();
    let rim: Vec<usize> = (0..voxels.len()).filter(|number| voxels.is_rim(*number)).collect();
    for &number in &rim {
        seen[number] = true;
    }
    // The rim itself is one piece; what lies inside it has all neighbours in the box.
    let mut reached = rim;
    let mut first = true;
    let (mut cavities, mut filled) = (0, 0);
    let mut start = 0;
    loop {
        while let Some(number) = reached.pop() {
            if !first {
                voxels.set(number, true);
                filled += 1;
            }
            let on_rim = first && voxels.is_rim(number);
            for &way in &ways {
                let Some(next) = number.checked_add_signed(way).filter(|next| *next < seen.len()) else {
                    continue;
                };
                // From the rim a step may lead round the box to the rim again, which is seen already, or inwards.
                if !seen[next] && (!on_rim || are_neighbours(voxels, number, next)) {
                    seen[next] = true;
                    reached.push(next);
                }
            }
        }
        first = false;
        while start < seen.len() && seen[start] {
            start += 1;
        }
        if start == seen.len() {
            return (cavities, filled);
        }
        cavities += 1;
        seen[start] = true;
        reached.push(start);
    }
}

fn are_neighbours(voxels: &Voxels, a: usize, b: usize) -> bool {
    let (a, b) = (voxels.at(a), voxels.at(b));
    (0..3).all(|axis| a[axis].abs_diff(b[axis]) <= 1)
}

/// The piece of every solid voxel, and of each piece its first voxel and its size.
fn pieces(voxels: &Voxels) -> (Vec<u32>, Vec<(usize, usize)>) {
    let ways = BY_SIDE.map(|way| voxels.stride(way));
    let mut piece = vec![UNSEEN; voxels.len()];
    let mut pieces = Vec::new();
    for start in 0..voxels.len() {
        if !voxels.solid(start) || piece[start] != UNSEEN {
            continue;
        }
        let label = u32::try_from(pieces.len()).unwrap_or(UNSEEN);
        piece[start] = label;
        let (mut size, mut reached) = (0, vec![start]);
        while let Some(number) = reached.pop() {
            size += 1;
            for next in ways.iter().filter_map(|way| number.checked_add_signed(*way)) {
                if voxels.solid(next) && piece[next] == UNSEEN {
                    piece[next] = label;
                    reached.push(next);
                }
            }
        }
        pieces.push((start, size));
    }
    (piece, pieces)
}

/// The label of the largest piece; of equal ones the first.
fn largest(pieces: &[(usize, usize)]) -> usize {
    (0..pieces.len()).max_by_key(|piece| (pieces[*piece].1, usize::MAX - piece)).unwrap_or(0)
}

/// Joins pieces to the largest one, along the shortest ways through voxels that the mesh passes through. Gives the number of
/// pieces joined and of voxels put in.
fn join(voxels: &mut Voxels, mesh: &Mesh, voxel_size: f64) -> (usize, usize) {
    let (mut piece, list) = pieces(voxels);
    let ways = BY_SIDE.map(|way| voxels.stride(way));
    let Ok(main) = u32::try_from(largest(&list)) else { return (0, 0) };
    let (mut joined, mut put) = (0, 0);
    let mut passable: Vec<Option<bool>> = vec![None; if list.len() > 1 { voxels.len() } else { 0 }];
    while joined + 1 < list.len() {
        let mut from = vec![usize::MAX; voxels.len()];
        let mut reached: VecDeque<usize> =
            (0..voxels.len()).filter(|number| piece[*number] == main).collect();
        for &number in &reached {
            from[number] = number;
        }
        let mut found = None;
        'search: while let Some(number) = reached.pop_front() {
            for next in ways.iter().filter_map(|way| number.checked_add_signed(*way)) {
                if from[next] != usize::MAX || voxels.is_rim(next) {
                    continue;
                }
                from[next] = number;
                if voxels.solid(next) {
                    found = Some(next);
                    break 'search;
                }
                let near = *passable[next].get_or_insert_with(|| {
                    mesh.distance(voxels.at(next).map(|c| f64::from(c) + 0.5), voxel_size) <= THROUGH
                });
                if near {
                    reached.push_back(next);
                }
            }
        }
        let Some(there) = found else { break };
        let other = piece[there];
        for label in piece.iter_mut().filter(|label| **label == other) {
            *label = main;
        }
        joined += 1;
        let mut number = from[there];
        while from[number] != number {
            voxels.set(number, true);
            piece[number] = main;
            put += 1;
            number = from[number];
        }
        // A way may brush against further pieces: they are joined by it too, and found next at no cost.
    }
    (joined, put)
}

/// Drops all pieces but the largest, where they are crumbs.
fn drop_crumbs(voxels: &mut Voxels, mesh: &Mesh, voxel_size: f64) -> Result<Option<Repair>, ModelProblem> {
    let (piece, list) = pieces(voxels);
    if list.len() < 2 {
        return Ok(None);
    }
    let main = largest(&list);
    let total: usize = list.iter().map(|(_, size)| size).sum();
    let crumbs = total - list[main].1;
    if crumbs as f64 > CRUMB_SHARE * total as f64 {
        let shown = list.iter().take(PIECES_SHOWN);
        let mut told: Vec<String> = shown
            .map(|(first, size)| {
                format!("{size} voxels with the one at {}", mesh.place_of(voxels.at(*first), voxel_size))
            })
            .collect();
        if list.len() > PIECES_SHOWN {
            told.push("...".into());
        }
        return Err(ModelProblem::SolidInPieces {
            size: voxel_size,
            count: list.len(),
            pieces: told.join("; "),
        });
    }
    for (number, label) in piece.iter().enumerate() {
        if *label != UNSEEN && *label as usize != main {
            voxels.set(number, false);
        }
    }
    Ok(Some(Repair::Dropped { pieces: list.len() - 1, voxels: crumbs }))
}
