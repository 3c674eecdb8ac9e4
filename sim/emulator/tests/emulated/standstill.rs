//! Storing settings erases flash, which halts the processor for half a second: the board's clock must not notice.

use crate::host::{Host, plant};
use crate::link_host::LIMITS;
use zygote_protocol::{Command, Limits, Micros, Millis, Reply, Settings};

/// Records of 512 bytes fill both sectors of 16 KiB by 64, of which the second starts blank: after so many changes three were erased.
const RECORDS: u32 = 128;

/// How far the board's clock is behind the true time, in microseconds, but for the way of the answer.
fn behind(host: &mut Host) -> u64 {
    match host.ask(Command::Settings) {
        Ok(Reply::Settings(report)) => host.board.now().since(report.at),
        other => panic!("{other:?}"),
    }
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn the_clock_is_right_after_flash_was_erased() {
    let mut host = Host::connected(&plant());
    let before = behind(&mut host);
    let (mut longest, mut last) = (0, Micros(0));
    for count in 0..RECORDS {
        let start = host.board.now();
        let limits = Limits { link_timeout: Millis(1_000 + count % 2), ..LIMITS };
        let settings = Settings { ceiling: limits, shortest_pulse_us: 500, longest_pulse_us: 2_500 };
        assert_eq!(host.ask(Command::Configure(settings)), Ok(Reply::Done));
        longest = longest.max(host.board.now().since(start));
        // Missed half turns would let the clock jump back now and then.
        let at = host.telemetry.last().map_or(last, |telemetry| telemetry.at);
        assert!(at >= last, "{at:?} after {last:?}");
        last = at;
    }
    assert!(longest > 400_000, "nothing was erased: {longest} us at the most");
    let after = behind(&mut host);
    assert!(after.abs_diff(before) < 2_000, "{before} us behind before, {after} us after");
}
