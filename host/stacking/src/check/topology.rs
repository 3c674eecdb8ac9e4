//! The cut surface: edges belong to their panels, a side carries one edge, the hinges are a tree through all panels, and
//! panels share a vertex only through hinges.

use super::document::Document;
use super::report::{Report, Rule};

/// The side of a panel that carries no edge yet.
const NO_EDGE: usize = usize::MAX;
/// A hinge whose edge was found in both of its panels.
pub(super) struct Joint {
    pub(super) hinge: usize,
    pub(super) panels: [usize; 2],
    /// The side of each panel that carries the hinge.
    pub(super) sides: [usize; 2],
}

/// Checks the topology and finds the sides that the hinges are on.
pub(super) fn check(document: &Document, report: &mut Report) -> Vec<Joint> {
    let mut owner = vec![[NO_EDGE; 4]; document.panels()];
    let mut joints = Vec::with_capacity(document.hinge_count());
    let mut group: Vec<usize> = (0..document.panels()).collect();
    for (index, (&[u, v], faces)) in document.edges.iter().zip(&document.edge_faces).enumerate() {
        let panels = faces.panels();
        let mut sides = [None; 2];
        // The edge runs as in its first panel, and so against its second.
        for (number, (panel, (start, end))) in panels.iter().zip([(u, v), (v, u)]).enumerate() {
            let face = document.faces[*panel];
            let side_from =
                |from: usize, to: usize| (0..4).find(|i| face[*i] == from && face[(i + 1) % 4] == to);
            let Some(side) = side_from(start, end) else {
                let reversed = side_from(end, start).is_some();
                let rule = if reversed { Rule::Orientation } else { Rule::Edge };
                let found = if reversed { "has it the other way round" } else { "has no such edge" };
                report.add(rule, format!("edges_vertices[{index}]"), format!("panel {panel} {found}"));
                continue;
            };
            let other = std::mem::replace(&mut owner[*panel][side], index);
            if other != NO_EDGE {
                report.add(
                    Rule::OneHingeASide,
                    format!("edges_vertices[{index}]"),
                    format!("side {side} of panel {panel} is edge {other} already"),
                );
            }
            sides[number] = Some(side);
        }
        if let [a, b] = *panels {
            let (group_a, group_b) = (find(&mut group, a), find(&mut group, b));
            report.require(group_a != group_b, Rule::Tree, || {
                (format!("edges_faces[{index}]"), format!("the hinge between {a} and {b} closes a loop"))
            });
            group[group_a] = group_b;
            if let [Some(side_a), Some(side_b)] = sides {
                joints.push(Joint { hinge: index, panels: [a, b], sides: [side_a, side_b] });
            }
        }
    }
    let pieces = (0..group.len()).filter(|panel| group[*panel] == *panel).count();
    report.require(pieces == 1, Rule::Tree, || {
        ("edges_faces".into(), format!("the hinges leave {pieces} pieces, expected one"))
    });
    let mut used = vec![false; document.target.points.len()];
    for vertex in document.faces.iter().flatten() {
        used[*vertex] = true;
    }
    let count = used.iter().filter(|used| **used).count();
    report.require(count == used.len(), Rule::CutSurface, || {
        let message = format!(
            "{count} vertices in use, expected 2N+2 = {}: panels share one without a hinge",
            used.len()
        );
        ("faces_vertices".into(), message)
    });
    joints
}

fn find(group: &mut [usize], mut panel: usize) -> usize {
    while group[panel] != panel {
        group[panel] = group[group[panel]];
        panel = group[panel];
    }
    panel
}
