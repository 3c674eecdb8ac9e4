//! `zygote flash` with a probe-rs of its own, which writes down what it is asked.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("flash-{name}"));
    fs::remove_dir_all(&folder).ok();
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A program that lists `probes`, writes its arguments into `asked`, and fails at `verb`.
fn tool(folder: &Path, probes: &str, fails_at: &str) -> PathBuf {
    let (path, asked) = (folder.join("probe-rs"), folder.join("asked"));
    let script = format!(
        "#!/bin/sh\necho \"$@\" >> {}\n[ \"$1\" = list ] && echo '{probes}'\n[ \"$1\" != '{fails_at}' ]\n",
        asked.display()
    );
    fs::write(&path, script).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path
}

/// ELF's numbers for a linked program, one that isn't, and two processors.
const LINKED: u16 = 2;
const LOOSE: u16 = 1;
const ARM: u16 = 40;
const MIPS: u16 = 8;

fn firmware(folder: &Path) -> PathBuf {
    elf(folder, LINKED, ARM, ".zygote", "board=nucleo-f446re\nchip=STM32F446RETx\n")
}

/// The file of a 32-bit program: an ELF header, and a section of seven letters with a text.
fn elf(folder: &Path, kind: u16, machine: u16, section: &str, card: &str) -> PathBuf {
    let names = format!("\0{section}\0.shstrtab\0");
    let (card_at, names_at) = (52, 52 + card.len());
    let table_at = (names_at + names.len()).next_multiple_of(4);
    let word = |value: usize| u32::try_from(value).unwrap().to_le_bytes();
    let half = |value: u16| value.to_le_bytes();
    let mut elf = b"\x7fELF\x01\x01\x01\0\0\0\0\0\0\0\0\0".to_vec();
    // Version 1, no entry, no segments, the table of sections.
    elf.extend([half(kind), half(machine)].concat());
    elf.extend([word(1), word(0), word(0), word(table_at), word(0)].concat());
    elf.extend([half(52), half(0), half(0), half(40), half(3), half(2)].concat());
    elf.extend(card.bytes());
    elf.extend(names.bytes());
    elf.resize(table_at, 0);
    for (name, kind, at, size) in [(0, 0, 0, 0), (1, 1, card_at, card.len()), (9, 3, names_at, names.len())] {
        let fields = [name, kind, 0, 0, at, size, 0, 0, 1, 0];
        elf.extend(fields.into_iter().flat_map(word));
    }
    let path = folder.join("firmware.elf");
    fs::write(&path, elf).unwrap();
    path
}

fn flash(elf: &Path, tool: &Path, more: &[&str]) -> Output {
    let mut zygote = Command::new(env!("CARGO_BIN_EXE_zygote"));
    zygote.arg("flash").arg(elf).arg("--tool").arg(tool).args(more).output().unwrap()
}

fn complaint(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

const PROBE: &str = "The following debug probes were found:
[0]: STLink V2-1 -- 0483:374b:0672FF";

#[test]
fn a_board_is_programmed_verified_and_started() {
    let folder = folder("good");
    let (elf, tool) = (firmware(&folder), tool(&folder, PROBE, "nothing"));
    let output = flash(&elf, &tool, &["--probe", "0483:374b"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let asked = fs::read_to_string(folder.join("asked")).unwrap();
    let common = "--chip STM32F446RETx --probe 0483:374b";
    let expected = format!("list\ndownload {common} --verify {}\nreset {common}\n", elf.display());
    assert_eq!(asked, expected);
}

#[test]
fn without_a_probe_nothing_is_tried() {
    let folder = folder("no-probe");
    let (elf, tool) = (firmware(&folder), tool(&folder, "No debug probes were found.", "nothing"));
    let output = flash(&elf, &tool, &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(complaint(&output).starts_with("error: no debug probe is attached: connect"), "{output:?}");
    assert_eq!(fs::read_to_string(folder.join("asked")).unwrap(), "list\n");
}

#[test]
fn without_the_tool_it_is_named() {
    let folder = folder("no-tool");
    let output = flash(&firmware(&folder), &folder.join("nowhere"), &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(complaint(&output).contains("install it (https://probe.rs)"), "{output:?}");
}

#[test]
fn a_file_that_is_no_firmware_is_bad_input_before_any_tool_runs() {
    let folder = folder("no-elf");
    let (text, tool) = (folder.join("text"), tool(&folder, PROBE, "nothing"));
    fs::write(&text, "hello").unwrap();
    for (elf, expected) in [(text, "it is not an ELF file"), (folder.join("nowhere"), "cannot read")] {
        let output = flash(&elf, &tool, &[]);
        assert_eq!(output.status.code(), Some(2));
        assert!(complaint(&output).contains(expected), "{output:?}");
    }
    assert!(!folder.join("asked").exists());
}

#[test]
fn firmware_for_another_processor_board_or_chip_is_refused_and_said_why() {
    let folder = folder("foreign");
    let tool = tool(&folder, PROBE, "nothing");
    let good = "board=nucleo-f446re\nchip=STM32F446RETx\n";
    for (kind, machine, section, card, expected) in [
        (LINKED, MIPS, ".zygote", good, "it is for Mips, expected Arm"),
        (LOOSE, ARM, ".zygote", good, "it is not linked: Relocatable"),
        (LINKED, ARM, ".others", good, "it is not firmware of zygote: it names no board"),
        (
            LINKED,
            ARM,
            ".zygote",
            "board=nucleo-f446re-z\nchip=STM32F446RETx\n",
            "it is for a board `nucleo-f446re-z`, known are nucleo-f446re, stm32f4-discovery",
        ),
        (
            LINKED,
            ARM,
            ".zygote",
            "board=nucleo-f446re\nchip=STM32L476RGTx\n",
            "it is for a nucleo-f446re with a STM32L476RGTx, expected STM32F446RETx",
        ),
        (LINKED, ARM, ".zygote", "board=nucleo-f446re\n", "it says nothing of its chip"),
    ] {
        let output = flash(&elf(&folder, kind, machine, section, card), &tool, &[]);
        assert_eq!(output.status.code(), Some(2));
        assert!(complaint(&output).contains(expected), "{output:?}");
    }
    assert!(!folder.join("asked").exists());
}

#[test]
fn a_download_that_fails_is_told_and_nothing_is_started() {
    let folder = folder("fails");
    let (elf, tool) = (firmware(&folder), tool(&folder, PROBE, "download"));
    let output = flash(&elf, &tool, &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(complaint(&output).contains("download` ended with exit status: 1"), "{output:?}");
    assert!(!fs::read_to_string(folder.join("asked")).unwrap().contains("reset"));
}
