//! Applies the core's outputs to the pins: PWM for the heaters, levels for the springs and the main switch.

use crate::pins::{HEATERS, SERVOS, SPRINGS};
use embassy_stm32::{
    gpio::{Output, OutputType, Pull, Speed},
    peripherals::{TIM1, TIM3, TIM4, TIM8},
    time::Hertz,
    timer::{
        GeneralInstance4Channel,
        simple_pwm::{PwmPinConfig, SimplePwm, SimplePwmChannel, SimplePwmChannels},
    },
};
use zygote_core::{Duty, Outputs};

/// Far above the thermal time constants, low enough for slow MOSFET gates. A new duty waits for the next period.
pub(crate) const HEATER_PWM: Hertz = Hertz(1_000);

/// Pulled down for the moments in which the timer doesn't drive the pin yet.
pub(crate) const HEATER_PIN: PwmPinConfig =
    PwmPinConfig { output_type: OutputType::PushPull, speed: Speed::Low, pull: Pull::Down };

/// The outputs of this board.
pub(crate) type BoardOutputs = Outputs<HEATERS, SERVOS, SPRINGS>;

/// The pins that move or heat something, and what they were last told.
pub(crate) struct Actuators {
    pub(crate) heaters_0: FourHeaters<TIM1>,
    pub(crate) heaters_4: FourHeaters<TIM3>,
    pub(crate) heaters_8: FourHeaters<TIM4>,
    pub(crate) heaters_12: FourHeaters<TIM8>,
    pub(crate) springs: [Output<'static>; SPRINGS],
    pub(crate) main_switch: Output<'static>,
    pub(crate) applied: BoardOutputs,
}

impl Actuators {
    /// Makes the pins follow `outputs`. Cheap when nothing has changed.
    pub(crate) fn apply(&mut self, outputs: &BoardOutputs) {
        if *outputs == self.applied {
            return;
        }
        // The main switch opens before the rest follows: it works at once, a duty only in the next period.
        self.main_switch.set_level(outputs.main_switch.into());
        for (spring, &on) in self.springs.iter_mut().zip(&outputs.springs) {
            spring.set_level(on.into());
        }
        let [a, b, c, d] = four_by_four(&outputs.heaters);
        self.heaters_0.apply(a);
        self.heaters_4.apply(b);
        self.heaters_8.apply(c);
        self.heaters_12.apply(d);
        self.applied.clone_from(outputs);
    }
}

/// The four heaters of one timer.
pub(crate) struct FourHeaters<T: GeneralInstance4Channel>([SimplePwmChannel<'static, T>; 4]);

impl<T: GeneralInstance4Channel> FourHeaters<T> {
    /// Takes a timer, every channel driven low.
    pub(crate) fn new(timer: SimplePwm<'static, T>) -> Self {
        let SimplePwmChannels { ch1, ch2, ch3, ch4 } = timer.split();
        let mut channels = [ch1, ch2, ch3, ch4];
        for channel in &mut channels {
            channel.set_duty_cycle_fully_off();
            channel.enable();
        }
        Self(channels)
    }

    fn apply(&mut self, duties: &[Duty]) {
        for (channel, duty) in self.0.iter_mut().zip(duties) {
            channel.set_duty_cycle_fraction(duty.per_mille().into(), Duty::FULL.per_mille().into());
        }
    }
}

fn four_by_four(duties: &[Duty; HEATERS]) -> [&[Duty]; 4] {
    let (first, last) = duties.split_at(8);
    let ((a, b), (c, d)) = (first.split_at(4), last.split_at(4));
    [a, b, c, d]
}
