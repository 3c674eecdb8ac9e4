//! Files that are no programs for this chip are refused, each with what is wrong with it.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use zygote_emulator::{ElfError, Image};

/// Offsets in the header of a 32-bit ELF file, and the numbers of processors.
const MACHINE: usize = 18;
const ARM: u16 = 40;
const RISC_V: u16 = 243;

/// A file with one segment of a stack's end and a reset vector, and nothing else.
fn file(machine: u16, address: u32, vectors: [u32; 2]) -> Vec<u8> {
    let mut bytes = b"\x7fELF\x01\x01\x01".to_vec();
    bytes.resize(16, 0);
    bytes.extend(2_u16.to_le_bytes());
    bytes.extend(machine.to_le_bytes());
    // Version, entry, program headers, section headers, flags.
    for word in [1, 0, 52, 0, 0_u32] {
        bytes.extend(word.to_le_bytes());
    }
    // Sizes and counts: this header, a program header, one of them, no section.
    for half in [52, 32, 1, 40, 0, 0_u16] {
        bytes.extend(half.to_le_bytes());
    }
    // A segment to be loaded: offset, addresses, sizes, readable, alignment.
    for word in [1, 84, address, address, 8, 8, 4, 4] {
        bytes.extend(word.to_le_bytes());
    }
    for vector in vectors {
        bytes.extend(vector.to_le_bytes());
    }
    bytes
}

const STACK: u32 = 0x2001_0000;
const ENTRY: u32 = 0x0800_01c9;

#[test]
fn a_program_of_a_stack_and_an_entry_is_taken() {
    let image = Image::from_elf(&file(ARM, 0x0800_0000, [STACK, ENTRY])).unwrap();
    assert_eq!((image.flash.len(), image.retained), (8, None));
}

#[test]
fn a_file_that_is_not_there_is_told_with_what_builds_it() {
    let error = Image::open(Path::new("/nowhere/zygote-nucleo-f446re")).unwrap_err();
    assert!(matches!(error, ElfError::Read(_)));
    assert!(error.to_string().contains("cargo xtask firmware"), "{error}");
}

#[test]
fn a_text_an_empty_file_and_a_program_for_a_large_processor_are_no_programs() {
    for bytes in [b"#!/bin/sh\n".as_slice(), b"", b"\x7fELF\x02\x01\x01"] {
        let error = Image::from_elf(bytes).unwrap_err();
        assert!(matches!(error, ElfError::NotElf { .. }), "{error}");
    }
    let ourselves = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    assert!(Image::from_elf(&ourselves).is_err());
}

#[test]
fn a_program_for_another_processor_is_told_by_its_number() {
    let error = Image::from_elf(&file(RISC_V, 0x0800_0000, [STACK, ENTRY])).unwrap_err();
    assert!(matches!(error, ElfError::OtherKind { got: 243, expected: 40, .. }), "{error}");
    assert_eq!(file(RISC_V, 0, [0; 2])[MACHINE], 243);
}

#[test]
fn a_program_that_lies_elsewhere_is_for_another_chip() {
    let error = Image::from_elf(&file(ARM, 0x1000_0000, [STACK, ENTRY])).unwrap_err();
    assert!(matches!(error, ElfError::OutsideFlash { address: 0x1000_0000, .. }), "{error}");
    assert!(error.to_string().contains("0x08000000"), "{error}");
}

#[test]
fn a_stack_or_an_entry_outside_of_the_chip_is_no_program() {
    for vectors in [[0x2004_0000, ENTRY], [STACK, 0x0800_01c8], [STACK, 0x1000_0001], [u32::MAX; 2]] {
        let error = Image::from_elf(&file(ARM, 0x0800_0000, vectors)).unwrap_err();
        assert!(matches!(error, ElfError::Vectors { .. }), "{error}");
    }
}

#[test]
fn a_file_cut_short_is_damaged() {
    let whole = file(ARM, 0x0800_0000, [STACK, ENTRY]);
    for length in [10, 60, whole.len() - 1] {
        assert!(Image::from_elf(&whole[..length]).is_err(), "{length} bytes");
    }
    let error = Image::from_elf(&whole[..whole.len() - 1]).unwrap_err();
    assert!(matches!(error, ElfError::Truncated { address: 0x0800_0000 }), "{error}");
}
