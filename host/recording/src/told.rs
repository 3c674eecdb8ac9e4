//! A record in a sentence, for log, timeline and page.

use zygote_controller::Record;

/// How much a record matters: Foxglove's levels of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    Info = 2,
    Warning = 3,
    Error = 4,
}

/// The record in a sentence; nothing for telemetry.
pub(crate) fn sentence(record: &Record) -> Option<(Level, String)> {
    let said = match record {
        Record::Telemetry { .. } => return None,
        Record::Connected { line, board, firmware, boot, .. } => {
            (Level::Info, format!("connected: {board} with firmware {firmware} on {line}, boot {boot}"))
        }
        Record::Uploaded { run, steps } => (Level::Info, format!("run {run} uploaded: {steps} steps")),
        Record::State { state, .. } => {
            let level = if state == "safe" { Level::Warning } else { Level::Info };
            (level, format!("the MCU is {state}"))
        }
        Record::Started { hinge, .. } => (Level::Info, format!("hinge {hinge} starts")),
        Record::Opened { hinge, .. } => (Level::Info, format!("hinge {hinge} is at its angle")),
        Record::Done { hinge, peak_c, .. } => {
            let peak = peak_c.map(|peak| format!(", at most {peak:.1} °C")).unwrap_or_default();
            (Level::Info, format!("hinge {hinge} is done{peak}"))
        }
        Record::Fault { fault, value, limit, hinge, .. } => {
            let place = hinge.map(|hinge| format!(" at hinge {hinge}")).unwrap_or_default();
            (Level::Error, format!("{fault}{place}: measured {value}, limit {limit}"))
        }
        Record::Paused => {
            (Level::Warning, "the user pauses the run: the MCU is disarmed, everything is off".to_owned())
        }
        Record::StopRequested => (Level::Warning, "the user stops the run".to_owned()),
        Record::StopConfirmed { after_us } => {
            #[expect(clippy::cast_precision_loss, reason = "a confirmation takes less than 2^52 us")]
            let after_ms = *after_us as f64 / 1e3;
            (Level::Warning, format!("the MCU has confirmed the stop after {after_ms:.0} ms"))
        }
        Record::Lost { message } => (Level::Error, format!("the session broke: {message}")),
    };
    Some(said)
}
