//! What was seen, as a table, and held to its budget.

use crate::pair::{Kind, Most, Pair};
use crate::target::Entry;
use rustc_demangle::demangle;
use std::collections::BTreeSet;
use zygote_emulator::count::{Calls, CallsError, Linked, Taken};

/// Cycles a microsecond, as the NUCLEO-F446RE's board runs.
const MHZ: u64 = 166;
/// Time between two control ticks.
const TICK_US: u64 = 1_000;

/// Milliseconds in which a stop has to act (S8).
const STOP_MS: u64 = 10;

/// Cycles that an entry may take at most, a seventh above what was seen, so that growth is noticed. Those from flash are no measure of
/// growth: they change with where the linker puts what.
const fn budget(entry: Entry) -> u64 {
    match entry {
        Entry::New => 25_000,
        Entry::HandleBytes => 178_000,
        Entry::Tick => 59_000,
        Entry::PollTransmit => 23_500,
        Entry::Apply => 1_500,
        Entry::Keep => 17_000,
    }
}

/// Bytes of stack below any entry, whatever comes in.
const STACK_BUDGET: u32 = 3 * 1024;
/// Bytes of one core.
const RAM_BUDGET: u32 = 15 * 1024;

/// Figures that are over their budget.
#[derive(Debug, thiserror::Error)]
#[error("{what}: {got}, the budget is {budget}")]
pub(crate) struct OverBudget {
    what: String,
    got: u64,
    budget: u64,
}

fn hold(what: impl Into<String>, got: u64, budget: u64) -> Result<(), OverBudget> {
    if got <= budget { Ok(()) } else { Err(OverBudget { what: what.into(), got, budget }) }
}

/// The most of all calls of some kinds.
fn most(pair: &Pair, of: impl Fn(&Kind) -> bool) -> Most {
    let mut all = Most::default();
    for (kind, most) in pair.most.iter().filter(|(kind, _)| of(kind)) {
        if most.taken.cycles_from_flash > all.taken.cycles_from_flash {
            let what = if kind.what.is_empty() { String::new() } else { format!("{}: ", kind.what) };
            all.during = what + &most.during;
        }
        all.taken = all.taken.most(most.taken);
    }
    all
}

fn of_entry(pair: &Pair, entry: Entry) -> Most {
    most(pair, |kind| kind.entry == entry)
}

fn while_energised(pair: &Pair, entry: Entry) -> Most {
    most(pair, |kind| kind.entry == entry && kind.energised)
}

fn row(name: &str, most: &Most) -> String {
    let Taken { instructions, cycles, cycles_from_flash, .. } = most.taken;
    let us = cycles_from_flash.div_ceil(MHZ);
    let during = &most.during;
    format!("{name:<34} {instructions:>12} {cycles:>9} {cycles_from_flash:>10} {us:>6}  {during}\n")
}

pub(crate) fn times(pair: &Pair) -> String {
    let head = |what| {
        format!(
            "{what:<34} {:>12} {:>9} {:>10} {:>6}  longest in\n",
            "instructions", "cycles", "from flash", "us"
        )
    };
    let mut text = head("at any time");
    for entry in Entry::ALL {
        text += &row(entry.name(), &of_entry(pair, entry));
    }
    text += &head("\nwhile something may be energised");
    for entry in Entry::ALL.into_iter().filter(|entry| *entry != Entry::New) {
        text += &row(entry.name(), &while_energised(pair, entry));
    }
    text += &head("\nhandle_bytes, by what comes");
    let whats: BTreeSet<_> = pair.most.keys().map(|kind| kind.what).filter(|what| !what.is_empty()).collect();
    for what in whats {
        text += &row(&format!("  {what}"), &most(pair, |kind| kind.what == what));
    }
    text
}

/// The most that can come between two control ticks while something may be energised, at full rate of the line: a buffer, a frame
/// out, the tick, and after each what a board does then. Sending changes nothing that is kept.
fn between_ticks(pair: &Pair, cycles: impl Fn(Taken) -> u64) -> u64 {
    let most = |entry| cycles(while_energised(pair, entry).taken);
    let calls = most(Entry::HandleBytes) + most(Entry::PollTransmit) + most(Entry::Tick);
    calls + 3 * most(Entry::Apply) + 2 * most(Entry::Keep)
}

pub(crate) fn hold_times(pair: &Pair) -> Result<String, OverBudget> {
    for entry in Entry::ALL {
        let Taken { cycles, cycles_from_flash, .. } = of_entry(pair, entry).taken;
        let (name, stop) = (entry.name(), STOP_MS * 1_000 * MHZ);
        hold(format!("cycles of {name}"), cycles, budget(entry))?;
        hold(format!("cycles of {name} from flash, with a stop in {STOP_MS} ms"), cycles_from_flash, stop)?;
    }
    let cycles = between_ticks(pair, |taken| taken.cycles);
    let from_flash = between_ticks(pair, |taken| taken.cycles_from_flash);
    // The tick behind it is late then, by less than a period: none is left out, and the core's own limit is far.
    hold(
        "cycles from flash between two ticks while something may be energised",
        from_flash,
        2 * TICK_US * MHZ,
    )?;
    Ok(format!(
        "between two ticks while something may be energised: {cycles} cycles, {from_flash} from flash"
    ))
}

/// The deepest stack of each entry by its instructions, and the deepest that was seen.
pub(crate) fn stacks(pair: &Pair, linked: &Linked) -> Result<String, CallsError> {
    let entries = Entry::ALL.map(Entry::symbol);
    let calls = Calls::from(linked, &entries)?;
    let mut lines = vec![format!("{:<34} {:>9} {:>9}", "stack", "at most", "seen")];
    for entry in Entry::ALL {
        let (deepest, seen) = (calls.deepest(linked, entry.symbol())?, of_entry(pair, entry).taken.stack);
        lines.push(format!("{:<34} {:>9} {seen:>9}", entry.name(), deepest.bytes));
        let frames = deepest.path.iter().filter(|(_, frame)| *frame > 0);
        lines.extend(frames.map(|(name, frame)| format!("    {frame:>6} {:#}", demangle(name))));
    }
    lines.push(format!("{} functions, none calls itself, none calls by a register\n", calls.functions()));
    Ok(lines.join("\n"))
}

pub(crate) fn hold_memory(linked: &Linked) -> Result<(), Box<dyn std::error::Error>> {
    let entries = Entry::ALL.map(Entry::symbol);
    let calls = Calls::from(linked, &entries)?;
    for entry in Entry::ALL {
        let deepest = calls.deepest(linked, entry.symbol())?;
        hold(format!("stack of {}", entry.name()), deepest.bytes.into(), STACK_BUDGET.into())?;
    }
    let core = linked.static_named("FIGURES_CORE")?;
    hold("bytes of a core", (core.end - core.start).into(), RAM_BUDGET.into())?;
    Ok(())
}
