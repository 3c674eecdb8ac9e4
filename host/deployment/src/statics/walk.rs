//! Goes through an order hinge by hinge, and weighs what turns and what holds.

use super::load::{Load, Opening, Role, worst};
use super::swing::Swing;
use super::tipping::{Centre, Support, Tipping, margin};
use crate::motion::{Ground, Motion, MotionError, Plane, Thickness, Turn};
use crate::rig::{Degrees, Fitting, Grams, Millimetres, NewtonMetres, Rig, RigError};
use crate::schedule::start_opening_deg;
use crate::tree::{Tree, TreeError};
use glam::DVec3;
use std::collections::BTreeSet;
use zygote_stacking::Plan;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;
/// So near to the ground, in panel lengths, is on it: far above the rounding of poses, far below a thickness.
const ON_GROUND: f64 = 1e-6;

/// What gravity does to a plan that opens in some order.
#[derive(Debug, Clone, PartialEq)]
pub struct Statics {
    /// What a panel weighs.
    pub panel_mass: Grams,
    /// Of every step, in order, the load of the hinge that turns.
    pub turning: Vec<Load>,
    /// Of every step, in order, the worst load of its hinge from then to the end.
    pub holding: Vec<Load>,
    /// Of every step, in order, what its hinge holds when all are open: no order changes that.
    pub in_shape: Vec<Load>,
    /// Whether the whole stands.
    pub tipping: Tipping,
}

/// Why loads can't be told.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StaticsError {
    /// The rig doesn't suit the plan, or doesn't say what panels weigh.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The plan can't be moved.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The plan is no tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// No hinge, or one twice.
    #[error(
        "order: step {step} must open another of the {hinges} hinges than those before it, found {hinge}"
    )]
    Order {
        /// The place in the order, from 0.
        step: usize,
        /// What stands there.
        hinge: usize,
        /// Hinges in the plan.
        hinges: usize,
    },
}

impl Statics {
    /// The loads while the hinges of a plan open one by one in this order, slowly; each at the worst angle of the whole turn.
    ///
    /// Counted are the weights of panels. A hinge holds from its own step on; one that hasn't turned yet holds nothing.
    ///
    /// # Errors
    /// [`StaticsError`] if the rig doesn't suit the plan, or if the order isn't one.
    pub fn of(plan: &Plan, rig: &Rig, order: &[usize], support: Support) -> Result<Self, StaticsError> {
        let mass = rig.panel_mass(Millimetres(plan.panel_length_mm))?;
        let fittings = rig.fit_tree(&Tree::new(plan)?)?;
        let mut walk = Walk::new(plan, mass, DVec3::from_array(rig.gravity.direction), &fittings)?;
        let mut step_of = vec![None; plan.hinges.len()];
        let mut turning: Vec<Load> = Vec::with_capacity(order.len());
        let mut holding: Vec<Load> = Vec::with_capacity(order.len());
        let mut margins = Vec::with_capacity(order.len());
        for (step, &hinge) in order.iter().enumerate() {
            match step_of.get_mut(hinge) {
                Some(slot @ None) => *slot = Some(step),
                _ => return Err(StaticsError::Order { step, hinge, hinges: plan.hinges.len() }),
            }
            margins
                .push(walk.margin(hinge, support).map(|margin| Millimetres(margin * plan.panel_length_mm)));
            let (at_worst, at_end) = walk.turning(step, hinge);
            turning.push(at_worst);
            holding.push(at_end);
            walk.held(step, hinge, &mut |load| {
                if let Some(worst) = step_of[load.hinge].and_then(|step| holding.get_mut(step))
                    && load.factor() > worst.factor()
                {
                    *worst = load;
                }
            });
            walk.open(hinge);
        }
        let in_shape = order.iter().filter_map(|hinge| Some(walk.holding(*hinge, turning.last()?))).collect();
        Ok(Self { panel_mass: mass, turning, holding, in_shape, tipping: Tipping { support, margins } })
    }

    /// All loads beyond the rating, the worst first.
    pub fn overloads(&self) -> Vec<Load> {
        self.worst_first().into_iter().take_while(Load::is_overload).collect()
    }

