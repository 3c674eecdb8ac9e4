//! One row of the table: `zygote plan` as a whole process, several times, and what it says of its plan.

use crate::tools;
use anyhow::{Context, Result, ensure};
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// GNU time, which tells the most memory that a process held at once.
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
    /// Seconds in order, kilobytes where they are known, what the program said, and whether a check found the plan valid.
    Planned { seconds: Vec<f64>, kilobytes: Option<u64>, said: String, valid: bool },
    /// What the program said in place of a plan.
    Refused(String),
}

pub(super) const HEAD: &str = "| instance | N | K | seconds, median (min to max) | peak MB | bridges | cut | depth | valid |\n|---|---|---|---|---|---|---|---|---|";

impl Bench {
    /// Plans a model several times.
    pub(super) fn measure(&self, model: &Path, piles: usize, runs: usize) -> Result<Row> {
        let plan = self.place.join("plan.fold");
        let timed = Path::new(TIME).is_file();
        let (mut seconds, mut said, mut kilobytes) = (Vec::with_capacity(runs), String::new(), None);
        for _ in 0..runs {
            let mut command = if timed { Command::new(TIME) } else { Command::new(&self.program) };
            if timed {
                command.args(["-q", "-f", "%M"]).arg(&self.program);
            }
            command.arg("plan").arg(model).args(["--piles", &piles.to_string(), "--output"]).arg(&plan);
            let begin = Instant::now();
            let output =
                command.output().with_context(|| format!("cannot start {}", self.program.display()))?;
            seconds.push(begin.elapsed().as_secs_f64());
            let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
            if !output.status.success() {
                // Without the line that GNU time adds.
                let words = complaint.lines().filter(|line| line.parse::<u64>().is_err());
                return Ok(Row::Refused(words.collect::<Vec<_>>().join(" ")));
            }
            let most = complaint.lines().next_back().and_then(|line| line.parse::<u64>().ok());
            kilobytes = kilobytes.max(most);
            said = String::from_utf8_lossy(&output.stdout).into_owned();
        }
        seconds.sort_by(f64::total_cmp);
        // A process of its own reads the file again and checks it by rules that share no code with the planner.
        let valid = tools::output_of(Command::new(&self.program).arg("check").arg(&plan)).is_ok();
        Ok(Row::Planned { seconds, kilobytes, said, valid })
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
            Self::Planned { seconds, kilobytes, said, valid } => {
                write!(f, "{}", spread(seconds))?;
                match kilobytes {
                    Some(kilobytes) => write!(f, " | {}", kilobytes.div_ceil(1024))?,
                    None => write!(f, " | {UNKNOWN}")?,
                }
                for label in ["bridges: ", "cut edges: ", "depth of the tree path: "] {
                    write!(f, " | {}", number_after(said, label))?;
                }
                write!(f, " | {}", if *valid { "yes" } else { "NO" })
            }
            Self::Refused(reason) => write!(f, "refused: {} | | | | |", reason.trim()),
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
