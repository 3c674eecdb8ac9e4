//! Golden bytes of what protocol version 3 appended: the code of a current that nobody planned. Never edited: a change here is a
//! new version and a new file.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod golden;

use golden::golden;
use zygote_protocol::{Fault, FaultCode, Micros, granted_session};

#[test]
fn unplanned_current_stays() {
    let fault = Fault {
        code: FaultCode::UnplannedCurrent,
        at: Micros(5_000_000),
        step: None,
        channel: None,
        value: 800,
        limit: 400,
    };
    golden(&fault, "0fc096b1020000c00ca006");
}

#[test]
fn sessions_are_granted_as_ever() {
    assert_eq!(granted_session(0x0102_0304, 0), 0x0102_0304);
    assert_eq!(granted_session(0x0102_0304, 1), 0x9f35_7abd);
    assert_eq!(
        granted_session(0x0102_0304, 0xdead_beef),
        0x0102_0304 ^ 0xdead_beef_u32.wrapping_mul(0x9e37_79b9)
    );
    assert_eq!(granted_session(0x9e37_79b9, 1), 0x9e37_79b9, "0 is no session");
}
