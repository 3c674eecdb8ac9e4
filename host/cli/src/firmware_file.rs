//! Reads of a firmware's ELF file for which board and chip it is: its section `.zygote` says so.

use anyhow::{Context, Result, bail, ensure};
use object::{Architecture, BinaryFormat, Object, ObjectKind, ObjectSection};
use std::path::Path;

/// Boards that there is firmware for, and the chips on them.
const BOARDS: [(&str, &str); 2] =
    [("nucleo-f446re", "STM32F446RETx"), ("stm32f4-discovery", "STM32F407VGTx")];

/// Which board a program is for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Card {
    pub(crate) board: String,
    pub(crate) chip: String,
}

/// The card of the program in this file.
pub(crate) fn card_of(path: &Path) -> Result<Card> {
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    read(&bytes).with_context(|| format!("{} can't be flashed", path.display()))
}

fn read(bytes: &[u8]) -> Result<Card> {
    let Ok(file) = object::File::parse(bytes) else { bail!("it is not an ELF file") };
    ensure!(file.format() == BinaryFormat::Elf, "it is a {:?} file, expected ELF", file.format());
    let architecture = file.architecture();
    ensure!(architecture == Architecture::Arm, "it is for {architecture:?}, expected Arm");
    ensure!(file.kind() == ObjectKind::Executable, "it is not linked: {:?}", file.kind());
    let section =
        file.section_by_name(".zygote").context("it is not firmware of zygote: it names no board")?;
    let text = std::str::from_utf8(section.data()?).context("what it says of its board isn't text")?;
    let field = |name: &str| {
        let value = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix('='));
        value.map(str::to_owned).with_context(|| format!("it says nothing of its {name}: {text:?}"))
    };
    let card = Card { board: field("board")?, chip: field("chip")? };
    match BOARDS.iter().find(|(board, _)| *board == card.board) {
        None => {
            let known = BOARDS.map(|(board, _)| board).join(", ");
            bail!("it is for a board `{}`, known are {known}", card.board)
        }
        Some((_, chip)) => {
            ensure!(*chip == card.chip, "it is for a {} with a {}, expected {chip}", card.board, card.chip);
        }
    }
    Ok(card)
}