    /// The hinges that some load overloads, rising.
    pub fn overloaded(&self) -> Vec<usize> {
        let hinges: BTreeSet<_> = self.overloads().iter().map(|load| load.hinge).collect();
        hinges.into_iter().collect()
    }

    /// Those that are overloaded when all are open, whatever the order, rising.
    pub fn overloaded_in_shape(&self) -> Vec<usize> {
        let beyond = self.in_shape.iter().filter(|load| load.is_overload());
        let hinges: BTreeSet<_> = beyond.map(|load| load.hinge).collect();
        hinges.into_iter().collect()
    }

    /// With panels of at most this mass no hinge is overloaded: torque goes with the mass. `None` where nothing has an arm.
    pub fn bearable_mass(&self) -> Option<Grams> {
        let worst = self.worst_first().first().map(Load::factor).filter(|factor| *factor > 0.0)?;
        Some(Grams(self.panel_mass.0 / worst))
    }

    /// All loads, the worst first.
    pub fn worst_first(&self) -> Vec<Load> {
        let mut loads: Vec<_> = self.turning.iter().chain(&self.holding).copied().collect();
        loads.sort_by(|a, b| {
            b.factor().total_cmp(&a.factor()).then((a.hinge, a.role).cmp(&(b.hinge, b.role)))
        });
        loads
    }
}

/// The state between two steps. Branches are counted in the order of the tree: each with all that hangs on it in one piece.
struct Walk<'a> {
    plan: &'a Plan,
    fittings: &'a [Fitting],
    tree: Tree,
    motion: Motion,
    /// Of every hinge its branch.
    branch_of: Vec<usize>,
    /// Of every branch, how many panels it moves, and the sum of their centres.
    counts: Vec<usize>,
    sums: Vec<DVec3>,
    /// The sum of all centres.
    total: DVec3,
    /// Newtons that a panel weighs, times the panel length in metres: arms are in panel lengths.
    weight: DVec3,
    ground: Plane,
    /// Of every panel, whether it touches the ground.
    grounded: Vec<bool>,
}

impl<'a> Walk<'a> {
    fn new(plan: &'a Plan, mass: Grams, down: DVec3, fittings: &'a [Fitting]) -> Result<Self, StaticsError> {
        let tree = Tree::new(plan)?;
        let motion = Motion::new(plan, Thickness::of(plan), None)?;
        let mut branch_of = vec![0; plan.hinges.len()];
        for (number, branch) in tree.branches().iter().enumerate() {
            branch_of[branch.hinge] = number;
        }
        let counts: Vec<_> =
            tree.branches().iter().map(|branch| motion.linkage().moved(branch.hinge).count()).collect();
        let ground = Ground { normal: -down }.plane(motion.linkage(), motion.poses())?;
        let mut walk = Self {
            plan,
            fittings,
            motion,
            branch_of,
            sums: vec![DVec3::ZERO; counts.len()],
            counts,
            tree,
            total: DVec3::ZERO,
            weight: -ground.normal * (mass.0 * 1e-3 * GRAVITY * plan.panel_length_mm * 1e-3),
            ground,
            grounded: vec![false; plan.panels()],
        };
        walk.sum(0..walk.sums.len());
        walk.total = (0..plan.panels()).map(|panel| walk.centre(panel)).sum();
        for panel in 0..plan.panels() {
            walk.grounded[panel] = walk.touches(panel);
        }
        Ok(walk)
    }

    fn centre(&self, panel: usize) -> DVec3 {
        let inner = -0.5 * self.plan.thickness;
        self.motion.poses()[panel].transform_point3(DVec3::new(0.5, 0.5, inner))
    }

    /// The corners of both faces.
    fn corners(&self, panel: usize) -> [DVec3; 8] {
        let pose = self.motion.poses()[panel];
        std::array::from_fn(|corner| {
            let bit = |bit: usize| if corner >> bit & 1 == 0 { 0.0 } else { 1.0 };
            pose.transform_point3(DVec3::new(bit(0), bit(1), -bit(2) * self.plan.thickness))
        })
    }

