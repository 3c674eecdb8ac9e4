//! Back to front: a binary space partition (Fuchs, Kedem and Naylor 1980) of the panels.
//!
//! Exact for any panels, however they stand: where no order of whole panels is right (three that overlap in a
//! ring, two that cross), panels are cut along the plane of another. Panels on a lattice are never cut.

use glam::DVec3;

/// Nearer to a plane than this, in panel lengths, is on it: far above the rounding of poses, far below what a
/// picture shows.
const ON_PLANE: f64 = 1e-6;
/// How many panels are tried as the next plane; the one that cuts fewest others is taken.
const CANDIDATES: usize = 6;

/// A panel or a part of one.
#[derive(Debug, Clone)]
pub(super) struct Fragment {
    /// Number of the panel.
    pub(super) panel: usize,
    /// Corners, counter-clockwise seen from the panel's outer side.
    pub(super) corners: Vec<DVec3>,
    /// Whether the side from this corner to the next is part of the panel's rim, not a cut.
    pub(super) rim: Vec<bool>,
    /// Unit normal of the panel, to its outer side.
    pub(super) normal: DVec3,
}

impl Fragment {
    /// A whole panel.
    pub(super) fn whole(panel: usize, corners: &[DVec3; 4]) -> Self {
        let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero();
        Self { panel, corners: corners.to_vec(), rim: vec![true; 4], normal }
    }

    fn distances(&self, other: &Self) -> Vec<f64> {
        other.corners.iter().map(|corner| (corner - self.corners[0]).dot(self.normal)).collect()
    }
}

enum Side {
    Front,
    Back,
    On,
    Across,
}

fn side(distances: &[f64]) -> Side {
    let front = distances.iter().any(|distance| *distance > ON_PLANE);
    let back = distances.iter().any(|distance| *distance < -ON_PLANE);
    match (front, back) {
        (true, true) => Side::Across,
        (true, false) => Side::Front,
        (false, true) => Side::Back,
        (false, false) => Side::On,
    }
}

/// Orders the panels so that each one is hidden only by later ones, seen from far away in the direction `to_eye`.
pub(super) fn back_to_front(panels: Vec<Fragment>, to_eye: DVec3) -> Vec<Fragment> {
    let mut painted = Vec::with_capacity(panels.len());
    // A stack of its own: panels of a convex shape make a tree as deep as there are panels.
    let mut work = vec![Work::Sort(panels)];
    while let Some(next) = work.pop() {
        match next {
            Work::Paint(fragments) => painted.extend(fragments),
            Work::Sort(fragments) => {
                let Some(plane) = choose(&fragments) else { continue };
                let parts = divide(fragments, plane);
                let mut on = parts.on;
                // Two panels in one place, back to back: the one that shows its outer side hides the other.
                on.sort_by_key(|fragment| fragment.normal.dot(to_eye) > 0.0);
                let (far, near) = if parts.normal.dot(to_eye) > 0.0 {
                    (parts.back, parts.front)
                } else {
                    (parts.front, parts.back)
                };
                work.extend([Work::Sort(near), Work::Paint(on), Work::Sort(far)]);
            }
        }
    }
    painted
}

enum Work {
    Sort(Vec<Fragment>),
    Paint(Vec<Fragment>),
}

/// The index of the fragment whose plane cuts fewest others, and parts the rest most evenly.
fn choose(fragments: &[Fragment]) -> Option<usize> {
    let step = fragments.len().div_ceil(CANDIDATES).max(1);
    (step / 2..fragments.len()).step_by(step).chain((!fragments.is_empty()).then_some(0)).min_by_key(
        |&candidate| {
            let plane = &fragments[candidate];
            let (mut front, mut back, mut cut) = (0_usize, 0_usize, 0_usize);
            for other in fragments {
                match side(&plane.distances(other)) {
                    Side::Front => front += 1,
                    Side::Back => back += 1,
                    Side::On => {}
                    Side::Across => cut += 1,
                }
            }
            8 * cut + front.abs_diff(back)
        },
    )
}

