//! What came of a run (S12): which hinges moved, which didn't, why, and what to do next.

use crate::{ClockFit, DriftVerdict, HingeDrift};
use serde::{Deserialize, Serialize};
use std::fmt;
use zygote_deployment::{Direction, Kind, Schedule};
use zygote_protocol::{LinkCounters, StepState};

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "outcome", content = "why", rename_all = "snake_case")]
pub enum Outcome {
    /// Every hinge is open.
    Deployed,
    /// Every hinge is closed again.
    Folded,
    /// The user stopped it, and the MCU confirmed.
    Stopped,
    /// The user paused it: the MCU was disarmed, and everything is off.
    Paused,
    /// The MCU turned everything off.
    Fault(String),
    /// The session broke; the MCU turns everything off by itself.
    Lost(String),
}

/// What became of one hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HingeOutcome {
    /// Open, or closed where the run folds the shape up.
    Opened,
    /// It was moving when everything went off; its angle isn't known.
    Interrupted,
    /// It never started.
    NotMoved,
}

/// One hinge of the run. Times are MCU time from the start of the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HingeReport {
    /// Number of the hinge in the plan.
    pub hinge: usize,
    /// What moves it.
    pub kind: Kind,
    /// Its channel.
    pub channel: u16,
    /// What became of it.
    pub outcome: HingeOutcome,
    /// When it started, s.
    pub started_s: Option<f64>,
    /// When it was at its angle, s.
    pub opened_s: Option<f64>,
    /// When it was at its angle and cool, s.
    pub done_s: Option<f64>,
    /// Highest temperature measured, °C.
    pub peak_c: Option<f64>,
}

/// A run in retrospect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// The run's number.
    pub run: u32,
    /// The rig.
    pub rig: String,
    /// The board's name.
    pub board: String,
    /// Version of its firmware.
    pub firmware: String,
    /// Which way it went.
    pub direction: Direction,
    /// How it ended.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// MCU time from the start to the end of the run, s.
    pub duration_s: f64,
    /// Time that the schedule expected until the last hinge is at its angle, s.
    pub expected_s: f64,
    /// The hinges, in the order of the steps.
    pub hinges: Vec<HingeReport>,
    /// Frames that this side got damaged, and data frames that it sent again.
    pub damaged_frames: u32,
    /// See `damaged_frames`.
    pub repeated_frames: u32,
    /// The MCU's clock against the host's; none when the MCU never told its time.
    pub clock: Option<ClockFit>,
    /// Hinges held against their calibration, where they have one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drift: Vec<HingeDrift>,
    /// What to do now.
    pub next: String,
}

impl RunReport {
    /// A report in which nothing has happened yet.
    pub(crate) fn new(run: u32, schedule: &Schedule, board: &str, firmware: &str) -> Self {
        let hinges = schedule
            .steps
            .iter()
            .map(|step| HingeReport {
                hinge: step.hinge,
                kind: step.motion.kind(),
                channel: step.channel,
                outcome: HingeOutcome::NotMoved,
                started_s: None,
                opened_s: None,
                done_s: None,
                peak_c: None,
            })
            .collect();
        Self {
            run,
            rig: schedule.rig.clone(),
            board: board.to_owned(),
            firmware: firmware.to_owned(),
            direction: schedule.direction(),
            outcome: Outcome::Deployed,
            duration_s: 0.0,
            #[expect(clippy::cast_precision_loss, reason = "a makespan is far below 2^52 ms")]
            expected_s: schedule.makespan.0 as f64 / 1e3,
            hinges,
            damaged_frames: 0,
            repeated_frames: 0,
            clock: None,
            drift: Vec::new(),
            next: String::new(),
        }
    }

    /// Puts hinges in front that an earlier run moved.
    pub(crate) fn precede(&mut self, earlier: Self) {
        let all =
            earlier.hinges.into_iter().map(|hinge| HingeReport { outcome: HingeOutcome::Opened, ..hinge });
        self.hinges.splice(0..0, all);
    }

    /// Takes over what the MCU says of a step, which is the last word on it.
    pub(crate) fn settle(&mut self, step: usize, state: StepState) {
        if let Some(hinge) = self.hinges.get_mut(step) {
            hinge.outcome = match state {
                StepState::Waiting => HingeOutcome::NotMoved,
                StepState::Moving | StepState::Interrupted => HingeOutcome::Interrupted,
                StepState::Opened | StepState::Done => HingeOutcome::Opened,
            };
        }
    }

