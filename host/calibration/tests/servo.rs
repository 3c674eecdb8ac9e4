//! Servos that are made up, and what is found of them.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use zygote_calibration::servo::{
    Doubt, FoundServo, Look, NextLook, NotReached, ServoBounds, ServoNominal, ServoRecord, ServoRefusal,
    doubt, found, next_look, servo_picture,
};

const NOMINAL: ServoNominal = ServoNominal { pulse_0_us: 500.0, pulse_270_us: 2500.0 };
const BOUNDS: ServoBounds = ServoBounds { shortest_us: 400, longest_us: 2600, tolerance_deg: 1.0 };

/// A servo with a hinge on it.
#[derive(Debug, Clone, Copy)]
struct MadeUp {
    at_0_us: f64,
    at_270_us: f64,
    bow_deg: f64,
    /// It doesn't move for less.
    dead_deg: f64,
    backlash_deg: f64,
    stops_deg: (f64, f64),
    /// Somebody feels that it pushes.
    tells: bool,
    /// Readings are rounded to this.
    rounded_deg: f64,
    motor_deg: f64,
    hinge_deg: f64,
    pushed: usize,
}

const PLAIN: MadeUp = MadeUp {
    at_0_us: 500.0,
    at_270_us: 2500.0,
    bow_deg: 0.0,
    dead_deg: 0.4,
    backlash_deg: 0.0,
    stops_deg: (-30.0, 300.0),
    tells: true,
    rounded_deg: 0.0,
    motor_deg: 20.0,
    hinge_deg: 20.0,
    pushed: 0,
};

impl MadeUp {
    fn commanded(&self, pulse_us: f64) -> f64 {
        let share = ((pulse_us - self.at_0_us) / (self.at_270_us - self.at_0_us)).clamp(-0.2, 1.2);
        270.0 * share + 4.0 * self.bow_deg * share * (1.0 - share)
    }

    /// Goes there, and says whether it pushes.
    fn go(&mut self, pulse_us: u16) -> bool {
        let target = self.commanded(f64::from(pulse_us));
        let free = target.clamp(self.stops_deg.0, self.stops_deg.1);
        if (target - self.motor_deg).abs() > self.dead_deg {
            self.motor_deg = free;
        }
        let play = self.backlash_deg / 2.0;
        let hinge = self.hinge_deg.clamp(self.motor_deg - play, self.motor_deg + play);
        self.hinge_deg = hinge.clamp(self.stops_deg.0, self.stops_deg.1);
        (target - free).abs() > self.dead_deg
    }

    fn read(&self) -> f64 {
        if self.rounded_deg > 0.0 {
            (self.hinge_deg / self.rounded_deg).round() * self.rounded_deg
        } else {
            self.hinge_deg
        }
    }

    /// Follows the search to its end; every reading is believed the second time.
    fn calibrate(
        &mut self,
        nominal: &ServoNominal,
        bounds: &ServoBounds,
    ) -> Result<ServoRecord, ServoRefusal> {
        let mut record = ServoRecord::default();
        for _ in 0..200 {
            let NextLook::At { pulse_us, via_us, .. } = next_look(&record, nominal, bounds)? else {
                return Ok(record);
            };
            assert!((bounds.shortest_us..=bounds.longest_us).contains(&pulse_us), "{pulse_us}");
            if let Some(via_us) = via_us {
                self.go(via_us);
            }
            let pushes = self.go(pulse_us);
            self.pushed += usize::from(pushes);
            let look = Look { pulse_us, angle_deg: self.read(), pushes: pushes && self.tells };
            if let Some(doubt) = doubt(&record, nominal, bounds, &look) {
                assert!(!doubt.is_final(), "{doubt}");
            }
            record.take(look, nominal, bounds);
        }
        panic!("no end: {record:?}");
    }

    fn found(&mut self) -> (FoundServo, usize) {
        let record = self.calibrate(&NOMINAL, &BOUNDS).unwrap();
        (found(&record, &NOMINAL, &BOUNDS), record.looks.len())
    }

    /// How far the hinge is off, led to a point from the middle.
    fn error_deg(&mut self, found: &FoundServo, angle_deg: u16) -> f64 {
        let point = found.points.iter().find(|point| point.angle_deg == angle_deg).unwrap();
        self.go(1500);
        self.go(point.pulse_us);
        (self.hinge_deg - f64::from(angle_deg)).abs()
    }
}

