//! A linked program without vectors: its flash, its names, and which bytes of it are instructions.

use object::elf::{EM_ARM, SHF_ALLOC, STT_FUNC, STT_OBJECT};
use object::read::elf::{FileHeader, SectionHeader, Sym};
use object::{Endianness, elf::FileHeader32, elf::SHT_NOBITS, elf::SHT_SYMTAB};
use rsemu::cpu::arm::v7m::isa::{self, Insn};
use std::collections::BTreeMap;
use std::ops::Range;

/// Where the flash of an STM32 begins.
pub(crate) const FLASH: u32 = 0x0800_0000;
/// Where the RAM of every Cortex-M begins.
pub(crate) const RAM: u32 = 0x2000_0000;

/// Why a program can't be taken apart.
#[derive(Debug, thiserror::Error)]
pub enum LinkedError {
    /// Not an ELF file of 32 bits, or a broken one.
    #[error("not an ELF file for a 32-bit processor, or a damaged one: {0}")]
    NotElf(#[from] object::Error),
    /// A program for another processor.
    #[error("the processor is {0}, expected ARM ({EM_ARM})")]
    OtherProcessor(u16),
    /// Statics with an initial value, which start-up code would copy: there is none.
    #[error("section {name} has initial values for RAM, and nothing copies them there")]
    InitialValues {
        /// The section.
        name: String,
    },
    /// A section in neither.
    #[error(
        "section {name} lies at {address:#010x}, expected flash from {FLASH:#010x} or RAM from {RAM:#010x}"
    )]
    Elsewhere {
        /// The section.
        name: String,
        /// Its address.
        address: u32,
    },
    /// A name that isn't there.
    #[error("the program has no `{0}`")]
    NoSuchName(String),
}

/// A function or a static.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) name: String,
    pub(crate) start: u32,
    pub(crate) size: u32,
}

/// An instruction where it lies.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub(crate) at: u32,
    pub(crate) size: u32,
    pub(crate) insn: Insn,
}

/// What the linker made.
#[derive(Debug, Clone)]
pub struct Linked {
    pub(crate) flash: Vec<u8>,
    /// By address; of functions with several names, one.
    pub(crate) functions: BTreeMap<u32, Place>,
    statics: Vec<Place>,
    /// Where instructions (`true`) or constants (`false`) begin.
    kinds: BTreeMap<u32, bool>,
    /// Bytes of RAM up to the end of the last static.
    pub(crate) statics_end: u32,
}

impl Linked {
    /// Takes an ELF file apart.
    ///
    /// # Errors
    /// [`LinkedError`].
    pub fn from_elf(bytes: &[u8]) -> Result<Self, LinkedError> {
        let header = FileHeader32::<Endianness>::parse(bytes)?;
        let endian = header.endian()?;
        if header.e_machine(endian) != EM_ARM {
            return Err(LinkedError::OtherProcessor(header.e_machine(endian)));
        }
        let sections = header.sections(endian, bytes)?;
        let (mut flash, mut statics_end) = (Vec::new(), RAM);
        for section in sections.iter() {
            let (address, size) = (section.sh_addr(endian), section.sh_size(endian));
            if section.sh_flags(endian) & SHF_ALLOC == 0 || size == 0 {
                continue;
            }
            let name =
                || String::from_utf8_lossy(sections.section_name(endian, section).unwrap_or_default()).into();
            match (address, section.sh_type(endian)) {
                (RAM.., SHT_NOBITS) => statics_end = statics_end.max(address + size),
                (RAM.., _) => return Err(LinkedError::InitialValues { name: name() }),
                (FLASH..RAM, _) => place(&mut flash, address, section.data(endian, bytes)?),
                (_, _) => return Err(LinkedError::Elsewhere { name: name(), address }),
            }
        }

        let symbols = sections.symbols(endian, bytes, SHT_SYMTAB)?;
        let (mut functions, mut statics, mut kinds) = (BTreeMap::new(), Vec::new(), BTreeMap::new());
        for (_, symbol) in symbols.enumerate() {
            let name = String::from_utf8_lossy(symbols.symbol_name(endian, symbol)?).into_owned();
            let (start, size) = (symbol.st_value(endian) & !1, symbol.st_size(endian));
            match symbol.st_type() {
                STT_FUNC if size > 0 => _ = functions.insert(start, Place { name, start, size }),
                STT_OBJECT => statics.push(Place { name, start, size }),
                // Mapping symbols: `$t` or `$t.3` before instructions, `$d` before constants.
                _ if name.starts_with("$t") => _ = kinds.insert(start, true),
                _ if name.starts_with("$d") => _ = kinds.insert(start, false),
                _ => {}
            }
        }
        Ok(Self { flash, functions, statics, kinds, statics_end })
    }

