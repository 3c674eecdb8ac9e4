//! Executes the steps of a program in tree order and under the supply limit (S7, S10).
//!
//! ```text
//!   Waiting --all of `after` opened, current to spare--> Moving --> Opened (SMA cools) --> Done
//!      any, when everything goes off: Moving -> Interrupted
//! ```

use crate::event_queue::EventQueue;
use crate::io::Outputs;
use crate::program::index;
use crate::servo_mover::ServoMover;
use crate::sma_heater::SmaHeater;
use crate::spring_release::SpringRelease;
use crate::trip::Trip;
use heapless::Vec;
use zygote_protocol::{
    Action, CentiCelsius, Event, EventKind, Fault, Micros, Milliamps, Motion as MotionReport, Phase, Step,
    StepState, TELEMETRY_MOTIONS,
};

/// Events that one more motion may cause before it is over, and the run's end.
const EVENTS_PER_MOTION: usize = 3;

/// A step's actuator at work.
#[derive(Debug, Clone, Copy)]
enum Motion {
    Heat(SmaHeater),
    Turn(ServoMover),
    Release(SpringRelease),
}

#[derive(Debug, Clone, Copy)]
enum Slot {
    Waiting,
    Active(Motion),
    Ended(StepState),
}

/// What the sequencer needs to know at one instant.
pub(crate) struct Instant<'a> {
    pub(crate) now: Micros,
    pub(crate) supply: Milliamps,
    pub(crate) temperature: &'a dyn Fn(u16) -> Option<CentiCelsius>,
}

/// What the motions under way take.
#[derive(Debug, Clone, Copy)]
struct Load {
    current: Milliamps,
    /// Motions that aren't over yet.
    motions: usize,
}

/// The state of every step of a run.
#[derive(Debug)]
pub(crate) struct Sequencer<const STEPS: usize> {
    slots: Vec<Slot, STEPS>,
}

impl Motion {
    fn start(action: &Action, instant: &Instant<'_>) -> Option<Self> {
        Some(match *action {
            Action::Heat(heat) => {
                Self::Heat(SmaHeater::start(heat, instant.now, (instant.temperature)(heat.channel)?))
            }
            Action::Pulse(pulse) => {
                Self::Heat(SmaHeater::pulse(pulse, instant.now, (instant.temperature)(pulse.channel)?))
            }
            Action::Turn(turn) => Self::Turn(ServoMover::start(turn, instant.now)),
            Action::Release(release) => Self::Release(SpringRelease::start(release, instant.now)),
        })
    }

    fn advance(&mut self, instant: &Instant<'_>) -> Result<(), Trip> {
        match self {
            // Without a temperature there is nothing to decide; the thermal guard trips if it stays away.
            Self::Heat(heater) => match (instant.temperature)(heater.channel()) {
                Some(temperature) => heater.advance(instant.now, temperature),
                None => Ok(()),
            },
            Self::Turn(servo) => {
                servo.advance(instant.now);
                Ok(())
            }
            Self::Release(spring) => {
                spring.advance(instant.now);
                Ok(())
            }
        }
    }

    fn step_state(&self) -> StepState {
        match self {
            Self::Heat(heater) => heater.step_state(),
            Self::Turn(servo) => servo.step_state(),
            Self::Release(spring) => spring.step_state(),
        }
    }

    fn phase(&self, instant: &Instant<'_>) -> Option<Phase> {
        match self {
            Self::Heat(heater) => heater.phase((instant.temperature)(heater.channel())?),
            Self::Turn(servo) => servo.phase(),
            Self::Release(spring) => spring.phase(),
        }
    }

    /// Current that this motion may draw now, at full power.
    fn current(&self, action: &Action) -> Milliamps {
        match (self, self.step_state()) {
            (Self::Turn(servo), StepState::Done) => servo.spec().hold_current,
            (Self::Release(spring), _) if !spring.energised() => Milliamps(0),
            (_, StepState::Moving) => action.current(),
            (_, _) => Milliamps(0),
        }
    }

    fn channel(&self) -> u16 {
        match self {
            Self::Heat(heater) => heater.channel(),
            Self::Turn(servo) => servo.spec().channel,
            Self::Release(spring) => spring.channel(),
        }
    }

    fn peak(&self) -> Option<CentiCelsius> {
        match self {
            Self::Heat(heater) => Some(heater.peak()),
            Self::Turn(_) | Self::Release(_) => None,
        }
    }
}

impl Slot {
    fn state(&self) -> StepState {
        match self {
            Self::Waiting => StepState::Waiting,
            Self::Active(motion) => motion.step_state(),
            Self::Ended(state) => *state,
        }
    }
}

impl Load {
    const NONE: Self = Self { current: Milliamps(0), motions: 0 };

    fn add(&mut self, slot: &Slot, step: &Step) {
        if let Slot::Active(motion) = slot {
            self.current.0 = self.current.0.saturating_add(motion.current(&step.action).0);
            self.motions += usize::from(motion.step_state() != StepState::Done);
        }
    }

    fn leaves_room_for(self, step: &Step, instant: &Instant<'_>, events: &EventQueue) -> bool {
        self.current.0.saturating_add(step.action.current().0) <= instant.supply.0
            && events.room() >= (self.motions + 1) * EVENTS_PER_MOTION
    }
}

fn is_open(state: StepState) -> bool {
    matches!(state, StepState::Opened | StepState::Done)
}

impl<const STEPS: usize> Sequencer<STEPS> {
    pub(crate) const fn new() -> Self {
        Self { slots: Vec::new() }
    }

    /// Makes every step of a program wait.
    pub(crate) fn load(&mut self, steps: &[Step]) {
        // In place: a second program's worth of slots would lie on the stack for a moment.
        self.slots.clear();
        self.slots.extend(steps.iter().take(STEPS).map(|_| Slot::Waiting));
    }

