//! What a step draws, and the checksum of a program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use crc::{CRC_32_ISO_HDLC, Crc};
use zygote_protocol::{
    Action, CentiCelsius, Command, Heat, MAX_PAYLOAD, Micros, Milliamps, Millis, Millivolts, Pulse,
    READINGS_PER_REPLY, Reading, Readings, Release, Reply, Report, Request, Response, STEPS_PER_COMMAND,
    Step, Turn, program_crc,
};

fn step(hinge: u16, action: Action) -> Step {
    Step { hinge, after: heapless::Vec::new(), action }
}

fn actions() -> [Action; 4] {
    let heat = Heat {
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
    };
    let turn = Turn {
        channel: 1,
        from_us: 1_000,
        to_us: 2_000,
        duration: Millis(800),
        settle: Millis(200),
        current: Milliamps(300),
        hold_current: Milliamps(50),
    };
    let release = Release { channel: 2, pulse: Millis(50), settle: Millis(300), current: Milliamps(400) };
    let pulse = Pulse {
        channel: 4,
        duty: 250,
        duration: Millis(8_000),
        target: CentiCelsius(8_000),
        max_temperature: CentiCelsius(11_000),
        cool: CentiCelsius(4_000),
        rest: Millis(700),
        min_gain: CentiCelsius(150),
        gain_window: Millis(5_000),
        current: Milliamps(500),
    };
    [Action::Heat(heat), Action::Turn(turn), Action::Release(release), Action::Pulse(pulse)]
}

#[test]
fn a_step_needs_the_current_of_its_motion() {
    assert_eq!(actions().map(|action| action.current()), [200, 300, 400, 500].map(Milliamps));
}

#[test]
fn the_sum_of_a_program_is_that_of_its_steps_encoded_one_after_the_other() {
    let steps = [(0, 2), (1, 0), (2, 3), (3, 1)].map(|(hinge, of)| step(hinge, actions()[of]));
    let bytes: Vec<u8> = steps
        .iter()
        .flat_map(|step| postcard::to_slice(step, &mut [0; MAX_PAYLOAD]).unwrap().to_vec())
        .collect();
    assert_eq!(program_crc(&steps), Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&bytes));
    assert_eq!(program_crc([]), 0, "nothing sums up to zero");
    assert_ne!(program_crc(steps.iter().rev()), program_crc(&steps), "order counts");
}

#[test]
fn a_pulse_keeps_the_limits_of_a_heat_that_is_on_for_its_time_and_held_for_none() {
    let [.., Action::Pulse(pulse)] = actions() else { panic!("no pulse") };
    let heat = Heat {
        channel: 4,
        target: CentiCelsius(8_000),
        hold: Millis(0),
        max_on: Millis(8_000),
        max_temperature: CentiCelsius(11_000),
        cool: CentiCelsius(4_000),
        rest: Millis(700),
        min_gain: CentiCelsius(150),
        gain_window: Millis(5_000),
        current: Milliamps(500),
    };
    assert_eq!(pulse.heat(), heat);
}

fn length<T: serde::Serialize>(message: &T) -> usize {
    postcard::to_slice(message, &mut [0; 2 * MAX_PAYLOAD]).unwrap().len()
}

#[test]
fn the_longest_steps_and_readings_fit_a_frame() {
    let (hottest, longest) = (CentiCelsius(i16::MIN), Millis(u32::MAX));
    let heat = Action::Heat(Heat {
        channel: u16::MAX,
        target: hottest,
        hold: longest,
        max_on: longest,
        max_temperature: hottest,
        cool: hottest,
        rest: longest,
        min_gain: hottest,
        gain_window: longest,
        current: Milliamps(u32::MAX),
    });
    let pulse = Action::Pulse(Pulse {
        channel: u16::MAX,
        duty: u16::MAX,
        duration: longest,
        target: hottest,
        max_temperature: hottest,
        cool: hottest,
        rest: longest,
        min_gain: hottest,
        gain_window: longest,
        current: Milliamps(u32::MAX),
    });
    for action in [heat, pulse] {
        let step = Step { hinge: u16::MAX, after: [u16::MAX; 4].into_iter().collect(), action };
        let steps = std::iter::repeat_n(step, STEPS_PER_COMMAND).collect();
        let request = Request { id: u16::MAX, command: Command::Steps { first: u16::MAX, steps } };
        assert!(length(&request) <= MAX_PAYLOAD, "{} bytes", length(&request));
    }
    let reading = Reading { temperature: Some(hottest), duty: u16::MAX };
    let readings = Readings {
        at: Micros(u64::MAX),
        supply: Millivolts(u32::MAX),
        current: Milliamps(u32::MAX),
        first: u16::MAX,
        channels: [reading; READINGS_PER_REPLY].into_iter().collect(),
    };
    let report = Report::Response(Response { id: u16::MAX, result: Ok(Reply::Readings(readings)) });
    assert!(length(&report) <= MAX_PAYLOAD, "{} bytes", length(&report));
}
