//! Physical quantities as they go over the wire: integers, one newtype a unit.

use core::fmt;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

macro_rules! unit {
    ($(#[$doc:meta])* $name:ident($raw:ty), $suffix:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, Schema)]
        pub struct $name(pub $raw);

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!("{} ", $suffix), self.0)
            }
        }
    };
}

unit! {
    /// Time in microseconds since some fixed start: the MCU's boot, or the host's.
    Micros(u64), "us"
}
unit! {
    /// A span of time in milliseconds.
    Millis(u32), "ms"
}
unit! {
    /// Temperature in hundredths of a degree Celsius.
    CentiCelsius(i16), "c°C"
}
unit! {
    /// Current in milliamperes.
    Milliamps(u32), "mA"
}
unit! {
    /// Voltage in millivolts.
    Millivolts(u32), "mV"
}

impl Micros {
    /// The time `span` later.
    #[must_use]
    pub const fn plus(self, span: Millis) -> Self {
        Self(self.0.saturating_add(span.to_micros()))
    }

    /// The span since `earlier`, in microseconds; zero when `earlier` is later.
    pub const fn since(self, earlier: Self) -> u64 {
        self.0.saturating_sub(earlier.0)
    }
}

impl Millis {
    /// The same span in microseconds.
    pub const fn to_micros(self) -> u64 {
        // u32 -> u64 loses nothing; `From` is not const.
        #[expect(clippy::as_conversions, reason = "widening, in a const fn")]
        let ms = self.0 as u64;
        ms * 1000
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::fmt::Write;

    #[test]
    fn times_and_spans_go_together_and_saturate() {
        assert_eq!(Millis(7).to_micros(), 7_000);
        assert_eq!(Millis(u32::MAX).to_micros(), 4_294_967_295_000);
        assert_eq!(Micros(5).plus(Millis(7)), Micros(7_005));
        assert_eq!(Micros(u64::MAX - 1).plus(Millis(1)), Micros(u64::MAX));
        assert_eq!((Micros(9).since(Micros(5)), Micros(5).since(Micros(9))), (4, 0));
    }

    #[test]
    fn quantities_are_told_with_their_unit() {
        let mut told = heapless::String::<64>::new();
        write!(
            told,
            "{}, {}, {}, {}, {}",
            Micros(1),
            Millis(2),
            CentiCelsius(-3),
            Milliamps(4),
            Millivolts(5)
        )
        .unwrap();
        assert_eq!(told, "1 us, 2 ms, -3 c°C, 4 mA, 5 mV");
    }
}
