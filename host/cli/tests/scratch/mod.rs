//! A folder of its own for each test, and the `zygote` command run in it.

#![expect(clippy::unwrap_used, reason = "a test that cannot set up its folder fails")]

use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::{env, fs};

/// A folder that is empty at first and gone at the end.
pub(crate) struct Scratch {
    folder: PathBuf,
}

/// How a command ended.
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) output: String,
    pub(crate) errors: String,
}

/// A command that runs.
#[allow(dead_code, reason = "not every test serves something")]
pub(crate) struct Server(Child);

#[allow(dead_code, reason = "not every test serves something")]
impl Server {
    /// What it says first, once it says it.
    pub(crate) fn first_line(&mut self) -> String {
        let mut line = String::new();
        BufReader::new(self.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
        line.trim_end().to_owned()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

impl Scratch {
    pub(crate) fn new(name: &str) -> Self {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        fs::remove_dir_all(&folder).ok();
        fs::create_dir_all(&folder).unwrap();
        Self { folder }
    }

    pub(crate) fn zygote(&self, arguments: &[&str]) -> Run {
        let mut command = Command::new(env!("CARGO_BIN_EXE_zygote"));
        let run = command.args(arguments).current_dir(&self.folder).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Run { code: run.status.code().unwrap(), output: text(run.stdout), errors: text(run.stderr) }
    }

    #[allow(dead_code, reason = "not every test needs a path")]
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// A command that goes on until it is dropped.
    #[allow(dead_code, reason = "not every test serves something")]
    pub(crate) fn start(&self, arguments: &[&str]) -> Server {
        let mut command = Command::new(env!("CARGO_BIN_EXE_zygote"));
        Server(command.args(arguments).current_dir(&self.folder).stdout(Stdio::piped()).spawn().unwrap())
    }

    /// The command with something on its standard input, which then ends.
    #[allow(dead_code, reason = "not every test tells it something")]
    pub(crate) fn zygote_told(&self, arguments: &[&str], input: &str) -> Run {
        let mut command = Command::new(env!("CARGO_BIN_EXE_zygote"));
        command.args(arguments).current_dir(&self.folder);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // It may have ended without reading all of it.
        child.stdin.take().unwrap().write_all(input.as_bytes()).ok();
        let run = child.wait_with_output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Run { code: run.status.code().unwrap(), output: text(run.stdout), errors: text(run.stderr) }
    }

    #[allow(dead_code, reason = "not every test reads files")]
    pub(crate) fn read(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    #[allow(dead_code, reason = "not every test reads files")]
    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder.join(name)).unwrap()
    }

    #[allow(dead_code, reason = "not every test writes files of its own")]
    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.folder.join(name), text).unwrap();
    }

    /// All that is in the folder, hidden files too.
    #[allow(dead_code, reason = "not every test counts files")]
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.folder).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.folder).ok();
    }
}

/// The path of a model of this repository.
#[allow(dead_code, reason = "not every test needs a model")]
pub(crate) fn model(name: &str) -> String {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name).to_str().unwrap().into()
}
