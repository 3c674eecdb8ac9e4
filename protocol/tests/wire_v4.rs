//! Golden bytes of what protocol version 4 appended: pulses, readings, the code of a power out of bounds, the memory's report. Never edited: a change
//! here is a new version and a new file.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod golden;

use golden::golden;
use zygote_protocol::{
    Action, CentiCelsius, Command, MemoryReport, MemoryState, Micros, Milliamps, Millis, Millivolts, Pulse,
    Reading, Readings, RefusalCode, Reply, Report, Request, Response, Step,
};

#[test]
fn pulses_stay() {
    let pulse = Pulse {
        channel: 3,
        duty: 250,
        duration: Millis(20_000),
        target: CentiCelsius(9_500),
        max_temperature: CentiCelsius(12_000),
        cool: CentiCelsius(4_500),
        rest: Millis(500),
        min_gain: CentiCelsius(150),
        gain_window: Millis(5_000),
        current: Milliamps(200),
    };
    let step = Step { hinge: 4, after: heapless::Vec::new(), action: Action::Pulse(pulse) };
    let steps = std::iter::once(step).collect();
    golden(
        &Request { id: 513, command: Command::Steps { first: 0, steps } },
        "810403000104000303fa01a09c01b89401c0bb01a846f403ac028827c801",
    );
    golden(&RefusalCode::PulseDuty, "17");
}

#[test]
fn readings_stay() {
    golden(&Request { id: 513, command: Command::Readings { first: 16 } }, "81040c10");
    let believed = Reading { temperature: Some(CentiCelsius(2_345)), duty: 250 };
    let readings = Readings {
        at: Micros(300),
        supply: Millivolts(4_950),
        current: Milliamps(620),
        first: 16,
        channels: [believed, Reading { temperature: None, duty: 0 }].into_iter().collect(),
    };
    let told = Response { id: 513, result: Ok(Reply::Readings(readings)) };
    golden(&Report::Response(told), "0081040005ac02d626ec04100201d224fa010000");
}

#[test]
fn the_report_on_the_memory_stays() {
    golden(&Request { id: 513, command: Command::Memory }, "81040d");
    let report = MemoryReport { state: MemoryState::OtherVersion, damaged: 300 };
    let told = Response { id: 513, result: Ok(Reply::Memory(report)) };
    golden(&Report::Response(told), "008104000602ac02");
    for (state, bytes) in [
        (MemoryState::Kept, "00"),
        (MemoryState::Blank, "01"),
        (MemoryState::OtherVersion, "02"),
        (MemoryState::Unusable, "03"),
    ] {
        golden(&state, bytes);
    }
}
