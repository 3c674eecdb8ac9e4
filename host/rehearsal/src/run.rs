//! One rehearsal: the real controller deploys over the simulated line, things go wrong, and the truth is noted.

use crate::board::{BoardError, channels, plant};
use crate::cause::{Cause, Way};
use crate::script::Script;
use crate::stage::Stage;
use crate::subject::Subject;
use crate::witness::{Watch, Witness};
use std::collections::BTreeSet;
use std::io;
use zygote_controller::{Deployment, EventLog, RunReport, Session, deploy};
use zygote_deployment::{Rig, Schedule};
use zygote_protocol::{Micros, Millis};
use zygote_sim::plant::Config;
use zygote_sim::{Board, Impairment};

/// How long an answer to the hello is waited for.
pub(crate) const HELLO_PATIENCE: Millis = Millis(2_000);
/// Session, run and boot, so that every rehearsal is the same.
pub(crate) const NUMBER: u32 = 1;
/// S3: everything is off so long after the link timeout.
pub(crate) const LINK_GRACE: Millis = Millis(50);
/// S7: measured current may show so much above the limit, per cent.
const CURRENT_MARGIN_PER_CENT: f64 = 10.0;
/// Standard deviations of the current's noise that no filter of three readings exceeds in a campaign.
const NOISE_SIGMAS: f64 = 5.0;

/// What is rehearsed.
#[derive(Debug, Clone)]
pub struct Trial {
    /// The rig as the host knows it.
    pub rig: Rig,
    /// What it runs.
    pub schedule: Schedule,
    /// The rig as it truly is.
    pub plant: Config,
    /// What goes wrong.
    pub causes: Vec<Cause>,
    /// What is wrong with the line from the start on.
    pub line: Vec<(Way, Impairment)>,
    /// Of all chance on the line.
    pub seed: u64,
    /// The host must have ended by then.
    pub most: Millis,
    /// How long the board is watched after the host's end.
    pub afterwards: Millis,
    /// Keep a log of what happens.
    pub log: bool,
}

/// How the host's program ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// With a report.
    Report(Box<RunReport>),
    /// Hinges were measured, so many of them to the end.
    Measured {
        /// To the end.
        done: usize,
        /// All.
        of: usize,
    },
    /// Nothing was started, or a calibration broke off.
    Refused(String),
    /// It was killed.
    Killed,
}

/// A rehearsal in retrospect.
pub struct Rehearsed {
    /// How the host ended, and when.
    pub ending: Ending,
    /// Virtual time of the host's end.
    pub ended_at: Micros,
    /// The host didn't end in time.
    pub overran: bool,
    /// What truly happened.
    pub witness: Witness,
    /// What went wrong, and when.
    pub script: Script,
}

impl Trial {
    /// A run in which nothing goes wrong, on the plant that the rig file describes.
    ///
    /// # Errors
    /// A rig that can't be simulated.
    pub fn new(rig: Rig, schedule: Schedule) -> Result<Self, BoardError> {
        let plant = plant(&rig, Some(&schedule))?;
        let (causes, line) = (Vec::new(), Vec::new());
        let (most, afterwards) = (Millis(u32::MAX), Millis(0));
        Ok(Self { rig, schedule, plant, causes, line, seed: 0, most, afterwards, log: false })
    }

    /// Runs it.
    ///
    /// # Errors
    /// A rig that can't be simulated, or a cause that its plant can't have.
    pub fn run(&self) -> Result<Rehearsed, BoardError> {
        self.run_in(self.open()?)
    }

    /// Runs it on another board than the simulated one.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn run_on<B: Subject>(&self, board: B) -> Result<Rehearsed, BoardError> {
        self.run_in(self.open_on(board))
    }

    fn run_in<B: Subject>(&self, mut stage: Stage<B>) -> Result<Rehearsed, BoardError> {
        let stop = stage.user_stops();
        let ending = match Session::connect(&mut stage, NUMBER, HELLO_PATIENCE) {
            Err(error) => Ending::Refused(error.to_string()),
            Ok(mut session) => {
                let deployment = Deployment {
                    schedule: &self.schedule,
                    rig: &self.rig,
                    run: NUMBER,
                    open: &BTreeSet::new(),
                    clear: false,
                    // What goes wrong on the simulator harms no hinge.
                    any_board: true,
                    interrupted: &|| stop.get(),
                    steer: None,
                };
                match deploy(&mut session, &deployment, &mut EventLog::new(io::sink()), &mut |_| {}) {
                    Ok(report) => Ending::Report(Box::new(report)),
                    Err(error) => Ending::Refused(error.to_string()),
                }
            }
        };
        self.close(stage, ending)
    }

    /// What is seen when the host has ended so.
    ///
    /// # Errors
    /// A cause that the plant can't have.
    pub fn close<B: Subject>(&self, mut stage: Stage<B>, ending: Ending) -> Result<Rehearsed, BoardError> {
        let ending = if stage.host_is_killed() { Ending::Killed } else { ending };
        let (ended_at, overran) = (stage.board().now(), stage.is_over());
        watch(&mut stage, ended_at.plus(self.afterwards))?;
        let (witness, script) = stage.into_parts();
        Ok(Rehearsed { ending, ended_at, overran, witness, script })
    }

    /// The stage, for a host of one's own; [`Self::close`] ends it.
    ///
    /// # Errors
    /// A rig that can't be simulated.
    pub fn open(&self) -> Result<Stage, BoardError> {
        Ok(self.open_on(Board::new(&self.plant, channels(&self.rig)?, NUMBER)?))
    }

    /// The stage with another board than the simulated one.
    pub fn open_on<B: Subject>(&self, board: B) -> Stage<B> {
        let witness = Witness::new(&self.schedule, self.bounds(), &board, self.log);
        let mut stage = Stage::new(board, witness, Script::new(self.causes.clone()), self.seed)
            .until(Micros(0).plus(self.most));
        for (way, impairment) in &self.line {
            stage.impair(*way, *impairment);
        }
        stage
    }

    /// Silence of the host after which the MCU turns everything off.
    pub(crate) fn link_timeout(&self) -> Millis {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 to 5,000 by the rules of the rig file"
        )]
        let ms = (self.rig.link.timeout.0 * 1e3).round() as u32;
        Millis(ms)
    }

    fn bounds(&self) -> Watch {
        let limit_a = self.schedule.supply_limit.0 as f64 / 1e3;
        let noise_a = NOISE_SIGMAS * self.plant.supply.current_noise_ma / 1e3;
        let timeout = self.link_timeout();
        Watch {
            most_a: limit_a * (1.0 + CURRENT_MARGIN_PER_CENT / 100.0) + noise_a,
            link_timeout: Millis(timeout.0 + LINK_GRACE.0),
        }
    }
}

/// Lets time pass without a host.
fn watch<B: Subject>(stage: &mut Stage<B>, until: Micros) -> Result<(), BoardError> {
    while stage.board().now() < until {
        stage.step(until)?;
    }
    Ok(())
}
