//! What the board senses: the thermistors through the 16:1 multiplexer, the supply's voltage and current, and the
//! stop button. Everything is read anew for each tick: the core counts bad samples in a row, and a sample that it
//! saw before would count twice.

use crate::pins::HEATERS;
use embassy_stm32::{
    Peri,
    adc::{Adc, SampleTime},
    gpio::{Input, Output},
    peripherals::{ADC1, PA0, PA1, PA4},
};
use embassy_time::Timer;
use zygote_core::{ADC_FULL_SCALE, Inputs};
use zygote_protocol::{Milliamps, Millivolts};

/// Reference of the ADC, and supply of the thermistors' pull-ups (so their readings don't depend on it).
const REFERENCE_MV: u32 = 3_300;
/// Supply voltage over voltage at the pin: 100 kOhm above 10 kOhm, 36.3 V full scale.
const SUPPLY_DIVIDER: u32 = 11;
/// Current per millivolt at the pin: a shunt amplifier of 100 mV/A, 33 A full scale.
const MILLIAMPS_PER_MILLIVOLT: u32 = 10;
/// 144 cycles at 20.75 MHz are 6.9 us, enough for the 5 kOhm of a thermistor divider behind the multiplexer.
const SAMPLE_TIME: SampleTime = SampleTime::CYCLES144;
/// Time for the common pin to follow a new channel: nine time constants of 10 kOhm and 60 pF are 5.4 us.
const SETTLE_US: u64 = 20;

/// ADC, multiplexer and stop button, with room for a reading of each thermistor.
pub(crate) struct Sensors {
    pub(crate) adc: Adc<'static, ADC1>,
    pub(crate) thermistor: Peri<'static, PA0>,
    pub(crate) supply: Peri<'static, PA1>,
    pub(crate) current: Peri<'static, PA4>,
    /// S0 to S3 of the multiplexer.
    pub(crate) select: [Output<'static>; 4],
    /// Pulled up on the board, low when pressed.
    pub(crate) stop: Input<'static>,
    pub(crate) thermistors: [u16; HEATERS],
}

impl Sensors {
    /// A fresh reading of everything; takes about half a millisecond, most of it waiting.
    pub(crate) async fn read(&mut self) -> Inputs<'_> {
        for channel in 0..HEATERS {
            for (bit, pin) in self.select.iter_mut().enumerate() {
                pin.set_level((channel >> bit & 1 == 1).into());
            }
            Timer::after_micros(SETTLE_US).await;
            let reading = self.adc.blocking_read(&mut self.thermistor, SAMPLE_TIME);
            if let Some(thermistor) = self.thermistors.get_mut(channel) {
                *thermistor = reading;
            }
        }
        let supply = self.adc.blocking_read(&mut self.supply, SAMPLE_TIME);
        let current = self.adc.blocking_read(&mut self.current, SAMPLE_TIME);
        Inputs {
            thermistors: &self.thermistors,
            supply: Millivolts(pin_millivolts(supply) * SUPPLY_DIVIDER),
            current: Milliamps(pin_millivolts(current) * MILLIAMPS_PER_MILLIVOLT),
            stop_pressed: self.stop.is_low(),
        }
    }

    /// Sixteen bits of the noise in the lowest bits of the supply's reading.
    pub(crate) fn noise(&mut self) -> u16 {
        (0..16).fold(0, |noise: u16, _| {
            noise.rotate_left(1) ^ self.adc.blocking_read(&mut self.supply, SampleTime::CYCLES3)
        })
    }
}

fn pin_millivolts(reading: u16) -> u32 {
    u32::from(reading) * REFERENCE_MV / u32::from(ADC_FULL_SCALE)
}
