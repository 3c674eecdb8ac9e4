//! What a viewer needs to place every panel of a plan at any time: joints as numbers, and when each hinge moves.
//! `docs/src/viewer.md` is the page for its JSON.

use crate::kinematics::Kinematics;
use crate::picture::{Timeline, TimelineError};
use glam::DAffine3;
use serde::Serialize;
use zygote_stacking::{HingeKind, Plan};

/// A pose: the columns of the rotation, then the translation.
pub type Pose = [f64; 12];

/// A plan in motion. Lengths are panel lengths, angles of turns radians.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Playback {
    /// File name of the model.
    pub model: String,
    /// How long a panel is.
    pub panel_length_mm: f64,
    /// Thickness of a layer.
    pub thickness: f64,
    /// Package volume of the target over that of the zygote.
    pub expansion_ratio: f64,
    /// The panel that stays fixed.
    pub root: usize,
    /// Its frame in the space of the zygote, which stands on z = 0.
    pub root_pose: Pose,
    /// From the space of the zygote to that of the target's coordinates, the root fixed.
    pub target_from_zygote: Pose,
    /// The piles, bottom up.
    pub piles: Vec<Column>,
    /// The hinges by their number.
    pub hinges: Vec<Joined>,
    /// The same as joints, each after that of its parent.
    pub joints: Vec<Turned>,
    /// Whether times are seconds of a schedule; else the hinges open in the order of the tree, one in one unit of time.
    pub scheduled: bool,
    /// When the last hinge is open.
    pub end: f64,
    /// Of every hinge when it starts and when it is open.
    pub spans: Vec<(f64, f64)>,
}

/// A pile.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Column {
    /// The cell (i, j), covering [i, i+1] x [j, j+1].
    pub cell: [i32; 2],
    /// Panel numbers from the bottom up.
    pub panels: Vec<usize>,
}

/// A hinge as the plan has it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Joined {
    /// `fold` or `bridge`.
    pub kind: &'static str,
    /// The two panels; of a fold the lower one first.
    pub panels: [usize; 2],
    /// The edge of each panel that carries it: edge `e` runs from corner `e` to corner `(e + 1) % 4`.
    pub edges: [usize; 2],
    /// The side of the first panel's cell.
    pub side: &'static str,
    /// Opening angle in the zygote, degrees.
    pub closed_deg: u16,
    /// Opening angle in the target, degrees.
    pub opening_deg: u16,
}

/// A hinge as a joint from the panel nearer to the root to the one that it moves.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Turned {
    /// Number of the hinge.
    pub hinge: usize,
    /// The panel nearer to the root.
    pub parent: usize,
    /// The panel that it moves, with all that hangs on it.
    pub child: usize,
    /// Where the child is in the parent's frame, in the zygote.
    pub parent_from_child: Pose,
    /// A point of the axis, in the parent's frame.
    pub anchor: [f64; 3],
    /// The axis, of length 1, in the parent's frame.
    pub axis: [f64; 3],
    /// Turn about the axis from the zygote to the target.
    pub turn: f64,
    /// Layers of the child above the parent, along the parent's outer normal; fades as the hinge opens.
    pub lift: f64,
}

impl Playback {
    /// The motion of a plan at the times of its schedule.
    ///
    /// # Errors
    /// [`TimelineError`] if the plan is no tree or its schedule isn't its own.
    pub fn of(plan: &Plan) -> Result<Self, TimelineError> {
        let kinematics = Kinematics::new(plan)?;
        let timeline = Timeline::new(plan)?;
        let joints = kinematics.joints().iter().map(|joint| Turned {
            hinge: joint.hinge,
            parent: joint.parent,
            child: joint.child,
            // At rest, without thickness.
            parent_from_child: numbers(joint.parent_from_child(0.0, 0.0)),
            anchor: joint.anchor().to_array(),
            axis: joint.axis().to_array(),
            turn: joint.turn,
            lift: joint.lift,
        });
        let hinges = plan.hinges.iter().map(|hinge| {
            let (kind, closed_deg) = match hinge.kind {
                HingeKind::Fold => ("fold", 0),
                HingeKind::Bridge => ("bridge", 180),
            };
            Joined {
                kind,
                panels: hinge.panels,
                edges: hinge.edges,
                side: hinge.side.letter(),
                closed_deg,
                opening_deg: hinge.opening_deg,
            }
        });
        let piles = plan.piles.iter().map(|pile| Column { cell: pile.cell, panels: pile.panels.clone() });
        Ok(Self {
            model: plan.source.model.clone(),
            panel_length_mm: plan.panel_length_mm,
            thickness: plan.thickness,
            expansion_ratio: plan.expansion_ratio(),
            root: plan.root,
            root_pose: numbers(kinematics.root_pose(plan.thickness)),
            target_from_zygote: numbers(kinematics.target_from_zygote()),
            piles: piles.collect(),
            hinges: hinges.collect(),
            joints: joints.collect(),
            scheduled: plan.schedule.is_some(),
            end: timeline.end(),
            spans: (0..plan.hinges.len()).filter_map(|hinge| timeline.span(hinge)).collect(),
        })
    }
}

fn numbers(pose: DAffine3) -> Pose {
    // A plan's squares stand on whole numbers; -0.0 would only make the file longer.
    pose.to_cols_array().map(|number| number + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::frame;
    use crate::testing::real_plans;
    use glam::DVec3;
    use serde_json::json;
    use std::path::Path;

    /// Plans, and where their panels are at some times, for the tests of the page, which has kinematics of its own.
    fn poses() -> String {
        let plans = real_plans().into_iter().map(|plan| {
            let kinematics = Kinematics::new(&plan).expect("a tree");
            let timeline = Timeline::new(&plan).expect("a timeline");
            let moments = [0.0, 0.31, 0.5, 0.77, 1.0].map(|share| {
                let fractions = timeline.fractions(share * timeline.end());
                let frames = kinematics.corners(&fractions, plan.thickness).into_iter().map(|corners| {
                    // Far below what matters, far above what differs between two ways to the same number.
                    numbers(frame(&corners)).map(|number| (number * 1e9).round() / 1e9 + 0.0)
                });
                json!({ "share": share, "frames": frames.collect::<Vec<_>>() })
            });
            json!({ "playback": Playback::of(&plan).expect("in motion"), "moments": moments })
        });
        serde_json::to_string(&plans.collect::<Vec<_>>()).expect("JSON") + "\n"
    }

    #[test]
    fn the_page_is_tested_against_the_poses_of_these_kinematics() {
        let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("../viewer/tests/poses.json");
        let poses = poses();
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&golden, &poses).expect("written");
        }
        let found = std::fs::read_to_string(&golden).expect("the golden file is there");
        assert!(found == poses, "{} is out of date: run this test with UPDATE_GOLDEN=1", golden.display());
    }

    #[test]
    fn joints_come_after_those_of_their_parents() {
        for plan in real_plans() {
            let playback = Playback::of(&plan).expect("in motion");
            let mut placed = vec![false; plan.panels()];
            placed[playback.root] = true;
            for joint in &playback.joints {
                assert!(placed[joint.parent]);
                assert!(!std::mem::replace(&mut placed[joint.child], true));
                assert!((DVec3::from_array(joint.axis).length() - 1.0).abs() < 1e-12);
            }
            assert!(placed.iter().all(|placed| *placed));
        }
    }
}
