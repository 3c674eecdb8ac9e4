//! What outlives power, in the emulated flash: settings, records that are spoiled, and a supply that fails while one is written.

use crate::host::{Host, plant, program};
use crate::link_host::heat;
use zygote_emulator::{ElfError, Image};
use zygote_protocol::{
    Actuator, Calibration, CentiCelsius, Command, HeaterCalibration, MemoryReport, MemoryState, Milliamps,
    Millis, Refusal, RefusalCode, Reply, ResetCause, Settings,
};

/// The two sectors of records, and the size of a record.
const SECTORS: [u32; 2] = [0x0800_4000, 0x0800_8000];
const SECTOR: u32 = 0x4000;
const RECORD: u32 = 512;

fn in_force(host: &mut Host) -> (Settings, Settings) {
    match host.ask(Command::Settings) {
        Ok(Reply::Settings(report)) => (report.in_force, report.compiled),
        other => panic!("{other:?}"),
    }
}

/// What the board says of its memory.
fn told(host: &mut Host) -> (MemoryState, u16) {
    match host.ask(Command::Memory) {
        Ok(Reply::Memory(MemoryReport { state, damaged })) => (state, damaged),
        other => panic!("{other:?}"),
    }
}

/// What is compiled in, with a lower ceiling.
fn lowered(host: &mut Host, to: i16) -> Settings {
    let (_, mut settings) = in_force(host);
    settings.ceiling.max_temperature = CentiCelsius(to);
    settings
}

fn configure(host: &mut Host, settings: Settings) -> Result<Reply, Refusal> {
    host.ask(Command::Configure(settings))
}

fn power_cycle(host: &mut Host, seed: u64) {
    host.board.power_cycle(seed);
    assert!(host.all_off());
    host.pass(Millis(20));
    host.connect(80 + u32::try_from(seed).unwrap());
    assert_eq!(host.identity.as_ref().unwrap().reset, ResetCause::Power);
}

fn places() -> impl DoubleEndedIterator<Item = u32> {
    SECTORS.into_iter().flat_map(|sector| (sector..sector + SECTOR).step_by(RECORD as usize))
}

fn is_blank(host: &Host, place: u32) -> bool {
    host.board.flash(place, RECORD).iter().all(|byte| *byte == 0xff)
}

