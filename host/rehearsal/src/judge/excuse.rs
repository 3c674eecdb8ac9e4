//! What no sensor of the board can see, and so excuses what the MCU believes of a hinge.
//!
//! The board has one thermistor a heater and one current sensor; it has no sense of an angle. So it can't know of
//!
//! * a jammed hinge of any kind, or a blocked servo whose current stays under the limit;
//! * a supply that is too weak while a servo turns or a burn wire glows, which are run by time;
//! * a thermistor that drifts upwards: the hinge counts as open before it is hot enough.
//!
//! A MOSFET that is stuck on opens its hinge before its turn, for which the fault that follows is the remedy.

use crate::cause::What;
use crate::run::{Rehearsed, Trial};
use zygote_deployment::Kind;
use zygote_sim::plant::{Fault, Hinge};

/// Of each step of the schedule, what is excused.
#[derive(Debug)]
pub struct Excuses {
    closed: Vec<bool>,
    moved: Vec<bool>,
}

impl Excuses {
    /// Those that follow from what happened.
    pub fn of(trial: &Trial, rehearsed: &Rehearsed) -> Self {
        let steps = &trial.schedule.steps;
        let mut excuses = Self { closed: vec![false; steps.len()], moved: vec![false; steps.len()] };
        for (_, what) in rehearsed.script.happened() {
            let What::Break(fault) = what else { continue };
            for (at, step) in steps.iter().enumerate() {
                let channel = usize::from(step.channel);
                let (closed, moved) = excused(*fault, step.motion.kind(), channel);
                excuses.closed[at] |= closed;
                excuses.moved[at] |= moved;
            }
        }
        excuses
    }

    /// A step may count as opened though its hinge is truly closed.
    pub fn may_be_closed(&self, step: usize) -> bool {
        self.closed.get(step).copied().unwrap_or(false)
    }

    /// A step may count as not moved though its hinge truly has.
    pub fn may_have_moved(&self, step: usize) -> bool {
        self.moved.get(step).copied().unwrap_or(false)
    }
}

/// Whether a fault excuses a hinge that is closed but counts as open, and one that has moved but counts as not moved.
fn excused(fault: Fault, kind: Kind, channel: usize) -> (bool, bool) {
    let sma = |at: usize| kind == Kind::Sma && at == channel;
    let servo = |at: usize| kind == Kind::Servo && at == channel;
    match fault {
        Fault::Jammed(Hinge::Sma(at)) => (sma(at), false),
        Fault::Jammed(Hinge::Servo(at)) | Fault::ServoStalled(at) => (servo(at), false),
        Fault::Jammed(Hinge::Spring(at)) => (kind == Kind::Spring && at == channel, false),
        Fault::SupplyCut | Fault::SupplySag { .. } => (kind != Kind::Sma, false),
        Fault::ThermistorDrifting { channel: at, kelvin_per_s } => (sma(at) && kelvin_per_s > 0.0, false),
        Fault::MosfetStuckOn(at) => (false, sma(at)),
        Fault::ThermistorOpen(_)
        | Fault::ThermistorShorted(_)
        | Fault::ThermistorFrozen(_)
        | Fault::ThermistorLoose(_)
        | Fault::HeaterOpen(_)
        | Fault::HeaterShorted { .. }
        | Fault::SupplyRestored => (false, false),
    }
}