    /// Where a function begins.
    ///
    /// # Errors
    /// No such function.
    pub fn function(&self, name: &str) -> Result<u32, LinkedError> {
        let found = self.functions.values().find(|function| function.name == name);
        found.map(|function| function.start).ok_or_else(|| LinkedError::NoSuchName(name.to_owned()))
    }

    /// Where a static lies, and its bytes.
    ///
    /// # Errors
    /// No such static.
    pub fn static_named(&self, name: &str) -> Result<Range<u32>, LinkedError> {
        let found = self.statics.iter().find(|place| place.name == name);
        let place = found.ok_or_else(|| LinkedError::NoSuchName(name.to_owned()))?;
        Ok(place.start..place.start + place.size)
    }

    /// Bytes of flash.
    pub fn flash_bytes(&self) -> usize {
        self.flash.len()
    }

    /// Bytes of RAM that its statics take.
    pub fn static_bytes(&self) -> u32 {
        self.statics_end - RAM
    }

    /// The function that an address lies in.
    pub(crate) fn function_at(&self, address: u32) -> Option<&Place> {
        let (_, function) = self.functions.range(..=address).next_back()?;
        (address < function.start + function.size).then_some(function)
    }

    /// The instructions of a function, constants between them left out.
    pub(crate) fn lines(&self, function: &Place) -> Vec<Line> {
        let (mut at, end) = (function.start, function.start + function.size);
        let mut lines = Vec::new();
        while at < end {
            if !self.is_code(at) {
                at = self.kinds.range(at + 1..).next().map_or(end, |(next, _)| *next);
                continue;
            }
            let line = self.line(at);
            at += line.size;
            lines.push(line);
        }
        lines
    }

    /// The instruction at an address.
    pub(crate) fn line(&self, at: u32) -> Line {
        let first = self.half(at);
        if isa::is_32bit(first) {
            Line { at, size: 4, insn: isa::decode(first, self.half(at + 2)) }
        } else {
            Line { at, size: 2, insn: isa::decode(first, 0) }
        }
    }

    fn is_code(&self, at: u32) -> bool {
        self.kinds.range(..=at).next_back().is_none_or(|(_, code)| *code)
    }

    /// Two bytes of flash; erased flash outside of the program.
    fn half(&self, at: u32) -> u16 {
        let start = at.wrapping_sub(FLASH) as usize;
        let bytes = self.flash.get(start..start.saturating_add(2)).and_then(|bytes| bytes.try_into().ok());
        bytes.map_or(u16::MAX, u16::from_le_bytes)
    }
}

fn place(flash: &mut Vec<u8>, address: u32, data: &[u8]) {
    let start = (address - FLASH) as usize;
    if flash.len() < start + data.len() {
        flash.resize(start + data.len(), 0xff);
    }
    if let Some(place) = flash.get_mut(start..start + data.len()) {
        place.copy_from_slice(data);
    }
}

#[cfg(test)]
impl Linked {
    /// Functions one behind the other from the start of flash, each aligned to 4 bytes.
    pub(super) fn of_code(functions: &[(&str, &[u16])]) -> Self {
        let mut linked = Self {
            flash: Vec::new(),
            functions: BTreeMap::new(),
            statics: Vec::new(),
            kinds: BTreeMap::from([(FLASH, true)]),
            statics_end: RAM,
        };
        for (name, code) in functions {
            let start = FLASH + u32::try_from(linked.flash.len()).unwrap();
            let size = 2 * u32::try_from(code.len()).unwrap();
            linked.flash.extend(code.iter().flat_map(|half| half.to_le_bytes()));
            linked.flash.resize(linked.flash.len().next_multiple_of(4), 0);
            linked.functions.insert(start, Place { name: (*name).to_owned(), start, size });
        }
        linked
    }
}
