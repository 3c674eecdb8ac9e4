//! `cargo xtask firmware`: builds every board, prints its sections, and holds it to its memory;
//! then the same for codec and link alone (`firmware/link-size`), and for the whole core without board (`firmware/core-figures`), which
//! links only if no panic is left in it; `cargo xtask figures` runs that one.
//!
//! Where rustup has the target, the board is built as usual. Where it hasn't (a machine that cannot fetch one),
//! Debian's compiler builds the core library from Debian's copy of its source; see
//! `docs/decisions/0003-building-firmware-without-rustup-targets.md`.

use crate::{sections, stack, tools};
use anyhow::{Context, Result, bail, ensure};
use object::{Object, ObjectSection};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

const TARGET: &str = "thumbv7em-none-eabihf";
/// A board of half a megabyte of flash is not to need a quarter of it, nor a quarter of its RAM for statics.
const BUDGET: sections::Budget = sections::Budget { flash: 128 * 1024, ram: 32 * 1024 };

/// What codec and link alone may take of it.
const LINK_BUDGET: sections::Budget = sections::Budget { flash: 26 * 1024, ram: 6 * 1024 };

/// What the core may take, with 48 channels.
const CORE_BUDGET: sections::Budget = sections::Budget { flash: 56 * 1024, ram: 20 * 1024 };

const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_CARGO: &str = "/usr/bin/cargo";
const DEBIAN_PACKAGES: &[&str] = &["rustc-web", "cargo-web", "rust-web-src", "lld"];
/// The oldest compiler that the workspace takes (`rust-version` in its manifest).
const OLDEST_MINOR: u32 = 91;

/// Builds and measures every board.
pub(crate) fn run() -> Result<()> {
    let toolchain = Toolchain::find()?;
    for board in boards()? {
        let name =
            board.file_name().and_then(|name| name.to_str()).context("a board's folder isn't UTF-8")?;
        measure(&toolchain, &board, name, BUDGET)?;
        let elf = elf_of(name);
        println!("  for {}", chip_of(&elf)?);
        let bytes = fs::read(&elf).with_context(|| format!("cannot read {}", elf.display()))?;
        stack::check(&bytes).with_context(|| format!("{name}: a stack that overflows would be missed"))?;
    }
    let firmware = tools::root().join("firmware");
    measure(&toolchain, &firmware.join("link-size"), "link-size", LINK_BUDGET)?;
    measure(&toolchain, &firmware.join("core-figures"), "core-figures", CORE_BUDGET)
}

/// Builds the core without a board; its ELF file.
pub(crate) fn core_figures() -> Result<PathBuf> {
    build(&Toolchain::find()?, &tools::root().join("firmware/core-figures"), "core-figures")
}

/// Builds what is in a folder; its ELF file.
fn build(toolchain: &Toolchain, folder: &Path, name: &str) -> Result<PathBuf> {
    let mut build = toolchain.cargo();
    build.current_dir(folder).args(["build", "--release", "--locked", "--target", TARGET]);
    tools::run(build.arg("--target-dir").arg(target_dir()))?;

    Ok(elf_of(name))
}

/// Builds what is in a folder, prints its sections, and holds it to its memory.
fn measure(toolchain: &Toolchain, folder: &Path, name: &str, budget: sections::Budget) -> Result<()> {
    let elf = build(toolchain, folder, name)?;
    let bytes = fs::read(&elf).with_context(|| format!("cannot read {}", elf.display()))?;
    let sections = sections::of(&bytes).with_context(|| format!("cannot read {}", elf.display()))?;
    println!("\n{name}\n{}", sections::table(&sections, budget));
    sections::hold_to(&sections, budget).with_context(|| format!("{name} is too large"))
}

fn target_dir() -> PathBuf {
    tools::root().join("target/firmware")
}

/// Where the program of a folder lies once it is built.
pub(crate) fn elf_of(name: &str) -> PathBuf {
    target_dir().join(TARGET).join("release").join(format!("zygote-{name}"))
}

