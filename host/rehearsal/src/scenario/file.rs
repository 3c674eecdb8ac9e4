//! A scenario file as it is typed. Unknown keys are refused here; what they mean is found out in `resolve`.

use serde::Deserialize;
use std::path::PathBuf;
use toml::Spanned;
use zygote_deployment::{Celsius, Ohms, Seconds, Volts};

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScenarioFile {
    pub(super) version: Spanned<u32>,
    pub(super) about: String,
    /// The safety rule that it shows, where it shows one.
    pub(super) rule: Option<String>,
    pub(super) job: Option<JobTable>,
    #[serde(default)]
    pub(super) line: LineTable,
    #[serde(default)]
    pub(super) cause: Vec<Spanned<CauseTable>>,
    pub(super) expect: Spanned<ExpectTable>,
}

/// What is deployed: a model, planned and scheduled on a rig.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JobTable {
    /// Relative to the scenario file.
    pub(super) model: PathBuf,
    #[serde(default = "one")]
    pub(super) piles: usize,
    #[serde(default = "one")]
    pub(super) parallel: usize,
    pub(super) rig: RigSource,
}

fn one() -> usize {
    1
}

/// The rig: a file, or its text.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum RigSource {
    File(PathBuf),
    Text(String),
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct LineTable {
    pub(super) seed: u64,
    pub(super) to_board: Option<ImpairmentTable>,
    pub(super) to_host: Option<ImpairmentTable>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct ImpairmentTable {
    pub(super) delay: Seconds,
    pub(super) loss: f64,
    pub(super) flip: f64,
    pub(super) duplicate: f64,
    pub(super) reorder: f64,
}

impl Default for ImpairmentTable {
    fn default() -> Self {
        Self { delay: Seconds(0.0), loss: 0.0, flip: 0.0, duplicate: 0.0, reorder: 0.0 }
    }
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CauseTable {
    #[serde(default)]
    pub(super) when: WhenTable,
    #[serde(default = "at_once")]
    pub(super) after: Seconds,
    pub(super) what: WhatTable,
}

fn at_once() -> Seconds {
    Seconds(0.0)
}

/// Exactly one of: `at`; `mcu`; `step` or `hinge` with `is`; `hinge` with `above`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct WhenTable {
    pub(super) at: Option<Seconds>,
    pub(super) mcu: Option<StateName>,
    pub(super) step: Option<usize>,
    pub(super) hinge: Option<usize>,
    pub(super) is: Option<StepName>,
    pub(super) above: Option<Celsius>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum StateName {
    Idle,
    Loaded,
    Armed,
    Running,
    Finished,
    Safe,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum StepName {
    Waiting,
    Moving,
    Opened,
    Done,
    Interrupted,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) enum WhatTable {
    ThermistorOpen { hinge: usize },
    ThermistorShorted { hinge: usize },
    ThermistorFrozen { hinge: usize },
    ThermistorLoose { hinge: usize },
    ThermistorDrifting { hinge: usize, kelvin_per_second: f64 },
    HeaterOpen { hinge: usize },
    HeaterShorted { hinge: usize, left: Ohms },
    MosfetStuckOn { hinge: usize },
    Jammed { hinge: usize },
    ServoStalled { hinge: usize },
    SupplyCut,
    SupplySag { voltage: Volts, resistance: Ohms },
    SupplyRestored,
    TasksStuck,
    McuStuck,
    Reset { cause: ResetName },
    StopPressed,
    StopReleased,
    StopFrame,
    LineCut { way: Option<WayName>, span: Option<Seconds> },
    LineBad { way: Option<WayName>, line: ImpairmentTable },
    LineGood,
    HostKilled,
    UserStops,
    SecondHost,
    FramesReplayed,
    Noise { bytes: usize },
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ResetName {
    Power,
    Pin,
    Watchdog,
    Software,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum WayName {
    ToBoard,
    ToHost,
    Both,
}

/// What must be the case in the end. Every key may be left out but `outcome`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExpectTable {
    pub(super) outcome: OutcomeName,
    /// Code of the fault that the MCU latched, or "none".
    pub(super) fault: Option<String>,
    /// Words that the host's report or refusal must contain.
    pub(super) says: Option<String>,
    /// No current through any heater after this time from `since`.
    pub(super) heaters_off_within: Option<Seconds>,
    /// The hinge whose heater `heaters_off_within` is about; all of them unless set.
    pub(super) heater_of: Option<usize>,
    /// No current out of the supply after this time from `since`.
    pub(super) off_within: Option<Seconds>,
    #[serde(default)]
    pub(super) since: Since,
    /// No foil was ever hotter.
    pub(super) never_above: Option<Celsius>,
    /// Hinges that truly stand at their angle in the end; no others do.
    pub(super) open: Option<Open>,
    /// The host ended within this time from the first cause.
    pub(super) host_knows_within: Option<Seconds>,
    /// How long the board is watched after the host's end.
    #[serde(default = "afterwards")]
    pub(super) afterwards: Seconds,
}

fn afterwards() -> Seconds {
    Seconds(3.0)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum OutcomeName {
    Deployed,
    Stopped,
    Paused,
    Fault,
    Lost,
    Refused,
    Killed,
}

/// What times are counted from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
pub(super) enum Since {
    /// The first cause.
    #[default]
    #[serde(rename = "cause")]
    Cause,
    /// The start of the run.
    #[serde(rename = "start")]
    Start,
    /// The link timeout after the last frame of the host that reached the board.
    #[serde(rename = "link loss")]
    LinkLoss,
}

/// "all", or the numbers of hinges.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub(super) enum Open {
    Word(All),
    Hinges(Vec<usize>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum All {
    All,
}
