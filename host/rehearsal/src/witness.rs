//! What was truly the case in the course of a rehearsal: currents, temperatures and angles of the plant, and when the
//! board last heard its host. It looks after every step of the virtual clock; nothing it notes comes from messages.

use crate::subject::Subject;
use crate::wiretap::Wiretap;
use zygote_deployment::{Kind, Schedule};
use zygote_protocol::{Fault, Micros, Millis, State, StepState};
use zygote_sim::plant::{ServoHinge, SpringHinge};

/// A hinge is at its angle within this, degrees.
pub const ANGLE_TOLERANCE_DEG: f64 = 1.0;
/// Less current than this, amperes, is rounding.
const NO_CURRENT_A: f64 = 1e-9;
/// Events that are kept for a log.
const MOST_LINES: usize = 2_000;

/// A time in which something was so.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// From when.
    pub from: Micros,
    /// Until when.
    pub to: Micros,
}

/// What became of one hinge, in truth.
#[derive(Debug, Clone, PartialEq)]
pub struct HingeTruth {
    /// Its number in the plan.
    pub hinge: usize,
    /// What moves it.
    pub kind: Kind,
    /// Its channel.
    pub channel: usize,
    /// Where it stood before the run, degrees.
    pub start_deg: f64,
    /// Where it is to stand, degrees.
    pub goal_deg: f64,
    /// Where it stands.
    pub angle_deg: f64,
    /// When its actuator was first driven.
    pub driven_at: Option<Micros>,
    /// Steps before it, by index, that weren't truly open then.
    pub driven_before: Vec<usize>,
    /// How often its step began to move.
    pub starts: u32,
    /// Times in which its heater was powered.
    pub heated: Vec<Span>,
    /// The highest temperature of its foil, °C, and when that was.
    pub hottest: Option<(f64, Micros)>,
    after: Vec<usize>,
    state: StepState,
}

impl HingeTruth {
    /// It stands where it is to stand.
    pub fn is_open(&self) -> bool {
        (self.angle_deg - self.goal_deg).abs() <= ANGLE_TOLERANCE_DEG
    }

    /// It stands where it stood.
    pub fn has_not_moved(&self) -> bool {
        (self.angle_deg - self.start_deg).abs() <= ANGLE_TOLERANCE_DEG
    }
}

/// What the currents are held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Watch {
    /// More current than this, amperes, is too much.
    pub most_a: f64,
    /// Silence of the host after which everything is to be off.
    pub link_timeout: Millis,
}

/// The truth so far.
#[derive(Debug)]
pub struct Witness {
    watch: Watch,
    /// The hinges in the order of the steps.
    pub hinges: Vec<HingeTruth>,
    /// Times in which current flowed out of the supply.
    pub energised: Vec<Span>,
    /// Times in which current flowed through heaters.
    pub heated: Vec<Span>,
    /// Times of more current than allowed.
    pub over_current: Vec<Span>,
    /// Times of current in a state in which nothing may flow.
    pub unarmed: Vec<Span>,
    /// Times of current although the host had been silent for longer than the timeout.
    pub unheard: Vec<Span>,
    /// States of the MCU with when they began.
    pub states: Vec<(Micros, State)>,
    /// Faults that the MCU latched.
    pub faults: Vec<Fault>,
    /// What the board's end of the line hears.
    pub heard: Wiretap,
    log: Option<Vec<String>>,
}

impl Witness {
    /// Nothing seen yet of a board that is to run a schedule.
    pub fn new(schedule: &Schedule, watch: Watch, board: &impl Subject, with_log: bool) -> Self {
        let hinges = schedule
            .steps
            .iter()
            .map(|step| HingeTruth {
                hinge: step.hinge,
                kind: step.motion.kind(),
                channel: usize::from(step.channel),
                start_deg: f64::from(step.from_opening_deg),
                goal_deg: f64::from(step.opening_deg),
                angle_deg: f64::from(step.from_opening_deg),
                driven_at: None,
                driven_before: Vec::new(),
                starts: 0,
                heated: Vec::new(),
                hottest: None,
                after: step.after.clone(),
                state: StepState::Waiting,
            })
            .collect();
        Self {
            watch,
            hinges,
            energised: Vec::new(),
            heated: Vec::new(),
            over_current: Vec::new(),
            unarmed: Vec::new(),
            unheard: Vec::new(),
            states: vec![(board.now(), board.state())],
            faults: Vec::new(),
            heard: Wiretap::default(),
            log: with_log.then(Vec::new),
        }
    }

