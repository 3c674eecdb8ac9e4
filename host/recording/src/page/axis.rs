//! Round numbers along an axis.

/// Spans between marks of time that people count in, s.
const TIMES: [f64; 18] = [
    0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 900.0, 1800.0, 3600.0, 7200.0,
    18000.0,
];

/// Times from 0 to `end`, at most so many and one.
pub(super) fn times(end: f64, most: f64) -> Vec<(f64, String)> {
    let longest = TIMES[TIMES.len() - 1];
    let step = TIMES.into_iter().find(|step| end / step <= most).unwrap_or(longest);
    multiples(0.0, end, step).into_iter().map(|at| (at, clock(at, step, end))).collect()
}

/// Seconds where all is over within two minutes, else minutes and seconds.
fn clock(at: f64, step: f64, end: f64) -> String {
    if step < 1.0 {
        return format!("{at:.1} s");
    }
    if end < 120.0 {
        return format!("{at:.0} s");
    }
    let (minutes, seconds) = ((at / 60.0).floor(), at % 60.0);
    format!("{minutes:.0}:{seconds:02.0}")
}

/// Round values between two, at most so many and one.
pub(super) fn values(low: f64, high: f64, most: f64) -> Vec<(f64, String)> {
    let span = (high - low).max(1e-9);
    let power = 10_f64.powf((span / most).log10().floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| span / step <= most);
    let step = step.unwrap_or(10.0 * power);
    let decimals = if step >= 1.0 {
        0
    } else if step >= 0.1 {
        1
    } else {
        2
    };
    let label = |at: f64| if decimals == 0 { format!("{at:.0}") } else { format!("{at:.decimals$}") };
    multiples((low / step - 1e-6).ceil() * step, high, step).into_iter().map(|at| (at, label(at))).collect()
}

fn multiples(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0_u16..=64)
        .map(|count| from + f64::from(count) * step)
        .take_while(|at| *at <= to + step * 1e-6)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_of_time_are_round_and_not_too_many() {
        for end in [0.7, 3.0, 59.0, 61.0, 400.0, 9_000.0] {
            let marks = times(end, 10.0);
            assert!((2..=11).contains(&marks.len()), "{end}: {marks:?}");
            assert!(marks.iter().all(|(at, _)| *at <= end * 1.001), "{end}: {marks:?}");
        }
        assert_eq!(times(100.0, 10.0)[3].1, "30 s");
        assert_eq!(times(300.0, 10.0)[3].1, "1:30");
        assert_eq!(times(900.0, 10.0)[3].1, "6:00");
    }

    #[test]
    fn values_cover_the_span_in_round_steps() {
        let labels =
            |low, high| values(low, high, 6.0).into_iter().map(|(_, label)| label).collect::<Vec<_>>();
        assert_eq!(labels(0.0, 1.05), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(20.0, 131.0), ["20", "40", "60", "80", "100", "120"]);
        assert_eq!(labels(4.93, 5.02), ["4.94", "4.96", "4.98", "5.00", "5.02"]);
    }
}
