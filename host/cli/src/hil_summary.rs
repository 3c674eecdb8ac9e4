//! What a run of the serial suite came to: its record as a table.

use anyhow::{Context, Result};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// The record of a run, as far as the table needs it.
#[derive(Deserialize)]
pub(crate) struct Summary {
    metadata: BTreeMap<String, String>,
    phases: Vec<Phase>,
}

/// A test.
#[derive(Deserialize)]
struct Phase {
    name: String,
    level: String,
    outcome: Outcome,
    outcome_details: Vec<String>,
    measurements: BTreeMap<String, Measurement>,
    attachments: BTreeMap<String, String>,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
enum Outcome {
    Pass,
    Fail,
    Error,
    Skip,
}

#[derive(Deserialize)]
struct Measurement {
    marginal: bool,
}

/// Counts of a level's tests.
#[derive(Default)]
struct Row {
    passed: usize,
    failed: usize,
    skipped: usize,
    measured: usize,
    marginal: usize,
}

impl Summary {
    /// Reads a record.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let text = fs::read_to_string(path)
            .with_context(|| format!("{}: the tests left no record", path.display()))?;
        serde_json::from_str(&text).with_context(|| format!("{}: no record of the suite", path.display()))
    }

    /// Tests that ran or were skipped.
    pub(crate) fn total(&self) -> usize {
        self.phases.len()
    }

    /// Tests that failed, or that couldn't be set up.
    pub(crate) fn failed(&self) -> usize {
        self.phases.iter().filter(|phase| phase.is_bad()).count()
    }

    /// A line a level, and what failed with its reason.
    pub(crate) fn table(&self) -> String {
        let mut rows: Vec<(&str, Row)> = Vec::new();
        for phase in &self.phases {
            let at = rows.iter().position(|(level, _)| *level == phase.level).unwrap_or_else(|| {
                rows.push((&phase.level, Row::default()));
                rows.len() - 1
            });
            if let Some((_, row)) = rows.get_mut(at) {
                row.count(phase);
            }
        }
        let told = |key: &str| self.metadata.get(key).map_or("?", String::as_str);
        let mut text = format!(
            "\n{} ({}), board {}, firmware {} ({}), rig {}, seed {}\n\n",
            told("bench"),
            told("target"),
            told("board"),
            told("firmware"),
            told("firmware_git"),
            told("rig"),
            told("seed")
        );
        text += "level        passed  failed  skipped  measured  marginal\n";
        for (level, Row { passed, failed, skipped, measured, marginal }) in rows {
            // Writing to a string doesn't fail.
            writeln!(text, "{level:<11} {passed:>7} {failed:>7} {skipped:>8} {measured:>9} {marginal:>9}")
                .ok();
        }
        for phase in self.phases.iter().filter(|phase| phase.is_bad()) {
            writeln!(text, "\nfailed: {}\n  {}", phase.name, phase.reason()).ok();
            for file in phase.attachments.values() {
                writeln!(text, "  see {file}").ok();
            }
        }
        for phase in self.phases.iter().filter(|phase| phase.outcome == Outcome::Skip) {
            writeln!(text, "skipped: {}: {}", phase.name, phase.reason()).ok();
        }
        text
    }
}

impl Phase {
    fn is_bad(&self) -> bool {
        matches!(self.outcome, Outcome::Fail | Outcome::Error)
    }

    /// pytest marks the lines that tell the error.
    fn reason(&self) -> &str {
        let lines = || self.outcome_details.iter().flat_map(|detail| detail.lines());
        let error = lines().find_map(|line| line.strip_prefix("E  "));
        error.or_else(|| lines().next_back()).unwrap_or("no reason told").trim()
    }
}

impl Row {
    fn count(&mut self, phase: &Phase) {
        match phase.outcome {
            Outcome::Pass => self.passed += 1,
            Outcome::Fail | Outcome::Error => self.failed += 1,
            Outcome::Skip => self.skipped += 1,
        }
        self.measured += phase.measurements.len();
        self.marginal += phase.measurements.values().filter(|one| one.marginal).count();
    }
}