    /// Looks at the time from `from` until now, in which the MCU was in the state `then` and drove what it drove.
    pub(crate) fn look(&mut self, from: Micros, then: State, board: &impl Subject) {
        let span = Span { from, to: board.now() };
        let plant = board.plant();
        let current_a = plant.supply_a();
        if span.from < span.to && current_a > NO_CURRENT_A {
            note(&mut self.energised, span);
            if plant.heaters_a() > NO_CURRENT_A {
                note(&mut self.heated, span);
            }
            if current_a > self.watch.most_a {
                note(&mut self.over_current, span);
            }
            if !matches!(then, State::Armed | State::Running) {
                note(&mut self.unarmed, span);
            }
            let silence = span.to.since(self.heard.last_frame.unwrap_or_default());
            if silence > self.watch.link_timeout.to_micros() {
                note(&mut self.unheard, span);
            }
        }
        self.look_at_hinges(span, board);
    }

    fn look_at_hinges(&mut self, span: Span, board: &impl Subject) {
        let (now, plant) = (board.now(), board.plant());
        for hinge in &mut self.hinges {
            let angle = match hinge.kind {
                Kind::Sma => plant.sma_hinges().get(hinge.channel).map(|sma| {
                    if span.from < span.to && sma.heater_w() > 0.0 {
                        note(&mut hinge.heated, span);
                    }
                    let foil_c = sma.temperature_c();
                    if hinge.hottest.is_none_or(|(hottest_c, _)| foil_c > hottest_c) {
                        hinge.hottest = Some((foil_c, now));
                    }
                    sma.angle_deg()
                }),
                Kind::Servo => plant.servo_hinges().get(hinge.channel).map(ServoHinge::angle_deg),
                Kind::Spring => plant.spring_hinges().get(hinge.channel).map(SpringHinge::angle_deg),
            };
            hinge.angle_deg = angle.unwrap_or(f64::NAN);
        }
    }

    /// Looks at what the MCU decided just now.
    pub(crate) fn look_at_decisions(&mut self, board: &impl Subject) {
        let now = board.now();
        let state = board.state();
        if self.states.last().is_none_or(|(_, last)| *last != state) {
            self.states.push((now, state));
            self.say(now, || format!("MCU {state:?}"));
            if let Some(fault) = board.fault()
                && self.faults.last() != Some(&fault)
            {
                self.faults.push(fault);
                self.say(now, || format!("fault {} ({} against {})", fault.code, fault.value, fault.limit));
            }
        }
        self.look_at_steps(board);
        if state == State::Running {
            self.look_at_order(board);
        }
    }

    fn look_at_steps(&mut self, board: &impl Subject) {
        let now = board.now();
        let mut said = Vec::new();
        for (hinge, state) in self.hinges.iter_mut().zip(board.step_states()) {
            if hinge.state != state {
                if state == StepState::Moving {
                    hinge.starts += 1;
                }
                hinge.state = state;
                if self.log.is_some() {
                    said.push(format!("hinge {} {state:?}, truly at {:.1}°", hinge.hinge, hinge.angle_deg));
                }
            }
        }
        for line in said {
            self.say(now, || line);
        }
    }

    fn look_at_order(&mut self, board: &impl Subject) {
        for at in 0..self.hinges.len() {
            let Some(HingeTruth { kind, channel, driven_at: None, .. }) = self.hinges.get(at) else {
                continue;
            };
            if board.drives(*kind, *channel) {
                let closed = |before: &usize| self.hinges.get(*before).is_some_and(|hinge| !hinge.is_open());
                let before =
                    self.hinges.get(at).map(|hinge| hinge.after.iter().copied().filter(closed).collect());
                if let (Some(hinge), Some(before)) = (self.hinges.get_mut(at), before) {
                    hinge.driven_at = Some(board.now());
                    hinge.driven_before = before;
                }
            }
        }
    }

    /// Adds a line to the log, if there is one.
    pub(crate) fn say(&mut self, now: Micros, line: impl FnOnce() -> String) {
        if let Some(log) = &mut self.log
            && log.len() < MOST_LINES
        {
            #[expect(clippy::cast_precision_loss, reason = "a rehearsal is far shorter than 2^52 us")]
            let seconds = now.0 as f64 / 1e6;
            log.push(format!("{seconds:>10.3} s  {}", line()));
        }
    }

    /// The log, line by line.
    pub fn log(&self) -> &[String] {
        self.log.as_deref().unwrap_or_default()
    }

    /// How often the MCU entered a state.
    pub fn times_in(&self, state: State) -> usize {
        self.states.iter().filter(|(_, entered)| *entered == state).count()
    }

    /// From when on nothing of the kind was so any more, looking from `since` on; `since` itself if nothing was so then.
    pub fn over_by(spans: &[Span], since: Micros) -> Micros {
        spans.last().map_or(since, |span| span.to).max(since)
    }
}

/// Adds a span to those before it; two that touch are one.
fn note(spans: &mut Vec<Span>, span: Span) {
    match spans.last_mut() {
        Some(last) if last.to == span.from => last.to = span.to,
        _ => spans.push(span),
    }
}
