//! The target: no square twice, one, two or four panels at a lattice edge, hinges between partners, fold angles.

use super::document::Document;
use super::hinges::check_angle;
use super::report::{Report, Rule};
use super::squares::{Frame, Square, fold_angle};
use super::topology::Joint;
use std::collections::BTreeMap;

/// Checks the target.
pub(super) fn check(document: &Document, target: &Frame<'_>, joints: &[Joint], report: &mut Report) {
    let mut taken: BTreeMap<Square, usize> = BTreeMap::new();
    let mut around: BTreeMap<[[i32; 3]; 2], Vec<(usize, usize)>> = BTreeMap::new();
    for (panel, square) in target.squares() {
        if let Some(other) = taken.insert(square, panel) {
            let message = format!("on the same square, with the same outer side, as panel {other}");
            report.add(Rule::Overlap, format!("faces_vertices[{panel}]"), message);
        }
        for side in 0..4 {
            around.entry(edge(target, panel, side)).or_default().push((panel, side));
        }
    }
    for ([p, q], found) in &around {
        report.require([1, 2, 4].contains(&found.len()), Rule::LatticeEdge, || {
            let message = format!("{} panels meet at the edge {p:?} {q:?}, expected 1, 2 or 4", found.len());
            (format!("faces_vertices[{}]", found[0].0), message)
        });
    }
    for Joint { hinge, panels: [a, b], sides: [side_a, side_b] } in joints {
        let (into_a, into_b) = (target.into(*a, *side_a), target.into(*b, *side_b));
        let normal_a = target.normal(*a);
        let angle = fold_angle(into_a, into_b, normal_a, 1);
        check_angle(&document.target, *hinge, angle, &[-90, 0, 90], report);
        let found = &around[&edge(target, *a, *side_a)];
        if found.len() > 2 {
            let partners = partners(target, found, into_a, normal_a);
            report.require(partners.contains(b), Rule::Partner, || {
                let message = format!("at this edge of 4 panels the partner of {a} is {partners:?}, not {b}");
                (format!("edges_faces[{hinge}]"), message)
            });
        }
    }
}

fn edge(frame: &Frame<'_>, panel: usize, side: usize) -> [[i32; 3]; 2] {
    let [p, q] = frame.ends(panel, side);
    [p.min(q), p.max(q)]
}

/// The panels met first on turning about an edge from a panel towards its inner side.
fn partners(frame: &Frame<'_>, found: &[(usize, usize)], into_a: [i32; 3], normal_a: [i32; 3]) -> Vec<usize> {
    let turn = [normal_a.map(|c| -c), into_a.map(|c| -c), normal_a];
    let standing = |way: [i32; 3]| -> Vec<usize> {
        let there = found.iter().filter(|(panel, side)| frame.into(*panel, *side) == way);
        there.map(|(panel, _)| *panel).collect()
    };
    turn.into_iter().map(standing).find(|panels| !panels.is_empty()).unwrap_or_default()
}
