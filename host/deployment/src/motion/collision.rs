//! A collision, named so that a person finds it: hinge, panels, angle, depth.

use std::fmt;

/// What a moving panel runs into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Obstacle {
    /// Another panel.
    Panel(usize),
    /// The ground.
    Ground,
}

/// Two cores that meet while a hinge opens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// The hinge that opens.
    pub hinge: usize,
    /// The panel that the hinge moves; where blocks meet, the one that goes deepest.
    pub panel: usize,
    /// What it meets.
    pub obstacle: Obstacle,
    /// The hinge has opened so far when they meet, degrees: not yet at `from_deg`, at `to_deg` at the latest. Where only any
    /// collision was asked for, an angle at which they are in each other.
    pub from_deg: f64,
    /// See `from_deg`.
    pub to_deg: f64,
    /// How deep they get in each other over the motion, panel lengths: the shortest way out, the most found at steps of a
    /// degree. 0 where they only come too near to tell.
    pub depth: f64,
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panel(panel) => write!(f, "panel {panel}"),
            Self::Ground => f.write_str("the ground"),
        }
    }
}

impl fmt::Display for Collision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { hinge, panel, obstacle, to_deg, depth, .. } = self;
        write!(
            f,
            "hinge {hinge}: panel {panel} meets {obstacle} at {to_deg:.1} degrees, {depth:.2e} panel lengths deep"
        )
    }
}
