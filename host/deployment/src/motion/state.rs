//! A motion under way: which hinges are open, where every panel is, and what would happen if one more opened.

use super::apart::{Conflict, Pair, Wanted};
use super::block::{self, Block};
use super::collision::{Collision, Obstacle};
use super::cuboid::Cuboid;
use super::ground::{Ground, Plane};
use super::linkage::Linkage;
use super::near::{self, LOOKED_FOR};
use super::thickness::{MotionError, Thickness};
use super::turning::{Body, Turn};
use super::{FINEST, TOUCHING};
use glam::DAffine3;
use std::sync::Arc;
use zygote_stacking::Plan;

/// The panels of a plan while they move. Cheap to clone: what doesn't move is shared.
#[derive(Debug, Clone)]
pub struct Motion {
    linkage: Arc<Linkage>,
    ground: Option<Plane>,
    open: Vec<bool>,
    poses: Vec<DAffine3>,
}

/// What was looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tally {
    pub(super) panel_pairs: u64,
    pub(super) box_pairs: u64,
    pub(super) clearance: f64,
}

impl Tally {
    pub(super) fn new() -> Self {
        Self { panel_pairs: 0, box_pairs: 0, clearance: LOOKED_FOR }
    }
}

impl Motion {
    /// The zygote of a plan, all hinges closed.
    ///
    /// # Errors
    /// See [`Linkage::new`]; also a ground whose normal is no direction.
    pub fn new(plan: &Plan, thickness: Thickness, ground: Option<Ground>) -> Result<Self, MotionError> {
        let linkage = Linkage::new(plan, thickness)?;
        let (open, poses) = (vec![false; linkage.hinges()], linkage.poses_at(&[]));
        let ground = ground.map(|ground| ground.plane(&linkage, &poses)).transpose()?;
        Ok(Self { linkage: Arc::new(linkage), ground, open, poses })
    }

    /// The joints.
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// Where every panel is: its frame in space, see [`Linkage`].
    pub fn poses(&self) -> &[DAffine3] {
        &self.poses
    }

    /// Whether a hinge is open.
    pub fn is_open(&self, hinge: usize) -> bool {
        self.open[hinge]
    }

    /// Opens a hinge, whatever is in the way.
    pub fn open(&mut self, hinge: usize) {
        self.set(hinge, true);
    }

    /// Closes a hinge, whatever is in the way.
    pub fn close(&mut self, hinge: usize) {
        self.set(hinge, false);
    }

    /// Opens a hinge if nothing is in the way; an open one stays so.
    ///
    /// # Errors
    /// A collision, not always that at the least angle; then the hinge stays closed.
    pub fn try_open(&mut self, hinge: usize) -> Result<(), Collision> {
        if self.open[hinge] {
            return Ok(());
        }
        if let Some(collision) = self.blocked(hinge) {
            return Err(collision);
        }
        self.open(hinge);
        Ok(())
    }

    /// Some collision that opening a closed hinge would cause; the first that is found. `None` also where it is open.
    pub fn blocked(&self, hinge: usize) -> Option<Collision> {
        let mut first = None;
        self.examine(hinge, Wanted::Any, &mut Tally::new(), &mut |collision| {
            first = Some(collision);
            true
        });
        first
    }

    /// The same among some panels alone: nothing else is looked at.
    pub(super) fn blocked_among(&self, hinge: usize, counts: &dyn Fn(usize) -> bool) -> bool {
        let mut blocked = false;
        self.examine_among(hinge, counts, Wanted::Any, &mut Tally::new(), &mut |_| {
            blocked = true;
            true
        });
        blocked
    }

    /// All collisions that opening a closed hinge causes, one for every two blocks that meet.
    pub(super) fn collisions(&self, hinge: usize, tally: &mut Tally) -> Vec<Collision> {
        let mut all = Vec::new();
        self.examine(hinge, Wanted::Least, tally, &mut |collision| {
            all.push(collision);
            false
        });
        all.sort_by(|a, b| {
            a.to_deg.total_cmp(&b.to_deg).then((a.panel, a.obstacle).cmp(&(b.panel, b.obstacle)))
        });
        all
    }

