//! The schedule reader: any text is a schedule or a refusal; what was read can be written and is read as the same.

use zygote_deployment::Schedule;

/// Bytes as a schedule of its own.
pub(crate) fn check(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Ok(schedule) = Schedule::from_text(text) else { return };
    let written = schedule.to_text().expect("what was read can be written");
    let again = Schedule::from_text(&written).expect("what was written can be read");
    assert_eq!(again.to_text().expect("and written again"), written);
}
