//! What a firmware takes of flash and RAM, read from its ELF file.

use anyhow::{Result, ensure};
use object::{Object, ObjectSection, SectionFlags, elf};

/// Where the RAM of every Cortex-M begins; flash lies below.
const RAM_START: u64 = 0x2000_0000;

/// What a board may take at most, in bytes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Budget {
    /// Code, constants, and the initial values of statics.
    pub(crate) flash: u64,
    /// Statics; the stack isn't among them.
    pub(crate) ram: u64,
}

/// A section that takes memory on the chip.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Section {
    name: String,
    flash: u64,
    ram: u64,
}

impl Section {
    fn new(name: &str, address: u64, size: u64, has_content: bool) -> Self {
        let in_ram = address >= RAM_START;
        // Statics with an initial value lie in both: the start-up code copies them.
        let flash = if has_content { size } else { 0 };
        Self { name: name.to_owned(), flash, ram: if in_ram { size } else { 0 } }
    }
}

/// The sections of an ELF file that take memory, as they stand in it.
///
/// # Errors
/// When `elf` isn't one.
pub(crate) fn of(elf: &[u8]) -> Result<Vec<Section>> {
    let file = object::File::parse(elf)?;
    let mut sections = Vec::new();
    for section in file.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else { continue };
        if sh_flags & u64::from(elf::SHF_ALLOC) != 0 && section.size() > 0 {
            let has_content = section.kind() != object::SectionKind::UninitializedData;
            sections.push(Section::new(section.name()?, section.address(), section.size(), has_content));
        }
    }
    Ok(sections)
}

/// A line a section, the sums, and the budget.
pub(crate) fn table(sections: &[Section], budget: Budget) -> String {
    let line = |name: &str, flash: u64, ram: u64| format!("  {name:<16} {flash:>9} {ram:>9}\n");
    let mut text = format!("  {:<16} {:>9} {:>9}\n", "section", "flash", "ram");
    for section in sections {
        text += &line(&section.name, section.flash, section.ram);
    }
    let (flash, ram) = sums(sections);
    text + &line("sum", flash, ram) + &line("budget", budget.flash, budget.ram)
}

/// Refuses what is larger than the budget.
///
/// # Errors
/// Names the memory, the size and the budget.
pub(crate) fn hold_to(sections: &[Section], budget: Budget) -> Result<()> {
    let (flash, ram) = sums(sections);
    ensure!(flash > 0, "the program is empty");
    ensure!(flash <= budget.flash, "flash: {flash} bytes, the budget is {}", budget.flash);
    ensure!(ram <= budget.ram, "static RAM: {ram} bytes, the budget is {}", budget.ram);
    Ok(())
}

fn sums(sections: &[Section]) -> (u64, u64) {
    sections.iter().fold((0, 0), |(flash, ram), section| (flash + section.flash, ram + section.ram))
}

#[cfg(test)]
mod checks {
    use super::*;

    fn program() -> Vec<Section> {
        vec![
            Section::new(".text", 0x0800_0200, 1000, true),
            Section::new(".data", 0x2000_4000, 30, true),
            Section::new(".bss", 0x2000_401e, 500, false),
        ]
    }

    #[test]
    fn initialised_statics_count_in_flash_and_in_ram() {
        assert_eq!(sums(&program()), (1030, 530));
    }

    #[test]
    fn a_program_over_its_budget_is_refused_with_both_numbers() {
        assert!(hold_to(&program(), Budget { flash: 1030, ram: 530 }).is_ok());
        let flash = hold_to(&program(), Budget { flash: 1029, ram: 530 }).unwrap_err();
        assert_eq!(flash.to_string(), "flash: 1030 bytes, the budget is 1029");
        let ram = hold_to(&program(), Budget { flash: 1030, ram: 529 }).unwrap_err();
        assert_eq!(ram.to_string(), "static RAM: 530 bytes, the budget is 529");
    }

    #[test]
    fn a_file_that_is_no_program_is_refused() {
        assert!(of(b"not an ELF file").is_err());
    }
}
