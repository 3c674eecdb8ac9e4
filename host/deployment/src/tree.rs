//! The tree of a plan seen from its root: which hinge comes before which, and the order of opening one by one.

use zygote_stacking::{Hinge, HingeKind, Plan};

/// A plan whose hinges don't join its panels to one tree.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TreeError {
    /// The root is no panel.
    #[error("plan: the root must be one of the {panels} panels, found {root}")]
    NoRoot {
        /// The root in the plan.
        root: usize,
        /// Panels in the plan.
        panels: usize,
    },
    /// A hinge names a panel that doesn't exist.
    #[error("plan: hinge {hinge} must join two of the {panels} panels, found {found}")]
    NoPanel {
        /// Number of the hinge.
        hinge: usize,
        /// What it names.
        found: usize,
        /// Panels in the plan.
        panels: usize,
    },
    /// Too many or too few hinges.
    #[error("plan: {panels} panels need {} hinges, found {hinges}", panels - 1)]
    Count {
        /// Panels in the plan.
        panels: usize,
        /// Hinges in the plan.
        hinges: usize,
    },
    /// A panel that the root doesn't reach.
    #[error("plan: the hinges join panel {panel} to the root {root} in no way")]
    Unreached {
        /// Number of the panel.
        panel: usize,
        /// The root.
        root: usize,
    },
}

/// A hinge seen from the root.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Branch {
    /// Number of the hinge.
    pub hinge: usize,
    /// The panel nearer to the root.
    pub parent: usize,
    /// The panel that the hinge moves, with all that hangs on it.
    pub child: usize,
    /// The hinge that moves the parent; `None` where the parent is the root.
    pub before: Option<usize>,
}

/// The tree path of a plan, rooted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tree {
    branches: Vec<Branch>,
}

impl Tree {
    /// The tree of a plan.
    ///
    /// # Errors
    /// [`TreeError`] if the hinges of the plan aren't a tree of all its panels.
    pub fn new(plan: &Plan) -> Result<Self, TreeError> {
        let panels = plan.target.len();
        if plan.root >= panels {
            return Err(TreeError::NoRoot { root: plan.root, panels });
        }
        if plan.hinges.len() + 1 != panels {
            return Err(TreeError::Count { panels, hinges: plan.hinges.len() });
        }
        let mut at_panel = vec![Vec::new(); panels];
        for (number, hinge) in plan.hinges.iter().enumerate() {
            for [panel, other] in [hinge.panels, [hinge.panels[1], hinge.panels[0]]] {
                let hinges = at_panel.get_mut(panel).ok_or(TreeError::NoPanel {
                    hinge: number,
                    found: panel,
                    panels,
                })?;
                hinges.push((number, other));
            }
        }
        let mut branches = Vec::with_capacity(plan.hinges.len());
        let mut reached = vec![false; panels];
        reached[plan.root] = true;
        let mut open = vec![];
        push_children(&mut open, plan, &at_panel, plan.root, None);
        while let Some(branch) = open.pop() {
            if std::mem::replace(&mut reached[branch.child], true) {
                continue;
            }
            branches.push(branch);
            push_children(&mut open, plan, &at_panel, branch.child, Some(branch.hinge));
        }
        match reached.iter().position(|reached| !reached) {
            Some(panel) => Err(TreeError::Unreached { panel, root: plan.root }),
            None => Ok(Self { branches }),
        }
    }

    /// The hinges in the order in which they are opened one by one: from the root out, each after the hinge
    /// before it, and strip by strip.
    ///
    /// Depth first, since a strip whose rest lies on one cell opens without a collision in the ideal, while
    /// half-opened strips side by side come in each other's way. At a panel with several hinges the strip
    /// above goes first, then the strip below, and bridges last: a bridge swings another pile as a whole,
    /// which needs room that the layers of this pile must first make.
    pub fn branches(&self) -> &[Branch] {
        &self.branches
    }
}

/// Pushes the hinges of `panel` so that the first to be opened is popped first.
fn push_children(
    open: &mut Vec<Branch>,
    plan: &Plan,
    at_panel: &[Vec<(usize, usize)>],
    panel: usize,
    before: Option<usize>,
) {
    let first = open.len();
    let others = at_panel[panel].iter().filter(|(hinge, _)| Some(*hinge) != before);
    open.extend(others.map(|&(hinge, child)| Branch { hinge, parent: panel, child, before }));
    open[first..]
        .sort_by_key(|branch| std::cmp::Reverse((rank(&plan.hinges[branch.hinge], panel), branch.hinge)));
}

/// See [`Tree::branches`].
fn rank(hinge: &Hinge, parent: usize) -> u8 {
    match hinge.kind {
        HingeKind::Fold if hinge.panels[0] == parent => 0,
        HingeKind::Fold => 1,
        HingeKind::Bridge => 2,
    }
}
