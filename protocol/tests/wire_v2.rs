//! Golden bytes of what protocol version 2 appended: what outlives a reset, and the codes of a thermistor that stands still and of a
//! hinge that doesn't cool. Never edited: a change here is a new version and a new file.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod golden;

use golden::golden;
use zygote_protocol::{
    Command, Fault, FaultCode, Micros, Reply, Report, Request, ResetCause, Response, Snapshot, State,
    StepState,
};

#[test]
fn the_last_run_stays() {
    golden(&Request { id: 513, command: Command::LastRun }, "810409");
    let nothing = Response { id: 513, result: Ok(Reply::LastRun(None)) };
    golden(&Report::Response(nothing), "008104000300");
    let mut snapshot = Snapshot::new(9, Micros(5_000_000), State::Safe, Some(7), Some(frozen()));
    for state in
        [StepState::Done, StepState::Opened, StepState::Waiting, StepState::Interrupted, StepState::Moving]
    {
        snapshot.push(state);
    }
    snapshot.session = Some(3);
    let told = Response { id: 513, result: Ok(Reply::LastRun(Some(snapshot))) };
    golden(&Report::Response(told), "00810400030109c096b102050107010dc096b10201030102e05db81705024a010103");
}

fn frozen() -> Fault {
    Fault {
        code: FaultCode::SensorFrozen,
        at: Micros(5_000_000),
        step: Some(3),
        channel: Some(2),
        value: 6_000,
        limit: 1_500,
    }
}

#[test]
fn new_codes_stay() {
    golden(&frozen(), "0dc096b10201030102e05db817");
    golden(&FaultCode::NoCooling, "0e");
    golden(&ResetCause::DeadMan, "05");
}
