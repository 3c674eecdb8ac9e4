//! The run in space: panels in frames that hang on each other, moved by what is known of the hinges, and the hinges under way in the colour
//! of their temperature.
//!
//! The recorder asks for the first picture once, then shows every record; what didn't change gives no message.

use crate::primitive::{
    Colour, Cube, Deletion, Entity, FrameTransforms, KeyValue, Line, Pose, SceneUpdate, Transform,
};
use crate::stamp::Stamp;
use std::collections::{BTreeMap, BTreeSet};
use zygote_controller::{MotionState, Record};
use zygote_deployment::scene::{Frames, Link};
use zygote_deployment::{Schedule, TreeError};
use zygote_stacking::{HingeKind, Plan};

/// The frame in which the zygote stands on z = 0; a panel's edge is 1 m there.
const SPACE: &str = "zygote";
/// A hinge is drawn anew when it has turned so far, degrees.
const LEAST_TURN_DEG: f64 = 0.5;
/// Its colour changes in steps so wide, °C.
const COLOUR_STEP_C: f64 = 10.0;
/// Temperatures between which a hinge's colour goes from blue to red, °C.
const COLD_C: f64 = 20.0;
const HOT_C: f64 = 140.0;
/// From the edge of the panel to that of its plate, panel lengths.
const GAP: f64 = 0.012;
/// Thickness of a hinge's line, panel lengths.
const LINE: f64 = 0.06;
/// A plate is at least so thick, panel lengths, so that it has sides.
const LEAST_THICKNESS: f64 = 2e-3;

/// A hinge's way, in degrees of opening.
#[derive(Debug, Clone, Copy)]
struct Way {
    zygote: f64,
    target: f64,
    /// Where its step ends.
    end: f64,
    /// Where it is drawn.
    drawn: f64,
}

impl Way {
    fn fraction(self) -> f64 {
        let way = self.target - self.zygote;
        if way == 0.0 { 0.0 } else { (self.drawn - self.zygote) / way }
    }
}

/// The scene of a run.
pub(crate) struct Scene {
    frames: Frames,
    plate: f64,
    ways: Vec<Way>,
    /// Hinges under way as they were drawn last: phase, and step of colour.
    drawn: BTreeMap<usize, (&'static str, Option<i64>)>,
}

impl Scene {
    pub(crate) fn new(plan: &Plan, schedule: &Schedule, open: &BTreeSet<usize>) -> Result<Self, TreeError> {
        let mut ways: Vec<_> = plan
            .hinges
            .iter()
            .map(|hinge| {
                let zygote = match hinge.kind {
                    HingeKind::Fold => 0.0,
                    HingeKind::Bridge => 180.0,
                };
                let target = f64::from(hinge.opening_deg);
                Way { zygote, target, end: target, drawn: zygote }
            })
            .collect();
        for step in &schedule.steps {
            let Some(way) = ways.get_mut(step.hinge) else { continue };
            let (from, to) = (f64::from(step.from_opening_deg), f64::from(step.opening_deg));
            way.end = to;
            way.drawn = if open.contains(&step.hinge) { to } else { from };
        }
        let plate = plan.thickness.max(LEAST_THICKNESS);
        Ok(Self { frames: Frames::new(plan)?, plate, ways, drawn: BTreeMap::new() })
    }

    /// Every panel, in its frame.
    pub(crate) fn panels(&self, at: Stamp) -> SceneUpdate {
        let side = 1.0 - 2.0 * GAP;
        let entities = (0..self.frames.panels())
            .map(|panel| Entity {
                cubes: vec![Cube {
                    pose: self.frames.middle(panel).into(),
                    size: [side, side, self.plate].into(),
                    color: Colour::opaque(self.frames.colour(panel)),
                }],
                metadata: vec![KeyValue { key: "panel", value: panel.to_string() }],
                ..Entity::new(at, frame_of(panel), frame_of(panel))
            })
            .collect();
        SceneUpdate { deletions: Vec::new(), entities }
    }

