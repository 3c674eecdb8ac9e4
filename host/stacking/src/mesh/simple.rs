//! Voxels that can change sides without a change of topology. `edit` calls it.
//!
//! Solid voxels hang together by their sides, empty ones by sides and edges, as `one_piece` has it. A voxel is *simple* when its
//! solid neighbours by sides hang together among its 26 neighbours, and so do its empty neighbours by sides and edges: then
//! no piece, cavity or tunnel comes or goes when it is put or taken (Bertrand, *Simple points, topological numbers and
//! geodesic neighborhoods in cubic grids*, 1994).

/// The 26 neighbours and the voxel itself, as bits: x fastest, then y, then z; the voxel itself is bit 13.
pub(super) type Neighbourhood = u32;

/// The bit of the voxel itself.
pub(super) const CENTRE: usize = 13;

/// For every place of the neighbourhood, those that share a side with it, and those that share a side or an edge.
const TOUCHING: ([Neighbourhood; 27], [Neighbourhood; 27]) = touching();

/// The neighbours of the centre by sides.
pub(super) const BY_SIDE: Neighbourhood = TOUCHING.0[CENTRE];

/// The neighbours of the centre by sides and edges.
const BY_SIDE_AND_EDGE: Neighbourhood = TOUCHING.1[CENTRE];

const ALL_AROUND: Neighbourhood = ((1 << 27) - 1) & !(1 << CENTRE);

const fn touching() -> ([Neighbourhood; 27], [Neighbourhood; 27]) {
    let (mut by_side, mut by_edge) = ([0; 27], [0; 27]);
    let mut a = 0;
    while a < 27 {
        let mut b = 0;
        while b < 27 {
            let (dx, dy, dz) = (
                (a % 3_usize).abs_diff(b % 3),
                (a / 3 % 3_usize).abs_diff(b / 3 % 3),
                (a / 9_usize).abs_diff(b / 9),
            );
            let apart = dx * dx + dy * dy + dz * dz;
            if apart == 1 {
                by_side[a] |= 1 << b;
            }
            if apart == 1 || apart == 2 {
                by_edge[a] |= 1 << b;
            }
            b += 1;
        }
        a += 1;
    }
    (by_side, by_edge)
}

/// Whether the voxel can be put or taken and all hangs together as before. A bit is 1 where a neighbour is solid.
pub(super) fn is_simple(solid: Neighbourhood) -> bool {
    let solid = solid & ALL_AROUND;
    let empty = !solid & ALL_AROUND;
    hang_together(solid & BY_SIDE, solid, &TOUCHING.0)
        && hang_together(empty & BY_SIDE_AND_EDGE, empty, &TOUCHING.1)
}

/// Whether all of `these`, of which there is one at least, are in one piece of `within`.
fn hang_together(these: Neighbourhood, within: Neighbourhood, touching: &[Neighbourhood; 27]) -> bool {
    if these == 0 {
        return false;
    }
    let mut reached = these & these.wrapping_neg();
    let mut front = reached;
    while front != 0 {
        let mut next = 0;
        while front != 0 {
            next |= touching[front.trailing_zeros() as usize];
            front &= front - 1;
        }
        front = next & within & !reached;
        reached |= front;
    }
    these & !reached == 0
}

/// At how many of its twelve edges the voxel or its neighbours touch along the edge only.
pub(super) fn touching_sheets(solid: Neighbourhood) -> u32 {
    let is = |at: usize| solid >> at & 1 == 1;
    // A step along one axis and one along another, either way.
    let steps = [(1, 3), (1, 9), (3, 9)];
    let signs = [(true, true), (true, false), (false, true), (false, false)];
    let step = |at: usize, by: usize, up: bool| if up { at + by } else { at - by };
    let edges = steps.into_iter().flat_map(|pair| signs.map(|sign| (pair, sign)));
    let touches = edges.map(|((a, b), (up_a, up_b))| {
        let (one, other) = (step(CENTRE, a, up_a), step(CENTRE, b, up_b));
        let across = step(one, b, up_b);
        is(CENTRE) == is(across) && is(one) == is(other) && is(CENTRE) != is(one)
    });
    touches.map(u32::from).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(places: &[[i32; 3]]) -> Neighbourhood {
        places.iter().map(|[x, y, z]| 1 << (13 + x + 3 * y + 9 * z)).sum()
    }

    #[test]
    fn a_bump_a_dent_and_the_end_of_a_row_are_simple() {
        let below: Vec<[i32; 3]> = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [x, y, -1])).collect();
        assert!(is_simple(bits(&below)));
        assert!(is_simple(bits(&[[1, 0, 0]])));
        assert!(is_simple(ALL_AROUND & !bits(&[[0, 0, 1]])));
    }

    #[test]
    fn a_voxel_alone_within_or_between_is_not_simple() {
        assert!(!is_simple(0), "a new piece");
        assert!(!is_simple(ALL_AROUND), "a cavity");
        assert!(!is_simple(bits(&[[1, 0, 0], [-1, 0, 0]])), "joins two pieces, or parts one");
        assert!(!is_simple(ALL_AROUND & !bits(&[[0, 0, 1], [0, 0, -1]])), "the last voxel of a tunnel");
    }

    #[test]
    fn sheets_that_touch_along_an_edge_are_counted_from_both_sides() {
        let centre = [0, 0, 0];
        assert_eq!(touching_sheets(bits(&[centre])), 0);
        assert_eq!(touching_sheets(bits(&[centre, [1, 1, 0], [1, 0, -1]])), 2);
        assert_eq!(touching_sheets(bits(&[[1, 0, 0], [0, -1, 0]])), 1);
        assert_eq!(touching_sheets(bits(&[centre, [1, 1, 0], [1, 0, 0]])), 0);
    }

    #[test]
    fn edges_join_empty_voxels_but_not_solid_ones() {
        assert!(!is_simple(bits(&[[1, 0, 0], [0, 1, 0]])), "joins two voxels that touched along an edge");
        assert!(is_simple(bits(&[[1, 0, 0], [0, 1, 0], [1, 1, 0]])));
        let way_out = [[1, 0, 1], [1, 0, 0]];
        assert!(is_simple(ALL_AROUND & !bits(&way_out)));
        assert!(is_simple(ALL_AROUND & !bits(&[[1, 0, 1]])), "the way out by an edge is a way");
    }
}
