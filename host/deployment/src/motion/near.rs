//! Which blocks could meet at all in a turn: as spheres, by their place along the hinge's axis, about it and off it.

use super::block::Block;
use super::turning::Turn;
use glam::DVec3;

/// Pairs that are further apart than this, panel lengths, aren't looked at: no clearance above it is measured.
pub const LOOKED_FOR: f64 = 0.1;

/// Where a block is, seen from the axis.
#[derive(Debug, Clone, Copy)]
struct Seen {
    /// Along the axis: centre and half the width.
    along: f64,
    reach: f64,
    /// Of the centre from the axis.
    off: f64,
    across: DVec3,
    radius: f64,
}

impl Seen {
    fn new(block: &Block, turn: &Turn) -> Self {
        let from = block.cuboid.centre - turn.anchor;
        let along = from.dot(turn.axis);
        let across = from - turn.axis * along;
        let reach = block.cuboid.reach(turn.axis);
        Self { along, reach, off: across.length(), across, radius: block.cuboid.radius() }
    }

    /// How near the centres come, at least, when the first one turns.
    fn nearest(&self, still: &Self, turn: &Turn) -> f64 {
        let lift = still.along - self.along;
        let (x, y) = (self.across.dot(still.across), turn.axis.dot(self.across.cross(still.across)));
        let ahead = y.atan2(x).rem_euclid(std::f64::consts::TAU);
        if ahead <= turn.angle {
            return lift.hypot(self.off - still.off);
        }
        let (sin, cos) = turn.angle.sin_cos();
        let end = self.across * cos + turn.axis.cross(self.across) * sin;
        lift.hypot(self.across.distance(still.across).min(end.distance(still.across)))
    }
}

/// Calls `take` with the numbers of every pair that could come nearer than [`LOOKED_FOR`], until it says to stop.
/// Returns whether it did.
pub(super) fn each(
    turn: &Turn,
    moving: &[Block],
    still: &[Block],
    mut take: impl FnMut(usize, usize) -> bool,
) -> bool {
    let margin = LOOKED_FOR + turn.stretch().length();
    let seen =
        |blocks: &[Block]| -> Vec<Seen> { blocks.iter().map(|block| Seen::new(block, turn)).collect() };
    let (moving, still) = (seen(moving), seen(still));
    let mut by_place: Vec<usize> = (0..still.len()).collect();
    // Sorting pays where many seek among many.
    if moving.len() > 8 {
        by_place.sort_by(|a, b| still[*a].along.total_cmp(&still[*b].along));
    }
    let longest = still.iter().map(|seen| seen.reach).fold(0.0, f64::max);
    for (number, body) in moving.iter().enumerate() {
        let room = body.reach + margin;
        let among = if moving.len() > 8 {
            let place = |along: f64| by_place.partition_point(|other| still[*other].along < along);
            &by_place[place(body.along - room - longest)..place(body.along + room + longest)]
        } else {
            &by_place[..]
        };
        for other in among {
            let seen = &still[*other];
            let reach = body.radius + seen.radius + margin;
            if (seen.along - body.along).abs() <= room + seen.reach
                && (seen.off - body.off).abs() <= reach
                && body.nearest(seen, turn) <= reach
                && take(number, *other)
            {
                return true;
            }
        }
    }
    false
}
