//! The hinges in the zygote: kind, side and angles of each; the count of bridges and breaks; and the cut edges.

use super::document::{Document, FrameArrays};
use super::items::Letter;
use super::piles::Stack;
use super::report::{Report, Rule};
use super::squares::{Frame, fold_angle};
use super::topology::Joint;
use crate::plan::{HingeKind, Side};
use std::collections::BTreeSet;

/// Checks the hinges of a flat zygote.
pub(super) fn check(
    document: &Document,
    zygote: &Frame<'_>,
    stack: &Stack,
    joints: &[Joint],
    report: &mut Report,
) {
    for (index, entry) in document.hinges.iter().enumerate() {
        let panels = document.edge_faces[index].panels();
        report.require(entry.panels[..] == *panels, Rule::Hinge, || {
            (
                format!("zygote:hinges[{index}]"),
                format!("panels {:?}, edges_faces has {panels:?}", entry.panels),
            )
        });
    }
    for joint in joints {
        check_place(document, zygote, stack, joint, report);
        check_opening(document, stack, joint, report);
    }
    count(document, joints, report);
}

/// A fold joins consecutive heights of a pile, a bridge equal heights of neighbours; both on the side that the file says.
fn check_place(document: &Document, zygote: &Frame<'_>, stack: &Stack, joint: &Joint, report: &mut Report) {
    let Joint { hinge, panels: [a, b], sides: [side_a, side_b] } = *joint;
    let entry = &document.hinges[hinge];
    let here = || format!("zygote:hinges[{hinge}]");
    let ((cell_a, height_a), (cell_b, height_b)) = (stack[a], stack[b]);
    let (into_a, into_b) = (zygote.into(a, side_a), zygote.into(b, side_b));
    let Some(side) = Side::ALL.into_iter().find(|side| side.step() == [-into_a[0], -into_a[1]]) else {
        return;
    };
    report.require(entry.side == side, Rule::Side, || {
        (here(), format!("stated {}, the coordinates give {}", entry.side.letter(), side.letter()))
    });
    let up = zygote.normal(a);
    // Panel b lies on the outer side of a when it is above a that looks up, or below a that looks down.
    let onto = if (height_b > height_a) == (up[2] > 0) && height_a != height_b { 1 } else { -1 };
    let angle = fold_angle(into_a, into_b, up, onto);
    let places = || format!("from {cell_a:?} height {height_a} to {cell_b:?} height {height_b}");
    match entry.kind {
        HingeKind::Fold => {
            report.require(cell_a == cell_b && height_b == height_a + 1, Rule::Fold, || {
                (here(), format!("{}, expected one up in one pile", places()))
            });
            check_angle(&document.zygote, hinge, angle, &[180, -180], report);
        }
        HingeKind::Bridge => {
            let [dx, dy] = side.step();
            let beyond = [cell_a[0] + dx, cell_a[1] + dy];
            report.require(height_a == height_b && cell_b == beyond, Rule::Bridge, || {
                let expected = format!("expected equal height on the cell beyond side {}", side.letter());
                (here(), format!("{}, {expected}", places()))
            });
            check_angle(&document.zygote, hinge, angle, &[0], report);
        }
    }
}

/// The opening angle is measured where the panels touch: on the inner side for a fold over an odd height.
fn check_opening(document: &Document, stack: &Stack, joint: &Joint, report: &mut Report) {
    let entry = &document.hinges[joint.hinge];
    let height = stack[joint.panels[0]].1;
    let angle = document.target.angles[joint.hinge];
    let inner = entry.kind == HingeKind::Fold && height % 2 == 1;
    let opening = if inner { 180.0 + angle } else { 180.0 - angle };
    report.require(f64::from(entry.opening_deg) - opening == 0.0, Rule::Opening, || {
        let message =
            format!("stated {}, fold angle {angle} at height {height} gives {opening}", entry.opening_deg);
        (format!("zygote:hinges[{}]", joint.hinge), message)
    });
}

fn count(document: &Document, joints: &[Joint], report: &mut Report) {
    let mut degree = vec![0; document.panels()];
    for panel in joints.iter().flat_map(|joint| joint.panels) {
        degree[panel] += 1;
    }
    let bridges =
        joints.iter().filter(|joint| document.hinges[joint.hinge].kind == HingeKind::Bridge).count();
    // Of every panel the one that a fold joins onto it; more than one only in a file that is wrong.
    let mut above = vec![usize::MAX; document.panels()];
    let mut more = BTreeSet::new();
    for entry in document.hinges.iter().filter(|entry| entry.kind == HingeKind::Fold) {
        let [lower, upper] = entry.panels;
        if above[lower] == usize::MAX {
            above[lower] = upper;
        } else {
            more.insert(entry.panels);
        }
    }
    let is_folded = |pair: &[usize]| above[pair[0]] == pair[1] || more.contains(&[pair[0], pair[1]]);
    let pairs = document.piles.iter().flat_map(|pile| pile.panels.windows(2));
    let breaks = pairs.filter(|pair| !is_folded(pair)).count();
    report.require(bridges + 1 == breaks + document.piles.len(), Rule::BridgesBreaks, || {
        let expected = format!("expected K-1 = {}", document.piles.len() - 1);
        ("zygote:hinges".into(), format!("{bridges} bridges less {breaks} breaks, {expected}"))
    });
    report.figures.bridges = bridges;
    report.figures.breaks = breaks;
    report.figures.high_degree_panels = degree.iter().filter(|degree| **degree > 2).count();
    report.figures.openings =
        [90, 180, 270].map(|opening| document.hinges.iter().filter(|e| e.opening_deg == opening).count());
}

/// One hinge's fold angle and letter in one frame against the angle computed from the coordinates.
pub(super) fn check_angle(
    frame: &FrameArrays,
    index: usize,
    computed: i32,
    allowed: &[i32],
    report: &mut Report,
) {
    let stated = frame.angles[index];
    // Angles are whole numbers: what is off by a hair is another one.
    let agrees = stated - f64::from(computed) == 0.0 && allowed.contains(&computed);
    report.require(agrees, Rule::FoldAngle, || {
        let message =
            format!("stated {stated}, the coordinates give {computed}, expected one of {allowed:?}");
        (format!("{}edges_foldAngle[{index}]", frame.prefix), message)
    });
    let letter = match computed {
        1.. => b'V',
        0 => b'F',
        _ => b'M',
    };
    require_letter(frame, index, letter, report);
}

fn require_letter(frame: &FrameArrays, index: usize, letter: u8, report: &mut Report) {
    let stated = frame.letters.entries[index];
    report.require(stated == Letter(letter), Rule::Assignment, || {
        let found = frame.letters.odd.get(&index);
        let found = found.map_or_else(|| char::from(stated.0).to_string(), String::clone);
        let message = format!("stated {found}, expected {}", char::from(letter));
        (format!("{}edges_assignment[{index}]", frame.prefix), message)
    });
}

/// Cut edges are borders of angle 0 in both frames.
pub(super) fn check_cut_edges(document: &Document, report: &mut Report) {
    for frame in [&document.target, &document.zygote] {
        for index in document.hinge_count()..document.edges.len() {
            require_letter(frame, index, b'B', report);
            report.require(frame.angles[index] == 0.0, Rule::FoldAngle, || {
                let message = format!("stated {}, a cut edge has 0", frame.angles[index]);
                (format!("{}edges_foldAngle[{index}]", frame.prefix), message)
            });
        }
    }
}
