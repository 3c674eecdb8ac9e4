//! Golden bytes of protocol version 1. Never edited: a change here is a new version and a new file. Later versions only append, so these
//! hold in them as well; the schema hash is that of the latest.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on fails")]

mod golden;

use golden::{bytes, golden, hex};
use heapless::Vec;
use zygote_protocol::{
    Action, CentiCelsius, Command, Decoder, Event, EventKind, Fault, FaultCode, FrameKind, Header, Heat,
    Hello, Limits, MAX_ENCODED, Micros, Milliamps, Millis, Millivolts, Motion, Phase, Refusal, RefusalCode,
    Release, Reply, Report, Request, Response, State, Status, Step, StepState, Telemetry, Turn, Urgent,
    encode,
};

fn heat() -> Step {
    Step {
        hinge: 300,
        after: Vec::from_slice(&[0, 2]).unwrap(),
        action: Action::Heat(Heat {
            channel: 3,
            target: CentiCelsius(9_500),
            hold: Millis(1_000),
            max_on: Millis(20_000),
            max_temperature: CentiCelsius(12_000),
            cool: CentiCelsius(4_500),
            rest: Millis(500),
            min_gain: CentiCelsius(500),
            gain_window: Millis(3_000),
            current: Milliamps(200),
        }),
    }
}

fn limits() -> Limits {
    Limits {
        max_temperature: CentiCelsius(12_000),
        max_on: Millis(30_000),
        min_rest: Millis(500),
        supply: Milliamps(2_000),
        link_timeout: Millis(1_000),
    }
}

#[test]
fn a_hello_stays() {
    golden(&Hello { min: 1, current: 1, schema: 0x1234_5678 }, "0101f8acd19101");
}

#[test]
fn commands_stay() {
    let request = |command| Request { id: 513, command };
    let rig = || "bench-1".try_into().unwrap();
    golden(&request(Command::Status), "810400");
    golden(&request(Command::Progress { first: 64 }), "81040140");
    golden(
        &request(Command::Upload { run: 7, rig: rig(), steps: 13, crc: 0xdead_beef }),
        "810402070762656e63682d310deffdb6f50d",
    );
    let steps = [
        heat(),
        Step {
            hinge: 1,
            after: Vec::new(),
            action: Action::Turn(Turn {
                channel: 2,
                from_us: 500,
                to_us: 1_500,
                duration: Millis(900),
                settle: Millis(150),
                current: Milliamps(400),
                hold_current: Milliamps(50),
            }),
        },
        Step {
            hinge: 2,
            after: Vec::new(),
            action: Action::Release(Release {
                channel: 0,
                pulse: Millis(200),
                settle: Millis(500),
                current: Milliamps(1_000),
            }),
        },
    ];
    golden(
        &request(Command::Steps { first: 4, steps: Vec::from_slice(&steps).unwrap() }),
        "8104030403ac020200020003b89401e807a09c01c0bb01a846f403e807b817c80101000102f403dc0b8407960190033202000200c801f403e807",
    );
    golden(&request(Command::Commit), "810404");
    golden(
        &request(Command::Arm { rig: rig(), limits: limits(), lifetime: Millis(60_000) }),
        "8104050762656e63682d31c0bb01b0ea01f403d00fe807e0d403",
    );
    golden(&request(Command::Start { run: 7 }), "81040607");
    golden(&request(Command::Disarm), "810407");
    golden(&request(Command::Clear), "810408");
    golden(&Urgent::Stop, "00");
}

