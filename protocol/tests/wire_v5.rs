//! Golden bytes of what protocol version 5 appended: calibrations that a board keeps, and the codes of steps that don't go with them.
//! Never edited: a change here is a new version and a new file.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod golden;

use golden::golden;
use zygote_protocol::{
    Actuator, Calibration, CentiCelsius, Command, HeaterCalibration, Milliamps, Millis, RefusalCode, Reply,
    Report, Request, Response, ServoCalibration, schema,
};

const HEATER: HeaterCalibration = HeaterCalibration {
    current: Milliamps(200),
    gain: CentiCelsius(4_800),
    window: Millis(3_000),
    opens_at: Some(CentiCelsius(7_800)),
};

#[test]
fn the_schema_hash_stays() {
    assert_eq!(format!("{:08x}", schema::compute()), "7a13a429");
    assert_eq!(schema::hash(), schema::compute());
}

#[test]
fn what_a_board_is_asked_and_told_to_keep_stays() {
    let request = |command| Request { id: 513, command };
    golden(&request(Command::Calibration(Actuator::Heater(3))), "81040e0003");
    golden(&request(Command::Calibration(Actuator::Servo(300))), "81040e01ac02");
    let heater = Calibration::Heater { channel: 3, known: Some(HEATER) };
    golden(&request(Command::Calibrate(heater)), "81040f000301c801804bb81701f079");
    let unseen = HeaterCalibration { opens_at: None, ..HEATER };
    let heater = Calibration::Heater { channel: 3, known: Some(unseen) };
    golden(&request(Command::Calibrate(heater)), "81040f000301c801804bb81700");
    let forgotten = Calibration::Heater { channel: 3, known: None };
    golden(&request(Command::Calibrate(forgotten)), "81040f000300");
}

#[test]
fn what_a_board_tells_of_an_actuator_stays() {
    let told =
        |calibration| Report::Response(Response { id: 513, result: Ok(Reply::Calibration(calibration)) });
    let servo = ServoCalibration { shortest_us: 520, longest_us: 2_480 };
    golden(&told(Calibration::Servo { channel: 3, known: Some(servo) }), "00810400070103018804b013");
    golden(&told(Calibration::Servo { channel: 3, known: None }), "0081040007010300");
}

#[test]
fn new_codes_stay() {
    golden(&RefusalCode::CalibratedCurrent, "18");
    golden(&RefusalCode::CalibratedGain, "19");
    golden(&RefusalCode::CalibratedTarget, "1a");
    golden(&RefusalCode::CalibrationValue, "1b");
}
