//! `zygote man`: the manual, a page a verb, for `man`.

use crate::Cli;
use crate::failure::{Failure, OrFail};
use crate::output::{say, write_files};
use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;
use std::io;
use std::path::PathBuf;

/// Arguments of `zygote man`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The folder for the pages, made where it isn't there: ~/.local/share/man/man1, for example
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Writes every page, or none.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let pages = pages(&command).or_failed()?;
    let files: Vec<_> = pages.into_iter().map(|(name, page)| (arguments.folder.join(name), page)).collect();
    write_files(Some(&arguments.folder), &files)?;
    say(format_args!("{} pages: {}", files.len(), arguments.folder.display()));
    Ok(())
}

/// Name and text of the pages of a command and of all below it.
fn pages(command: &Command) -> io::Result<Vec<(String, Vec<u8>)>> {
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page)?;
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    let mut all = vec![(format!("{name}.1"), page)];
    for below in command.get_subcommands() {
        all.extend(pages(below)?);
    }
    Ok(all)
}
