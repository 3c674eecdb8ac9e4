//! The scene as another reader sees it, against the poses that it was made from.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

use super::*;
use crate::testing::real_plans;
use glam::{DMat4, Quat, Vec3};
use gltf::animation::util::ReadOutputs;

/// 32-bit floats along a chain of a hundred panels.
const SAME: f64 = 1e-4;

/// What the reader finds: the panels' squares at a time.
struct Played {
    document: gltf::Document,
    buffer: Vec<u8>,
}

impl Played {
    fn new(plan: &Plan) -> Self {
        Self::read(&gltf(plan).expect("a scene"))
    }

    fn read(file: &[u8]) -> Self {
        let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(file).expect("valid glTF");
        Self { document, buffer: blob.expect("a buffer") }
    }

    fn local(&self, node: &gltf::Node, time: f64) -> DMat4 {
        let (place, turn, _) = node.transform().decomposed();
        let (mut place, mut turn) = (Vec3::from_array(place), Quat::from_array(turn));
        let channels = self.document.animations().flat_map(|animation| {
            animation
                .channels()
                .filter(|channel| channel.target().node().index() == node.index())
                .collect::<Vec<_>>()
        });
        for channel in channels {
            let reader = channel.reader(|_| Some(&self.buffer));
            let times: Vec<f32> = reader.read_inputs().expect("times").collect();
            #[expect(clippy::cast_possible_truncation, reason = "the format's numbers")]
            let time = (time as f32).clamp(times[0], times[times.len() - 1]);
            let next = times.partition_point(|key| *key < time).clamp(1, times.len() - 1);
            let share = (time - times[next - 1]) / (times[next] - times[next - 1]);
            match reader.read_outputs().expect("values") {
                ReadOutputs::Rotations(turns) => {
                    let turns: Vec<_> = turns.into_f32().map(Quat::from_array).collect();
                    turn = turns[next - 1].slerp(turns[next], share);
                }
                ReadOutputs::Translations(places) => {
                    let places: Vec<_> = places.map(Vec3::from_array).collect();
                    place = places[next - 1].lerp(places[next], share);
                }
                _ => panic!("nothing else is animated"),
            }
        }
        DMat4::from_rotation_translation(turn.as_dquat(), place.as_dvec3())
    }

    /// The middle of every panel and a point above its outer side.
    fn panels(&self, time: f64) -> Vec<[DVec3; 2]> {
        let mut found = vec![[DVec3::NAN; 2]; self.document.nodes().len() - 1];
        let scene = self.document.default_scene().expect("a scene");
        let mut open: Vec<_> = scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect();
        while let Some((node, parent)) = open.pop() {
            let pose = parent * self.local(&node, time);
            if node.mesh().is_some() {
                let middle = DVec3::new(0.5, 0.5, 0.0);
                found[node.index()] = [middle, middle + DVec3::Z].map(|point| pose.transform_point3(point));
            }
            open.extend(node.children().map(|child| (child, pose)));
        }
        found
    }
}

/// The same by the kinematics.
fn expected(plan: &Plan, fractions: &[f64]) -> Vec<[DVec3; 2]> {
    // y up, where the zygote has z.
    let upright = |point: DVec3| DVec3::new(point.x, point.z, -point.y);
    let corners = Kinematics::new(plan).expect("a tree").corners(fractions, plan.thickness);
    corners
        .iter()
        .map(|corners| {
            let middle = (corners[0] + corners[2]) / 2.0;
            let outwards = (corners[1] - corners[0]).cross(corners[3] - corners[0]);
            [upright(middle), upright(middle + outwards)]
        })
        .collect()
}

fn assert_same(plan: &Plan, found: &[[DVec3; 2]], expected: &[[DVec3; 2]]) {
    assert_eq!(found.len(), expected.len());
    for (panel, (found, expected)) in found.iter().zip(expected).enumerate() {
        let off = found.iter().zip(expected).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(off < SAME, "{}: panel {panel} is off by {off}", plan.source.model);
    }
}

#[test]
fn it_goes_from_the_zygote_to_the_target() {
    for plan in real_plans() {
        let played = Played::new(&plan);
        let hinges = plan.hinges.len();
        assert_same(&plan, &played.panels(0.0), &expected(&plan, &vec![0.0; hinges]));
        assert_same(&plan, &played.panels(hinges as f64), &expected(&plan, &vec![1.0; hinges]));
    }
}

#[test]
fn half_way_through_a_turn_its_hinge_is_half_open() {
    for plan in real_plans() {
        let played = Played::new(&plan);
        let tree = crate::tree::Tree::new(&plan).expect("a tree");
        for index in [0, plan.hinges.len() / 2, plan.hinges.len() - 1] {
            let mut fractions = vec![0.0; plan.hinges.len()];
            for branch in &tree.branches()[..index] {
                fractions[branch.hinge] = 1.0;
            }
            fractions[tree.branches()[index].hinge] = 0.5;
            // Between two keys what fades is on a line where the truth is on an arc: less than the gap between two plates.
            let found = played.panels(index as f64 + 0.5);
            for (found, expected) in found.iter().zip(expected(&plan, &fractions)) {
                assert!(
                    found[0].distance(expected[0]) < 0.01 * plan.thickness + SAME,
                    "{}",
                    plan.source.model
                );
            }
        }
    }
}

#[test]
fn at_rest_it_is_the_zygote() {
    for plan in real_plans() {
        let mut played = Played::new(&plan);
        let moving = played.panels(0.0);
        let mut root = played.document.into_json();
        root.animations.clear();
        played.document = gltf::Document::from_json(root).expect("valid without motion");
        assert_same(&plan, &played.panels(0.0), &moving);
    }
}

#[test]
fn the_target_alone_stands_as_in_the_plan_and_does_not_move() {
    for plan in real_plans() {
        let still = Played::read(&gltf_of_target(&plan).expect("a scene"));
        assert_eq!(still.document.animations().count(), 0);
        let found: Vec<_> = still.panels(0.0).iter().map(|[middle, _]| *middle).collect();
        for (panel, corners) in plan.target.iter().enumerate() {
            let [a, b] = [corners[0], corners[2]].map(|corner| DVec3::from_array(corner.map(f64::from)));
            let middle = (a + b) / 2.0;
            let off = found[panel].distance(DVec3::new(middle.x, middle.z, -middle.y));
            assert!(off < SAME, "{}: panel {panel} is off by {off}", plan.source.model);
        }
    }
}

#[test]
fn the_same_plan_gives_the_same_bytes() {
    let plan = &real_plans()[2];
    assert_eq!(gltf(plan).expect("a scene"), gltf(plan).expect("a scene"));
}
