//! Where a run is as people see it, and what they may ask for there.

use serde::{Deserialize, Serialize};

/// What a page may ask for; a stop besides, from anywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "order", rename_all = "snake_case")]
pub enum Order {
    /// Load a run.
    Choose {
        /// Which of those on offer.
        run: usize,
    },
    /// Arm what is loaded.
    Arm,
    /// Take the arming back.
    Disarm,
    /// Start what is armed.
    Start,
    /// Pause what runs.
    Pause,
    /// No longer pause.
    GoOn,
    /// Load what is left of the run.
    Resume {
        /// Servos that were interrupted stand again where they started.
        #[serde(default)]
        back: bool,
    },
    /// Leave the safe state: somebody has looked at the rig.
    Clear,
    /// Give up what is loaded.
    Unload,
    /// End the program.
    End,
}

impl Order {
    /// Its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Choose { .. } => "choose",
            Self::Arm => "arm",
            Self::Disarm => "disarm",
            Self::Start => "start",
            Self::Pause => "pause",
            Self::GoOn => "go_on",
            Self::Resume { .. } => "resume",
            Self::Clear => "clear",
            Self::Unload => "unload",
            Self::End => "end",
        }
    }
}

/// Where the run is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Stage {
    /// Its name.
    pub stage: &'static str,
    /// In a sentence.
    pub told: String,
    /// Orders that are taken now.
    pub can: Vec<&'static str>,
    /// Servos that were interrupted: their hinges have to be brought back by hand before the run goes on.
    pub interrupted: Vec<usize>,
}

impl Stage {
    /// Somewhere, where these orders are taken.
    pub fn new(stage: &'static str, told: impl Into<String>, can: &[&'static str]) -> Self {
        Self { stage, told: told.into(), can: can.to_vec(), interrupted: Vec::new() }
    }

    /// Nothing can be asked for: it works on it.
    pub fn busy(told: impl Into<String>) -> Self {
        Self::new("busy", told, &[])
    }

    pub(crate) fn loaded() -> Self {
        let told = "The program is on the MCU and checked. Nothing is energised.";
        Self::new("loaded", told, &["arm", "unload"])
    }

    pub(crate) fn armed() -> Self {
        let told = "The main switch is closed; nothing moves yet. After a minute the arming is taken back.";
        Self::new("armed", told, &["start", "disarm"])
    }

    pub(crate) fn running() -> Self {
        Self::new("running", "The MCU goes on by itself.", &["pause"])
    }

    pub(crate) fn pausing() -> Self {
        let told = "Everything goes off as soon as no servo is on its way.";
        Self::new("pausing", told, &["go_on"])
    }
}
