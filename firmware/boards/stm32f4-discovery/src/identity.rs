//! What the board tells the core about itself: who it is, and what no host can ask of it.

use crate::pins::CHANNELS;
use zygote_core::{Config, NTC_10K};
use zygote_protocol::{CentiCelsius, Identity, Limits, Milliamps, Millis, ResetCause};

/// What `zygote flash` and the emulator read of the program's file; it isn't in flash.
#[used]
#[expect(unsafe_code, reason = "the linker script keeps the section out of the chip's memory")]
#[unsafe(link_section = ".zygote")]
static CARD: [u8; 43] = *b"board=stm32f4-discovery\nchip=STM32F407VGTx\n";

/// Ceilings of this board (S13).
const CEILING: Limits = Limits {
    // The hottest common nitinol has turned at 98 °C; paper browns above 150 °C.
    max_temperature: CentiCelsius(12_000),
    max_on: Millis(60_000),
    min_rest: Millis(0),
    // What the terminals and the main switch carry for good.
    supply: Milliamps(10_000),
    link_timeout: Millis(5_000),
};

/// What the core is to know; `boot` differs from start to start.
pub(crate) fn config(boot: u32, reset: ResetCause) -> Config {
    let identity = Identity {
        boot,
        firmware: env!("CARGO_PKG_VERSION").try_into().unwrap_or_default(),
        git: env!("ZYGOTE_COMMIT").try_into().unwrap_or_default(),
        board: "stm32f4-discovery".try_into().unwrap_or_default(),
        unique_id: embassy_stm32::uid::uid(),
        reset,
    };
    Config {
        identity,
        ceiling: CEILING,
        channels: CHANNELS,
        thermistor: NTC_10K,
        // That of common servos.
        servo_pulse_us: 500..=2_500,
    }
}
