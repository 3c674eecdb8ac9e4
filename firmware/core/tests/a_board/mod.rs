//! What a small board tells its core: for tests, benches and fuzz targets.

use zygote_core::{Config, NTC_10K};
use zygote_protocol::{CentiCelsius, Channels, Identity, Limits, Milliamps, Millis, ResetCause};

/// A board with these channels. Its boot id is 0, which grants the sessions that are asked for: frames can be written down.
pub(crate) fn config(heaters: u16, servos: u16, springs: u16) -> Config {
    let identity = Identity {
        boot: 0,
        firmware: heapless::String::new(),
        git: heapless::String::new(),
        board: heapless::String::new(),
        unique_id: [0; 12],
        reset: ResetCause::Power,
    };
    let ceiling = Limits {
        max_temperature: CentiCelsius(12_000),
        max_on: Millis(20_000),
        min_rest: Millis(500),
        supply: Milliamps(1_000),
        link_timeout: Millis(1_000),
    };
    let channels = Channels { heaters, servos, springs };
    Config { identity, ceiling, channels, thermistor: NTC_10K, servo_pulse_us: 500..=2_500 }
}