/// The chip that a board's program says it is for.
pub(crate) fn chip_of(elf: &Path) -> Result<String> {
    let bytes = fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
    let file = object::File::parse(bytes.as_slice())?;
    let card = file.section_by_name(".zygote").context("the program names no board")?;
    let text = std::str::from_utf8(card.data()?)?;
    let chip = text.lines().find_map(|line| line.strip_prefix("chip="));
    chip.map(str::to_owned).with_context(|| format!("the program names no chip: {text:?}"))
}

/// The boards, and what they share: crates outside of the host workspace.
pub(crate) fn outside() -> Result<Vec<PathBuf>> {
    let mut folders = boards()?;
    folders.push(tools::root().join("firmware/stm32f4"));
    Ok(folders)
}

/// The folders of the boards, in alphabetical order.
pub(crate) fn boards() -> Result<Vec<PathBuf>> {
    let folder = tools::root().join("firmware/boards");
    let entries = fs::read_dir(&folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut boards = Vec::new();
    for entry in entries {
        let board = entry?.path();
        if board.join("Cargo.toml").is_file() {
            boards.push(board);
        }
    }
    boards.sort();
    ensure!(!boards.is_empty(), "no board in {}", folder.display());
    Ok(boards)
}

/// Where the core library of the target comes from.
enum Toolchain {
    /// The toolchain in use has it.
    Installed,
    /// Debian's compiler builds it.
    Debian,
}

impl Toolchain {
    fn find() -> Result<Self> {
        let sysroot = tools::output_of(tools::command("rustc").args(["--print", "sysroot"]))?;
        if Path::new(sysroot.trim()).join("lib/rustlib").join(TARGET).is_dir() {
            return Ok(Self::Installed);
        }
        if let Err(missing) = debian() {
            println!("target {TARGET} isn't installed, and neither is Debian's Rust: {missing:#}");
            tools::apt_install(DEBIAN_PACKAGES)
                .with_context(|| format!("cannot build for {TARGET}: try `rustup target add {TARGET}`"))?;
            debian()?;
        }
        Ok(Self::Debian)
    }

    fn cargo(&self) -> Command {
        let mut cargo = match self {
            Self::Installed => tools::cargo(),
            Self::Debian => {
                let mut cargo = Command::new(DEBIAN_CARGO);
                cargo.env("RUSTC", DEBIAN_RUSTC);
                // Building the core library is unstable, and Debian's copy of its source is the matching one.
                cargo.env("RUSTC_BOOTSTRAP", "1").args(["-Z", "build-std=core"]);
                // Debian's compiler comes without rust-lld.
                cargo.env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER", "ld.lld");
                cargo
            }
        };
        // These would replace the board's own, which name its linker scripts.
        cargo.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS");
        cargo
    }
}

/// Whether Debian's compiler, its source and the linker are there.
fn debian() -> Result<()> {
    let version = tools::output_of(Command::new(DEBIAN_RUSTC).arg("--version"))?;
    ensure!(
        minor(&version).is_some_and(|minor| minor >= OLDEST_MINOR),
        "{DEBIAN_RUSTC} is `{}`, expected 1.{OLDEST_MINOR} or newer",
        version.trim()
    );
    tools::output_of(Command::new(DEBIAN_CARGO).arg("--version"))?;
    tools::output_of(Command::new("ld.lld").arg("--version"))?;
    let sysroot = tools::output_of(Command::new(DEBIAN_RUSTC).args(["--print", "sysroot"]))?;
    let source = Path::new(sysroot.trim()).join("lib/rustlib/src/rust/library/core");
    if !source.is_dir() {
        bail!("no source of the core library in {}", source.display());
    }
    Ok(())
}

/// The 96 of `rustc 1.96.0 (...)`.
fn minor(version: &str) -> Option<u32> {
    version.strip_prefix("rustc 1.")?.split('.').next()?.parse().ok()
}

#[cfg(test)]
mod checks {
    use super::*;

    #[test]
    fn the_minor_version_is_read_from_what_the_compiler_prints() {
        assert_eq!(minor("rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball)"), Some(96));
        assert_eq!(minor("rustc 2.0.0"), None);
        assert_eq!(minor("clang 1.96"), None);
    }
}
