//! `zygote reconfigure`: which hinges of a stack to move so that it unfolds into another shape.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use anyhow::Context;
use clap::Args;
use std::fmt::Write as _;
use std::path::PathBuf;
use zygote_stacking::{Action, Counts, Reconfiguration, Slot, SlotKind};

/// Arguments of `zygote reconfigure`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The plan by which the stack is hinged now
    #[arg(value_name = "A.fold")]
    first: PathBuf,
    /// The plan that it is to follow; as many panels and piles, on cells that lie alike
    #[arg(value_name = "B.fold")]
    second: PathBuf,
    /// Write all hinges here, kept ones too, a row each
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    /// List the hinges that are kept, too
    #[arg(long)]
    all: bool,
}

/// Compares two plans and lists what to do.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (first, second) = (input::plan(&arguments.first)?, input::plan(&arguments.second)?);
    let (a, b) = (arguments.first.display(), arguments.second.display());
    let way = Reconfiguration::between(&first, &second)
        .with_context(|| format!("{a} can't become {b}"))
        .or_bad_input()?;
    if let Some(path) = &arguments.csv {
        write_file(path, csv(&way).as_bytes())?;
    }
    say(format_args!("turn the stack of {a}: {}; then, by cells and sides of {b}:", way.motion));
    say(format_args!("{:<8} {:<8} {:>6}  {:<7} {:<5} to", "cell", "kind", "height", "what", "from"));
    for (slot, action) in way.actions.iter().filter(|(_, action)| arguments.all || !is_kept(action)) {
        let Row { cell: [i, j], kind, height, what, from, to } = row(slot, action);
        let line = format!("{:<8} {kind:<8} {height:>6}  {what:<7} {from:<5} {to:<5}", format!("({i},{j})"));
        say(line.trim_end());
    }
    let Counts { kept, turned, moved, removed, added } = way.counts;
    say(format_args!(
        "{} hinges: keep {kept}, turn {turned}, move {moved}, remove {removed}, add {added}",
        first.hinges.len()
    ));
    Ok(())
}

fn is_kept(action: &Action) -> bool {
    matches!(action, Action::Keep(_))
}

/// A hinge of the list.
struct Row {
    cell: [i32; 2],
    kind: &'static str,
    height: usize,
    what: &'static str,
    from: String,
    to: String,
}

fn row(slot: &Slot, action: &Action) -> Row {
    let none = String::new();
    let (what, from, to) = match action {
        Action::Keep(mounted) => ("keep", mounted.to_string(), mounted.to_string()),
        Action::Turn { from, to } => ("turn", from.to_string(), to.to_string()),
        Action::Move { from, to } => ("move", from.to_string(), to.to_string()),
        Action::Remove(from) => ("remove", from.to_string(), none),
        Action::Add(to) => ("add", none, to.to_string()),
    };
    let kind = match slot.kind {
        SlotKind::Fold => "fold",
        SlotKind::Bridge(_) => "bridge",
    };
    Row { cell: slot.cell, kind, height: slot.height, what, from, to }
}

/// All hinges as comma-separated values: side and opening angle before and after.
fn csv(way: &Reconfiguration) -> String {
    let mut text = "what,kind,cell_x,cell_y,height,from_side,from_deg,to_side,to_deg\n".to_owned();
    for (slot, action) in &way.actions {
        let Row { cell: [i, j], kind, height, what, from, to } = row(slot, action);
        // A side is one letter; the angle follows it.
        let split = |hinge: &str| {
            let (side, angle) = hinge.split_at(hinge.len().min(1));
            format!("{side},{angle}")
        };
        let _infallible = writeln!(text, "{what},{kind},{i},{j},{height},{},{}", split(&from), split(&to));
    }
    text
}
