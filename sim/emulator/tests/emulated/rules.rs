//! What the program does on its chip.

use crate::host::{Host, plant};
use zygote_protocol::{Millis, ResetCause};

const WHY: &str = "needs the board's program; cargo xtask test emulator";

#[test]
#[ignore = "needs the board's program: cargo xtask test emulator"]
fn the_board_starts_and_answers_a_hello() {
    let _ = WHY;
    let mut host = Host::new(&plant());
    let start = std::time::Instant::now();
    host.pass(Millis(20));
    println!("{:?} {} instructions now {:?}", start.elapsed(), host.board.instructions(), host.board.now());
    host.connect(77);
    let identity = host.identity.clone().unwrap();
    println!("{identity:?}");
    assert_eq!((identity.board.as_str(), identity.reset), ("nucleo-f446re", ResetCause::Power));
    let start = std::time::Instant::now();
    let before = host.board.instructions();
    host.pass(Millis(1000));
    println!("{:?} {} instructions", start.elapsed(), host.board.instructions() - before);
}

/// Every way through the chip, a second long: the same bytes out, the same number of instructions.
#[test]
#[ignore = "needs the board's program: cargo xtask test emulator"]
fn the_fast_way_and_the_core_agree_on_every_cycle() {
    let mut hurried = Host::new(&plant());
    let mut careful = Host::new(&plant());
    careful.board.do_not_hurry();
    for host in [&mut hurried, &mut careful] {
        host.pass(Millis(20));
    }
    println!("{} {}", hurried.board.instructions(), careful.board.instructions());
    for host in [&mut hurried, &mut careful] {
        host.connect(77);
        host.pass(Millis(500));
    }
    assert_eq!(hurried.board.instructions(), careful.board.instructions());
    assert_eq!(hurried.board.now(), careful.board.now());
    assert_eq!(hurried.telemetry, careful.telemetry);
    assert!(!hurried.telemetry.is_empty());
}