    /// Every frame, where its hinge is now.
    pub(crate) fn frames(&self, at: Stamp) -> FrameTransforms {
        let (root, pose) = self.frames.root();
        let root = Transform {
            timestamp: at,
            parent_frame_id: SPACE.to_owned(),
            child_frame_id: frame_of(root),
            translation: pose.translation.into(),
            rotation: pose.rotation.into(),
        };
        let hinges = (0..self.ways.len()).filter_map(|hinge| self.transform(at, hinge));
        FrameTransforms { transforms: std::iter::once(root).chain(hinges).collect() }
    }

    fn transform(&self, at: Stamp, hinge: usize) -> Option<Transform> {
        let Link { parent, child, pose } = self.frames.link(hinge, self.ways.get(hinge)?.fraction())?;
        Some(Transform {
            timestamp: at,
            parent_frame_id: frame_of(parent),
            child_frame_id: frame_of(child),
            translation: pose.translation.into(),
            rotation: pose.rotation.into(),
        })
    }

    /// The frames that a record moves. A hinge that starts is told again where it stands: whoever draws lines between two places should
    /// not let it creep there all the time before.
    pub(crate) fn moved(&mut self, at: Stamp, record: &Record) -> Option<FrameTransforms> {
        let hinges: Vec<usize> = match record {
            Record::Started { hinge, .. } => vec![*hinge],
            Record::Opened { hinge, .. } => {
                let way = self.ways.get_mut(*hinge)?;
                way.drawn = way.end;
                vec![*hinge]
            }
            Record::Telemetry { motions, .. } => {
                motions.iter().filter_map(|motion| self.turned(motion)).collect()
            }
            _ => Vec::new(),
        };
        let transforms: Vec<_> = hinges.into_iter().filter_map(|hinge| self.transform(at, hinge)).collect();
        (!transforms.is_empty()).then_some(FrameTransforms { transforms })
    }

    /// The hinge, if it has turned far enough to be drawn anew.
    fn turned(&mut self, motion: &MotionState) -> Option<usize> {
        let opening_deg = motion.opening_deg?;
        let way = self.ways.get_mut(motion.hinge)?;
        if (opening_deg - way.drawn).abs() < LEAST_TURN_DEG {
            return None;
        }
        way.drawn = opening_deg;
        Some(motion.hinge)
    }

    /// The hinges under way, if they look otherwise than before.
    pub(crate) fn hinges(&mut self, at: Stamp, record: &Record) -> Option<SceneUpdate> {
        let Record::Telemetry { motions, .. } = record else { return None };
        let now: BTreeMap<_, _> =
            motions.iter().map(|motion| (motion.hinge, (motion.phase, colour_step(motion)))).collect();
        if now == self.drawn {
            return None;
        }
        self.drawn = now;
        let entities = motions.iter().filter_map(|motion| self.line(at, motion)).collect();
        Some(SceneUpdate { deletions: vec![Deletion { timestamp: at, r#type: 1, id: "" }], entities })
    }

    /// A hinge under way as a line: in the frame of the panel that it moves it lies along x.
    fn line(&self, at: Stamp, motion: &MotionState) -> Option<Entity> {
        let link = self.frames.link(motion.hinge, 0.0)?;
        let warmth =
            motion.temperature_c.map(|celsius| ((celsius - COLD_C) / (HOT_C - COLD_C)).clamp(0.0, 1.0));
        let colour = warmth.map_or([0.95, 0.75, 0.1], |warmth| [warmth, 0.15, 1.0 - warmth]);
        let line = Line {
            r#type: 0,
            pose: Pose::identity(),
            thickness: LINE,
            scale_invariant: false,
            points: vec![[0.0; 3].into(), [1.0, 0.0, 0.0].into()],
            color: Colour::opaque(colour),
            colors: [],
            indices: [],
        };
        let metadata = vec![KeyValue { key: "phase", value: motion.phase.to_owned() }];
        let id = format!("hinge {}", motion.hinge);
        Some(Entity { lines: vec![line], metadata, ..Entity::new(at, frame_of(link.child), id) })
    }
}

fn frame_of(panel: usize) -> String {
    format!("panel {panel}")
}

#[expect(clippy::cast_possible_truncation, reason = "degrees Celsius of a hinge")]
fn colour_step(motion: &MotionState) -> Option<i64> {
    motion.temperature_c.map(|celsius| (celsius / COLOUR_STEP_C).round() as i64)
}
