//! Output files appear whole or not at all, and what a verb prints goes to standard output.

use crate::failure::{Failure, OrFail};
use anyhow::Context;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::{fs, io, process};

/// Writes a file beside its place and then moves it there, so that no reader ever sees half of it.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let name =
        path.file_name().with_context(|| format!("{}: names no file", path.display())).or_bad_input()?;
    let temporary = path.with_file_name(format!(".{}.{}.tmp", name.to_string_lossy(), process::id()));
    let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // Whatever is left of the temporary file is of no use to anyone; the first error is the one to tell.
        fs::remove_file(&temporary).ok();
    }
    written.with_context(|| format!("{}: cannot be written", path.display())).or_failed()
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
