//! Whether a stack that overflows is noticed (S9): the stack must lie at the very bottom of the RAM with all statics above it, so
//! that what runs over leaves the RAM and faults, instead of changing statics.

use anyhow::{Context, Result, ensure};
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags, elf};

/// Where the RAM of every Cortex-M begins; just below it is nothing on the chips of our boards.
const RAM_START: u64 = 0x2000_0000;

/// Where a program keeps its stack and its statics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Layout {
    /// The stack pointer at the start: the first word of the vector table.
    first: u64,
    /// The lowest address that the linker script gives the stack.
    end: u64,
    /// The lowest address of any static.
    statics: u64,
}

/// Checks a board's program.
///
/// # Errors
/// Says which address is wrong.
pub(crate) fn check(program: &[u8]) -> Result<()> {
    let layout = of(program)?;
    hold(layout)?;
    println!(
        "  stack {:#x} down to {:#x}, {} KiB, nothing below; statics from {:#x} on",
        layout.first,
        layout.end,
        (layout.first - layout.end) / 1024,
        layout.statics
    );
    Ok(())
}

fn of(program: &[u8]) -> Result<Layout> {
    let file = object::File::parse(program)?;
    let vectors = file.section_by_name(".vector_table").context("no vector table")?.data()?;
    let first =
        vectors.first_chunk().map(|word| u32::from_le_bytes(*word)).context("the vector table is empty")?;
    let end = file.symbols().find(|symbol| symbol.name() == Ok("_stack_end"));
    let end = end.context("the linker script doesn't say where the stack ends (_stack_end)")?.address();
    let in_ram = file.sections().filter(|section| {
        let SectionFlags::Elf { sh_flags } = section.flags() else { return false };
        sh_flags & u64::from(elf::SHF_ALLOC) != 0 && section.size() > 0 && section.address() >= RAM_START
    });
    let statics = in_ram.map(|section| section.address()).min().context("no statics")?;
    Ok(Layout { first: first.into(), end, statics })
}

fn hold(Layout { first, end, statics }: Layout) -> Result<()> {
    ensure!(end == RAM_START, "the stack ends at {end:#x}, expected the bottom of the RAM, {RAM_START:#x}");
    ensure!(first > end, "the stack begins at {first:#x}, below its end {end:#x}");
    ensure!(first <= statics, "statics at {statics:#x} lie below the top of the stack, {first:#x}");
    Ok(())
}

#[cfg(test)]
mod checks {
    use super::*;

    const GOOD: Layout = Layout { first: 0x2001_0000, end: RAM_START, statics: 0x2001_0000 };

    #[test]
    fn a_stack_below_all_statics_is_good() {
        assert!(hold(GOOD).is_ok());
    }

    #[test]
    fn the_usual_layout_with_the_stack_on_top_is_refused() {
        let usual = Layout { first: 0x2002_0000, end: 0x2000_4800, statics: RAM_START };
        assert!(hold(usual).unwrap_err().to_string().contains("expected the bottom of the RAM"));
        let overlapping = Layout { statics: 0x2000_fffc, ..GOOD };
        let message = hold(overlapping).unwrap_err().to_string();
        assert_eq!(message, "statics at 0x2000fffc lie below the top of the stack, 0x20010000");
        assert!(hold(Layout { first: RAM_START, ..GOOD }).is_err());
    }

    #[test]
    fn what_is_no_program_is_refused() {
        assert!(check(b"no program").is_err());
    }
}