    /// Whether two closed hinges can open at once, at whatever speeds: neither moves the other, and what they move is apart
    /// at all angles of both. That each one alone is free is for [`Self::blocked`] to say, before and after the other.
    pub fn together(&self, first: usize, second: usize) -> bool {
        let carried = |a: usize, b: usize| self.linkage.moves(a, self.linkage.child(b));
        if carried(first, second) || carried(second, first) {
            return false;
        }
        let [ours, theirs] = [first, second]
            .map(|hinge| self.leg(hinge).into_iter().map(|body| (body, body.swept())).collect::<Vec<_>>());
        let touching = self.linkage.thickness().touching();
        ours.iter().all(|(first, [low, high])| {
            theirs.iter().all(|(second, [other_low, other_high])| {
                low.cmpgt(*other_high).any()
                    || other_low.cmpgt(*high).any()
                    || Pair {
                        first,
                        second,
                        wanted: Wanted::Any,
                        touching,
                        finest: FINEST,
                        clearance: None,
                        hint: None,
                    }
                    .over_all()
                    .is_none()
            })
        })
    }

    /// What a hinge would move, turning from closed to open; nothing where it doesn't turn.
    pub(super) fn leg(&self, hinge: usize) -> Vec<Body> {
        let turn = self.linkage.turn(hinge, &self.poses);
        if turn.angle == 0.0 {
            return Vec::new();
        }
        let mut bodies = Vec::new();
        let closed = |fold: usize| fold != hinge && !self.open[fold];
        block::each(&self.linkage, &self.poses, closed, |block| {
            if self.linkage.moves(hinge, block.layers[0].panel) {
                bodies.push(Body::turning(block.cuboid, &turn));
            }
        });
        bodies
    }

    fn set(&mut self, hinge: usize, open: bool) {
        if std::mem::replace(&mut self.open[hinge], open) != open {
            self.linkage.place(hinge, &self.open, &mut self.poses);
        }
    }

    /// The blocks that a hinge moves, and all others.
    fn blocks(&self, hinge: usize) -> (Vec<Block<'_>>, Vec<Block<'_>>) {
        let (mut moving, mut still) = (Vec::new(), Vec::new());
        let closed = |fold: usize| fold != hinge && !self.open[fold];
        block::each(&self.linkage, &self.poses, closed, |block| {
            if self.linkage.moves(hinge, block.layers[0].panel) {
                moving.push(block);
            } else {
                still.push(block);
            }
        });
        (moving, still)
    }

    /// Calls `take` with every collision, until it says to stop.
    fn examine(
        &self,
        hinge: usize,
        wanted: Wanted,
        tally: &mut Tally,
        take: &mut dyn FnMut(Collision) -> bool,
    ) {
        self.examine_among(hinge, &|_| true, wanted, tally, take);
    }

