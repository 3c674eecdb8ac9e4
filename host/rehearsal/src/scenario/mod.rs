//! Scenario files: what is deployed, what goes wrong and when, and what must happen. `docs/src/rehearsal.md` is their
//! page.

mod error;
mod file;
mod resolve;
mod verdict;

pub use error::ScenarioError;
pub use verdict::{Row, Verdict, table};

use crate::board;
use crate::cause::Way;
use crate::run::{Rehearsed, Trial};
use file::{RigSource, ScenarioFile};
use resolve::At;
use std::path::{Path, PathBuf};
use std::{fs, io};
use toml::Spanned;
use zygote_deployment::{Limits, Order, Rig, Schedule, Tree};
use zygote_protocol::Millis;
use zygote_sim::Impairment;
use zygote_stacking::{Model, Request};

/// The one version of the scenario file.
const VERSION: u32 = 1;
/// No scenario goes on for longer.
const MOST: Millis = Millis(3_600_000);

/// A scenario.
#[derive(Debug, Clone)]
pub struct Scenario {
    /// Its file, as the user named it.
    pub file: String,
    /// What it is about, in a line.
    pub about: String,
    /// The safety rule that it shows.
    pub rule: Option<String>,
    text: String,
    content: ScenarioFile,
}

impl Scenario {
    /// Reads a scenario file.
    ///
    /// # Errors
    /// [`ScenarioError`] with the line.
    pub fn open(path: &Path) -> Result<Self, ScenarioError> {
        let file = path.display().to_string();
        let text = read(path)?;
        Self::read(&file, &text)
    }

    /// Reads the text of a scenario file; `file` is its name in messages.
    ///
    /// # Errors
    /// [`ScenarioError`] with the line.
    pub fn read(file: &str, text: &str) -> Result<Self, ScenarioError> {
        let content: ScenarioFile = toml::from_str(text).map_err(|error| ScenarioError::Parse {
            file: file.to_owned(),
            line: line_of(text, error.span().map_or(0, |span| span.start)),
            message: error.message().to_owned(),
        })?;
        let version = *content.version.get_ref();
        if version != VERSION {
            let at = At { file, line: line_of(text, content.version.span().start) };
            return Err(at.refuse("version", VERSION.to_string(), version.to_string()));
        }
        let scenario = Self {
            file: file.to_owned(),
            about: content.about.clone(),
            rule: content.rule.clone(),
            text: text.to_owned(),
            content,
        };
        verdict::check(scenario.at(&scenario.content.expect), scenario.content.expect.get_ref())?;
        Ok(scenario)
    }

    /// The scenario files of a folder, or the one file that a path names; in the order of their names.
    ///
    /// # Errors
    /// [`ScenarioError`] for the first that can't be used.
    pub fn find(path: &Path) -> Result<Vec<Self>, ScenarioError> {
        let mut files = Vec::new();
        if path.is_dir() {
            let failed = |source: io::Error| ScenarioError::Read { file: path.display().to_string(), source };
            for entry in fs::read_dir(path).map_err(failed)? {
                let found = entry.map_err(failed)?.path();
                if found.extension().is_some_and(|ending| ending == "toml") {
                    files.push(found);
                }
            }
            files.sort();
        } else {
            files.push(path.to_owned());
        }
        files.iter().map(|file| Self::open(file)).collect()
    }

    /// The file's name without folder and ending.
    pub fn name(&self) -> String {
        Path::new(&self.file)
            .file_stem()
            .map_or_else(|| self.file.clone(), |stem| stem.to_string_lossy().into_owned())
    }

    /// What it is about, planned and scheduled, with its causes.
    ///
    /// # Errors
    /// [`ScenarioError`].
    pub fn trial(&self) -> Result<Trial, ScenarioError> {
        let job =
            self.content.job.as_ref().ok_or_else(|| ScenarioError::NoJob { file: self.file.clone() })?;
        let rig = match &job.rig {
            RigSource::File(path) => {
                let path = self.beside(path);
                self.job("the rig", Rig::read(&path.display().to_string(), &read(&path)?))?
            }
            RigSource::Text(text) => {
                self.job("the rig", Rig::read(&format!("{} (rig.text)", self.file), text))?
            }
        };
        let model = self.job("the model", Model::read(&self.beside(&job.model), None))?;
        let request = Request { piles: job.piles, ..Request::default() };
        let plan = self.job("the plan", zygote_stacking::plan(&model, &request))?;
        let order = Order::of_tree(&self.job("the plan", Tree::new(&plan))?);
        let schedule = Schedule::plan(&plan, &rig, &order, &Limits::at_most(job.parallel));
        self.trial_of(rig, self.job("the schedule", schedule)?)
    }

    /// The causes of this scenario in a run of the user's own.
    ///
    /// # Errors
    /// [`ScenarioError`], for a hinge that the schedule doesn't have among others.
    pub fn trial_of(&self, rig: Rig, schedule: Schedule) -> Result<Trial, ScenarioError> {
        let plant = board::plant(&rig, Some(&schedule))
            .map_err(|source| ScenarioError::Board { file: self.file.clone(), source: Box::new(source) })?;
        let causes = self.content.cause.iter();
        let causes = causes.map(|cause| resolve::cause(self.at(cause), cause.get_ref(), &schedule));
        let expect = &self.content.expect;
        Ok(Trial {
            causes: causes.collect::<Result<_, _>>()?,
            line: self.line()?,
            seed: self.content.line.seed,
            most: MOST,
            afterwards: resolve::millis(self.at(expect), "afterwards", expect.get_ref().afterwards)?,
            log: false,
            rig,
            schedule,
            plant,
        })
    }

    fn line(&self) -> Result<Vec<(Way, Impairment)>, ScenarioError> {
        resolve::line(At { file: &self.file, line: 1 }, &self.content.line)
    }

    /// Runs it and judges it.
    ///
    /// # Errors
    /// [`ScenarioError`].
    pub fn rehearse(&self) -> Result<Verdict, ScenarioError> {
        let trial = self.trial()?;
        let rehearsed = trial
            .run()
            .map_err(|source| ScenarioError::Board { file: self.file.clone(), source: Box::new(source) })?;
        Ok(self.judge(&trial, &rehearsed))
    }

    /// Holds a rehearsal against what is expected, and against the rules that always hold.
    pub fn judge(&self, trial: &Trial, rehearsed: &Rehearsed) -> Verdict {
        verdict::judge(self, self.content.expect.get_ref(), trial, rehearsed)
    }

    fn beside(&self, path: &Path) -> PathBuf {
        Path::new(&self.file).parent().unwrap_or(Path::new("")).join(path)
    }

    fn at<T>(&self, table: &Spanned<T>) -> At<'_> {
        At { file: &self.file, line: line_of(&self.text, table.span().start) }
    }

    fn job<T, E: std::error::Error + Send + Sync + 'static>(
        &self,
        what: &'static str,
        result: Result<T, E>,
    ) -> Result<T, ScenarioError> {
        result.map_err(|source| ScenarioError::Job {
            file: self.file.clone(),
            what,
            source: Box::new(source),
        })
    }
}

fn read(path: &Path) -> Result<String, ScenarioError> {
    fs::read_to_string(path)
        .map_err(|source| ScenarioError::Read { file: path.display().to_string(), source })
}

/// The line, from 1, of a place in a text.
fn line_of(text: &str, place: usize) -> usize {
    1 + text.bytes().take(place).filter(|byte| *byte == b'\n').count()
}

#[cfg(test)]
mod tests;
