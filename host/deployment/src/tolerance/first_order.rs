//! First order: a hinge that is off by a small angle moves a point beyond it by the angle times its distance from the axis.
//! The mean square of a point's error is a quadratic form in the point, which adds up along the tree: linear time for
//! all panels, and the forms of two panels at a cut edge differ by the hinges between them alone.

use super::{Chain, HingeErrors};
use glam::{DMat3, DVec3};
use zygote_stacking::CutEdge;

/// Mean squares.
pub(super) struct FirstOrder {
    pub(super) panels: Vec<f64>,
    pub(super) gaps: Vec<f64>,
}

/// The mean square displacement of a point x by some hinges: x'Ax - 2 b'x + c.
#[derive(Debug, Clone, Copy)]
struct Form {
    a: DMat3,
    b: DVec3,
    c: f64,
}

impl Form {
    const NONE: Self = Self { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0 };

    fn at(&self, x: DVec3) -> f64 {
        x.dot(self.a * x) - 2.0 * self.b.dot(x) + self.c
    }

    /// With one more hinge: its angle moves x by the distance from its axis, its offset moves any point alike.
    fn with(&self, anchor: DVec3, axis: DVec3, errors: HingeErrors) -> Self {
        let variance = errors.angle_rad * errors.angle_rad;
        let across = DMat3::IDENTITY - DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
        Self {
            a: self.a + across * variance,
            b: self.b + across * anchor * variance,
            c: self.c + anchor.dot(across * anchor) * variance + 3.0 * errors.offset * errors.offset,
        }
    }
}

/// Propagates the errors of all hinges.
pub(super) fn propagate(chain: &Chain, cut_edges: &[CutEdge], errors: HingeErrors) -> FirstOrder {
    let panels = chain.corners.len();
    // Coordinates from the root, so that the form's terms stay small.
    let origin = chain.centre(chain.root);
    let mut forms = vec![Form::NONE; panels];
    let mut ancestry = Ancestry::new(panels, chain.root);
    for joint in &chain.joints {
        forms[joint.child] = forms[joint.parent].with(joint.anchor - origin, joint.axis, errors);
        ancestry.add(joint.child, joint.parent);
    }
    let gap = |cut_edge: &CutEdge| {
        let [p, q] = cut_edge.panels;
        let common = forms[ancestry.common(p, q)];
        let square = |end: DVec3| {
            let x = end - origin;
            (forms[p].at(x) + forms[q].at(x) - 2.0 * common.at(x)).max(0.0)
        };
        chain.ends(cut_edge).map(square).iter().sum::<f64>() / 2.0
    };
    FirstOrder {
        panels: (0..panels).map(|panel| forms[panel].at(chain.centre(panel) - origin).max(0.0)).collect(),
        gaps: cut_edges.iter().map(gap).collect(),
    }
}

/// The last common panel of two ways from the root, in steps that grow with the distance (Myers 1983).
struct Ancestry {
    parent: Vec<usize>,
    jump: Vec<usize>,
    depth: Vec<usize>,
}

impl Ancestry {
    fn new(panels: usize, root: usize) -> Self {
        Self { parent: vec![root; panels], jump: vec![root; panels], depth: vec![0; panels] }
    }

    /// Adds a panel below one that is there.
    fn add(&mut self, panel: usize, parent: usize) {
        let jump = self.jump[parent];
        let equal = self.depth[parent] - self.depth[jump] == self.depth[jump] - self.depth[self.jump[jump]];
        self.parent[panel] = parent;
        self.depth[panel] = self.depth[parent] + 1;
        self.jump[panel] = if equal { self.jump[jump] } else { parent };
    }

    fn common(&self, mut p: usize, mut q: usize) -> usize {
        while self.depth[p] != self.depth[q] {
            if self.depth[p] < self.depth[q] {
                (p, q) = (q, p);
            }
            let jump = self.jump[p];
            p = if self.depth[jump] >= self.depth[q] { jump } else { self.parent[p] };
        }
        while p != q {
            let (jump_p, jump_q) = (self.jump[p], self.jump[q]);
            (p, q) = if jump_p == jump_q { (self.parent[p], self.parent[q]) } else { (jump_p, jump_q) };
        }
        p
    }
}
