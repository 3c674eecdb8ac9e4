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
