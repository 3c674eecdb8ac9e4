//! Moves hinges from sample to sample, and compares the boxes that move with all others.

use super::plates::{Layer, Plates};
use super::slab::Slab;
use super::{LOOKED_FOR, Meeting, Other, Setting, Verdict};
use glam::{DAffine3, DVec3};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::BTreeMap;

/// Boxes further apart than this have no gap below [`LOOKED_FOR`] along any of the directions compared: from corner to
/// corner the best of them shows a third of the square, at least.
const NEAR: f64 = 2.0 * LOOKED_FOR;

/// A hinge that moves, and from which fraction of its turn to which.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moving {
    pub(super) joint: usize,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// Consecutive layers of a pile that lie on each other.
struct Run<'a> {
    layers: &'a [Layer],
    /// Where they are in the zygote.
    cell: [f64; 2],
    height: usize,
    zygote: Slab,
    /// Which of the hinges in motion moves them: the nearest one.
    mover: Option<usize>,
}

/// The panels on their way.
pub(super) struct Sampler<'a> {
    plates: &'a Plates,
    /// Normal and offset.
    ground: Option<(DVec3, f64)>,
    step: f64,
    /// Whether every pair is compared, not only those near each other.
    every_pair: bool,
    /// Deeper is a collision, less is rounding.
    touching: f64,
    /// Of every joint.
    fractions: Vec<f64>,
    /// Of every panel, from its place in the zygote.
    motions: Vec<DAffine3>,
    meetings: BTreeMap<(bool, usize, usize, Other), Meeting>,
    clearance: f64,
    samples: u64,
    pairs: u64,
}

/// Gaps of one pair over a phase.
struct Gaps {
    least: f64,
    touch_at_an_end: bool,
}

impl<'a> Sampler<'a> {
    pub(super) fn new(plates: &'a Plates, setting: &Setting, every_pair: bool) -> Self {
        let panels = plates.joint_of.len() + 1;
        let mut sampler = Self {
            plates,
            ground: None,
            step: setting.step_deg.to_radians(),
            every_pair,
            touching: (plates.thickness * 1e-4).max(1e-9),
            fractions: vec![0.0; panels - 1],
            motions: vec![DAffine3::IDENTITY; panels],
            meetings: BTreeMap::new(),
            clearance: LOOKED_FOR,
            samples: 0,
            pairs: 0,
        };
        // The ground is under the whole of the plates, not their cores.
        sampler.ground = setting.ground.map(|normal| {
            let normal = DVec3::from_array(normal).normalize();
            let lowest = plates
                .piles
                .iter()
                .map(|(cell, layers)| core(*cell, 0, layers.len(), plates.thickness, 0.0).lowest(normal));
            (normal, lowest.fold(f64::INFINITY, f64::min))
        });
        sampler
    }

