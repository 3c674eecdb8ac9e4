//! The host of the tests on an emulated board.

pub(crate) use crate::link_host::heat;
use crate::link_host::{Host as LinkHost, TestBoard};
use std::path::PathBuf;
use zygote_emulator::{Drive, EmulatedBoard, Image};
use zygote_protocol::{Command, Millis, Reply, Snapshot, State};
use zygote_sim::plant::{Config, Plant, SmaConfig};

pub(crate) type Host = LinkHost<EmulatedBoard>;

/// The program under test.
pub(crate) fn program() -> PathBuf {
    std::env::var_os("ZYGOTE_BOARD_ELF").map_or_else(
        || {
            PathBuf::from(env!("CARGO_MANIFEST_DIR"))
                .join("../../target/firmware/thumbv7em-none-eabihf/release/zygote-nucleo-f446re")
        },
        PathBuf::from,
    )
}

/// A rig of four SMA hinges.
pub(crate) fn plant() -> Config {
    Config { heaters: vec![SmaConfig::opening(90.0); 4], seed: 7, ..Config::default() }
}

impl TestBoard for EmulatedBoard {
    fn plant(&self) -> &Plant {
        EmulatedBoard::plant(self)
    }

    /// By the pins.
    fn is_all_off(&self) -> bool {
        self.drive() == Drive::OFF
    }
}

impl Host {
    /// With a board that has just been switched on.
    pub(crate) fn new(plant: &Config) -> Self {
        let image = Image::open(&program()).unwrap();
        Self::of(EmulatedBoard::new(&image, plant, 1).unwrap())
    }

    /// Connected to a board that has started.
    pub(crate) fn connected(plant: &Config) -> Self {
        let mut host = Self::new(plant);
        host.pass(Millis(20));
        host.connect(77);
        host
    }

    /// What the program is doing, by what it keeps in its memory.
    pub(crate) fn state(&self) -> State {
        self.board.snapshot().map_or(State::Idle, |snapshot| snapshot.state)
    }

    /// What the MCU says that it was doing before its latest reset.
    pub(crate) fn kept(&mut self) -> Snapshot {
        match self.ask(Command::LastRun) {
            Ok(Reply::LastRun(Some(snapshot))) => snapshot,
            other => panic!("{other:?}"),
        }
    }
}