    /// The same for blocks of panels that count.
    fn examine_among(
        &self,
        hinge: usize,
        counts: &dyn Fn(usize) -> bool,
        wanted: Wanted,
        tally: &mut Tally,
        take: &mut dyn FnMut(Collision) -> bool,
    ) {
        let turn = self.linkage.turn(hinge, &self.poses);
        if self.open[hinge] || turn.angle == 0.0 {
            return;
        }
        let (mut moving, mut still) = self.blocks(hinge);
        moving.retain(|block| counts(block.layers[0].panel));
        still.retain(|block| counts(block.layers[0].panel));
        let panels = |blocks: &[Block]| blocks.iter().map(|block| block.layers.len() as u64).sum::<u64>();
        tally.panel_pairs += panels(&moving) * panels(&still);
        let bodies: Vec<_> = moving.iter().map(|block| Body::turning(block.cuboid, &turn)).collect();
        if let Some(plane) = &self.ground {
            let meets = bodies.iter().zip(&moving).filter_map(|(body, block)| {
                let conflict = plane.conflict(body)?;
                Some(self.with_ground(hinge, block, &turn, plane, conflict))
            });
            for collision in meets {
                if take(collision) {
                    return;
                }
            }
        }
        let touching = self.linkage.thickness().touching();
        near::each(&turn, &moving, &still, |a, b| {
            tally.box_pairs += 1;
            let (body, other) = (&bodies[a], Body::still(still[b].cuboid));
            // What touches at the start or at the end of the motion has no clearance to speak of.
            let touches = || [0.0, turn.angle].iter().any(|at| body.at(*at).gap(other.start()) <= TOUCHING);
            let clearance = (wanted == Wanted::Least && !touches()).then_some(&mut tally.clearance);
            let conflict =
                Pair { first: body, second: &other, wanted, touching, finest: FINEST, clearance, hint: None }
                    .over_all();
            conflict.is_some_and(|conflict| {
                take(self.between(hinge, [&moving[a], &still[b]], &turn, wanted, &conflict))
            })
        });
    }

    /// Names a collision between blocks.
    fn between(
        &self,
        hinge: usize,
        [moving, still]: [&Block; 2],
        turn: &Turn,
        wanted: Wanted,
        conflict: &Conflict,
    ) -> Collision {
        let (body, other) = (Body::turning(moving.cuboid, turn), &still.cuboid);
        let mut worst = (body.at(conflict.first[1]).gap(other), conflict.first[1]);
        if wanted == Wanted::Least {
            for angle in degrees(turn) {
                let gap = body.at(angle).gap(other);
                if gap < worst.0 {
                    worst = (gap, angle);
                }
            }
        }
        let least = |block: &Block, gap: &dyn Fn(&Cuboid) -> f64| {
            let gaps = (0..block.layers.len())
                .map(|layer| gap(&block.layer(&self.linkage, &self.poses, layer)))
                .enumerate();
            gaps.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(layer, _)| layer)
        };
        let turned = |layer: &Cuboid| Body::turning(*layer, turn).at(worst.1);
        let layer = least(moving, &|layer| turned(layer).gap(other));
        let deepest = turned(&moving.layer(&self.linkage, &self.poses, layer));
        let obstacle = least(still, &|layer| deepest.gap(layer));
        Collision {
            hinge,
            panel: moving.layers[layer].panel,
            obstacle: Obstacle::Panel(still.layers[obstacle].panel),
            from_deg: conflict.first[0].to_degrees(),
            to_deg: conflict.first[1].to_degrees(),
            depth: (-worst.0).max(0.0),
        }
    }

    /// Names a collision with the ground.
    fn with_ground(
        &self,
        hinge: usize,
        block: &Block,
        turn: &Turn,
        plane: &Plane,
        conflict: [f64; 2],
    ) -> Collision {
        let depth = |cuboid: Cuboid| {
            let body = Body::turning(cuboid, turn);
            let pieces = body.quarters();
            let low = |piece| plane.offset - body.extent(plane.normal, piece)[0];
            pieces.iter().map(low).fold(f64::NEG_INFINITY, f64::max)
        };
        let deepest = (0..block.layers.len())
            .map(|layer| (depth(block.layer(&self.linkage, &self.poses, layer)), layer))
            .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let (depth, layer) = deepest.unwrap_or_default();
        Collision {
            hinge,
            panel: block.layers[layer].panel,
            obstacle: Obstacle::Ground,
            from_deg: conflict[0].to_degrees(),
            to_deg: conflict[1].to_degrees(),
            depth: depth.max(0.0),
        }
    }
}

/// The angles at which the depth of a collision is taken, radians.
fn degrees(turn: &Turn) -> impl Iterator<Item = f64> {
    let angle = turn.angle;
    (0..=360).map(|degree| f64::from(degree).to_radians()).take_while(move |at| *at <= angle + TOUCHING)
}