/// As long as the first sector isn't full, the newest record is the last.
fn newest(host: &Host) -> u32 {
    places().rev().find(|place| !is_blank(host, *place)).unwrap()
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s13_settings_outlive_power_and_a_spoiled_record_falls_back_to_the_one_before() {
    let mut host = Host::connected(&plant());
    let boot = host.identity.as_ref().unwrap().boot;
    let (first, second) = (lowered(&mut host, 9_000), lowered(&mut host, 8_000));
    assert_eq!(told(&mut host), (MemoryState::Blank, 0));
    assert_eq!(configure(&mut host, first), Ok(Reply::Done));
    power_cycle(&mut host, 2);
    assert_eq!(in_force(&mut host).0, first);
    assert_eq!(told(&mut host), (MemoryState::Kept, 0));
    assert_eq!(host.identity.as_ref().unwrap().boot, boot.wrapping_add(1));

    assert_eq!(configure(&mut host, second), Ok(Reply::Done));
    let spoiled = newest(&host) + 20;
    host.board.spoil_flash(spoiled, 0x10);
    power_cycle(&mut host, 3);
    assert_eq!(in_force(&mut host).0, first);
    assert_eq!(told(&mut host), (MemoryState::Kept, 1));
    // The number of the start was in the record before as well.
    assert_eq!(host.identity.as_ref().unwrap().boot, boot.wrapping_add(2));
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s13_with_every_record_spoiled_the_compiled_ceilings_hold_and_settings_can_be_stored_again() {
    let mut host = Host::connected(&plant());
    let settings = lowered(&mut host, 9_000);
    assert_eq!(configure(&mut host, settings), Ok(Reply::Done));
    let records: Vec<u32> = places().filter(|place| !is_blank(&host, *place)).collect();
    assert!(records.len() >= 2, "{records:x?}");
    for record in &records {
        host.board.spoil_flash(record + 9, 1);
    }
    power_cycle(&mut host, 2);
    let (now, compiled) = in_force(&mut host);
    assert_eq!(now, compiled);
    let damaged = u16::try_from(records.len()).unwrap();
    assert_eq!(told(&mut host), (MemoryState::Blank, damaged));
    assert_eq!(configure(&mut host, settings), Ok(Reply::Done));
    assert_eq!(told(&mut host), (MemoryState::Kept, damaged));
    power_cycle(&mut host, 3);
    assert_eq!(in_force(&mut host).0, settings);
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s13_a_supply_that_fails_while_a_record_is_written_leaves_the_old_settings_or_the_new_ones() {
    let mut host = Host::connected(&plant());
    let [old, new] = [9_000, 8_000].map(|ceiling| lowered(&mut host, ceiling));
    assert_eq!(configure(&mut host, old), Ok(Reply::Done));
    // Some of the words of a record, the first and the checksum among them.
    for (word, seed) in [1, 2, 3, 9, 128].into_iter().zip(2..) {
        host.board.cut_power_in_flash(word);
        host.send(Command::Configure(new));
        host.pass_until(Millis(1_000), |host| host.board.is_off());
        assert!(host.all_off());
        host.pass(Millis(20));
        power_cycle(&mut host, seed);
        assert_eq!(in_force(&mut host).0, old, "cut in word {word}");
    }
    assert_eq!(configure(&mut host, new), Ok(Reply::Done));
    power_cycle(&mut host, 9);
    assert_eq!(in_force(&mut host).0, new);
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s13_a_supply_that_fails_while_a_sector_is_erased_leaves_the_old_settings() {
    let mut host = Host::connected(&plant());
    let [old, new] = [9_000, 8_000].map(|ceiling| lowered(&mut host, ceiling));
    assert_eq!(configure(&mut host, old), Ok(Reply::Done));
    // Both sectors full, by what is no record: the next one has the second sector erased.
    let last = newest(&host);
    for place in places().filter(|place| *place > last) {
        host.board.spoil_flash(place, 0xff);
    }
    host.board.cut_power_in_flash(1);
    host.send(Command::Configure(new));
    host.pass_until(Millis(3_000), |host| host.board.is_off());
    let [erased, left] = [SECTORS[1], SECTORS[1] + SECTOR / 2].map(|place| is_blank(&host, place));
    assert!(erased && !left, "the sector is half erased");
    power_cycle(&mut host, 2);
    assert_eq!(in_force(&mut host).0, old);
    assert_eq!(configure(&mut host, new), Ok(Reply::Done));
    power_cycle(&mut host, 3);
    assert_eq!(in_force(&mut host).0, new);
}

/// What is known of the heater of this channel.
fn known(host: &mut Host, channel: u16) -> Option<HeaterCalibration> {
    match host.ask(Command::Calibration(Actuator::Heater(channel))) {
        Ok(Reply::Calibration(Calibration::Heater { known, .. })) => known,
        other => panic!("{other:?}"),
    }
}

fn calibrate(host: &mut Host, channel: u16, known: HeaterCalibration) -> Result<Reply, Refusal> {
    host.ask(Command::Calibrate(Calibration::Heater { channel, known: Some(known) }))
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s6_calibrations_outlive_power_beside_the_settings_and_bind_the_steps_of_later_sessions() {
    let mut host = Host::connected(&plant());
    let heater = HeaterCalibration {
        current: Milliamps(200),
        gain: CentiCelsius(4_000),
        window: Millis(3_000),
        opens_at: None,
    };
    let weaker = HeaterCalibration { gain: CentiCelsius(100), ..heater };
    let settings = lowered(&mut host, 12_000);
    assert_eq!(calibrate(&mut host, 0, weaker), Ok(Reply::Done));
    assert_eq!(configure(&mut host, settings), Ok(Reply::Done));
    assert_eq!(calibrate(&mut host, 15, heater), Ok(Reply::Done));
    power_cycle(&mut host, 2);
    assert_eq!(in_force(&mut host).0, settings);
    assert_eq!([0, 14, 15].map(|channel| known(&mut host, channel)), [Some(weaker), None, Some(heater)]);
    assert_eq!(host.upload(&[heat(0, &[])]), Ok(Reply::Done));
    assert_eq!(calibrate(&mut host, 0, heater), Ok(Reply::Done));
    // A record that ageing spoils falls back to what was known before.
    let spoiled = newest(&host) + 300;
    host.board.spoil_flash(spoiled, 1);
    power_cycle(&mut host, 3);
    assert_eq!([0, 15].map(|channel| known(&mut host, channel)), [Some(weaker), Some(heater)]);
    assert_eq!(calibrate(&mut host, 0, heater), Ok(Reply::Done));
    power_cycle(&mut host, 4);
    let refusal = host.upload(&[heat(0, &[])]).unwrap_err();
    assert_eq!((refusal.code, refusal.expected), (RefusalCode::CalibratedGain, 1_000), "{refusal:?}");
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn the_program_of_another_board_is_refused_by_that_boards_name() {
    let other = program().with_file_name("zygote-stm32f4-discovery");
    let error = Image::open(&other).unwrap_err();
    assert!(matches!(&error, ElfError::Board { got } if got == "stm32f4-discovery"), "{error}");
    assert!(error.to_string().contains("nucleo-f446re"), "{error}");
}