    fn on_ground(&self, point: DVec3) -> bool {
        self.ground.above(point).abs() <= ON_GROUND
    }

    fn touches(&self, panel: usize) -> bool {
        self.corners(panel).iter().any(|corner| self.on_ground(*corner))
    }

    /// Sums the centres of whole branches anew.
    fn sum(&mut self, branches: std::ops::Range<usize>) {
        for number in branches.clone() {
            self.sums[number] = self.centre(self.tree.branches()[number].child);
        }
        // Children come after their parents.
        for number in branches.clone().rev() {
            if let Some(before) = self.before(number).filter(|before| branches.contains(before)) {
                let sum = self.sums[number];
                self.sums[before] += sum;
            }
        }
    }

    /// The branch that moves a branch.
    fn before(&self, branch: usize) -> Option<usize> {
        self.tree.branches()[branch].before.map(|hinge| self.branch_of[hinge])
    }

    fn turn(&self, branch: usize) -> Turn {
        self.motion.linkage().turn(self.tree.branches()[branch].hinge, self.motion.poses())
    }

    /// The torque against opening, about an axis, of a weight on an arm.
    fn torque(axis: DVec3, arm: DVec3, weight: DVec3) -> f64 {
        -arm.cross(weight).dot(axis)
    }

    fn opening(&self, hinge: usize, angle: f64) -> Opening {
        let hinge = &self.plan.hinges[hinge];
        let [from_deg, to_deg] = [start_opening_deg(hinge), hinge.opening_deg].map(f64::from);
        Opening { from_deg, to_deg, angle }
    }

    /// The load of the hinge that turns, at its worst and at the end.
    fn turning(&self, step: usize, hinge: usize) -> (Load, Load) {
        let branch = self.branch_of[hinge];
        let turn = self.turn(branch);
        // The axis shifts with what it carries, so the arm only turns.
        let arm = self.sums[branch] - turn.anchor * self.counts[branch] as f64;
        let swing = Swing {
            cosine: Self::torque(turn.axis, arm, self.weight),
            sine: Self::torque(turn.axis, turn.axis.cross(arm), self.weight),
            ..Swing::default()
        };
        let opening = self.opening(hinge, turn.angle);
        let rating = self.fittings[hinge].drive.torque();
        let load = |role, angle| Load {
            hinge,
            role,
            step,
            turning: hinge,
            opening: opening.at(angle),
            torque: NewtonMetres(swing.at(angle)),
            rating: rating.at(opening.at(angle)),
        };
        (load(Role::Turning, worst(&swing, rating, &opening)), load(Role::Holding, turn.angle))
    }

    /// What an open hinge holds after the last step.
    fn holding(&self, hinge: usize, last: &Load) -> Load {
        let (axis, arm) = self.arm(self.branch_of[hinge]);
        let own = Degrees(f64::from(self.plan.hinges[hinge].opening_deg));
        let turned = &self.plan.hinges[last.turning];
        Load {
            hinge,
            role: Role::Holding,
            step: last.step,
            turning: last.turning,
            opening: Degrees(f64::from(turned.opening_deg)),
            torque: NewtonMetres(Self::torque(axis, arm, self.weight)),
            rating: self.fittings[hinge].drive.torque().at(own),
        }
    }

