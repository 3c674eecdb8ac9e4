//! What was seen, as a table, and held to its budget.

use crate::pair::{Most, Pair};
use crate::target::Entry;
use zygote_emulator::{Calls, CallsError, Linked};

/// Cycles a microsecond, as the NUCLEO-F446RE's board runs.
const MHZ: u64 = 166;
/// Time between two control ticks.
const TICK_US: u64 = 2_000;

/// What an entry may take at most, from flash whose accelerator has nothing. A fifth above what was seen, so that growth is noticed.
const fn budget(entry: Entry) -> u64 {
    match entry {
        Entry::New => 1,
        Entry::HandleBytes => 1,
        Entry::Tick => 1,
        Entry::PollTransmit => 1,
        Entry::Apply => 1,
        Entry::Keep => 1,
    }
}

/// Bytes of stack below any entry, whatever comes in.
const STACK_BUDGET: u32 = 8 * 1024;
/// Bytes of one core.
const RAM_BUDGET: u32 = 16 * 1024;

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

/// The most of an entry, whatever it was called with.
fn most(pair: &Pair, entry: Entry) -> Most {
    let mut all = Most::default();
    for ((of, what), most) in &pair.most {
        if *of != entry {
            continue;
        }
        if most.taken.cycles_from_flash > all.taken.cycles_from_flash {
            all.during = if what.is_empty() { most.during.clone() } else { format!("{what}; {}", most.during) };
        }
        all.taken = all.taken.most(most.taken);
    }
    all
}

pub(crate) fn times(pair: &Pair) -> String {
    let mut text = format!(
        "{:<34} {:>12} {:>9} {:>11} {:>7}  longest in\n",
        "", "instructions", "cycles", "from flash", "us"
    );
    let mut row = |name: &str, most: &Most| {
        let taken = most.taken;
        text += &format!(
            "{name:<34} {:>12} {:>9} {:>11} {:>7}  {}\n",
            taken.instructions,
            taken.cycles,
            taken.cycles_from_flash,
            taken.cycles_from_flash.div_ceil(MHZ),
            most.during
        );
    };
    for entry in Entry::ALL {
        row(entry.name(), &most(pair, entry));
    }
    row("\nhandle_bytes, by what comes", &Most::default());
    for ((entry, what), most) in &pair.most {
        if *entry == Entry::HandleBytes {
            row(&format!("  {what}"), most);
        }
    }
    text
}

pub(crate) fn hold_times(pair: &Pair) -> Result<(), OverBudget> {
    for entry in Entry::ALL {
        let got = most(pair, entry).taken.cycles_from_flash;
        hold(format!("cycles of {}", entry.name()), got, budget(entry))?;
    }
    // Everything that can come between two ticks, once each.
    let all = [Entry::HandleBytes, Entry::Tick, Entry::PollTransmit, Entry::Apply, Entry::Keep];
    let sum = all.into_iter().map(|entry| most(pair, entry).taken.cycles_from_flash).sum();
    hold("cycles of one of each", sum, TICK_US * MHZ)
}

/// The deepest stack of each entry by its instructions, and the deepest that was seen.
pub(crate) fn stacks(pair: &Pair, linked: &Linked) -> Result<String, CallsError> {
    let entries = Entry::ALL.map(Entry::symbol);
    let calls = Calls::from(linked, &entries)?;
    let mut text = format!("{:<34} {:>9} {:>9}\n", "stack", "at most", "seen");
    for entry in Entry::ALL {
        let deepest = calls.deepest(linked, entry.symbol())?;
        text += &format!("{:<34} {:>9} {:>9}\n", entry.name(), deepest.bytes, most(pair, entry).taken.stack);
        for (name, frame) in deepest.path.iter().filter(|(_, frame)| *frame > 0) {
            text += &format!("    {frame:>6} {name}\n");
        }
    }
    Ok(text + &format!("{} functions, none calls itself, none calls by a register\n", calls.functions()))
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
