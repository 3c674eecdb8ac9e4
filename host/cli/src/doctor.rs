//! `zygote doctor`: what is here of what zygote can use, and what to do about what isn't: ports and their permissions, a board's firmware,
//! other programs.

use crate::failure::{Failure, OrFail};
use crate::identity;
use crate::output::say;
use crate::view;
use anyhow::anyhow;
use clap::Args;
use serde::Serialize;
use std::process::Command;
use zygote_controller::{SerialTransport, Session, serial_ports};
use zygote_protocol::Millis;

/// How long an answer to the hello is waited for.
const HELLO_PATIENCE: Millis = Millis(2_000);
/// What lets everybody at the computer use an ST-LINK and its serial port.
const UDEV_RULE: &str = "write SUBSYSTEMS==\"usb\", ATTRS{idVendor}==\"0483\", MODE=\"0660\", GROUP=\"plugdev\", TAG+=\"uaccess\" to \
                         /etc/udev/rules.d/70-st-link.rules, run `udevadm control --reload`, and plug the board in again; or join the \
                         group of the port (often dialout)";

/// Arguments of `zygote doctor`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Ask the board at this serial port who it is; nothing is energised
    #[arg(long, value_name = "DEV")]
    port: Option<String>,
    /// Speed of the line
    #[arg(long, value_name = "BAUD", default_value_t = 921_600)]
    baud: u32,
    /// Print as JSON
    #[arg(long)]
    json: bool,
}

/// One thing that was looked at.
#[derive(Debug, PartialEq, Eq, Serialize)]
struct Finding {
    what: String,
    is_fine: bool,
    found: String,
    /// What to do where it isn't fine.
    remedy: Option<String>,
}

impl Finding {
    fn fine(what: impl Into<String>, found: impl Into<String>) -> Self {
        Self { what: what.into(), is_fine: true, found: found.into(), remedy: None }
    }

    fn poor(what: impl Into<String>, found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { what: what.into(), is_fine: false, found: found.into(), remedy: Some(remedy.into()) }
    }

    fn lines(&self) -> String {
        let mark = if self.is_fine { "ok" } else { "--" };
        let line = format!("{mark}  {:<18} {}", self.what, self.found);
        match &self.remedy {
            Some(remedy) => format!("{line}\n                       {remedy}"),
            None => line,
        }
    }
}

/// Looks at everything; fails only where a board was asked for and isn't well.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut findings = vec![Finding::fine("zygote", env!("CARGO_PKG_VERSION"))];
    findings.extend(ports());
    let board = arguments.port.as_ref().map(|port| board(port, arguments.baud));
    let is_well = board.as_ref().is_none_or(|board| board.is_fine);
    findings.extend(board);
    findings.push(page());
    findings.extend(PROGRAMS.iter().map(program));
    if arguments.json {
        say(serde_json::to_string_pretty(&findings).or_failed()?);
    } else {
        findings.iter().map(Finding::lines).for_each(say);
    }
    if is_well { Ok(()) } else { Err(Failure::Failed(anyhow!("the board isn't well"))) }
}

/// The serial ports, and whether this user may open them.
fn ports() -> Vec<Finding> {
    let ports = serial_ports();
    if ports.is_empty() {
        return vec![Finding::poor("serial ports", "none", "connect a board by USB; `--sim` needs none")];
    }
    ports.into_iter().map(|port| permission(&port)).collect()
}

fn permission(port: &str) -> Finding {
    match std::fs::OpenOptions::new().read(true).write(true).open(port) {
        Ok(_) => Finding::fine("serial port", format!("{port} may be used")),
        Err(error) if error.kind() == std::io::ErrorKind::PermissionDenied => {
            Finding::poor("serial port", format!("{port} may not be used"), UDEV_RULE)
        }
        Err(error) => {
            Finding::poor("serial port", format!("{port}: {error}"), "see whether another program uses it")
        }
    }
}

/// Who answers at a port.
fn board(port: &str, baud: u32) -> Finding {
    let line = match SerialTransport::open(port, baud) {
        Ok(line) => line,
        Err(error) => return Finding::poor("board", error.to_string(), UDEV_RULE),
    };
    match Session::connect(line, identity::fresh(), HELLO_PATIENCE) {
        Ok(session) => {
            let told = &session.info().identity;
            let (board, firmware, git) = (&told.board, &told.firmware, &told.git);
            Finding::fine(
                "board",
                format!("{board} with firmware {firmware} ({git}), reset by {:?}", told.reset),
            )
        }
        Err(error) => Finding::poor(
            "board",
            error.to_string(),
            "see that the board has power and the firmware of this version: `zygote flash`",
        ),
    }
}

fn page() -> Finding {
    if view::has_page() {
        Finding::fine("viewer", "its page is in this program")
    } else {
        Finding::poor(
            "viewer",
            "its page isn't in this program",
            "run `cargo xtask viewer`, then build zygote again",
        )
    }
}

/// A program of others, what it is for, and where to get it.
struct Program {
    names: &'static [&'static str],
    purpose: &'static str,
    remedy: &'static str,
}

const PROGRAMS: [Program; 3] = [
    Program { names: &["probe-rs"], purpose: "zygote flash", remedy: "install it: https://probe.rs" },
    Program {
        names: &["python3", "python"],
        purpose: "zygote hil",
        remedy: "install Python 3.10 or newer with venv",
    },
    Program {
        names: &["chromium", "chromium-browser", "google-chrome"],
        purpose: "zygote view --png",
        remedy: "install Chromium; any browser will do for `zygote view` without --png",
    },
];

fn program(program: &Program) -> Finding {
    let Program { names, purpose, remedy } = *program;
    let version = names.iter().find_map(|name| {
        let told = Command::new(name).arg("--version").output().ok().filter(|told| told.status.success())?;
        String::from_utf8_lossy(&told.stdout).lines().next().map(|line| line.trim().to_owned())
    });
    let what = names.first().copied().unwrap_or_default();
    match version {
        Some(version) => Finding::fine(what, format!("{version}, for {purpose}")),
        None => Finding::poor(what, format!("isn't there, for {purpose}"), remedy),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_is_not_there_is_told_with_what_it_is_for_and_where_to_get_it() {
        let missing = Program { names: &["no-such-program-at-all"], purpose: "tests", remedy: "do without" };
        let finding = program(&missing);
        assert_eq!(finding, Finding::poor("no-such-program-at-all", "isn't there, for tests", "do without"));
        assert!(finding.lines().starts_with("--  no-such-program-at-all isn't there"), "{}", finding.lines());
    }

    #[test]
    fn a_port_that_is_not_there_is_no_board() {
        let finding = board("/dev/no-such-port", 921_600);
        assert!(!finding.is_fine && finding.found.contains("/dev/no-such-port"), "{finding:?}");
    }
}
