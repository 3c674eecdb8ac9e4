//! `zygote completions`: what a shell needs to complete this program's verbs and options.

use crate::Cli;
use crate::failure::Failure;
use crate::output::say;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Arguments of `zygote completions`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The shell
    shell: Shell,
}

/// Prints the shell's script.
#[expect(clippy::unnecessary_wraps, reason = "verbs are all alike")]
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "zygote", &mut script);
    say(String::from_utf8_lossy(&script).trim_end());
    Ok(())
}