fn angles(found: &FoundServo) -> Vec<u16> {
    found.points.iter().map(|point| point.angle_deg).collect()
}

#[test]
fn a_servo_that_is_as_the_rig_file_says_takes_few_readings() {
    let (found, looks) = PLAIN.clone().found();
    assert_eq!(angles(&found), [0, 90, 180, 270]);
    assert!(looks <= 7, "{looks}");
    for (point, pulse_us) in found.points.iter().zip([500, 1167, 1833, 2500]) {
        assert!(point.pulse_us.abs_diff(pulse_us) <= 1, "{point:?}");
    }
    assert!(found.worst_off_line_deg().unwrap() < 0.1);
}

#[test]
fn a_bowed_or_reversed_servo_is_found_all_the_same() {
    for servo in [
        MadeUp { bow_deg: 30.0, ..PLAIN },
        MadeUp { bow_deg: -30.0, ..PLAIN },
        MadeUp { at_0_us: 2450.0, at_270_us: 620.0, ..PLAIN },
        MadeUp { at_0_us: 2450.0, at_270_us: 620.0, bow_deg: 20.0, ..PLAIN },
    ] {
        let mut servo = servo;
        let (found, looks) = servo.found();
        assert_eq!(angles(&found), [0, 90, 180, 270], "{servo:?}");
        assert!(looks <= 20, "{looks} for {servo:?}");
        for angle in [0, 90, 180, 270] {
            assert!(servo.error_deg(&found, angle) <= 1.0, "{angle} of {servo:?}");
        }
        let off = found.worst_off_line_deg().unwrap();
        assert_eq!(off > 5.0, servo.bow_deg.abs() > 10.0, "{off} of {servo:?}");
    }
}

#[test]
fn an_end_stop_is_found_and_not_pushed_against_again() {
    for tells in [true, false] {
        let mut servo = MadeUp { stops_deg: (0.0, 200.0), tells, ..PLAIN };
        let (found, looks) = servo.found();
        assert_eq!(angles(&found), [0, 90, 180]);
        let [(270, NotReached::Stop { at_deg })] = found.unreached[..] else { panic!("{found:?}") };
        assert!((at_deg - 200.0).abs() < 0.5 && looks < 14, "{at_deg}, {looks}");
        assert_eq!(found.stop_high_deg, Some(at_deg));
        assert!(servo.pushed <= if tells { 1 } else { 3 }, "{} times, told: {tells}", servo.pushed);
    }
}

#[test]
fn a_pulse_at_an_end_stop_doesnt_push_against_it() {
    for tells in [true, false] {
        let mut servo = MadeUp { at_270_us: 2390.0, stops_deg: (-10.0, 180.0), tells, ..PLAIN };
        let (found, _) = servo.found();
        assert_eq!(angles(&found), [0, 90, 180]);
        assert!(!servo.go(found.points[2].pulse_us), "told: {tells}, {found:?}");
    }
}

#[test]
fn pulses_that_the_board_doesnt_send_are_not_asked_for() {
    let mut servo = MadeUp { at_0_us: 300.0, at_270_us: 3300.0, ..PLAIN };
    let (found, _) = servo.found();
    assert_eq!(angles(&found), [90, 180]);
    let [(0, NotReached::Bound { at_deg: low }), (270, NotReached::Bound { at_deg: high })] =
        found.unreached[..]
    else {
        panic!("{found:?}")
    };
    assert!((low - 9.0).abs() < 0.5 && (high - 207.0).abs() < 0.5, "{low}, {high}");
    assert!(found.is_complete());
}

#[test]
fn a_servo_that_doesnt_move_or_pushes_from_the_start_is_refused() {
    let mut still = MadeUp { stops_deg: (100.0, 104.0), tells: false, ..PLAIN };
    let refusal = still.calibrate(&NOMINAL, &BOUNDS).unwrap_err();
    assert!(matches!(refusal, ServoRefusal::Still { turned_deg: 0..=4, .. }), "{refusal}");
    let mut jammed = MadeUp { stops_deg: (100.0, 104.0), ..PLAIN };
    let refusal = jammed.calibrate(&NOMINAL, &BOUNDS).unwrap_err();
    assert_eq!(refusal, ServoRefusal::Jammed { pulse_us: 1500 });
}

