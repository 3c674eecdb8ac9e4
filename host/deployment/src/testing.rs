//! Small plans for this crate's tests.

use zygote_stacking::{Hinge, HingeKind, Model, Pile, Plan, Request, Side, Source, Surface};

fn source() -> Source {
    Source {
        model: "by hand".into(),
        voxel_size: None,
        distance: None,
        bounds: [1, 1, 1],
        seed: 0,
        program: "test".into(),
    }
}

/// A plan of which only the tree counts: panel `i + 1` hangs on panel `parents[i]`, which is at most `i`. Its
/// coordinates are no surface.
pub(crate) fn tree_plan(parents: &[usize], kinds: &[HingeKind]) -> Plan {
    let panels = parents.len() + 1;
    Plan {
        target: vec![[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]; panels],
        zygote: vec![[[0, 0], [1, 0], [1, 1], [0, 1]]; panels],
        hinges: parents
            .iter()
            .zip(kinds)
            .enumerate()
            .map(|(index, (parent, kind))| Hinge {
                kind: *kind,
                panels: [*parent, index + 1],
                edges: [1, 3],
                side: Side::E,
                opening_deg: [90, 180, 270][index % 3],
                zygote_angle_deg: if *kind == HingeKind::Fold { 180 } else { 0 },
                target_angle_deg: [90, 0, -90][index % 3],
            })
            .collect(),
        piles: vec![Pile { cell: [0, 0], panels: (0..panels).collect() }],
        root: 0,
        thickness: 0.05,
        panel_length_mm: 100.0,
        source: source(),
        schedule: None,
    }
}

/// A strip of `panels` folds.
pub(crate) fn strip(panels: usize) -> Plan {
    tree_plan(&(0..panels - 1).collect::<Vec<_>>(), &vec![HingeKind::Fold; panels - 1])
}

/// A rig file with `extra` at its end.
pub(crate) fn rig_text(extra: &str) -> String {
    format!(
        r#"version = 1
[rig]
id = "bench-1"
[supply]
voltage = "5 V"
limit = "2 A"
resistance = "50 mohm"
[[node]]
name = "a"
heaters = 16
servos = 4
springs = 2
{extra}"#
    )
}

/// The squares between some voxels and the rest of space, counter-clockwise seen from outside.
pub(crate) fn boundary(voxels: &[[i32; 3]]) -> Vec<[[i32; 3]; 4]> {
    let mut quads = Vec::new();
    for voxel in voxels {
        for axis in 0..3 {
            for (side, step) in [(0, -1), (1, 1)] {
                let mut beyond = *voxel;
                beyond[axis] += step;
                if voxels.contains(&beyond) {
                    continue;
                }
                let corner = |u: i32, v: i32| {
                    let mut corner = *voxel;
                    corner[axis] += side;
                    corner[(axis + 1) % 3] += u;
                    corner[(axis + 2) % 3] += v;
                    corner
                };
                let mut quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                if step < 0 {
                    quad.reverse();
                }
                quads.push(quad);
            }
        }
    }
    quads
}

/// Plans as the planner makes them: a cube, a bar and an L of three voxels, and a ring of eight.
pub(crate) fn real_plans() -> Vec<Plan> {
    let ring: Vec<_> = (0..9).filter(|cell| *cell != 4).map(|cell| [cell % 3, cell / 3, 0]).collect();
    let shapes = [
        ("cube", vec![[0, 0, 0]], 1),
        ("bar", vec![[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1),
        ("L", vec![[0, 0, 0], [1, 0, 0], [0, 0, 1]], 2),
        ("ring", ring, 4),
    ];
    shapes
        .into_iter()
        .map(|(name, voxels, piles)| {
            let quads = boundary(&voxels);
            let lines = (1..=quads.len()).collect();
            let model = Model::new(name, Surface::new(quads, lines).expect("a surface")).expect("one piece");
            let request = Request { piles, thickness: 0.05, seed: 1, ..Request::default() };
            zygote_stacking::plan(&model, &request).expect("a plan")
        })
        .collect()
}
