//! The records of a board over thousands of starts, with power failing within every single write and erasure.
#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::cast_possible_truncation,
    reason = "a test that cannot go on fails"
)]

mod flash;

use flash::{Failure, Flash, SECTOR, SIZE};
use zygote_parts::{Memory, MemoryError};
use zygote_protocol::{
    Calibration, CentiCelsius, HeaterCalibration, Kept, Limits, MemoryReport, MemoryState, Milliamps, Millis,
    ServoCalibration, Settings,
};

const FIRST: u32 = 0x1234_0000;
/// Bytes of a record.
const RECORD: usize = 512;
/// Channels of a board.
const CHANNELS: u16 = 16;

type TheMemory = Memory<Flash, 16, 16>;
type TheKept = Kept<16, 16>;

fn settings(max_on: u32) -> Settings {
    Settings {
        ceiling: Limits {
            max_temperature: CentiCelsius(9_000),
            max_on: Millis(max_on),
            min_rest: Millis(500),
            supply: Milliamps(10_000),
            link_timeout: Millis(5_000),
        },
        shortest_pulse_us: 500,
        longest_pulse_us: 2_500,
    }
}

/// Settings of this longest time, and calibrations of every channel whose values take the most bytes.
fn kept(max_on: u32) -> TheKept {
    let mut kept = TheKept::NOTHING;
    kept.settings = Some(settings(max_on));
    for channel in 0..CHANNELS {
        let heater = HeaterCalibration {
            current: Milliamps(u32::MAX),
            gain: CentiCelsius(i16::MIN),
            window: Millis(u32::MAX),
            opens_at: Some(CentiCelsius(i16::MIN + 1)),
        };
        let servo = ServoCalibration { shortest_us: u16::MAX, longest_us: u16::MAX };
        let heater = Calibration::Heater { channel, known: Some(heater) };
        let servo = Calibration::Servo { channel, known: Some(servo) };
        kept.put(heater).and(kept.put(servo)).unwrap();
    }
    kept
}

fn open(flash: Flash) -> TheMemory {
    Memory::open(flash, 0).unwrap()
}

/// What a board does with its memory from power on to power off; the number of the start, if it came that far.
fn life(flash: Flash, to_keep: Option<&TheKept>) -> (Flash, Option<u32>, bool) {
    let mut memory = open(flash);
    let start = memory.count_start(FIRST).ok();
    let is_kept = to_keep.is_some_and(|kept| memory.keep(kept).is_ok());
    let mut flash = memory.into_flash();
    flash.left = None;
    (flash, start, is_kept)
}

#[test]
fn a_fresh_flash_keeps_nothing_and_its_first_start_is_the_one_named() {
    let mut memory = open(Flash::new(1));
    assert_eq!(memory.kept(), Ok(None));
    assert_eq!(memory.report(), MemoryReport::BLANK);
    assert_eq!(memory.count_start(FIRST), Ok(FIRST));
    assert_eq!(memory.report(), MemoryReport::BLANK);
    assert_eq!(memory.count_start(77), Ok(FIRST + 1));
}

#[test]
fn what_is_kept_outlives_a_thousand_starts_and_sectors_take_turns() {
    let (mut flash, ..) = life(Flash::new(1), Some(&kept(1)));
    for start in 1..1_000 {
        let told;
        (flash, told, _) = life(flash, None);
        assert_eq!(told, Some(FIRST + start));
        let memory = open(flash);
        assert_eq!(memory.kept(), Ok(Some(kept(1))));
        flash = memory.into_flash();
    }
    let [a, b] = flash.erasures;
    assert!(a > 10 && a.abs_diff(b) <= 1, "{a} and {b} erasures");
}

/// From every state of the sectors, with power failing at every operation: what is kept is the old or the new, and the next
/// start has a number that none before it had.
#[test]
fn a_torn_write_falls_back_to_the_last_good_record() {
    let (mut failures, mut survivals) = (0, 0);
    for seed in 0..40 {
        // A state in the middle of a sector, at its end, just after the turn ..
        let mut whole = life(Flash::new(seed), Some(&kept(0))).0;
        let mut last = FIRST;
        for _ in 0..seed {
            let start;
            (whole, start, _) = life(whole, Some(&kept(0)));
            last = start.unwrap();
        }
        for cut in 1.. {
            let mut flash = whole.clone();
            flash.left = Some(cut);
            let (flash, start, is_kept) = life(flash, Some(&kept(1)));
            let last = start.map_or(last, |start| {
                assert!(start > last, "seed {seed}, cut {cut}");
                start
            });
            let mut memory = open(flash);
            let found = memory.kept();
            let old_or_new = [Ok(Some(kept(0))), Ok(Some(kept(1)))];
            assert!(old_or_new.contains(&found), "seed {seed}, cut {cut}: {found:?}");
            assert!(!is_kept || found == old_or_new[1], "seed {seed}, cut {cut}: said to be kept");
            let next = memory.count_start(FIRST).unwrap();
            assert!(next > last, "seed {seed}, cut {cut}: {next:#x} after {last:#x}");
            assert_eq!(memory.keep(&kept(2)), Ok(()), "seed {seed}, cut {cut}: works again");
            if is_kept {
                survivals += 1;
                break;
            }
            failures += 1;
        }
    }
    assert_eq!(survivals, 40, "each state ends with a life without a cut");
    assert!(failures > 400, "{failures}");
}

