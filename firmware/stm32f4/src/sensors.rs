//! What the board senses: the thermistors through the 16:1 multiplexer, the supply's voltage and current, and the
//! stop button. Everything is read anew for each tick: the core counts bad samples in a row, and a sample that it
//! saw before would count twice.

use crate::{board::HEATERS, servo_gate, stop};
use embassy_stm32::{
    adc::{Adc, AnyAdcChannel, SampleTime},
    gpio::{Input, Level, Output},
    peripherals::ADC1,
};
use embassy_time::{Duration, block_for};
use zygote_core::{ADC_FULL_SCALE, Inputs};
use zygote_protocol::{Milliamps, Millivolts};

/// Reference of the ADC, and supply of the thermistors' pull-ups (so their readings don't depend on it).
const REFERENCE_MV: u32 = 3_300;
/// Supply voltage over voltage at the pin: 100 kOhm above 10 kOhm, 36.3 V full scale.
const SUPPLY_DIVIDER: u32 = 11;
/// Current per millivolt at the pin: a shunt amplifier of 100 mV/A, 33 A full scale.
const MILLIAMPS_PER_MILLIVOLT: u32 = 10;
/// 56 cycles at 21 MHz are 2.7 us: nine time constants of 16 kOhm (a cold thermistor's divider, the switches) and
/// the 7 pF of the converter are 1 us.
const SAMPLE_TIME: SampleTime = SampleTime::CYCLES56;
/// Time for the common pin to follow a new channel: nine time constants of 10 kOhm and 60 pF are 5.4 us. The converter
/// takes another 3 us to wake up, and samples for 2.7.
const SETTLE: Duration = Duration::from_micros(6);

/// ADC, multiplexer and stop button, with room for a reading of each thermistor.
pub struct Sensors {
    /// The converter, for each reading.
    pub adc: Adc<'static, ADC1>,
    /// Common pin of the multiplexer.
    pub thermistor: AnyAdcChannel<'static, ADC1>,
    /// Supply voltage, divided.
    pub supply: AnyAdcChannel<'static, ADC1>,
    /// Supply current, amplified.
    pub current: AnyAdcChannel<'static, ADC1>,
    /// S0 to S3 of the multiplexer.
    pub select: [Output<'static>; 4],
    /// The stop button.
    pub stop: Input<'static>,
    /// The level that it has while it is pressed.
    pub stop_pressed: Level,
    /// The latest readings, counts.
    pub thermistors: [u16; HEATERS],
}

impl Sensors {
    /// A fresh reading of everything; takes a fifth of a millisecond.
    pub(crate) fn read(&mut self) -> Inputs<'_> {
        for (channel, reading) in self.thermistors.iter_mut().enumerate() {
            for (bit, pin) in self.select.iter_mut().enumerate() {
                pin.set_level((channel >> bit & 1 == 1).into());
            }
            block_for(SETTLE);
            *reading = self.adc.blocking_read(&mut self.thermistor, SAMPLE_TIME);
        }
        let supply = self.adc.blocking_read(&mut self.supply, SAMPLE_TIME);
        let current = self.adc.blocking_read(&mut self.current, SAMPLE_TIME);
        Inputs {
            thermistors: &self.thermistors,
            supply: Millivolts(scaled(supply, SUPPLY_DIVIDER)),
            current: Milliamps(scaled(current, MILLIAMPS_PER_MILLIVOLT)),
            // Both, in any order: an edge is told once, and a button that was pressed before the start has none.
            servos_lost: servo_gate::is_lost(),
            stop_pressed: stop::was_pressed() | (self.stop.get_level() == self.stop_pressed),
        }
    }

    /// The noise in the lowest bits of the supply's reading, many times over.
    pub(crate) fn noise(&mut self) -> u32 {
        (0..64).fold(0, |noise: u32, _| {
            noise.rotate_left(5) ^ u32::from(self.adc.blocking_read(&mut self.supply, SampleTime::CYCLES3))
        })
    }
}

/// So many times the millivolts at the pin, rounded once: a millivolt there is 10 mA of current.
fn scaled(reading: u16, times: u32) -> u32 {
    let full = u32::from(ADC_FULL_SCALE);
    (u32::from(reading) * REFERENCE_MV * times + full / 2) / full
}
