//! Which hinges move when: one by one, or all that may, each at its own speed.

use super::sampler::{Moving, Sampler};
use crate::order::Order;

/// Fractions that close to 1 are 1.
const DONE: f64 = 1.0 - 1e-9;

/// Opens one hinge after the other.
pub(super) fn one_by_one(sampler: &mut Sampler, order: &Order) {
    for hinge in &order.hinges {
        let joint = sampler.plates().joint_of[*hinge];
        sampler.phase(&[Moving { joint, from: 0.0, to: 1.0 }], false);
    }
}

/// A hinge on its way.
struct Running {
    joint: usize,
    /// When it starts.
    start: f64,
    /// Fractions of its turn in a unit of time.
    speed: f64,
    fraction: f64,
    /// Whether it takes no time.
    jumps: bool,
}

/// Opens every hinge when all that it waits for are open, or a little later, at a speed of its own; some at a jump, while all
/// others stay where they are.
pub(super) fn at_once(sampler: &mut Sampler, order: &Order, jumping: &[usize], seed: u64) {
    let mut random = Random(seed);
    let mut open_for = vec![Vec::new(); order.hinges.len()];
    let mut waiting: Vec<usize> = order.waits_for.iter().map(Vec::len).collect();
    for (hinge, others) in order.waits_for.iter().enumerate() {
        for other in others {
            open_for[*other].push(hinge);
        }
    }
    let mut ready: Vec<usize> =
        order.hinges.iter().copied().filter(|hinge| order.waits_for[*hinge].is_empty()).collect();
    let mut running: Vec<Running> = Vec::new();
    let mut now = 0.0;
    loop {
        for hinge in ready.drain(..) {
            // Half of them wait; speeds differ by up to eight times.
            let delay = (random.next() - 0.5).max(0.0) * 4.0;
            let speed = 8_f64.powf(random.next());
            let joint = sampler.plates().joint_of[hinge];
            let jumps = jumping.contains(&hinge);
            running.push(Running { joint, start: now + delay, speed, fraction: 0.0, jumps });
        }
        let next = |running: &Running| {
            let left = if running.jumps { 0.0 } else { (1.0 - running.fraction) / running.speed };
            if running.start > now { running.start } else { now + left }
        };
        let Some(then) = running.iter().map(next).reduce(f64::min) else { return };
        let mut moving = Vec::new();
        for one in running.iter_mut().filter(|one| one.start <= now) {
            let to = one.fraction + (then - now) * one.speed;
            let to = if to >= DONE || one.jumps { 1.0 } else { to };
            moving.push(Moving { joint: one.joint, from: one.fraction, to });
            one.fraction = to;
        }
        if !moving.is_empty() {
            sampler.phase(&moving, true);
        }
        now = then;
        running.retain(|one| {
            if one.fraction < 1.0 {
                return true;
            }
            for hinge in &open_for[sampler.plates().joint(one.joint).hinge] {
                waiting[*hinge] -= 1;
                if waiting[*hinge] == 0 {
                    ready.push(*hinge);
                }
            }
            false
        });
    }
}

/// Numbers from 0 to below 1 (`SplitMix64`).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
