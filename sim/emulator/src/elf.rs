//! Reads a program for the board: what is flashed, where, and whether it is for this chip at all.

use crate::chip::{FLASH, RAM};
use object::Endianness;
use object::elf::{EM_ARM, ET_EXEC, FileHeader32, PT_LOAD};
use object::read::elf::{FileHeader, ProgramHeader, SectionHeader, Sym};
use std::io;
use std::path::Path;
use zygote_protocol::RETAINED_WORDS;

/// The board that is emulated, and the section in which a program says which one it is for.
const BOARD: &str = "nucleo-f446re";
const CARD: &[u8] = b".zygote";
/// Interrupts of the STM32F446, so entries of its vector table after the first sixteen.
const INTERRUPTS: usize = 97;
/// The vector table as `cortex-m-rt` calls it.
const INTERRUPT_TABLE: &[u8] = b"__INTERRUPTS";
/// The end of the mangled name of the board's `reset::RETAINED`.
const RETAINED: &[u8] = b"5reset8RETAINED";

/// Why a file can't be run.
#[derive(Debug, thiserror::Error)]
pub enum ElfError {
    /// No such file, or it can't be read.
    #[error("the file can't be read; `cargo xtask firmware` builds the board's program")]
    Read(#[source] io::Error),
    /// Something else than a program, or a broken one.
    #[error("not an ELF file for a 32-bit processor, or a damaged one: {what}")]
    NotElf {
        /// What the reader says.
        what: object::Error,
    },
    /// The file ends too early.
    #[error("the file ends before its segment for {address:#010x} does: damaged")]
    Truncated {
        /// Where the segment was to go.
        address: u32,
    },
    /// A program of another kind.
    #[error("{what} is {got}, expected {expected}: not a program for the STM32F446")]
    OtherKind {
        /// The field.
        what: &'static str,
        /// What the file says.
        got: u64,
        /// What it should say.
        expected: u64,
    },
    /// A program for another chip.
    #[error(
        "a segment lies at {address:#010x} to {end:#010x}, outside of the STM32F446's flash ({:#010x} to {:#010x})",
        FLASH.start, FLASH.end
    )]
    OutsideFlash {
        /// Where it begins.
        address: u32,
        /// Where it ends.
        end: u64,
    },
    /// A program for another chip of the family.
    #[error(
        "its vector table has {got} interrupts, the STM32F446 has {INTERRUPTS}: a program for another chip"
    )]
    Interrupts {
        /// How many.
        got: usize,
    },
    /// A program for another board.
    #[error("it says that it is for the board `{got}`, expected `{BOARD}`")]
    Board {
        /// What it says.
        got: String,
    },
    /// No vector table at the start of flash.
    #[error("no program starts at {:#010x}: stack {stack:#010x}, first instruction {entry:#010x}", FLASH.start)]
    Vectors {
        /// The stack's end.
        stack: u32,
        /// The reset vector.
        entry: u32,
    },
}

impl From<object::Error> for ElfError {
    fn from(what: object::Error) -> Self {
        Self::NotElf { what }
    }
}

/// What is flashed: the bytes from the start of flash to the end of the program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// The bytes; gaps read as erased flash.
    pub flash: Vec<u8>,
    /// Where in RAM the program keeps what is to outlive a reset, if it says so.
    pub retained: Option<u32>,
}

impl Image {
    /// Reads a file.
    ///
    /// # Errors
    /// [`ElfError`].
    pub fn open(path: &Path) -> Result<Self, ElfError> {
        Self::from_elf(&std::fs::read(path).map_err(ElfError::Read)?)
    }

    /// Reads a program that is in memory.
    ///
    /// # Errors
    /// [`ElfError`], but for [`ElfError::Read`].
    pub fn from_elf(bytes: &[u8]) -> Result<Self, ElfError> {
        let header = FileHeader32::<Endianness>::parse(bytes)?;
        let endian = header.endian()?;
        expect("the byte order", u64::from(endian == Endianness::Big), 0)?;
        expect("the processor", header.e_machine(endian).into(), EM_ARM.into())?;
        expect("the file's type", header.e_type(endian).into(), ET_EXEC.into())?;

        let mut flash = Vec::new();
        for segment in header.program_headers(endian, bytes)? {
            let address = segment.p_paddr(endian);
            let data = segment.data(endian, bytes).map_err(|()| ElfError::Truncated { address })?;
            if segment.p_type(endian) != PT_LOAD || data.is_empty() {
                continue;
            }
            let end = u64::from(address) + data.len() as u64;
            if address < FLASH.start || end > FLASH.end.into() {
                return Err(ElfError::OutsideFlash { address, end });
            }
            let at = (address - FLASH.start) as usize;
            if flash.len() < at + data.len() {
                flash.resize(at + data.len(), 0xff);
            }
            if let Some(place) = flash.get_mut(at..at + data.len()) {
                place.copy_from_slice(data);
            }
        }
        let retained = look_at_sections(header, endian, bytes)?;
        let word = |at: usize| {
            flash.get(at..at + 4).and_then(|word| word.try_into().ok()).map_or(u32::MAX, u32::from_le_bytes)
        };
        let (stack, entry) = (word(0), word(4));
        let runs = entry & 1 == 1 && FLASH.contains(&entry) && stack > RAM.start && stack <= RAM.end;
        if runs { Ok(Self { flash, retained }) } else { Err(ElfError::Vectors { stack, entry }) }
    }
}

/// A program says which board it is for. Chips of one family differ in what interrupts they have, and programs show how
/// many they expect. Where the retained snapshot lies is told by its name.
fn look_at_sections(
    header: &FileHeader32<Endianness>,
    endian: Endianness,
    bytes: &[u8],
) -> Result<Option<u32>, ElfError> {
    let mut retained = None;
    let sections = header.sections(endian, bytes)?;
    if let Some((_, card)) = sections.section_by_name(endian, CARD) {
        let card = String::from_utf8_lossy(card.data(endian, bytes)?);
        let got = card.lines().find_map(|line| line.strip_prefix("board=")).unwrap_or_default();
        if got != BOARD {
            return Err(ElfError::Board { got: got.to_owned() });
        }
    }
    let symbols = sections.symbols(endian, bytes, object::elf::SHT_SYMTAB)?;
    for symbol in symbols.iter() {
        let (name, words) = (symbols.symbol_name(endian, symbol)?, symbol.st_size(endian) as usize / 4);
        if name == INTERRUPT_TABLE && words != INTERRUPTS {
            return Err(ElfError::Interrupts { got: words });
        }
        if name.ends_with(RETAINED) && words == RETAINED_WORDS {
            retained = Some(symbol.st_value(endian));
        }
    }
    Ok(retained)
}

fn expect(what: &'static str, got: u64, expected: u64) -> Result<(), ElfError> {
    if got == expected { Ok(()) } else { Err(ElfError::OtherKind { what, got, expected }) }
}
