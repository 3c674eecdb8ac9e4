//! What a check found: the rules that are broken, where, and the figures of the plan.

use std::collections::BTreeMap;
use std::fmt;

/// The rules, by the names under which they are reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// A key is not there.
    Missing,
    /// An array has another length than it should.
    Count,
    /// An entry is not what its key holds.
    Shape,
    /// A fixed key has another value, or a plain key none that is possible.
    Head,
    /// An edge that its panel doesn't have.
    Edge,
    /// An edge that runs the wrong way in its panel.
    Orientation,
    /// One side of a panel carries two edges.
    OneHingeASide,
    /// The hinges are no tree through all panels.
    Tree,
    /// Panels share a vertex without a hinge.
    CutSurface,
    /// A panel is no unit square.
    UnitSquare,
    /// Two panels on one square with the same outer side.
    Overlap,
    /// Another number of panels at a lattice edge than 1, 2 or 4.
    LatticeEdge,
    /// A hinge between panels that don't bound the same side.
    Partner,
    /// A fold angle that is not that of the coordinates.
    FoldAngle,
    /// A letter that doesn't go with its angle.
    Assignment,
    /// A panel in no pile, or in two.
    Piles,
    /// Piles of unequal height.
    PileHeight,
    /// Two piles on a cell, or cells apart.
    Cells,
    /// A panel that doesn't lie on its cell, or with the wrong side up.
    FoldingMap,
    /// An order of layers that is not that of the piles.
    FaceOrders,
    /// A hinge entry that is about other panels than its edge.
    Hinge,
    /// A hinge on another side than the file says.
    Side,
    /// A fold hinge between panels that are not one above the other.
    Fold,
    /// A bridge between panels that are not side by side.
    Bridge,
    /// An opening angle that doesn't go with the fold angle.
    Opening,
    /// Bridges less breaks are not K - 1.
    BridgesBreaks,
    /// An expansion ratio that the boxes don't give.
    Ver,
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Missing => "missing",
            Self::Count => "count",
            Self::Shape => "shape",
            Self::Head => "head",
            Self::Edge => "edge",
            Self::Orientation => "orientation",
            Self::OneHingeASide => "one-hinge-a-side",
            Self::Tree => "tree",
            Self::CutSurface => "cut-surface",
            Self::UnitSquare => "unit-square",
            Self::Overlap => "overlap",
            Self::LatticeEdge => "lattice-edge",
            Self::Partner => "partner",
            Self::FoldAngle => "fold-angle",
            Self::Assignment => "assignment",
            Self::Piles => "piles",
            Self::PileHeight => "pile-height",
            Self::Cells => "cells",
            Self::FoldingMap => "folding-map",
            Self::FaceOrders => "face-orders",
            Self::Hinge => "hinge",
            Self::Side => "side",
            Self::Fold => "fold",
            Self::Bridge => "bridge",
            Self::Opening => "opening",
            Self::BridgesBreaks => "bridges-breaks",
            Self::Ver => "ver",
        })
    }
}

/// A rule broken at a place: key and index, and what is expected and found there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// Key and index.
    pub place: String,
    /// Expected and found.
    pub message: String,
}

/// What a plan amounts to; filled in as far as the check came.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figures {
    /// N.
    pub panels: usize,
    /// K.
    pub piles: usize,
    /// Panels in a pile.
    pub height: usize,
    /// Cells of the grid along x and y.
    pub grid: [i64; 2],
    /// Bridges.
    pub bridges: usize,
    /// Consecutive heights without a hinge.
    pub breaks: usize,
    /// Panels with three hinges or more.
    pub high_degree_panels: usize,
    /// Hinges that open by 90, 180 and 270 degrees.
    pub openings: [usize; 3],
    /// Package-volume expansion ratio.
    pub expansion_ratio: f64,
}

/// What a check found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    violations: BTreeMap<Rule, Vec<Violation>>,
    /// What the plan amounts to.
    pub figures: Figures,
}

impl Report {
    /// Whether no rule is broken.
    pub fn is_valid(&self) -> bool {
        self.violations.is_empty()
    }

    /// The broken rules, each with the places where it is.
    pub fn violations(&self) -> impl Iterator<Item = (Rule, &[Violation])> {
        self.violations.iter().map(|(rule, found)| (*rule, found.as_slice()))
    }

    /// The broken rules as lines for people, with the first few places of each.
    pub fn lines(&self, shown_per_rule: usize) -> Vec<String> {
        let mut lines = Vec::new();
        for (rule, found) in self.violations() {
            for Violation { place, message } in found.iter().take(shown_per_rule) {
                lines.push(format!("{rule}: {place}: {message}"));
            }
            if found.len() > shown_per_rule {
                lines.push(format!("{rule}: ... and {} more", found.len() - shown_per_rule));
            }
        }
        lines
    }

    pub(super) fn add(&mut self, rule: Rule, place: impl Into<String>, message: impl Into<String>) {
        let violation = Violation { place: place.into(), message: message.into() };
        self.violations.entry(rule).or_default().push(violation);
    }

    /// Notes a violation unless the condition holds; place and message are made only when needed.
    pub(super) fn require(&mut self, holds: bool, rule: Rule, told: impl FnOnce() -> (String, String)) {
        if !holds {
            let (place, message) = told();
            self.add(rule, place, message);
        }
    }
}
