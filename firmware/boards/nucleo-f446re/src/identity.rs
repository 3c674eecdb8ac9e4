//! Who this board is, and what no host can ask of it.

use zygote_protocol::{CentiCelsius, Identity, Limits, Milliamps, Millis, ResetCause};

/// Ceilings of this board (S13).
pub(crate) const CEILING: Limits = Limits {
    // Panels of paper and PETG: well below what either stands.
    max_temperature: CentiCelsius(12_000),
    max_on: Millis(60_000),
    min_rest: Millis(0),
    // What the terminal and the main switch carry for good.
    supply: Milliamps(10_000),
    link_timeout: Millis(5_000),
};

/// The identity that goes into the hello.
pub(crate) fn identity(boot: u32, reset: ResetCause) -> Identity {
    Identity {
        boot,
        firmware: env!("CARGO_PKG_VERSION").try_into().unwrap_or_default(),
        git: env!("ZYGOTE_COMMIT").try_into().unwrap_or_default(),
        board: "nucleo-f446re".try_into().unwrap_or_default(),
        unique_id: embassy_stm32::uid::uid(),
        reset,
    }
}
