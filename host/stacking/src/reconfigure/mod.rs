//! From one plan to another on the same stack of panels: which hinges stay, move, open otherwise, come off or are added.
//! `zygote reconfigure` prints it.
//!
//! Panels are alike, so only the places of hinges count. The stack may be turned as a whole by quarter turns, and where
//! piles have an even number of panels upside down too, which keeps outer sides up at even heights; of all ways that bring
//! its piles to the cells of the other plan the one is taken in which fewest hinges change place, then fewest their angle.

mod like;
mod motion;
mod pieces;

pub use like::{Like, LikeError, plan_like};
pub use motion::Motion;

use crate::plan::{HingeKind, Plan, Side};
use crate::sequence::Mounted;
use std::collections::{BTreeMap, BTreeSet};

/// Plans that aren't on the same stack.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReconfigureError {
    /// Another number of panels.
    #[error("{first} panels in the first plan and {second} in the second, expected as many")]
    Panels {
        /// In the first plan.
        first: usize,
        /// In the second one.
        second: usize,
    },
    /// Another number of piles.
    #[error("{first} piles in the first plan and {second} in the second, expected as many")]
    Piles {
        /// In the first plan.
        first: usize,
        /// In the second one.
        second: usize,
    },
    /// Cells that lie otherwise.
    #[error("no turn brings the cells {first} of the first plan to the cells {second} of the second")]
    Cells {
        /// Of the first plan.
        first: String,
        /// Of the second one.
        second: String,
    },
}

/// Where a hinge is, but for its side: over a height of a pile, or between two piles at a height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Slot {
    /// The cell; of a bridge the one that it leaves by its side E or N.
    pub cell: [i32; 2],
    /// The height; of a fold the lower one.
    pub height: usize,
    /// Fold or bridge.
    pub kind: SlotKind,
}

/// What kind of place it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SlotKind {
    /// Between two consecutive heights: a hinge on any side.
    Fold,
    /// Between two piles, across this side.
    Bridge(Side),
}

/// What happens to the hinge of a slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Action {
    /// Nothing.
    Keep(Mounted),
    /// It stays where it is and opens by another angle.
    Turn {
        /// As it was.
        from: Mounted,
        /// As it will be.
        to: Mounted,
    },
    /// It goes to another side of the same two panels, and may open by another angle there.
    Move {
        /// As it was.
        from: Mounted,
        /// As it will be.
        to: Mounted,
    },
    /// It comes off: nothing joins these two panels in the second plan. As many are added elsewhere.
    Remove(Mounted),
    /// A hinge where none was.
    Add(Mounted),
}

/// How many hinges each action is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord)]
pub struct Counts {
    /// To another side.
    pub moved: usize,
    /// Come off; as many are added.
    pub removed: usize,
    /// Added.
    pub added: usize,
    /// Another angle only.
    pub turned: usize,
    /// Nothing to do.
    pub kept: usize,
}

impl Counts {
    /// What to compare ways by: hinges that change place, then those that change their angle.
    pub fn effort(&self) -> (usize, usize) {
        (self.moved + self.removed, self.turned)
    }
}

/// The way from one plan to another.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reconfiguration {
    /// How the first stack is turned before anything else.
    pub motion: Motion,
    /// What to do, by cell, height and kind; cells and sides are those of the second plan.
    pub actions: Vec<(Slot, Action)>,
    /// The sums.
    pub counts: Counts,
}

impl Reconfiguration {
    /// The way from plan `first` to plan `second`.
    ///
    /// # Errors
    /// Plans with unlike numbers of panels or piles, or cells that no turn brings together.
    pub fn between(first: &Plan, second: &Plan) -> Result<Self, ReconfigureError> {
        if first.panels() != second.panels() {
            return Err(ReconfigureError::Panels { first: first.panels(), second: second.panels() });
        }
        if first.piles.len() != second.piles.len() {
            return Err(ReconfigureError::Piles { first: first.piles.len(), second: second.piles.len() });
        }
        let there = slots(second, &Motion::NONE);
        let ways = Motion::all(first, second)
            .into_iter()
            .map(|motion| compare(motion, &slots(first, &motion), &there));
        // The first of the best: turned least, and not upside down where that is as good.
        let best = ways.min_by_key(|way| way.counts.effort());
        best.ok_or_else(|| ReconfigureError::Cells { first: cells(first), second: cells(second) })
    }
}

/// The hinges of a plan by their slots, after a motion of the whole stack.
fn slots(plan: &Plan, motion: &Motion) -> BTreeMap<Slot, Mounted> {
    let places = plan.places();
    let hinges = plan.hinges.iter().map(|hinge| {
        let [(pile, height), (other, other_height)] = hinge.panels.map(|panel| places[panel]);
        let (cell, across) = (motion.cell(plan.piles[pile].cell), motion.cell(plan.piles[other].cell));
        let side = motion.side(hinge.side);
        let height = motion.height(height).min(motion.height(other_height));
        let (cell, side, kind) = match hinge.kind {
            HingeKind::Fold => (cell, side, SlotKind::Fold),
            HingeKind::Bridge if side < Side::W => (cell, side, SlotKind::Bridge(side)),
            HingeKind::Bridge => (across, side.opposite(), SlotKind::Bridge(side.opposite())),
        };
        (Slot { cell, height, kind }, Mounted { side, opening_deg: hinge.opening_deg })
    });
    hinges.collect()
}

/// The hinges of a stack by their slots, the same however the stack is turned. Which panel stays fixed doesn't count.
pub(crate) fn regardless_of_turns(plan: &Plan) -> Vec<(Slot, Mounted)> {
    let turned = Motion::to_corner(plan, [0, 0]).map(|motion| slots(plan, &motion).into_iter().collect());
    turned.min().unwrap_or_default()
}

fn compare(
    motion: Motion,
    here: &BTreeMap<Slot, Mounted>,
    there: &BTreeMap<Slot, Mounted>,
) -> Reconfiguration {
    let all: BTreeSet<&Slot> = here.keys().chain(there.keys()).collect();
    let mut counts = Counts::default();
    let action = |slot: &Slot| {
        Some(match (here.get(slot).copied(), there.get(slot).copied()) {
            (Some(from), Some(to)) if from == to => Action::Keep(to),
            (Some(from), Some(to)) if from.side == to.side => Action::Turn { from, to },
            (Some(from), Some(to)) => Action::Move { from, to },
            (Some(from), None) => Action::Remove(from),
            (None, Some(to)) => Action::Add(to),
            (None, None) => return None,
        })
    };
    let actions: Vec<(Slot, Action)> =
        all.into_iter().filter_map(|slot| Some((*slot, action(slot)?))).collect();
    for (_, action) in &actions {
        *match action {
            Action::Keep(_) => &mut counts.kept,
            Action::Turn { .. } => &mut counts.turned,
            Action::Move { .. } => &mut counts.moved,
            Action::Remove(_) => &mut counts.removed,
            Action::Add(_) => &mut counts.added,
        } += 1;
    }
    Reconfiguration { motion, actions, counts }
}

/// The cells for a message: the first few.
fn cells(plan: &Plan) -> String {
    const SHOWN: usize = 8;
    let mut cells: Vec<[i32; 2]> = plan.piles.iter().map(|pile| pile.cell).collect();
    cells.sort_unstable();
    let mut list: Vec<String> = cells.iter().take(SHOWN).map(|[i, j]| format!("({i},{j})")).collect();
    if cells.len() > SHOWN {
        list.push(format!("and {} more", cells.len() - SHOWN));
    }
    list.join(" ")
}