struct Parts {
    normal: DVec3,
    front: Vec<Fragment>,
    on: Vec<Fragment>,
    back: Vec<Fragment>,
}

fn divide(fragments: Vec<Fragment>, plane: usize) -> Parts {
    let plane = fragments[plane].clone();
    let mut parts = Parts { normal: plane.normal, front: Vec::new(), on: Vec::new(), back: Vec::new() };
    for fragment in fragments {
        let distances = plane.distances(&fragment);
        match side(&distances) {
            Side::Front => parts.front.push(fragment),
            Side::Back => parts.back.push(fragment),
            Side::On => parts.on.push(fragment),
            Side::Across => {
                parts.front.push(cut(&fragment, &distances));
                let behind: Vec<_> = distances.iter().map(|distance| -distance).collect();
                parts.back.push(cut(&fragment, &behind));
            }
        }
    }
    parts
}

/// The part of a fragment with distances of 0 or more (Sutherland and Hodgman 1974).
fn cut(fragment: &Fragment, distances: &[f64]) -> Fragment {
    let count = fragment.corners.len();
    let (mut corners, mut rim) = (Vec::with_capacity(count + 1), Vec::with_capacity(count + 1));
    for i in 0..count {
        let j = (i + 1) % count;
        let (here, there) = (distances[i], distances[j]);
        if here >= 0.0 {
            corners.push(fragment.corners[i]);
            // A corner on the plane with the next one behind it begins the cut.
            rim.push(fragment.rim[i] && !(here <= 0.0 && there < 0.0));
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            corners.push(fragment.corners[i].lerp(fragment.corners[j], here / (here - there)));
            rim.push(here < 0.0 && fragment.rim[i]);
        }
    }
    Fragment { panel: fragment.panel, corners, rim, normal: fragment.normal }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TO_EYE: DVec3 = DVec3::new(0.48, -0.64, 0.6);

    fn square(origin: DVec3, x: DVec3, y: DVec3) -> [DVec3; 4] {
        [origin, origin + x, origin + x + y, origin + y]
    }

    fn area(fragment: &Fragment) -> f64 {
        let origin = fragment.corners[0];
        fragment.corners[1..]
            .windows(2)
            .map(|pair| (pair[0] - origin).cross(pair[1] - origin).dot(fragment.normal) / 2.0)
            .sum()
    }

    fn sorted(squares: &[[DVec3; 4]]) -> Vec<Fragment> {
        back_to_front(
            squares.iter().enumerate().map(|(i, corners)| Fragment::whole(i, corners)).collect(),
            TO_EYE,
        )
    }

    /// The panel seen at the foot of a ray to the eye, by brute force.
    fn seen_first(squares: &[[DVec3; 4]], foot: DVec3) -> Option<usize> {
        let hits = squares.iter().enumerate().filter_map(|(panel, corners)| {
            let fragment = Fragment::whole(panel, corners);
            let along = (corners[0] - foot).dot(fragment.normal) / TO_EYE.dot(fragment.normal);
            let point = foot + TO_EYE * along;
            inside(&fragment, point).then_some((panel, along))
        });
        hits.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(panel, _)| panel)
    }

    /// How far from its foot a ray meets the plane of a panel.
    fn depth(corners: &[DVec3; 4], foot: DVec3) -> f64 {
        let normal = Fragment::whole(0, corners).normal;
        (corners[0] - foot).dot(normal) / TO_EYE.dot(normal)
    }

    fn inside(fragment: &Fragment, point: DVec3) -> bool {
        let corners = &fragment.corners;
        (0..corners.len()).all(|i| {
            let side = corners[(i + 1) % corners.len()] - corners[i];
            // A side may be as short as a hair; then it says nothing.
            side.length() < 1e-9 || side.normalize().cross(point - corners[i]).dot(fragment.normal) > 1e-6
        })
    }

    /// The panel painted last over the foot of a ray.
    fn painted_last(fragments: &[Fragment], foot: DVec3) -> Option<usize> {
        let over = |fragment: &&Fragment| {
            let along = (fragment.corners[0] - foot).dot(fragment.normal) / TO_EYE.dot(fragment.normal);
            inside(fragment, foot + TO_EYE * along)
        };
        fragments.iter().rev().find(over).map(|fragment| fragment.panel)
    }

    fn direction() -> impl Strategy<Value = DVec3> {
        (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64)
            .prop_map(|(x, y, z)| DVec3::new(x, y, z))
            .prop_filter("not too short", |v| v.length() > 0.1)
            .prop_map(DVec3::normalize)
    }

    proptest! {
        /// Even where panels cross.
        #[test]
        fn what_is_painted_last_is_what_the_eye_sees_first(
            panels in prop::collection::vec((direction(), direction(), direction()), 2..14),
            feet in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 40),
        ) {
            let squares: Vec<_> = panels
                .iter()
                .filter(|(_, x, y)| x.cross(*y).length() > 0.1 && x.cross(*y).normalize().dot(TO_EYE).abs() > 0.05)
                .map(|(origin, x, y)| square(*origin, *x, x.cross(*y).normalize().cross(*x)))
                .collect();
            let fragments = sorted(&squares);
            let whole: f64 = fragments.iter().map(area).sum();
            prop_assert!((whole - squares.len() as f64).abs() < 1e-6, "area {} of {}", whole, squares.len());
            for (x, y) in feet {
                let foot = TO_EYE.any_orthonormal_vector() * x + TO_EYE.cross(TO_EYE.any_orthonormal_vector()) * y;
                // Near a rim a hair decides; those are left out.
                if let (Some(seen), Some(painted)) = (seen_first(&squares, foot), painted_last(&fragments, foot)) {
                    let near_rim = fragments.iter().any(|fragment| near_rim(fragment, foot));
                    let gap = depth(&squares[seen], foot) - depth(&squares[painted], foot);
                    prop_assert!(near_rim || gap < 1e-5, "{} hides {} by {}", seen, painted, gap);
                }
            }
        }
    }

    fn near_rim(fragment: &Fragment, foot: DVec3) -> bool {
        let along = (fragment.corners[0] - foot).dot(fragment.normal) / TO_EYE.dot(fragment.normal);
        let point = foot + TO_EYE * along;
        let corners = &fragment.corners;
        (0..corners.len()).any(|i| {
            let (from, to) = (corners[i], corners[(i + 1) % corners.len()]);
            let way = to - from;
            let share = ((point - from).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
            (from + way * share - point).length() < 1e-2
        })
    }

    #[test]
    fn panels_on_a_lattice_are_never_cut() {
        let mut squares = Vec::new();
        for i in 0..4_u8 {
            for j in 0..4_u8 {
                let at = DVec3::new(f64::from(i), f64::from(j), f64::from((i * j) % 3));
                squares.push(square(at, DVec3::X, DVec3::Y));
                squares.push(square(at, DVec3::Y, DVec3::Z));
                squares.push(square(at, DVec3::Z, DVec3::X));
            }
        }
        assert_eq!(sorted(&squares).len(), squares.len());
    }

    #[test]
    fn a_cut_keeps_the_rim_and_adds_none() {
        let across = square(DVec3::new(-0.5, 0.0, -0.5), DVec3::X, DVec3::Z);
        let fragments = sorted(&[square(DVec3::new(-1.0, -0.5, 0.0), DVec3::X * 2.0, DVec3::Y), across]);
        assert_eq!(fragments.len(), 3);
        let rims: usize = fragments.iter().map(|f| f.rim.iter().filter(|rim| **rim).count()).sum();
        // One of the two is cut: two of its sides become two each.
        assert_eq!(rims, 4 + 4 + 2);
    }
}
