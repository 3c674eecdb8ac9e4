//! Readings of every heater's thermistor, in any state: what a calibration samples, and what is looked at before anything is heated.

use crate::host::{CHANNELS, Host, heat, plant};
use zygote_protocol::{
    CentiCelsius, Channels, Command, Micros, Milliamps, Millis, Millivolts, READINGS_PER_REPLY, Reading,
    Readings, Reply, State,
};
use zygote_sim::Board;
use zygote_sim::plant::{Config, Fault as Broken, SmaConfig};

fn readings(host: &mut Host, first: u16) -> Readings {
    match host.ask(Command::Readings { first }) {
        Ok(Reply::Readings(readings)) => readings,
        other => panic!("{other:?}"),
    }
}

/// A reading within so many degrees of the truth, and this power.
fn is_true(reading: Reading, celsius: f64, duty: u16) -> bool {
    let Some(CentiCelsius(told)) = reading.temperature else { return false };
    (f64::from(told) / 100.0 - celsius).abs() < 1.0 && reading.duty == duty
}

#[test]
fn every_fitted_heater_is_told_before_anything_is_energised_and_it_changes_nothing() {
    let mut host = Host::new(&plant());
    host.pass(Millis(50));
    let told = readings(&mut host, 0);
    assert_eq!((told.first, told.channels.len()), (0, usize::from(CHANNELS.heaters)));
    let ambient = host.board.plant().sma_hinges()[0].temperature_c();
    assert!(told.channels.iter().all(|reading| is_true(*reading, ambient, 0)), "{told:?}");
    assert!(told.current < Milliamps(20), "{}", told.current);
    assert!(told.supply > Millivolts(4_500), "{}", told.supply);
    assert!(host.board.now().since(told.at) <= 5_000, "{} at {}", told.at, host.board.now());
    assert!(told.at > Micros(0));
    assert_eq!(host.board.core().state(), State::Idle);
    assert!(host.all_off());
}

#[test]
fn channels_are_told_from_the_one_asked_for_on_and_none_beyond_the_last() {
    let mut host = Host::new(&plant());
    host.pass(Millis(50));
    for (first, count) in [(0, 4), (1, 3), (3, 1), (4, 0), (u16::MAX, 0)] {
        let told = readings(&mut host, first);
        assert_eq!((told.first, told.channels.len()), (first, count));
    }
}

#[test]
fn power_and_current_are_told_while_a_hinge_is_heated() {
    let mut host = Host::new(&plant());
    host.run(&[heat(2, &[])]);
    host.pass(Millis(2_000));
    let told = readings(&mut host, 0);
    let duties: Vec<_> = told.channels.iter().map(|reading| reading.duty).collect();
    assert_eq!(duties, [0, 0, 1_000, 0]);
    assert!(told.current > Milliamps(50), "{}", told.current);
    let warm = |at: usize| told.channels[at].temperature.unwrap();
    assert!(warm(2).0 > warm(1).0 + 300, "{told:?}");
}

#[test]
fn s5_a_thermistor_that_is_open_or_shorted_tells_nothing_and_its_neighbours_do() {
    for broken in [Broken::ThermistorOpen(1), Broken::ThermistorShorted(1)] {
        let mut host = Host::new(&plant());
        host.board.plant_mut().inject(broken).unwrap();
        host.pass(Millis(50));
        let told = readings(&mut host, 0);
        let believed: Vec<_> = told.channels.iter().map(|reading| reading.temperature.is_some()).collect();
        assert_eq!(believed, [true, false, true, true], "{broken:?}");
    }
}

#[test]
fn more_heaters_than_fit_a_frame_are_told_in_several() {
    let config = Config { heaters: vec![SmaConfig::opening(90.0); 40], seed: 7, ..Config::default() };
    let channels = Channels { heaters: 40, servos: 0, springs: 0 };
    let mut host = Host::of(Board::new(&config, channels, 1).unwrap());
    host.pass(Millis(50));
    let most = u16::try_from(READINGS_PER_REPLY).unwrap();
    assert_eq!(readings(&mut host, 0).channels.len(), usize::from(most));
    assert_eq!(readings(&mut host, most).channels.len(), usize::from(40 - most));
}
