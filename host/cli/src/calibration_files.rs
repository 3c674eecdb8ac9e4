//! The files of a calibration, of heaters or servos: what stands in them before, what is kept on the way, and what is written and told
//! at the end.

use crate::board_calibrations::{Taught, teach};
use crate::calibrate::Arguments;
use crate::calibration_json;
use crate::calibration_table::essential;
use crate::failure::{Failure, OrFail};
use crate::output::{say, write_file};
use anyhow::{Context, anyhow};
use serde::Serialize;
use std::path::{Path, PathBuf};
use zygote_controller::calibrate::RecordsError;
use zygote_controller::{Session, Transport};
use zygote_deployment::{CalibratedHinge, Calibration, CalibrationVerdict, Rig};

/// Where they are.
pub(crate) struct Files {
    pub(crate) result: PathBuf,
    /// All that was measured.
    pub(crate) records: PathBuf,
    /// For people.
    report: PathBuf,
}

/// What was found of hinges.
pub(crate) struct Found {
    pub(crate) hinges: Calibration,
    /// The report.
    pub(crate) page: String,
    /// For a terminal.
    pub(crate) table: String,
}

impl Files {
    /// The result where it is asked for, else beside the rig file; the others beside it, with these extensions.
    pub(crate) fn new(arguments: &Arguments, records: &str, report: &str) -> Self {
        let result =
            arguments.output.clone().unwrap_or_else(|| arguments.rig.with_file_name("calibration.toml"));
        Self { records: result.with_extension(records), report: result.with_extension(report), result }
    }

    /// What an interrupted calibration measured, where it is gone on with.
    pub(crate) fn earlier<T>(
        &self,
        arguments: &Arguments,
        read: impl FnOnce(&[u8]) -> Result<T, RecordsError>,
        is_complete: impl FnOnce(&T) -> bool,
    ) -> Result<Option<T>, Failure> {
        let name = self.records.display().to_string();
        let bytes = match std::fs::read(&self.records) {
            Ok(bytes) => bytes,
            Err(error) if arguments.resume => {
                return Err(Failure::BadInput(anyhow!(error).context(format!("{name}: cannot be read"))));
            }
            Err(_) => return Ok(None),
        };
        let measured = read(&bytes).context(name.clone());
        if arguments.resume {
            return measured.map(Some).or_bad_input();
        }
        match measured {
            Ok(measured) if !is_complete(&measured) && !arguments.restart => Err(Failure::BadInput(anyhow!(
                "{name}: holds a calibration that was interrupted: --resume goes on with it, --restart forgets it"
            ))),
            Ok(_) | Err(_) => Ok(None),
        }
    }

    /// What the result's file says already.
    pub(crate) fn known(&self, rig: &Rig) -> Result<Option<Calibration>, Failure> {
        let name = self.result.display().to_string();
        match std::fs::read_to_string(&self.result) {
            Ok(text) => Calibration::read(&text, &rig.id).context(name).map(Some).or_bad_input(),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(Failure::BadInput(anyhow!(error).context(format!("{name}: cannot be read")))),
        }
    }

    /// Keeps what was measured by now.
    pub(crate) fn keep(&self, records: &impl Serialize) -> Result<(), String> {
        let json = serde_json::to_vec(records).map_err(|error| error.to_string())?;
        write_file(&self.records, &json).map_err(|failure| match failure {
            Failure::BadInput(error) | Failure::Failed(error) => format!("{error:#}"),
        })
    }

    /// Writes result and report, has the board keep what is known, and tells it all; succeeds only when every hinge is calibrated.
    pub(crate) fn finish<T: Transport>(
        &self,
        session: &mut Session<T>,
        rig: &Rig,
        mut result: Calibration,
        found: Found,
        json: bool,
    ) -> Result<(), Failure> {
        let calibrated = found.hinges.hinges.clone();
        result.take_in(found.hinges).or_failed()?;
        write_file(&self.result, result.text().or_failed()?.as_bytes())?;
        write_file(&self.report, found.page.as_bytes())?;
        let taught = teach(session, rig, &self.result, &result);
        if json {
            let files = [&self.result, &self.records, &self.report].map(PathBuf::as_path);
            let taught = taught.as_ref().ok();
            let document =
                calibration_json::document(&rig.id, &result.at(), &calibrated, taught, files).or_failed()?;
            say(serde_json::to_string_pretty(&document).or_failed()?);
        } else {
            say(found.table);
            let place = |path: &Path| path.display().to_string();
            say(format_args!("calibration: {}\nreport: {}", place(&self.result), place(&self.report)));
            taught.iter().map(Taught::line).for_each(say);
        }
        judge(&calibrated)?;
        taught.map(drop)
    }
}

fn judge(calibrated: &[CalibratedHinge]) -> Result<(), Failure> {
    let bad: Vec<String> = calibrated
        .iter()
        .filter(|hinge| hinge.verdict != CalibrationVerdict::Calibrated)
        .map(|hinge| {
            let why = hinge.why.clone().or_else(|| essential(hinge)).unwrap_or_default();
            format!("hinge {}: {}: {why}", hinge.hinge, hinge.verdict.name())
        })
        .collect();
    if bad.is_empty() { Ok(()) } else { Err(Failure::Failed(anyhow!("{}", bad.join("\n       ")))) }
}
