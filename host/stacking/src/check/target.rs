//! The target: no square twice, one, two or four panels at a lattice edge, hinges between partners, fold angles.

use super::document::Document;
use super::hinges::check_angle;
use super::lattice;
use super::report::{Report, Rule};
use super::squares::{Frame, Square, fold_angle};
use super::topology::Joint;
use std::collections::BTreeMap;

/// Checks the target.
pub(super) fn check(document: &Document, target: &Frame<'_>, joints: &[Joint], report: &mut Report) {
    require_distinct(target, report);
    let mut flanks: Vec<Flank> = Vec::with_capacity(4 * document.panels());
    for (panel, _) in target.squares() {
        flanks.extend((0..4).map(|side| Flank { edge: edge_name(target.ends(panel, side)), panel, side }));
    }
    flanks.sort_unstable();
    // Where more than two panels meet, by panel and side: few, if any.
    let mut crowded: BTreeMap<(usize, usize), &[Flank]> = BTreeMap::new();
    for found in flanks.chunk_by(|a, b| a.edge == b.edge) {
        report.require([1, 2, 4].contains(&found.len()), Rule::LatticeEdge, || {
            let [p, q] = target.ends(found[0].panel, found[0].side);
            let message = format!("{} panels meet at the edge {p:?} {q:?}, expected 1, 2 or 4", found.len());
            (format!("faces_vertices[{}]", found[0].panel), message)
        });
        if found.len() > 2 {
            crowded.extend(found.iter().map(|flank| ((flank.panel, flank.side), found)));
        }
    }
    for Joint { hinge, panels: [a, b], sides: [side_a, side_b] } in joints {
        let (into_a, into_b) = (target.into(*a, *side_a), target.into(*b, *side_b));
        let normal_a = target.normal(*a);
        let angle = fold_angle(into_a, into_b, normal_a, 1);
        check_angle(&document.target, *hinge, angle, &[-90, 0, 90], report);
        if let Some(found) = crowded.get(&(*a, *side_a)) {
            let partners = partners(target, found, into_a, normal_a);
            report.require(partners.contains(b), Rule::Partner, || {
                let message = format!("at this edge of 4 panels the partner of {a} is {partners:?}, not {b}");
                (format!("edges_faces[{hinge}]"), message)
            });
        }
    }
}

/// One side of a panel, at its lattice edge.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Flank {
    edge: u128,
    panel: usize,
    side: usize,
}

/// No two panels on one square with the same outer side.
fn require_distinct(target: &Frame<'_>, report: &mut Report) {
    let name = |square: Square| lattice::name(square.least, 2 * square.axis + usize::from(square.sign > 0));
    let mut names: Vec<(u128, usize)> =
        target.squares().map(|(panel, square)| (name(square), panel)).collect();
    names.sort_unstable();
    for pair in names.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let message = format!("on the same square, with the same outer side, as panel {}", pair[0].1);
        report.add(Rule::Overlap, format!("faces_vertices[{}]", pair[1].1), message);
    }
}

/// A name for a lattice edge of length 1, the same from both of its ends.
fn edge_name([p, q]: [[i32; 3]; 2]) -> u128 {
    let axis = (0..3).find(|axis| p[*axis] != q[*axis]);
    lattice::name(p.min(q), axis.unwrap_or_default())
}

/// The panels met first on turning about an edge from a panel towards its inner side.
fn partners(frame: &Frame<'_>, found: &[Flank], into_a: [i32; 3], normal_a: [i32; 3]) -> Vec<usize> {
    let turn = [normal_a.map(|c| -c), into_a.map(|c| -c), normal_a];
    let standing = |way: [i32; 3]| -> Vec<usize> {
        let there = found.iter().filter(|flank| frame.into(flank.panel, flank.side) == way);
        there.map(|flank| flank.panel).collect()
    };
    turn.into_iter().map(standing).find(|panels| !panels.is_empty()).unwrap_or_default()
}
