//! The program as a whole process, measured; and one row of the table of planning: `zygote plan` several times, and what it
//! says of its plan.

use crate::tools;
use anyhow::{Context, Result, ensure};
use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// GNU time, which tells the most memory that a process held at once, in kilobytes, and the seconds of processor time it took.
const TIME: &str = "/usr/bin/time";
/// What a row holds where nothing is known.
const UNKNOWN: &str = "";

/// The program, and the folder where models and plans stand.
pub(super) struct Bench {
    pub(super) program: PathBuf,
    pub(super) place: PathBuf,
}

/// What the runs of one command came to.
pub(super) enum Row {
    /// Seconds in order, what GNU time said of each run, what the program said, and whether a check found the plan valid.
    Planned { seconds: Vec<f64>, used: Vec<Used>, said: String, valid: bool },
    /// What the program said in place of a plan.
    Refused(String),
}

/// One run of the program.
pub(super) struct Run {
    pub(super) seconds: f64,
    /// What GNU time said, where there is one.
    pub(super) used: Option<Used>,
    pub(super) said: String,
    /// What it said on the error output.
    pub(super) complaint: String,
    /// 0 is good; none where it was killed.
    pub(super) code: Option<i32>,
}

/// What one run used.
pub(super) struct Used {
    kilobytes: f64,
    pub(super) processor_seconds: f64,
}

impl Used {
    /// Reads the last line that a command left under GNU time.
    fn of(complaint: &str) -> Option<Self> {
        let numbers: Vec<f64> = complaint.lines().next_back()?.split(' ').flat_map(str::parse).collect();
        let [kilobytes, user, system] = numbers[..] else { return None };
        Some(Self { kilobytes, processor_seconds: user + system })
    }
}

pub(super) const HEAD: &str = "| instance | N | K | seconds, median (min to max) | CPU s | peak MB | bridges | cut | depth | valid |\n|---|---|---|---|---|---|---|---|---|---|";

impl Bench {
    /// Runs the program once.
    pub(super) fn run<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Result<Run> {
        let timed = Path::new(TIME).is_file();
        let mut command = if timed { Command::new(TIME) } else { Command::new(&self.program) };
        if timed {
            command.args(["-q", "-f", "%M %U %S"]).arg(&self.program);
        }
        let begin = Instant::now();
        let output = command
            .args(arguments)
            .output()
            .with_context(|| format!("cannot start {}", self.program.display()))?;
        let seconds = begin.elapsed().as_secs_f64();
        let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
        let used = Used::of(&complaint);
        // Without the line that GNU time adds.
        let words: Vec<_> = complaint.lines().filter(|line| Used::of(line).is_none()).collect();
        Ok(Run {
            seconds,
            used,
            said: String::from_utf8_lossy(&output.stdout).into_owned(),
            complaint: words.join(" "),
            code: output.status.code(),
        })
    }

    /// Plans a model several times.
    pub(super) fn measure(&self, model: &Path, piles: usize, runs: usize) -> Result<Row> {
        let plan = self.place.join("plan.fold");
        let (mut seconds, mut used, mut said) = (Vec::with_capacity(runs), Vec::new(), String::new());
        for _ in 0..runs {
            let piles = piles.to_string();
            let asked =
                ["plan".as_ref(), model.as_os_str(), "--piles".as_ref(), piles.as_ref(), "--output".as_ref()];
            let run = self.run(asked.into_iter().chain([plan.as_os_str()]))?;
            if run.code != Some(0) {
                let reason = run.complaint.split_once(&format!("{}: ", model.display()));
                let reason = reason.map(|(_, reason)| reason.into());
                return Ok(Row::Refused(reason.unwrap_or(run.complaint)));
            }
            seconds.push(run.seconds);
            used.extend(run.used);
            said = run.said;
        }
        seconds.sort_by(f64::total_cmp);
        // A process of its own reads the file again and checks it by rules that share no code with the planner.
        let valid = tools::output_of(Command::new(&self.program).arg("check").arg(&plan)).is_ok();
        Ok(Row::Planned { seconds, used, said, valid })
    }

    /// Prints a row.
    ///
    /// # Errors
    /// The program doesn't start, or made a plan that is wrong.
    pub(super) fn row(
        &self,
        name: &str,
        model: &Path,
        panels: usize,
        piles: usize,
        runs: usize,
    ) -> Result<()> {
        let row = self.measure(model, piles, runs)?;
        println!("| {name} | {panels} | {piles} | {row} |");
        ensure!(!matches!(row, Row::Planned { valid: false, .. }), "{name}, K = {piles}: a wrong plan");
        Ok(())
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Planned { seconds, used, said, valid } => {
                write!(f, "{}", spread(seconds))?;
                let mut processor: Vec<f64> = used.iter().map(|run| run.processor_seconds).collect();
                processor.sort_by(f64::total_cmp);
                let most = used.iter().map(|run| run.kilobytes).reduce(f64::max);
                match (processor.get(processor.len() / 2), most) {
                    (Some(median), Some(most)) => write!(f, " | {median:.2} | {:.0}", most / 1024.0)?,
                    _ => write!(f, " | {UNKNOWN} | {UNKNOWN}")?,
                }
                for label in ["bridges: ", "cut edges: ", "depth of the tree path: "] {
                    write!(f, " | {}", number_after(said, label))?;
                }
                write!(f, " | {}", if *valid { "yes" } else { "NO" })
            }
            Self::Refused(reason) => write!(f, "refused: {} | | | | | |", reason.trim()),
        }
    }
}

/// Median, least and most of numbers in order.
fn spread(sorted: &[f64]) -> String {
    match sorted {
        [only] => format!("{only:.2}"),
        [first, .., last] => format!("{:.3} ({first:.3} to {last:.3})", sorted[sorted.len() / 2]),
        [] => UNKNOWN.into(),
    }
}

fn number_after<'a>(said: &'a str, label: &str) -> &'a str {
    let rest = said.split(label).nth(1).unwrap_or(UNKNOWN);
    &rest[..rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len())]
}