#[test]
fn reports_stay() {
    let response = |result| Report::Response(Response { id: 513, result });
    let fault = Fault {
        code: FaultCode::OverTemperature,
        at: Micros(5_000_000),
        step: Some(3),
        channel: Some(2),
        value: 12_050,
        limit: -1,
    };
    golden(&response(Ok(Reply::Done)), "0081040000");
    let status = Status {
        at: Micros(1_000_000),
        state: State::Safe,
        run: Some(7),
        fault: Some(fault),
        opened: 3,
        heaters_on: 0,
        main_switch: false,
    };
    golden(&response(Ok(Reply::Status(status))), "0081040001c0843d0501070105c096b10201030102a4bc0101030000");
    let steps = Vec::from_slice(&[StepState::Waiting, StepState::Done, StepState::Interrupted]).unwrap();
    golden(&response(Ok(Reply::Progress { first: 0, steps })), "00810400020003000304");
    golden(
        &response(Err(Refusal { code: RefusalCode::LimitAboveCeiling, at: 3, expected: 2_000, got: 3_000 })),
        "008104011003a01ff02e",
    );
    let event = |kind| Report::Event(Event { at: Micros(300), kind });
    golden(&event(EventKind::State(State::Running)), "01ac020003");
    golden(&event(EventKind::StepStarted { step: 1 }), "01ac020101");
    golden(&event(EventKind::StepOpened { step: 1 }), "01ac020201");
    golden(&event(EventKind::StepDone { step: 1, peak: Some(CentiCelsius(9_700)) }), "01ac02030101c89701");
    golden(&fault, "05c096b10201030102a4bc0101");
}

#[test]
fn telemetry_stays() {
    let phases = [
        Phase::Heating { temperature: CentiCelsius(-5), duty: 1_000 },
        Phase::Holding { temperature: CentiCelsius(9_600), duty: 400 },
        Phase::Cooling { temperature: CentiCelsius(6_000) },
        Phase::Turning { pulse_us: 1_200 },
        Phase::Releasing,
    ];
    let motions = (0..).zip(phases).map(|(step, phase)| Motion { step, phase }).collect();
    let telemetry = Telemetry {
        at: Micros(70_000_000_000),
        state: State::Running,
        supply: Millivolts(4_950),
        current: Milliamps(620),
        opened: 9,
        motions,
    };
    golden(&telemetry, "80f8cce2840203d626ec040905000009e807010180960190030202e05d0303b0090404");
}

#[test]
fn a_frame_stays() {
    let header = Header { kind: FrameKind::Data, session: 0x0102_0304, seq: 5, ack: 0 };
    let mut buffer = [0; MAX_ENCODED];
    let length = encode(header, &[0, 1, 0], &mut buffer).unwrap();
    assert_eq!(hex(&buffer[..length]), "0702040302010501020105199224b900");
    let mut decoder = Decoder::new();
    assert_eq!(decoder.next(&mut &buffer[..length]), Some(Ok(header)));
    assert_eq!(decoder.payload(), [0, 1, 0]);
}

#[test]
fn the_largest_messages_fit_a_frame() {
    let worst = Step {
        hinge: u16::MAX,
        after: Vec::from_slice(&[u16::MAX; 4]).unwrap(),
        action: Action::Heat(Heat {
            channel: u16::MAX,
            target: CentiCelsius(i16::MAX),
            hold: Millis(u32::MAX),
            max_on: Millis(u32::MAX),
            max_temperature: CentiCelsius(i16::MAX),
            cool: CentiCelsius(i16::MIN),
            rest: Millis(u32::MAX),
            min_gain: CentiCelsius(i16::MAX),
            gain_window: Millis(u32::MAX),
            current: Milliamps(u32::MAX),
        }),
    };
    let steps: Vec<Step, 4> = std::iter::repeat_n(worst, 4).collect();
    let request = Request { id: u16::MAX, command: Command::Steps { first: u16::MAX, steps } };
    assert!(bytes(&request).len() <= 240);
    let motion = Motion {
        step: u16::MAX,
        phase: Phase::Heating { temperature: CentiCelsius(i16::MIN), duty: u16::MAX },
    };
    let telemetry = Telemetry {
        at: Micros(u64::MAX),
        state: State::Safe,
        supply: Millivolts(u32::MAX),
        current: Milliamps(u32::MAX),
        opened: u16::MAX,
        motions: std::iter::repeat_n(motion, 8).collect(),
    };
    assert!(bytes(&telemetry).len() <= 240);
}
