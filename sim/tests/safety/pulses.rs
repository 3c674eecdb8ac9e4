//! Pulses of constant power are guarded as heat is, by the same rules: one by one, and in random trials of rigs that break.

use crate::host::{Host, LIMITS, heat, plant};
use zygote_protocol::{
    Action, CentiCelsius, EventKind, FaultCode, Limits, Milliamps, Millis, Pulse, Refusal, RefusalCode,
    Reply, State, Step, StepState,
};
use zygote_sim::Chance;
use zygote_sim::plant::{Config, Fault as Broken};

const PULSE: Pulse = Pulse {
    channel: 0,
    duty: 500,
    duration: Millis(5_000),
    target: CentiCelsius(9_500),
    max_temperature: CentiCelsius(12_000),
    cool: CentiCelsius(4_500),
    rest: Millis(1_000),
    min_gain: CentiCelsius(200),
    gain_window: Millis(3_000),
    current: Milliamps(200),
};

fn pulse(pulse: Pulse) -> Step {
    Step { hinge: pulse.channel, after: heapless::Vec::new(), action: Action::Pulse(pulse) }
}

fn duties(host: &Host) -> Vec<u16> {
    host.board.core().outputs().heaters.iter().map(|duty| duty.per_mille()).collect()
}

fn temperature_c(host: &Host, hinge: usize) -> f64 {
    host.board.plant().sma_hinges()[hinge].temperature_c()
}

#[test]
fn a_pulse_heats_at_its_power_for_its_time_and_the_hinge_cools() {
    let mut host = Host::new(&plant());
    let start = temperature_c(&host, 0);
    host.run(&[pulse(PULSE)]);
    let (mut on_ms, mut peak) = (0_u32, start);
    host.pass_until(Millis(60_000), |host| {
        let duty = duties(host)[0];
        assert!(duty == 0 || duty == 500, "{duty}");
        on_ms += u32::from(duty == 500);
        peak = peak.max(temperature_c(host, 0));
        host.board.core().state() == State::Finished
    });
    assert!((4_990..=5_010).contains(&on_ms), "{on_ms} ms");
    assert!(peak > start + 10.0, "{start} to {peak} °C");
    assert!(host.all_off());
    assert_eq!(host.step_states(), [StepState::Done]);
    let kinds = host.events.iter().filter_map(|event| match event.kind {
        EventKind::StepStarted { .. } => Some("started"),
        EventKind::StepOpened { .. } => Some("opened"),
        EventKind::StepDone { peak: Some(told), .. } => {
            assert!((f64::from(told.0) / 100.0 - peak).abs() < 2.0, "{told} for {peak} °C");
            Some("done")
        }
        EventKind::StepDone { peak: None, .. } | EventKind::State(_) => None,
    });
    assert_eq!(kinds.collect::<Vec<_>>(), ["started", "opened", "done"]);
}

#[test]
fn s4_a_pulse_that_gets_too_hot_turns_everything_off() {
    let mut host = Host::new(&plant());
    let hot = Pulse {
        duty: 1_000,
        duration: Millis(20_000),
        target: CentiCelsius(5_900),
        max_temperature: CentiCelsius(6_000),
        ..PULSE
    };
    host.run(&[pulse(hot)]);
    host.pass_until(Millis(20_000), |host| host.board.core().state() == State::Safe || duties(host)[0] == 0);
    // The pulse has ended at its target; what the foil still holds raises the reading past the limit.
    host.pass_until(Millis(5_000), |host| host.board.core().state() == State::Safe);
    let fault = host.board.core().fault().unwrap();
    assert_eq!((fault.code, fault.step, fault.channel), (FaultCode::OverTemperature, Some(0), Some(0)));
    assert!(host.all_off());
}

#[test]
fn s4_s6_s7_s13_a_pulse_that_no_heat_could_be_is_refused() {
    let refused = |code, expected, got| Err(Refusal { code, at: 0, expected, got });
    let cases = [
        (Pulse { duty: 0, ..PULSE }, refused(RefusalCode::PulseDuty, 1, 0)),
        (Pulse { duty: 1_001, ..PULSE }, refused(RefusalCode::PulseDuty, 1_000, 1_001)),
        (Pulse { duration: Millis(0), ..PULSE }, refused(RefusalCode::StepOverOnTime, 0, 0)),
        (Pulse { gain_window: Millis(5_001), ..PULSE }, refused(RefusalCode::StepOverOnTime, 5_000, 5_001)),
        (Pulse { min_gain: CentiCelsius(0), ..PULSE }, refused(RefusalCode::StepOverTemperature, 1, 0)),
        (
            Pulse { target: CentiCelsius(12_000), ..PULSE },
            refused(RefusalCode::StepOverTemperature, 12_000, 12_000),
        ),
        (Pulse { channel: 4, ..PULSE }, refused(RefusalCode::UnknownChannel, 3, 4)),
        (Pulse { duty: 1, ..PULSE }, Ok(Reply::Done)),
        (Pulse { duty: 1_000, ..PULSE }, Ok(Reply::Done)),
    ];
    let mut host = Host::new(&plant());
    for (case, answer) in cases {
        assert_eq!(host.upload(&[pulse(case)]), answer, "{case:?}");
    }
}