    /// Steps that have opened.
    pub(crate) fn opened(&self) -> u16 {
        index(self.states().filter(|state| is_open(*state)).count())
    }

    /// The state of each step.
    pub(crate) fn states(&self) -> impl Iterator<Item = StepState> {
        self.slots.iter().map(Slot::state)
    }

    /// Every step is done.
    pub(crate) fn is_finished(&self) -> bool {
        self.states().all(|state| state == StepState::Done)
    }

    /// Moves every motion on, starts what may start, and writes what the actuators are to do.
    ///
    /// # Errors
    /// A motion that must not go on.
    pub(crate) fn advance<const H: usize, const S: usize, const R: usize>(
        &mut self,
        steps: &[Step],
        instant: &Instant<'_>,
        events: &mut EventQueue,
        outputs: &mut Outputs<H, S, R>,
    ) -> Result<(), Fault> {
        for (at, slot) in (0..).zip(self.slots.iter_mut()) {
            advance_slot(at, slot, instant, events)?;
        }
        self.start_ready(steps, instant, events);
        for slot in &self.slots {
            if let Slot::Active(motion) = slot {
                drive(motion, outputs);
            }
        }
        Ok(())
    }

    /// Starts what may start; the load is summed up once, so that a tick takes no longer the more steps wait.
    fn start_ready(&mut self, steps: &[Step], instant: &Instant<'_>, events: &mut EventQueue) {
        let mut load = self.taken(steps);
        for (at, step) in steps.iter().enumerate() {
            let waiting = matches!(self.slots.get(at), Some(Slot::Waiting));
            if !waiting || !load.leaves_room_for(step, instant, events) || !self.are_open(&step.after) {
                continue;
            }
            if let (Some(slot), Some(motion)) = (self.slots.get_mut(at), Motion::start(&step.action, instant))
            {
                *slot = Slot::Active(motion);
                load.add(slot, step);
                events.push(Event { at: instant.now, kind: EventKind::StepStarted { step: index(at) } });
            }
        }
    }

    fn are_open(&self, steps: &[u16]) -> bool {
        let mut slots = steps.iter().map(|step| self.slots.get(usize::from(*step)));
        slots.all(|slot| slot.is_some_and(|slot| is_open(slot.state())))
    }

    fn taken(&self, steps: &[Step]) -> Load {
        let mut load = Load::NONE;
        self.slots.iter().zip(steps).for_each(|(slot, step)| load.add(slot, step));
        load
    }

    /// Most current that all motions together may draw now, by the program.
    pub(crate) fn planned(&self, steps: &[Step]) -> Milliamps {
        self.taken(steps).current
    }

    /// A servo is moved or held: what it draws depends on its load.
    pub(crate) fn drives_servo(&self) -> bool {
        self.slots.iter().any(|slot| matches!(slot, Slot::Active(Motion::Turn(_))))
    }

    /// Marks what was moving when everything went off.
    pub(crate) fn interrupt(&mut self) {
        for slot in &mut self.slots {
            if let Slot::Active(motion) = slot {
                *slot = Slot::Ended(match motion.step_state() {
                    StepState::Waiting | StepState::Moving | StepState::Interrupted => StepState::Interrupted,
                    // An open hinge stays open; that it may not have cooled matters to nobody after a restart.
                    StepState::Opened | StepState::Done => StepState::Done,
                });
            }
        }
    }

    /// The steps under way, those that move before those that cool.
    pub(crate) fn motions(&self, instant: &Instant<'_>) -> Vec<MotionReport, TELEMETRY_MOTIONS> {
        let report = |wanted: StepState| {
            self.slots.iter().enumerate().filter_map(move |(at, slot)| match slot {
                Slot::Active(motion) if motion.step_state() == wanted => {
                    Some(MotionReport { step: index(at), phase: motion.phase(instant)? })
                }
                _ => None,
            })
        };
        report(StepState::Moving).chain(report(StepState::Opened)).take(TELEMETRY_MOTIONS).collect()
    }
}

fn advance_slot(
    at: u16,
    slot: &mut Slot,
    instant: &Instant<'_>,
    events: &mut EventQueue,
) -> Result<(), Fault> {
    let Slot::Active(motion) = slot else { return Ok(()) };
    let before = motion.step_state();
    motion.advance(instant).map_err(|trip| trip.at(instant.now, Some(at), Some(motion.channel())))?;
    let after = motion.step_state();
    if !is_open(before) && is_open(after) {
        events.push(Event { at: instant.now, kind: EventKind::StepOpened { step: at } });
    }
    if before != StepState::Done && after == StepState::Done {
        events.push(Event { at: instant.now, kind: EventKind::StepDone { step: at, peak: motion.peak() } });
        // A servo goes on holding; a heater or a spring has nothing left to do.
        if !matches!(motion, Motion::Turn(_)) {
            *slot = Slot::Ended(StepState::Done);
        }
    }
    Ok(())
}

/// Writes what one motion wants; channels were checked when the program was committed.
fn drive<const H: usize, const S: usize, const R: usize>(motion: &Motion, outputs: &mut Outputs<H, S, R>) {
    let channel = usize::from(motion.channel());
    match motion {
        Motion::Heat(heater) => {
            if let Some(output) = outputs.heaters.get_mut(channel) {
                *output = heater.duty();
            }
        }
        Motion::Turn(servo) => {
            if let Some(output) = outputs.servos.get_mut(channel) {
                *output = Some(servo.pulse());
            }
        }
        Motion::Release(spring) => {
            if let Some(output) = outputs.springs.get_mut(channel) {
                *output = spring.energised();
            }
        }
    }
}

#[cfg(test)]
mod tests;