    pub(super) fn plates(&self) -> &'a Plates {
        self.plates
    }

    pub(super) fn close_all(&mut self) {
        self.fractions.fill(0.0);
        self.motions.fill(DAffine3::IDENTITY);
    }

    pub(super) fn verdict(self) -> Verdict {
        let meetings: Vec<_> = self.meetings.into_values().collect();
        let clearance = if meetings.iter().any(|meeting| !meeting.at_once) { 0.0 } else { self.clearance };
        Verdict { meetings, clearance, samples: self.samples, pairs: self.pairs }
    }

    /// Moves hinges evenly, all in the same time, and looks at every sample, ends included.
    pub(super) fn phase(&mut self, moving: &[Moving], at_once: bool) {
        let plates = self.plates;
        let mut moving = moving.to_vec();
        // Parents first, so that a hinge on a branch in motion is placed last.
        moving.sort_unstable_by_key(|one| one.joint);
        let widest = moving.iter().map(|one| plates.joint(one.joint).turn * (one.to - one.from));
        let widest = widest.fold(0.0, f64::max);
        if widest == 0.0 {
            self.place(&moving, 1.0);
            return;
        }
        let samples = (widest / self.step).ceil().max(1.0);
        let (runs, still) = self.runs(&moving);
        let stills: Vec<_> =
            still.iter().map(|run| run.zygote.moved(&self.motions[run.layers[0].panel])).collect();
        let near = (!self.every_pair).then(|| self.near(&moving, &runs, &stills));
        let mut gaps: BTreeMap<(usize, usize), Gaps> = BTreeMap::new();
        let mut sample = 0.0;
        while sample <= samples {
            self.place(&moving, sample / samples);
            self.samples += 1;
            let boxes: Vec<_> =
                runs.iter().map(|run| run.zygote.moved(&self.motions[run.layers[0].panel])).collect();
            let at_an_end = sample <= 0.0 || sample >= samples;
            for (number, (run, slab)) in runs.iter().zip(&boxes).enumerate() {
                self.against_ground(run, slab, &moving, at_once);
                let mut compare = |sampler: &mut Self, key: usize, other_run: &Run, other: &Slab| {
                    if slab.centre.distance(other.centre) > slab.radius + other.radius + LOOKED_FOR {
                        return;
                    }
                    sampler.pairs += 1;
                    let gap = slab.gap(other);
                    if gap < -sampler.touching {
                        sampler.meet(run, other_run, &moving, -gap, at_once);
                    }
                    if !at_once && gap < LOOKED_FOR {
                        let seen = gaps
                            .entry((number, key))
                            .or_insert(Gaps { least: LOOKED_FOR, touch_at_an_end: false });
                        seen.least = seen.least.min(gap);
                        seen.touch_at_an_end |= at_an_end && gap <= sampler.touching;
                    }
                };
                if let Some(near) = &near {
                    let [low, high] = slab.bounds();
                    let reach = AABB::from_corners(low.map(|low| low - NEAR), high.map(|high| high + NEAR));
                    for found in near.locate_in_envelope_intersecting(reach) {
                        compare(self, found.data, &still[found.data], &stills[found.data]);
                    }
                } else {
                    for (key, (other_run, other)) in still.iter().zip(&stills).enumerate() {
                        compare(self, key, other_run, other);
                    }
                }
                for (key, (other_run, other)) in runs.iter().zip(&boxes).enumerate().skip(number + 1) {
                    if run.mover != other_run.mover {
                        compare(self, still.len() + key, other_run, other);
                    }
                }
            }
            sample += 1.0;
        }
        let clear = gaps.values().filter(|seen| !seen.touch_at_an_end).map(|seen| seen.least);
        self.clearance = clear.fold(self.clearance, f64::min).max(0.0);
    }

    /// Puts all that moves where it is at a fraction of the phase.
    fn place(&mut self, moving: &[Moving], fraction: f64) {
        for one in moving {
            self.fractions[one.joint] =
                if fraction >= 1.0 { one.to } else { one.from + (one.to - one.from) * fraction };
        }
        for one in moving {
            for (place, joint) in (one.joint..).zip(self.plates.branch(one.joint)) {
                joint.place(self.fractions[place], &mut self.motions);
            }
        }
    }

    /// The boxes that move, and those that stand still.
    fn runs(&self, moving: &[Moving]) -> (Vec<Run<'a>>, Vec<Run<'a>>) {
        let mut mover = vec![None; self.motions.len()];
        let mut turns = vec![false; self.fractions.len()];
        for (number, one) in moving.iter().enumerate() {
            turns[one.joint] = true;
            for joint in self.plates.branch(one.joint) {
                mover[joint.child] = Some(number);
            }
        }
        let closed = |hinge: usize| {
            let joint = self.plates.joint_of[hinge];
            self.fractions[joint] == 0.0 && !turns[joint]
        };
        let (mut runs, mut still) = (Vec::new(), Vec::new());
        for (cell, layers) in &self.plates.piles {
            let mut height = 0;
            for run in layers.chunk_by(|below, _| below.fold.is_some_and(closed)) {
                let zygote = core(*cell, height, run.len(), self.plates.thickness, self.plates.rim);
                let mover = mover[run[0].panel];
                let run = Run { layers: run, cell: *cell, height, zygote, mover };
                height += run.layers.len();
                if mover.is_some() { runs.push(run) } else { still.push(run) }
            }
        }
        (runs, still)
    }

    /// The boxes that stand still where those that move can reach them.
    fn near(
        &self,
        moving: &[Moving],
        runs: &[Run],
        stills: &[Slab],
    ) -> RTree<GeomWithData<Rectangle<[f64; 3]>, usize>> {
        // In a turn distances to a point of the axis stay; where that point moves too, nothing is known.
        let balls: Vec<_> = moving
            .iter()
            .enumerate()
            .map(|(number, one)| {
                let joint = self.plates.joint(one.joint);
                let centre = self.motions[joint.parent].transform_point3(joint.anchor);
                let nested = moving
                    .iter()
                    .any(|other| self.plates.branch(other.joint).iter().any(|j| j.child == joint.parent));
                let of_it = runs.iter().filter(|run| run.mover == Some(number));
                let farthest = of_it.map(|run| {
                    let slab = run.zygote.moved(&self.motions[run.layers[0].panel]);
                    slab.centre.distance(centre) + slab.radius
                });
                let stretch = 2.0 * joint.stretch.length();
                let reach = if nested { f64::INFINITY } else { farthest.fold(0.0, f64::max) + stretch };
                (centre, reach + NEAR)
            })
            .collect();
        let reached = |slab: &Slab| {
            balls.iter().any(|(centre, reach)| slab.centre.distance(*centre) <= reach + slab.radius)
        };
        let boxes = stills.iter().enumerate().filter(|(_, slab)| reached(slab)).map(|(number, slab)| {
            let [low, high] = slab.bounds();
            GeomWithData::new(Rectangle::from_corners(low, high), number)
        });
        RTree::bulk_load(boxes.collect())
    }

    fn against_ground(&mut self, run: &Run, slab: &Slab, moving: &[Moving], at_once: bool) {
        let Some((normal, offset)) = self.ground else { return };
        if slab.lowest(normal) >= offset - self.touching {
            return;
        }
        let deepest = (0..run.layers.len())
            .map(|layer| (offset - self.layer(run, layer).lowest(normal), layer))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((depth, layer)) = deepest {
            self.note(run, layer, Other::Ground, moving, depth, at_once);
        }
    }

    /// Two boxes are in each other: says which panels.
    fn meet(&mut self, run: &Run, other: &Run, moving: &[Moving], depth: f64, at_once: bool) {
        let whole = other.zygote.moved(&self.motions[other.layers[0].panel]);
        let deepest = |gaps: &mut dyn Iterator<Item = f64>| {
            gaps.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(layer, _)| layer)
        };
        let ours = deepest(&mut (0..run.layers.len()).map(|layer| self.layer(run, layer).gap(&whole)));
        let slab = self.layer(run, ours);
        let theirs = deepest(&mut (0..other.layers.len()).map(|layer| slab.gap(&self.layer(other, layer))));
        self.note(run, ours, Other::Panel(other.layers[theirs].panel), moving, depth, at_once);
    }

    fn note(&mut self, run: &Run, layer: usize, other: Other, moving: &[Moving], depth: f64, at_once: bool) {
        let Some(mover) = run.mover.map(|number| moving[number].joint) else { return };
        let (joint, panel) = (self.plates.joint(mover), run.layers[layer].panel);
        let angle_deg = (joint.turn * self.fractions[mover]).to_degrees();
        let hinge = joint.hinge;
        let meeting = self.meetings.entry((at_once, hinge, panel, other)).or_insert(Meeting {
            hinge,
            panel,
            other,
            angle_deg,
            depth,
            at_once,
        });
        meeting.depth = meeting.depth.max(depth);
    }

    /// One layer of a run, in space.
    fn layer(&self, run: &Run, layer: usize) -> Slab {
        core(run.cell, run.height + layer, 1, self.plates.thickness, self.plates.rim)
            .moved(&self.motions[run.layers[0].panel])
    }
}

/// The box of the cores of some layers in the zygote.
fn core([x, y]: [f64; 2], height: usize, layers: usize, thickness: f64, rim: f64) -> Slab {
    let (low, high) = (height as f64 * thickness, (height + layers) as f64 * thickness);
    Slab::between(DVec3::new(x + rim, y + rim, low), DVec3::new(x + 1.0 - rim, y + 1.0 - rim, high))
}