#[test]
fn s4_s7_a_pulse_is_held_against_the_limits_of_the_session_too() {
    let mut host = Host::new(&plant());
    host.upload(&[pulse(PULSE)]).unwrap();
    let refused = |code, expected, got| Err(Refusal { code, at: 0, expected, got });
    let cases = [
        (Limits { max_on: Millis(4_999), ..LIMITS }, refused(RefusalCode::StepOverOnTime, 4_999, 5_000)),
        (Limits { min_rest: Millis(1_001), ..LIMITS }, refused(RefusalCode::StepOverOnTime, 1_001, 1_000)),
        (
            Limits { max_temperature: CentiCelsius(11_999), ..LIMITS },
            refused(RefusalCode::StepOverTemperature, 11_999, 12_000),
        ),
        (Limits { supply: Milliamps(199), ..LIMITS }, refused(RefusalCode::StepOverCurrent, 199, 200)),
        (Limits { max_on: Millis(5_000), supply: Milliamps(200), ..LIMITS }, Ok(Reply::Done)),
    ];
    for (limits, answer) in cases {
        assert_eq!(host.arm(limits), answer, "{limits:?}");
    }
}

#[test]
fn s10_a_pulse_and_a_heat_of_one_heater_are_not_of_one_program() {
    let mut host = Host::new(&plant());
    let both = [Step { hinge: 9, ..pulse(PULSE) }, heat(0, &[])];
    let refusal = Refusal { code: RefusalCode::ChannelTaken, at: 1, expected: 0, got: 0 };
    assert_eq!(host.upload(&both), Err(refusal));
}

#[test]
fn s7_pulses_wait_for_their_whole_current_whatever_their_power() {
    let mut host = Host::new(&plant());
    let steps: Vec<_> = (0..4).map(|channel| pulse(Pulse { channel, duty: 100, ..PULSE })).collect();
    host.upload(&steps).unwrap();
    host.arm(Limits { supply: Milliamps(599), ..LIMITS }).unwrap();
    host.ask(zygote_protocol::Command::Start { run: 5 }).unwrap();
    host.pass(Millis(100));
    assert_eq!(duties(&host)[..4], [100, 100, 0, 0]);
}

#[test]
fn s3_s8_a_stop_and_a_lost_link_end_a_pulse() {
    for cut in [false, true] {
        let mut host = Host::new(&plant());
        host.run(&[pulse(PULSE)]);
        host.pass(Millis(500));
        assert_eq!(duties(&host)[0], 500);
        if cut {
            host.connected = false;
            host.pass(Millis(1_050));
        } else {
            host.stop();
        }
        assert!(host.all_off());
    }
}

fn shortened(config: &mut Config, chance: &mut Chance) {
    for sma in &mut config.heaters {
        sma.heater_ohm *= chance.between(0.7, 1.4);
        sma.thermistor.noise_counts = chance.between(0.0, 1.5);
        sma.thermistor.lag_s = chance.between(0.1, 0.45);
        sma.convection_w_per_m2_k = chance.between(20.0, 70.0);
    }
}

fn any_pulse(channel: u16, chance: &mut Chance) -> Step {
    let whole = |chance: &mut Chance, least: u32, most: u32| {
        least + u32::try_from(chance.below(usize::try_from(most - least).unwrap())).unwrap()
    };
    let centi = |value: u32| CentiCelsius(i16::try_from(value).unwrap());
    let duration = whole(chance, 500, 20_000);
    let target = whole(chance, 5_000, 10_000);
    let any = Pulse {
        channel,
        duty: u16::try_from(whole(chance, 50, 1_001)).unwrap(),
        duration: Millis(duration),
        target: centi(target),
        max_temperature: centi(target + 1_500),
        min_gain: centi(whole(chance, 1, 200)),
        gain_window: Millis(whole(chance, 400, duration)),
        ..PULSE
    };
    pulse(any)
}

/// Whatever breaks while hinges are pulsed, none gets too hot, and in the end all is off.
#[test]
fn s4_s5_s6_random_pulses_on_rigs_that_break_leave_no_hinge_too_hot_and_nothing_on() {
    let (mut faults, mut finished) = (0, 0);
    for seed in 0..60 {
        let mut chance = Chance::new(seed);
        let mut config = Config { seed, ..plant() };
        shortened(&mut config, &mut chance);
        let steps: Vec<_> = (0..4).map(|channel| any_pulse(channel, &mut chance)).collect();
        let mut host = Host::new(&config);
        host.run(&steps);
        let breaks_at = Millis(u32::try_from(chance.below(15_000)).unwrap());
        let hinge = chance.below(4);
        let broken = [
            None,
            Some(Broken::ThermistorFrozen(hinge)),
            Some(Broken::ThermistorLoose(hinge)),
            Some(Broken::ThermistorOpen(hinge)),
            Some(Broken::MosfetStuckOn(hinge)),
            Some(Broken::HeaterOpen(hinge)),
        ][chance.below(6)];
        let mut hottest: f64 = 0.0;
        let mut watch = |host: &mut Host| {
            hottest = (0..4).map(|hinge| temperature_c(host, hinge)).fold(hottest, f64::max);
            host.board.core().state() != State::Running
        };
        let start = host.board.now();
        while host.board.now() < start.plus(breaks_at) && !watch(&mut host) {
            host.pass(Millis(2));
        }
        if let Some(broken) = broken {
            host.board.plant_mut().inject(broken).unwrap();
        }
        host.pass_until(Millis(180_000), watch);
        assert!(hottest < 125.0, "seed {seed}: {hottest} °C, {broken:?}");
        assert!(host.all_off(), "seed {seed}");
        match host.board.core().state() {
            State::Safe => faults += 1,
            State::Finished => finished += 1,
            other => panic!("seed {seed}: {other:?}"),
        }
    }
    assert!(faults >= 10 && finished >= 10, "{faults} faults, {finished} finished");
}