#[test]
fn a_reading_that_cant_be_is_doubted_and_one_read_again_takes_its_place() {
    let mut record = ServoRecord::default();
    for (pulse_us, angle_deg) in [(1500, 135.0), (1167, 80.0), (1241, 100.0)] {
        record.take(Look { pulse_us, angle_deg, pushes: false }, &NOMINAL, &BOUNDS);
    }
    let look = |pulse_us, angle_deg| Look { pulse_us, angle_deg, pushes: false };
    let doubted = |look: &Look| doubt(&record, &NOMINAL, &BOUNDS, look);
    assert_eq!(doubted(&look(1200, 91.0)), None);
    assert!(doubted(&look(1200, 400.0)).unwrap().is_final());
    let turned = doubted(&look(1200, 19.0)).unwrap();
    let expected = Doubt::Contradiction { found_deg: 19.0, other_deg: 80.0, other_us: 1167 };
    assert_eq!(turned, expected);
    assert!(matches!(doubted(&look(900, 60.0)), Some(Doubt::Surprise { .. })));
    record.take(look(1200, 70.0), &NOMINAL, &BOUNDS);
    let pulses: Vec<_> = record.looks.iter().map(|look| look.pulse_us).collect();
    assert_eq!(pulses, [1500, 1241, 1200], "80 deg at 1167 us was wrong");
}

/// As in splitmix64.
fn chance(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut mixed = *state;
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn two_hundred_servos_are_within_the_tolerance_and_their_backlash() {
    let mut seed = 7;
    let mut between = |low: f64, high: f64| low + (high - low) * chance(&mut seed);
    let (mut all, mut most, mut points, mut worst) = (0, 0, 0, 0.0_f64);
    for number in 0..200 {
        let (low, high) = (between(450.0, 700.0), between(2250.0, 2580.0));
        let reversed = between(0.0, 1.0) < 0.25;
        let has_stops = between(0.0, 1.0) < 0.4;
        let servo = MadeUp {
            at_0_us: if reversed { high } else { low },
            at_270_us: if reversed { low } else { high },
            bow_deg: between(-25.0, 25.0),
            dead_deg: between(0.1, 1.0),
            backlash_deg: between(0.0, 3.0),
            stops_deg: if has_stops { (between(-20.0, 40.0), between(195.0, 290.0)) } else { (-30.0, 300.0) },
            tells: between(0.0, 1.0) < 0.5,
            rounded_deg: [0.0, 0.5][usize::from(between(0.0, 1.0) < 0.5)],
            motor_deg: 60.0,
            hinge_deg: 60.0,
            pushed: 0,
        };
        let mut under_test = servo;
        let (found, looks) = under_test.found();
        assert!(found.is_complete(), "{number}: {found:?} of {servo:?}");
        for angle in [0, 90, 180, 270] {
            let (low, high) = servo.stops_deg;
            let inside = f64::from(angle) > low + 1.0 && f64::from(angle) < high - 1.0;
            let outside = f64::from(angle) < low - 1.5 || f64::from(angle) > high + 1.5;
            let is_found = angles(&found).contains(&angle);
            assert!(is_found || !inside, "{number}: {angle} of {servo:?}: {found:?}");
            assert!(!is_found || !outside, "{number}: {angle} of {servo:?}: {found:?}");
            if is_found {
                let error = under_test.error_deg(&found, angle);
                let allowed = 1.0 + servo.rounded_deg / 2.0 + servo.dead_deg + servo.backlash_deg;
                assert!(error <= allowed, "{number}: {error} at {angle} of {servo:?}");
                worst = worst.max(error - servo.backlash_deg);
                points += 1;
            }
        }
        (all, most) = (all + looks, most.max(looks));
    }
    println!("{points} points, {all} readings, at most {most} a servo, worst beyond backlash {worst:.2} deg");
    assert!(all <= 200 * 12 && most <= 25, "{all} readings, at most {most}");
}

#[test]
fn the_picture_has_every_reading_and_every_point() {
    let mut servo = MadeUp { stops_deg: (-5.0, 200.0), bow_deg: 10.0, ..PLAIN };
    let record = servo.calibrate(&NOMINAL, &BOUNDS).unwrap();
    let found = found(&record, &NOMINAL, &BOUNDS);
    let svg = servo_picture(&record, &found);
    assert_eq!(svg.matches("<title>").count(), record.looks.len());
    assert_eq!(svg.matches(" deg: ").count(), found.points.len());
    assert!(svg.contains("end stop, 200.0 deg") && svg.ends_with("</svg>\n"), "{svg}");
    assert!(servo_picture(&ServoRecord::default(), &found).ends_with("</svg>\n"));
}
