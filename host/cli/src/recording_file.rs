//! The file of a recording: a new one for every run, and its name.

use crate::failure::{Failure, OrFail};
use anyhow::{Context, anyhow};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use zygote_recording::{Job, Recorder, Recording};

/// What recordings are called.
const ENDING: &str = "mcap";

/// A recorder with the name of its file.
pub(crate) struct RecordingFile {
    pub(crate) recorder: Recorder<File>,
    pub(crate) path: PathBuf,
}

impl RecordingFile {
    /// A recorder of `job` into the file that was asked for, which must not exist; else into the next number beside what is run. Nothing is
    /// written before the run begins.
    pub(crate) fn new(job: &Job<'_>, asked: Option<&PathBuf>, run: &Path) -> Result<Self, Failure> {
        let path = match asked {
            // What isn't a plain file, such as /dev/null, may be written to again.
            Some(path) if path.is_file() => {
                let error = anyhow!("{}: exists already; a recording is never overwritten", path.display());
                return Err(Failure::BadInput(error));
            }
            Some(path) => path.clone(),
            None => next(run)?,
        };
        let (file, is_new) = (path.clone(), !path.exists());
        let open = move || if is_new { File::create_new(&file) } else { File::create(&file) };
        let recorder = Recorder::new(job, open).context("the run can't be recorded").or_bad_input()?;
        Ok(Self { recorder, path })
    }
}

/// `fish.3.mcap` where `fish.2.mcap` is the last of `fish.fold`'s.
fn next(run: &Path) -> Result<PathBuf, Failure> {
    let stem = run.file_stem().with_context(|| format!("{}: names no file", run.display())).or_bad_input()?;
    let stem = stem.to_string_lossy();
    let folder = match run.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let entries =
        fs::read_dir(folder).with_context(|| format!("{}: can't be listed", folder.display())).or_failed()?;
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let last = names.filter_map(|name| number(&name, &stem)).max().unwrap_or(0);
    Ok(run.with_file_name(format!("{stem}.{}.{ENDING}", last + 1)))
}

/// The number in the name of a recording.
fn number(name: &str, stem: &str) -> Option<u64> {
    name.strip_prefix(stem)?.strip_prefix('.')?.strip_suffix(ENDING)?.strip_suffix('.')?.parse().ok()
}

/// The wall clock.
pub(crate) fn now() -> Duration {
    // A clock before 1970 costs nothing but the date in the recording.
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default()
}

/// Reads a recording.
pub(crate) fn read(path: &Path) -> Result<Recording, Failure> {
    let name = path.display();
    let bytes = fs::read(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    Recording::read(&bytes).with_context(|| format!("{name}: no recording of a run")).or_bad_input()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_numbers_of_its_own_recordings_count() {
        assert_eq!(number("fish.12.mcap", "fish"), Some(12));
        for other in ["fish.mcap", "fish.x.mcap", "fish2.1.mcap", "fish.1.mcapx", "fish.1.fold", "fish"] {
            assert_eq!(number(other, "fish"), None, "{other}");
        }
    }
}
