//! The crease pattern folded by its own angles, with nothing of the plan: it has to become the shape.

#![expect(clippy::unwrap_used, reason = "what cannot be read fails the test")]

mod shapes;

use serde_json::Value;
use shapes::planned;
use zygote_fabrication::crease_pattern;

type Point = [f64; 3];

fn numbers(value: &Value) -> Vec<usize> {
    let number = |value: &Value| usize::try_from(value.as_u64().unwrap()).unwrap();
    value.as_array().unwrap().iter().map(number).collect()
}

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

/// A point turned about the line from `u` to `v`, which are one apart, by a right-handed angle.
fn turned(point: Point, u: Point, v: Point, degrees: f64) -> Point {
    let (axis, arm) = (minus(v, u), minus(point, u));
    let (sin, cos) = degrees.to_radians().sin_cos();
    let along: f64 = (0..3).map(|k| axis[k] * arm[k]).sum();
    let cross = [
        axis[1] * arm[2] - axis[2] * arm[1],
        axis[2] * arm[0] - axis[0] * arm[2],
        axis[0] * arm[1] - axis[1] * arm[0],
    ];
    [0, 1, 2].map(|k| u[k] + arm[k] * cos + cross[k] * sin + axis[k] * along * (1.0 - cos))
}

#[test]
fn folded_by_its_angles_it_is_the_shape() {
    for (model, piles) in [("i14.txt", 2), ("fish92.txt", 4), ("sheet12.obj", 4), ("torus32.txt", 1)] {
        let plan = planned(model, piles);
        let bytes = crease_pattern(&plan).unwrap();
        assert_eq!(bytes, crease_pattern(&plan).unwrap());
        let file: Value = serde_json::from_slice(&bytes).unwrap();
        let flat: Vec<Point> = file["vertices_coords"]
            .as_array()
            .unwrap()
            .iter()
            .map(|at| [at[0].as_f64().unwrap(), at[1].as_f64().unwrap(), 0.0])
            .collect();
        let faces: Vec<Vec<usize>> = file["faces_vertices"].as_array().unwrap().iter().map(numbers).collect();
        let edges: Vec<Vec<usize>> = file["edges_vertices"].as_array().unwrap().iter().map(numbers).collect();
        let joined: Vec<Vec<usize>> = file["edges_faces"].as_array().unwrap().iter().map(numbers).collect();
        // Faces from the first one on, each with the hinges between it and that one: the last is turned about first.
        let mut turns: Vec<Option<Vec<(Point, Point, f64)>>> = vec![None; faces.len()];
        turns[0] = Some(Vec::new());
        let mut open = vec![0];
        while let Some(face) = open.pop() {
            for (edge, sides) in joined.iter().enumerate().filter(|(_, sides)| sides.contains(&face)) {
                let Some(&other) = sides.iter().find(|side| **side != face && turns[**side].is_none()) else {
                    continue;
                };
                // The face on the left of its edge stays; a valley comes up.
                let (u, v) = if sides[0] == face { (0, 1) } else { (1, 0) };
                let angle = -file["edges_foldAngle"][edge].as_f64().unwrap();
                let mut so_far = turns[face].clone().unwrap();
                so_far.push((flat[edges[edge][u]], flat[edges[edge][v]], angle));
                turns[other] = Some(so_far);
                open.push(other);
            }
        }
        let folded = |face: usize, corner: usize| {
            let start = flat[faces[face][corner]];
            turns[face]
                .as_ref()
                .unwrap()
                .iter()
                .rev()
                .fold(start, |point, (u, v, angle)| turned(point, *u, *v, *angle))
        };
        // The shape in the frame of its first panel.
        let corners = plan.target[0].map(|corner| corner.map(f64::from));
        let (x, y) = (minus(corners[1], corners[0]), minus(corners[3], corners[0]));
        let z = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
        let first = [0, 1, 3].map(|corner| folded(0, corner));
        let (net_x, net_y) = (minus(first[1], first[0]), minus(first[2], first[0]));
        let dot = |a: Point, b: Point| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        for face in 0..faces.len() {
            for corner in 0..4 {
                let arm = minus(plan.target[face][corner].map(f64::from), corners[0]);
                let (across, along) = (dot(arm, x), dot(arm, y));
                let expected = [0, 1, 2].map(|k| {
                    let up = if k == 2 { dot(arm, z) } else { 0.0 };
                    first[0][k] + across * net_x[k] + along * net_y[k] + up
                });
                let off = minus(folded(face, corner), expected);
                assert!(dot(off, off).sqrt() < 1e-9, "{model}: panel {face}, corner {corner}: {off:?}");
            }
        }
    }
}