/// Power fails again and again, also while the damage of the failure before is being mended.
#[test]
fn no_number_of_a_start_comes_back_however_often_power_fails() {
    for seed in 0..20 {
        let mut flash = Flash::new(seed);
        (flash, _, _) = life(flash, Some(&kept(0)));
        let (mut last, mut surely, mut starts) = (FIRST, 0, 0);
        for life_number in 1..600_u32 {
            flash.left = Some(1 + u32::from(flash.any()) % 260);
            let (after, start, stored) = life(flash, Some(&kept(life_number)));
            flash = after;
            if let Some(start) = start {
                assert!(start > last, "seed {seed}, life {life_number}: {start:#x} after {last:#x}");
                (last, starts) = (start, starts + 1);
            }
            let memory = open(flash);
            let found =
                memory.kept().unwrap().and_then(|found| found.settings).map(|found| found.ceiling.max_on.0);
            assert!(
                found.is_some_and(|found| found >= surely && found <= life_number),
                "seed {seed}, life {life_number}: {found:?}, {surely} was kept"
            );
            surely = if stored { life_number } else { found.unwrap() };
            flash = memory.into_flash();
        }
        assert!(starts > 100, "seed {seed}: {starts} starts");
    }
}

#[test]
fn a_flash_full_of_noise_is_started_anew() {
    for seed in 0..50 {
        let mut flash = Flash::new(seed);
        for at in 0..SIZE {
            flash.bytes[at] = flash.any();
        }
        let mut memory = open(flash);
        let start = memory.count_start(FIRST);
        assert_eq!(start, Ok(FIRST), "seed {seed}");
        assert_eq!(memory.kept(), Ok(None), "seed {seed}");
        assert_eq!(memory.keep(&kept(5)), Ok(()), "seed {seed}");
    }
}

#[test]
fn what_another_version_kept_is_named_and_may_be_replaced() {
    let (mut flash, ..) = life(Flash::new(3), Some(&kept(1)));
    // The record with another version in front, its checksum right: what a newer firmware leaves behind.
    let mut memory = open(flash);
    memory.keep_as(7, &kept(1)).unwrap();
    assert_eq!(memory.kept(), Err(MemoryError::Version { got: 7 }));
    let message = MemoryError::<Failure>::Version { got: 7 }.to_string();
    assert_eq!(message, "what is stored is of version 7, expected 2");
    assert_eq!(memory.report(), MemoryReport { state: MemoryState::OtherVersion, damaged: 0 });
    assert_eq!(memory.keep(&kept(2)), Ok(()));
    assert_eq!(memory.report(), MemoryReport { state: MemoryState::Kept, damaged: 0 });
    flash = memory.into_flash();
    assert_eq!(open(flash).kept(), Ok(Some(kept(2))));
}

#[test]
fn a_flash_that_is_too_small_is_refused() {
    assert!(
        matches!(TheMemory::open(Flash::new(1), SECTOR as u32 / 2), Err(MemoryError::Room)),
        "one sector is left"
    );
    assert!(
        matches!(TheMemory::open(Flash::new(1), RECORD as u32), Err(MemoryError::Room)),
        "begins within a sector"
    );
}

/// Single bits, as ageing flips them: the record before the damaged one counts.
#[test]
fn a_damaged_record_falls_back_to_the_one_before() {
    let mut memory = open(Flash::new(9));
    for start in 0..3 {
        assert_eq!(memory.count_start(FIRST), Ok(FIRST + start));
    }
    let flash = memory.into_flash();
    for bit in 0..RECORD * 8 {
        let mut damaged = flash.clone();
        damaged.bytes[2 * RECORD + bit / 8] ^= 1 << (bit % 8);
        let mut memory = open(damaged);
        assert_eq!(memory.report(), MemoryReport { state: MemoryState::Blank, damaged: 1 }, "bit {bit}");
        assert_eq!(memory.count_start(FIRST), Ok(FIRST + 2), "bit {bit}");
    }
}

#[test]
fn a_worn_flash_is_told() {
    let mut flash = Flash::new(4);
    flash.worn = true;
    assert_eq!(open(flash).count_start(FIRST), Err(MemoryError::Worn));
}

#[test]
fn a_place_that_does_not_hold_is_passed_over() {
    let mut flash = Flash::new(4);
    flash.bytes[10] = 0x00;
    let mut memory = open(flash);
    assert_eq!(memory.count_start(FIRST), Ok(FIRST));
    let mut flash = memory.into_flash();
    flash.bytes[RECORD + 10] = 0x00;
    let mut memory = open(flash);
    assert_eq!(memory.count_start(FIRST), Ok(FIRST + 1));
    let flash = memory.into_flash();
    assert_ne!(flash.bytes[2 * RECORD], 0xff, "the third place, the second is damaged");
    assert_eq!(flash.bytes[SECTOR], 0xff);
}
