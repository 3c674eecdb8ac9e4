//! The board of the figures, which the emulator's host-side core is as well: the longest names, and the widest ceilings.

use crate::call::CHANNELS;
use core::ops::RangeInclusive;
use heapless::String;
use zygote_core::{Config, NTC_10K};
use zygote_protocol::{
    Calibration, CentiCelsius, Channels, HeaterCalibration, Identity, Kept, Limits, Milliamps, Millis,
    ResetCause, ServoCalibration,
};

/// No session may ask for more.
pub(crate) const CEILING: Limits = Limits {
    max_temperature: CentiCelsius(12_000),
    max_on: Millis(20_000),
    min_rest: Millis(0),
    supply: Milliamps(50_000),
    link_timeout: Millis(5_000),
};

/// With this boot id.
pub(crate) fn config(boot: u32) -> Config {
    let channels = u16::try_from(CHANNELS).unwrap_or(u16::MAX);
    let identity = Identity {
        boot,
        firmware: String::try_from("sixteen letters.").unwrap_or_default(),
        git: String::try_from("0123456789ab").unwrap_or_default(),
        board: String::try_from("a name of twenty-four ch").unwrap_or_default(),
        unique_id: [255; 12],
        reset: ResetCause::Watchdog,
    };
    Config {
        identity,
        ceiling: CEILING,
        channels: Channels { heaters: channels, servos: channels, springs: channels },
        thermistor: NTC_10K,
        servo_pulse_us: RangeInclusive::new(500, 2_500),
    }
}

/// What it keeps: every heater and servo is calibrated, so that each step is held against something, and fits.
pub(crate) fn kept() -> Kept<CHANNELS, CHANNELS> {
    let heater = HeaterCalibration {
        current: Milliamps(1),
        gain: CentiCelsius(1),
        window: Millis(7_000),
        opens_at: Some(CentiCelsius(0)),
    };
    let servo = ServoCalibration { shortest_us: 500, longest_us: 2_500 };
    let mut kept = Kept::NOTHING;
    for channel in (0..CHANNELS).flat_map(u16::try_from) {
        kept.put(Calibration::Heater { channel, known: Some(heater) });
        kept.put(Calibration::Servo { channel, known: Some(servo) });
    }
    kept
}
