//! S13: which limits are laxer than a board's ceiling.

use zygote_protocol::{CentiCelsius, LimitName, Limits, Milliamps, Millis};

const CEILING: Limits = Limits {
    max_temperature: CentiCelsius(12_000),
    max_on: Millis(30_000),
    min_rest: Millis(500),
    supply: Milliamps(2_000),
    link_timeout: Millis(1_000),
};

#[test]
fn s13_limits_at_the_ceiling_or_stricter_are_not_laxer() {
    assert_eq!(CEILING.laxer_than(&CEILING), None);
    let stricter = Limits {
        max_temperature: CentiCelsius(11_999),
        max_on: Millis(29_999),
        min_rest: Millis(501),
        supply: Milliamps(1_999),
        link_timeout: Millis(999),
    };
    assert_eq!(stricter.laxer_than(&CEILING), None);
}

#[test]
fn s13_a_limit_that_is_laxer_by_one_is_told_with_the_ceiling_and_its_value() {
    let cases = [
        (
            Limits { max_temperature: CentiCelsius(12_001), ..CEILING },
            (LimitName::MaxTemperature, 12_000, 12_001),
        ),
        (Limits { max_on: Millis(30_001), ..CEILING }, (LimitName::MaxOn, 30_000, 30_001)),
        (Limits { min_rest: Millis(499), ..CEILING }, (LimitName::MinRest, 500, 499)),
        (Limits { supply: Milliamps(2_001), ..CEILING }, (LimitName::Supply, 2_000, 2_001)),
        (Limits { link_timeout: Millis(1_001), ..CEILING }, (LimitName::LinkTimeout, 1_000, 1_001)),
    ];
    for (limits, expected) in cases {
        assert_eq!(limits.laxer_than(&CEILING), Some(expected));
    }
}