    /// Calls `take` with the load of every open hinge that feels the turn of a hinge: those that carry it, and those that it
    /// moves.
    fn held(&self, step: usize, hinge: usize, take: &mut dyn FnMut(Load)) {
        let branch = self.branch_of[hinge];
        let turn = self.turn(branch);
        let opening = self.opening(hinge, turn.angle);
        let mut bear = |bearer: usize, swing: Swing| {
            let bearer = self.tree.branches()[bearer].hinge;
            let own = Degrees(f64::from(self.plan.hinges[bearer].opening_deg));
            let angles = swing.candidates(0.0, turn.angle);
            let worst =
                angles.max_by(|a, b| swing.at(*a).abs().total_cmp(&swing.at(*b).abs()).then(b.total_cmp(a)));
            let angle = worst.unwrap_or(0.0);
            take(Load {
                hinge: bearer,
                role: Role::Holding,
                step,
                turning: hinge,
                opening: opening.at(angle),
                torque: NewtonMetres(swing.at(angle)),
                rating: self.fittings[bearer].drive.torque().at(own),
            });
        };
        let is_open = |branch: usize| self.motion.is_open(self.tree.branches()[branch].hinge);
        let Centre { cosine, sine, slope, .. } = self.moment(branch, &turn);
        let mut bearer = self.before(branch);
        while let Some(number) = bearer {
            if is_open(number) {
                let (axis, arm) = self.arm(number);
                let of = |arm| Self::torque(axis, arm, self.weight);
                bear(
                    number,
                    Swing {
                        constant: of(arm - cosine),
                        cosine: of(cosine),
                        sine: of(sine),
                        slope: of(slope),
                    },
                );
            }
            bearer = self.before(number);
        }
        // Seen from what turns, gravity turns the other way.
        let along = turn.axis * turn.axis.dot(self.weight);
        for number in branch + 1..branch + self.counts[branch] {
            if is_open(number) {
                let (axis, arm) = self.arm(number);
                let of = |weight| Self::torque(axis, arm, weight);
                let (cosine, sine) = (of(self.weight - along), of(-turn.axis.cross(self.weight)));
                bear(number, Swing { constant: of(along), cosine, sine, slope: 0.0 });
            }
        }
    }

    /// The axis of an open hinge, and the sum of the arms of all that hangs on it.
    fn arm(&self, branch: usize) -> (DVec3, DVec3) {
        let turn = self.turn(branch);
        let pivot = turn.anchor + turn.stretch();
        (turn.axis, self.sums[branch] - pivot * self.counts[branch] as f64)
    }

    /// What of the sum of all centres changes while a branch turns; the rest is left out.
    fn moment(&self, branch: usize, turn: &Turn) -> Centre {
        let count = self.counts[branch] as f64;
        let arm = self.sums[branch] - turn.anchor * count;
        let across = arm - turn.axis * turn.axis.dot(arm);
        Centre {
            constant: DVec3::ZERO,
            cosine: across,
            sine: turn.axis.cross(arm),
            slope: turn.shift * count,
        }
    }

    /// How far within its support the centre of mass stays while a hinge turns, panel lengths.
    fn margin(&self, hinge: usize, support: Support) -> Option<f64> {
        let branch = self.branch_of[hinge];
        let turn = self.turn(branch);
        let mut moves = vec![false; self.plan.panels()];
        for panel in self.motion.linkage().moved(hinge).filter(|_| turn.angle > 0.0) {
            moves[panel] = true;
        }
        let points: Vec<_> = match support {
            Support::Root => self.corners(self.plan.root).to_vec(),
            Support::Touching => (0..self.plan.panels())
                .filter(|panel| self.grounded[*panel] && !moves[*panel])
                .flat_map(|panel| self.corners(panel))
                .filter(|corner| self.on_ground(*corner))
                .collect(),
        };
        let Centre { cosine, sine, slope, .. } = self.moment(branch, &turn);
        let share = 1.0 / self.plan.panels() as f64;
        let centre = Centre {
            constant: (self.total - cosine) * share,
            cosine: cosine * share,
            sine: sine * share,
            slope: slope * share,
        };
        margin(&points, self.ground.normal, &centre, turn.angle)
    }

    fn open(&mut self, hinge: usize) {
        self.motion.open(hinge);
        let branch = self.branch_of[hinge];
        let before = self.sums[branch];
        self.sum(branch..branch + self.counts[branch]);
        let change = self.sums[branch] - before;
        self.total += change;
        let mut bearer = self.before(branch);
        while let Some(number) = bearer {
            self.sums[number] += change;
            bearer = self.before(number);
        }
        for number in branch..branch + self.counts[branch] {
            let panel = self.tree.branches()[number].child;
            self.grounded[panel] = self.touches(panel);
        }
    }
}
