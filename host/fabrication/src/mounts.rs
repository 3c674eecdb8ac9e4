//! The plan as the hands see it: which side of which panel gets which hinge.

use zygote_stacking::{Hinge, HingeKind, Plan, Side};

/// Where a hinge leads from a panel that lies in the stack.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Towards {
    /// To the next panel of the pile.
    Above,
    /// To the panel under it.
    Below,
    /// To a panel of the next pile: a bridge.
    Beside,
}

/// Which way a hinge is folded in the shape, seen on the outer side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fold {
    /// Outer sides come nearer.
    Valley,
    /// Outer sides turn away.
    Mountain,
    /// It stays in the plane.
    Flat,
}

/// A hinge on a side of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mount {
    /// Number of the hinge.
    pub hinge: usize,
    /// The panel at its other end.
    pub to: usize,
    /// Where that is.
    pub towards: Towards,
    /// How it is folded in the shape.
    pub fold: Fold,
    /// Opening angle in the shape, degrees.
    pub opening_deg: u16,
}

/// The hinges of a panel by side: E, N, W, S, as [`Side::ALL`].
pub type Mounts = [Option<Mount>; 4];

/// The hinges of every panel, by number.
pub fn mounts(plan: &Plan) -> Vec<Mounts> {
    let mut mounts = vec![Mounts::default(); plan.panels()];
    for (number, hinge) in plan.hinges.iter().enumerate() {
        let [a, b] = hinge.panels;
        let mount = |to, towards| Mount {
            hinge: number,
            to,
            towards,
            fold: Fold::of(hinge),
            opening_deg: hinge.opening_deg,
        };
        let (from_a, from_b, side_b) = match hinge.kind {
            HingeKind::Fold => (mount(b, Towards::Above), mount(a, Towards::Below), hinge.side),
            HingeKind::Bridge => {
                (mount(b, Towards::Beside), mount(a, Towards::Beside), hinge.side.opposite())
            }
        };
        mounts[a][hinge.side as usize] = Some(from_a);
        mounts[b][side_b as usize] = Some(from_b);
    }
    mounts
}

/// The mounts of a panel with their sides.
pub(crate) fn by_side(mounts: &Mounts) -> impl Iterator<Item = (Side, Mount)> + '_ {
    Side::ALL.into_iter().zip(mounts).filter_map(|(side, mount)| Some((side, (*mount)?)))
}

impl Fold {
    /// How a hinge is folded in the shape.
    pub fn of(hinge: &Hinge) -> Self {
        match hinge.target_angle_deg.signum() {
            1 => Self::Valley,
            -1 => Self::Mountain,
            _ => Self::Flat,
        }
    }

    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Valley => "valley",
            Self::Mountain => "mountain",
            Self::Flat => "flat",
        }
    }

    /// Its letter, as FOLD files have it.
    pub const fn letter(self) -> char {
        match self {
            Self::Valley => 'V',
            Self::Mountain => 'M',
            Self::Flat => 'F',
        }
    }
}

impl Towards {
    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Above => "above",
            Self::Below => "below",
            Self::Beside => "beside",
        }
    }
}
