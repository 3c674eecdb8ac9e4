//! Scenario files on the emulated board: the program that is flashed, its pins, timers, watchdog and serial line. Ignored
//! unless asked for, because the program has to be built first: `cargo xtask emulator`.

use std::path::{Path, PathBuf};
use std::time::Instant;
use zygote_emulator::{EmulatedBoard, Image};
use zygote_rehearsal::{Rehearsed, Scenario, Trial};
use zygote_rehearsal::scenario::{Verdict, table};

/// The program under test.
fn program() -> Image {
    let built = "../../target/firmware/thumbv7em-none-eabihf/release/zygote-nucleo-f446re";
    let path = std::env::var_os("ZYGOTE_BOARD_ELF")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join(built), PathBuf::from);
    Image::open(&path).unwrap()
}

fn scenario(name: &str) -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/scenarios");
    Scenario::open(&folder.join(name).with_extension("toml")).unwrap()
}

fn rehearse(image: &Image, trial: &Trial) -> Rehearsed {
    trial.run_on(EmulatedBoard::new(image, &trial.plant, 1).unwrap()).unwrap()
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn scenarios() {
    let image = program();
    let mut verdicts: Vec<Verdict> = Vec::new();
    let names = std::env::var("NAMES").unwrap();
    for name in names.split_whitespace() {
        let scenario = scenario(name);
        let mut trial = scenario.trial().unwrap();
        trial.log = true;
        let start = Instant::now();
        let rehearsed = rehearse(&image, &trial);
        let wall = start.elapsed().as_secs_f64();
        let virt = rehearsed.ended_at.0 as f64 / 1e6;
        println!("{name}: {virt:.1} s in {wall:.1} s: {:.2}", virt / wall);
        let verdict = scenario.judge(&trial, &rehearsed);
        if !verdict.holds() || std::env::var_os("LOG").is_some() {
            for line in rehearsed.witness.log() { println!("{line}"); }
            println!("{:?}", rehearsed.ending);
        }
        verdicts.push(verdict);
        println!("{}", table(&verdicts));
    }
}
