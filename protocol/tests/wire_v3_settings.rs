//! Golden bytes of what protocol version 3 appended: settings that a board keeps, and the codes of a lost servo driver and of
//! settings that can't be stored. Never edited: a change here is a new version and a new file.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod golden;

use golden::golden;
use zygote_protocol::{
    CentiCelsius, Command, FaultCode, Limits, Micros, Milliamps, Millis, RefusalCode, Reply, Report, Request,
    Response, Settings, SettingsReport,
};

const SETTINGS: Settings = Settings {
    ceiling: Limits {
        max_temperature: CentiCelsius(12_000),
        max_on: Millis(30_000),
        min_rest: Millis(500),
        supply: Milliamps(2_000),
        link_timeout: Millis(1_000),
    },
    shortest_pulse_us: 500,
    longest_pulse_us: 2_500,
};

#[test]
fn settings_stay() {
    golden(&Request { id: 513, command: Command::Settings }, "81040a");
    golden(
        &Request { id: 513, command: Command::Configure(SETTINGS) },
        "81040bc0bb01b0ea01f403d00fe807f403c413",
    );
    let report = SettingsReport { at: Micros(300), in_force: SETTINGS, compiled: SETTINGS };
    let told = Response { id: 513, result: Ok(Reply::Settings(report)) };
    golden(
        &Report::Response(told),
        "0081040004ac02c0bb01b0ea01f403d00fe807f403c413c0bb01b0ea01f403d00fe807f403c413",
    );
}

#[test]
fn new_codes_stay() {
    golden(&FaultCode::ServosLost, "10");
    golden(&RefusalCode::NotStored, "15");
    golden(&RefusalCode::Storing, "16");
}
