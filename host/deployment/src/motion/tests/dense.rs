//! Verdicts against another way to get them: panel by panel, angle by angle.

use super::{below, edges_may_touch, from_the_root};
use crate::motion::{Linkage, Motion, Options, Thickness, check};
use crate::testing::boundary;
use glam::{DAffine3, DVec3};
use std::collections::BTreeSet;
use zygote_stacking::{Model, Plan, Request, Surface};

/// Cores are shrunk by this on all sides, so that what only touches doesn't count: for two of them together no
/// less than [`Thickness::touching`].
const SHRUNK: f64 = 1e-6;

/// The eight corners of a panel's core.
fn corners(pose: &DAffine3, plates: Thickness) -> Vec<DVec3> {
    let (rim, t) = (plates.rim + SHRUNK, plates.thickness);
    let mut corners = Vec::new();
    for x in [rim, 1.0 - rim] {
        for y in [rim, 1.0 - rim] {
            for z in [-SHRUNK, SHRUNK - t] {
                corners.push(pose.transform_point3(DVec3::new(x, y, z)));
            }
        }
    }
    corners
}

/// Whether two boxes meet, by the projections of their corners on the fifteen directions.
pub(super) fn meet(a: &DAffine3, b: &DAffine3, plates: Thickness) -> bool {
    let centre = |pose: &DAffine3| pose.transform_point3(DVec3::new(0.5, 0.5, 0.0));
    if centre(a).distance(centre(b)) > 2_f64.sqrt() + 2.0 * plates.thickness {
        return false;
    }
    let axes = |pose: &DAffine3| [pose.matrix3.x_axis, pose.matrix3.y_axis, pose.matrix3.z_axis];
    let mut directions = [axes(a), axes(b)].concat();
    for u in axes(a) {
        directions.extend(axes(b).map(|v| u.cross(v)));
    }
    let (a, b) = (corners(a, plates), corners(b, plates));
    directions.into_iter().filter(|direction| direction.length() > 1e-6).all(|direction| {
        let extent = |points: &[DVec3]| {
            let along = || points.iter().map(|point| point.dot(direction));
            (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max))
        };
        let ((low, high), (other_low, other_high)) = (extent(&a), extent(&b));
        low < other_high && other_low < high
    })
}

/// Whether anything meets while a hinge opens, at steps of half a degree.
fn sampled(linkage: &Linkage, open: &[f64], hinge: usize, plates: Thickness) -> bool {
    let moved: BTreeSet<_> = linkage.moved(hinge).collect();
    let samples = (linkage.turn_deg(hinge) * 2.0).round();
    let mut fractions = open.to_vec();
    let mut sample = 0.0;
    while sample <= samples && samples > 0.0 {
        fractions[hinge] = sample / samples;
        let poses = linkage.poses_at(&fractions);
        for panel in &moved {
            for other in (0..linkage.panels()).filter(|other| !moved.contains(other)) {
                if meet(&poses[*panel], &poses[other], plates) {
                    return true;
                }
            }
        }
        sample += 1.0;
    }
    false
}

/// A solid grown cube by cube at random.
fn solid(seed: &mut u64, cubes: usize) -> Vec<[i32; 3]> {
    let mut solid = vec![[0; 3]];
    while solid.len() < cubes {
        let mut cube = solid[below(seed, solid.len())];
        cube[below(seed, 3)] += if below(seed, 2) == 0 { 1 } else { -1 };
        if !solid.contains(&cube) {
            solid.push(cube);
        }
    }
    solid
}

/// Some plan of a random solid in so many piles; none where the planner finds none.
pub(super) fn random_plan(seed: u64, piles: usize) -> Option<Plan> {
    let mut state = seed;
    let cubes = 2 + below(&mut state, 4);
    let quads = boundary(&solid(&mut state, cubes));
    let lines = (1..=quads.len()).collect();
    let model = Model::new("random", Surface::new(quads, lines).ok()?).ok()?;
    zygote_stacking::plan(&model, &Request { piles, seed, ..Request::default() }).ok()
}

/// Compares step by step what both ways say, in an order from the root and in a random one.
fn compare(plates_of: impl Fn(&Plan) -> Thickness, seeds: std::ops::Range<u64>) {
    let (mut free, mut blocked, mut wary, mut plans) = (0, 0, 0, 0);
    for (seed, piles) in seeds.flat_map(|seed| [(seed, 1), (seed, 2)]) {
        let Some(plan) = random_plan(seed, piles) else { continue };
        plans += 1;
        let plates = plates_of(&plan);
        let mut order = from_the_root(&plan);
        let mut state = seed ^ 0xd1ce;
        for shuffled in [false, true] {
            if shuffled {
                for place in (1..order.len()).rev() {
                    order.swap(place, below(&mut state, place + 1));
                }
            }
            let report = check(&plan, &order, plates, &Options::default()).expect("plates");
            let linkage = Linkage::new(&plan, plates).expect("plates");
            let mut motion = Motion::new(&plan, plates, None).expect("plates");
            let mut open = vec![0.0; order.len()];
            for (step, hinge) in order.iter().enumerate() {
                let told = report.collisions.iter().any(|(at, _)| *at == step);
                assert_eq!(motion.blocked(*hinge).is_some(), told, "seed {seed}, K {piles}, step {step}");
                let met = sampled(&linkage, &open, *hinge, plates);
                assert!(told || !met, "seed {seed}, K {piles}, hinge {hinge}, step {step}: a false free");
                match (told, met) {
                    (false, _) => free += 1,
                    (true, true) => blocked += 1,
                    (true, false) => {
                        println!("seed {seed}, K {piles}, step {step}: {:?}", motion.blocked(*hinge));
                        wary += 1;
                    }
                }
                motion.open(*hinge);
                open[*hinge] = 1.0;
            }
        }
    }
    println!("{plans} plans, {free} steps free, {blocked} blocked, {wary} blocked that sampling finds free");
    assert!(plans >= 8 && free > 50 && blocked > 20, "too few cases to mean anything");
    // What comes nearer than the finest piece, or meets between two samples only.
    assert!(wary * 50 <= free + blocked, "{wary} of {}", free + blocked);
}

#[test]
fn sampling_finds_no_collision_of_ideal_panels_where_the_check_finds_none() {
    compare(Thickness::ideal, 0..6);
}

#[test]
fn sampling_finds_no_collision_of_thick_panels_where_the_check_finds_none() {
    compare(|_| edges_may_touch(), 10..16);
}
