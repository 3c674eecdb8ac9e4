//! What a step draws, and the checksum of a program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use crc::{CRC_32_ISO_HDLC, Crc};
use zygote_protocol::{
    Action, CentiCelsius, Heat, MAX_PAYLOAD, Milliamps, Millis, Release, Step, Turn, program_crc,
};

fn step(hinge: u16, action: Action) -> Step {
    Step { hinge, after: heapless::Vec::new(), action }
}

fn actions() -> [Action; 3] {
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
    [Action::Heat(heat), Action::Turn(turn), Action::Release(release)]
}

#[test]
fn a_step_needs_the_current_of_its_motion() {
    assert_eq!(actions().map(|action| action.current()), [200, 300, 400].map(Milliamps));
}

#[test]
fn the_sum_of_a_program_is_that_of_its_steps_encoded_one_after_the_other() {
    let steps = [(0, 2), (1, 0), (2, 1)].map(|(hinge, of)| step(hinge, actions()[of]));
    let bytes: Vec<u8> = steps
        .iter()
        .flat_map(|step| postcard::to_slice(step, &mut [0; MAX_PAYLOAD]).unwrap().to_vec())
        .collect();
    assert_eq!(program_crc(&steps), Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&bytes));
    assert_eq!(program_crc([]), 0, "nothing sums up to zero");
    assert_ne!(program_crc(steps.iter().rev()), program_crc(&steps), "order counts");
}
