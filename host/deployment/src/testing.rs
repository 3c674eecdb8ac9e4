//! Small plans for this crate's tests.

use zygote_stacking::{Hinge, HingeKind, Pile, Plan, Side, Source};

fn source() -> Source {
    Source { model: "by hand".into(), voxel_size: None, bounds: [1, 1, 1], seed: 0, program: "test".into() }
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