    /// Ends the report.
    pub(crate) fn finish(&mut self, outcome: Outcome, counters: LinkCounters, clock: Option<ClockFit>) {
        self.clock = clock;
        self.damaged_frames = counters.bad;
        self.repeated_frames = counters.repeated;
        self.next = advice(&outcome, self.count(HingeOutcome::Interrupted));
        self.outcome = outcome;
    }

    /// How many hinges ended so.
    pub fn count(&self, outcome: HingeOutcome) -> usize {
        self.hinges.iter().filter(|hinge| hinge.outcome == outcome).count()
    }

    /// Every hinge is at its angle.
    pub fn is_complete(&self) -> bool {
        self.outcome == complete(self.direction) && self.count(HingeOutcome::Opened) == self.hinges.len()
    }
}

/// How a run that goes this way ends if nothing goes wrong.
pub(crate) fn complete(direction: Direction) -> Outcome {
    match direction {
        Direction::Deploy => Outcome::Deployed,
        Direction::Fold => Outcome::Folded,
    }
}

impl RunReport {
    fn tell_drift(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.drift.is_empty() {
            return Ok(());
        }
        let of = |verdict| self.drift.iter().filter(move |hinge| hinge.verdict == verdict);
        let (kept, all) = (of(DriftVerdict::Keep).count(), self.drift.len());
        writeln!(f, "calibration: {kept} of {all} hinges are as they were measured")?;
        for hinge in of(DriftVerdict::Recalibrate) {
            writeln!(f, "recalibrate hinge {}: {}", hinge.hinge, hinge.why.join("; "))?;
        }
        let unclear: Vec<_> = of(DriftVerdict::CannotTell).map(|hinge| hinge.hinge.to_string()).collect();
        if unclear.is_empty() {
            return Ok(());
        }
        writeln!(f, "not shown by this run: hinges {}; `zygote drift` says why", unclear.join(", "))
    }
}

fn advice(outcome: &Outcome, interrupted: usize) -> String {
    let look = if interrupted == 0 {
        "no hinge was moving at that moment"
    } else {
        "look at the hinges that were interrupted: their angle isn't known"
    };
    match outcome {
        Outcome::Deployed => "nothing: every hinge is open".to_owned(),
        Outcome::Folded => "nothing: every hinge is closed".to_owned(),
        Outcome::Paused => format!("{look}; go on from here with --resume and this report"),
        Outcome::Stopped | Outcome::Fault(_) => {
            format!("{look}; mend what is wrong, and go on from here with --clear --resume and this report")
        }
        Outcome::Lost(_) => format!(
            "{look}; the MCU has turned everything off by itself: check cable and power, then go on from here with --clear --resume and this report"
        ),
    }
}

impl fmt::Display for RunReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (total, opened) = (self.hinges.len(), self.count(HingeOutcome::Opened));
        let (done, at_angle) = match self.direction {
            Direction::Deploy => ("deployed", "open"),
            Direction::Fold => ("folded", "closed"),
        };
        let hinges = format!("{opened} of {total} hinges are {at_angle}");
        match &self.outcome {
            Outcome::Deployed | Outcome::Folded => writeln!(f, "{done}: {hinges}")?,
            Outcome::Stopped => writeln!(f, "stopped: {hinges}")?,
            Outcome::Paused => writeln!(f, "paused: {hinges}")?,
            Outcome::Fault(why) | Outcome::Lost(why) => writeln!(f, "not {done}: {hinges}; {why}")?,
        }
        for (name, outcome) in
            [("interrupted", HingeOutcome::Interrupted), ("not moved", HingeOutcome::NotMoved)]
        {
            let hinges: Vec<_> = self.hinges.iter().filter(|hinge| hinge.outcome == outcome).collect();
            if !hinges.is_empty() {
                let numbers: Vec<_> = hinges.iter().map(|hinge| hinge.hinge.to_string()).collect();
                writeln!(f, "{name}: hinges {}", numbers.join(", "))?;
            }
        }
        writeln!(
            f,
            "duration: {:.1} s (expected {:.1} s until the last hinge is {at_angle})",
            self.duration_s, self.expected_s
        )?;
        let peak = self.hinges.iter().filter_map(|hinge| hinge.peak_c).fold(f64::NEG_INFINITY, f64::max);
        if peak.is_finite() {
            writeln!(f, "hottest hinge: {peak:.1} °C")?;
        }
        if let Some(ClockFit { rate_ppm, residual_us, exchanges, .. }) = self.clock {
            writeln!(
                f,
                "MCU clock: {rate_ppm:+.1} ppm, residual {residual_us:.0} us ({exchanges} readings)"
            )?;
        }
        self.tell_drift(f)?;
        write!(f, "next: {}", self.next)
    }
}
