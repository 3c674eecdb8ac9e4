//! Output files appear whole or not at all, and what a verb prints goes to standard output.

use crate::failure::{Failure, OrFail};
use anyhow::{Context, anyhow};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::{fs, io, process};

/// Writes a file beside its place and then moves it there, so that no reader ever sees half of it.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let temporary = beside(path)?;
    let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // Whatever is left of the temporary file is of no use to anyone; the first error is the one to tell.
        fs::remove_file(&temporary).ok();
    }
    written.with_context(|| format!("{}: cannot be written", path.display())).or_failed()
}

/// Writes several files, in a folder that is made where it isn't there: all beside their places, and only when all are written
/// they are moved. What can't be written leaves no file and no folder.
pub(crate) fn write_files(folder: Option<&Path>, files: &[(PathBuf, Vec<u8>)]) -> Result<(), Failure> {
    if let Some((path, _)) = files.iter().find(|(path, _)| path.is_dir()) {
        return Err(Failure::Failed(anyhow!("{}: cannot be written: it is a folder", path.display())));
    }
    let made = folder.filter(|folder| !folder.is_dir());
    if let Some(folder) = made {
        fs::create_dir(folder)
            .with_context(|| format!("{}: cannot be made", folder.display()))
            .or_failed()?;
    }
    let places = files.iter().map(|(path, _)| Ok((beside(path)?, path))).collect::<Result<Vec<_>, _>>()?;
    let staged = || {
        for ((temporary, path), (_, bytes)) in places.iter().zip(files) {
            fs::write(temporary, bytes).map_err(|error| (error, *path))?;
        }
        places
            .iter()
            .try_for_each(|(temporary, path)| fs::rename(temporary, path).map_err(|error| (error, *path)))
    };
    staged().map_err(|(error, path)| {
        // As above: the first error is the one to tell.
        for (temporary, _) in &places {
            fs::remove_file(temporary).ok();
        }
        if let Some(folder) = made {
            // Only if it is empty.
            fs::remove_dir(folder).ok();
        }
        Failure::Failed(anyhow::Error::new(error).context(format!("{}: cannot be written", path.display())))
    })
}

/// Where a file is written before it is moved to its place.
fn beside(path: &Path) -> Result<PathBuf, Failure> {
    let name =
        path.file_name().with_context(|| format!("{}: names no file", path.display())).or_bad_input()?;
    Ok(path.with_file_name(format!(".{}.{}.tmp", name.to_string_lossy(), process::id())))
}

/// Prints a line for the user.
pub(crate) fn say(line: impl std::fmt::Display) {
    // A reader that has gone (`| head`) wants no more lines; the work and the exit code stand without them.
    writeln!(io::stdout(), "{line}").ok();
}

/// A file that is made, or emptied, when the first byte is written to it: what fails before leaves the old one alone.
pub(crate) struct LateFile {
    path: PathBuf,
    file: Option<fs::File>,
}

impl LateFile {
    /// A file that doesn't exist yet.
    pub(crate) fn new(path: PathBuf) -> Self {
        Self { path, file: None }
    }
}

impl Write for LateFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.write(bytes),
            empty => {
                let named = |error: io::Error| {
                    io::Error::new(error.kind(), format!("{}: {error}", self.path.display()))
                };
                empty.insert(fs::File::create(&self.path).map_err(named)?).write(bytes)
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), fs::File::flush)
    }
}
