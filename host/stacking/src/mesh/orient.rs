//! Turns over triangles that are inside out against their neighbours. `repair` calls it.

use super::{Corner, Triangle, cross, dot, minus};
use std::collections::BTreeMap;

/// Two triangles at one edge, and whether they pass it the same way, as neighbours should not.
type Neighbour = (usize, bool);

/// Gives the triangles of a piece one orientation where they have several; gives how many were turned, or nothing where a
/// piece has no two sides. A piece hangs together by edges of two triangles; its outer side is the one that makes its
/// volume positive.
pub(super) fn unite(triangles: &mut [[usize; 3]], corners: &[Corner]) -> Option<usize> {
    let neighbours = neighbours(triangles);
    let mut turned: Vec<Option<bool>> = vec![None; triangles.len()];
    let mut changes = 0;
    for start in 0..triangles.len() {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let (mut piece, mut next) = (vec![start], 0);
        let mut mixed = false;
        while let Some(&here) = piece.get(next) {
            next += 1;
            let own = turned[here] == Some(true);
            for &(there, alike) in &neighbours[here] {
                let wanted = own != alike;
                mixed |= alike;
                match turned[there] {
                    None => {
                        turned[there] = Some(wanted);
                        piece.push(there);
                    }
                    Some(found) if found != wanted => return None,
                    Some(_) => {}
                }
            }
        }
        if !mixed {
            continue;
        }
        let at = |triangle: usize| {
            let [a, b, c] = triangles[triangle].map(|corner| corners[corner]);
            if turned[triangle] == Some(true) { [a, c, b] } else { [a, b, c] }
        };
        let inside_out = volume(&piece.iter().map(|triangle| at(*triangle)).collect::<Vec<_>>()) < 0.0;
        for triangle in piece {
            if (turned[triangle] == Some(true)) != inside_out {
                triangles[triangle].swap(1, 2);
                changes += 1;
            }
        }
    }
    Some(changes)
}

/// The neighbours of every triangle across edges that it shares with one other.
fn neighbours(triangles: &[[usize; 3]]) -> Vec<Vec<Neighbour>> {
    let mut at_edge: BTreeMap<[usize; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (number, corners) in triangles.iter().enumerate() {
        for side in 0..3 {
            let (from, to) = (corners[side], corners[(side + 1) % 3]);
            at_edge.entry([from.min(to), from.max(to)]).or_default().push((number, from < to));
        }
    }
    let mut neighbours = vec![Vec::new(); triangles.len()];
    for meeting in at_edge.values() {
        if let [(a, a_way), (b, b_way)] = meeting[..] {
            neighbours[a].push((b, a_way == b_way));
            neighbours[b].push((a, a_way == b_way));
        }
    }
    neighbours
}

/// The volume inside; of an open piece the one between it and its middle.
fn volume(piece: &[Triangle]) -> f64 {
    let count = (3 * piece.len()) as f64;
    let middle = [0, 1, 2].map(|axis| piece.iter().flatten().map(|corner| corner[axis]).sum::<f64>() / count);
    let part = |&[a, b, c]: &Triangle| dot(minus(a, middle), cross(minus(b, middle), minus(c, middle)));
    piece.iter().map(part).sum::<f64>() / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Corner; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const TETRAHEDRON: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn every_mixture_of_turned_triangles_becomes_the_shape_with_its_outer_side_out() {
        for mixture in 1..15_u32 {
            let mut mesh = TETRAHEDRON;
            for (number, triangle) in mesh.iter_mut().enumerate() {
                if mixture >> number & 1 == 1 {
                    triangle.swap(1, 2);
                }
            }
            assert_eq!(unite(&mut mesh, &CORNERS), Some(mixture.count_ones() as usize));
            assert_eq!(mesh, TETRAHEDRON);
        }
    }

    #[test]
    fn a_piece_of_one_orientation_is_left_alone_even_inside_out() {
        let mut mesh = TETRAHEDRON.map(|[a, b, c]| [a, c, b]);
        let before = mesh;
        assert_eq!(unite(&mut mesh, &CORNERS), Some(0));
        assert_eq!(mesh, before);
    }

    #[test]
    fn a_moebius_strip_has_no_two_sides() {
        let mut mesh = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 0, 4], [4, 0, 1]];
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.5, 0.5, 2.0]];
        assert_eq!(unite(&mut mesh, &corners), None);
    }
}
