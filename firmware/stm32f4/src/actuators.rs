//! Applies the core's outputs to the pins: PWM for the heaters, levels for the springs and the main switch, and the
//! gate of the servos.

use crate::{
    board::{BoardOutputs, HEATERS, SPRINGS},
    servo_gate,
};
use embassy_stm32::{
    gpio::{Output, OutputType, Pull, Speed},
    time::Hertz,
    timer::{
        GeneralInstance4Channel,
        simple_pwm::{PwmPinConfig, SimplePwm, SimplePwmChannel, SimplePwmChannels},
    },
};
use zygote_core::{Duty, Outputs};

/// Far above the thermal time constants, low enough for slow MOSFET gates. A new duty waits for the next period.
pub const HEATER_PWM: Hertz = Hertz(1_000);

/// Pulled down for the moments in which the timer doesn't drive the pin yet.
pub const HEATER_PIN: PwmPinConfig =
    PwmPinConfig { output_type: OutputType::PushPull, speed: Speed::Low, pull: Pull::Down };

/// Heaters of one timer.
pub trait Heaters: Send {
    /// Makes the pins follow the duties, one each.
    fn apply(&mut self, duties: &[Duty]);
}

/// The pins that move or heat something, and what they were last told.
pub struct Actuators {
    heaters: [Option<&'static mut dyn Heaters>; HEATERS / 4],
    springs: [Output<'static>; SPRINGS],
    main_switch: Output<'static>,
    applied: BoardOutputs,
}

impl Actuators {
    /// Everything off; four heaters a timer, in the order of their channels.
    pub const fn new(
        heaters: [Option<&'static mut dyn Heaters>; HEATERS / 4],
        springs: [Output<'static>; SPRINGS],
        main_switch: Output<'static>,
    ) -> Self {
        Self { heaters, springs, main_switch, applied: Outputs::OFF }
    }

    /// Makes the pins follow `outputs`. Cheap when nothing has changed.
    pub(crate) fn apply(&mut self, outputs: &BoardOutputs) {
        if *outputs == self.applied {
            return;
        }
        // The main switch opens before the rest follows: it works at once, a duty only in the next period.
        self.main_switch.set_level(outputs.main_switch.into());
        servo_gate::want(&outputs.servos);
        for (spring, &on) in self.springs.iter_mut().zip(&outputs.springs) {
            spring.set_level(on.into());
        }
        for (group, duties) in self.heaters.iter_mut().zip(outputs.heaters.chunks(4)) {
            if let Some(group) = group {
                group.apply(duties);
            }
        }
        self.applied.clone_from(outputs);
    }
}

/// The four heaters of one timer.
pub struct FourHeaters<T: GeneralInstance4Channel>([SimplePwmChannel<'static, T>; 4]);

impl<T: GeneralInstance4Channel> FourHeaters<T> {
    /// Takes a timer, every channel driven low.
    pub fn new(timer: SimplePwm<'static, T>) -> Self {
        let SimplePwmChannels { ch1, ch2, ch3, ch4 } = timer.split();
        let mut channels = [ch1, ch2, ch3, ch4];
        for channel in &mut channels {
            channel.set_duty_cycle_fully_off();
            channel.enable();
        }
        Self(channels)
    }
}

impl<T: GeneralInstance4Channel> Heaters for FourHeaters<T>
where
    SimplePwmChannel<'static, T>: Send,
{
    fn apply(&mut self, duties: &[Duty]) {
        for (channel, duty) in self.0.iter_mut().zip(duties) {
            channel.set_duty_cycle_fraction(duty.per_mille().into(), Duty::FULL.per_mille().into());
        }
    }
}

/// The four heaters of a timer and its pins, as [`Actuators::new`] takes them:
/// `four_heaters!(p.TIM1, TIM1: p.PA8, p.PA9, p.PA10, p.PA11)`.
#[macro_export]
macro_rules! four_heaters {
    ($peripheral:expr, $timer:ident: $($pin:expr),+) => {{
        use embassy_stm32::timer::{
            low_level::CountingMode::EdgeAlignedUp,
            simple_pwm::{PwmPin, SimplePwm},
        };
        static GROUP: $crate::StaticCell<$crate::FourHeaters<embassy_stm32::peripherals::$timer>> =
            $crate::StaticCell::new();
        let timer = SimplePwm::new(
            $peripheral,
            $(Some(PwmPin::new_with_config($pin, $crate::HEATER_PIN)),)+
            $crate::HEATER_PWM,
            EdgeAlignedUp,
        );
        let group: &'static mut dyn $crate::Heaters = GROUP.init($crate::FourHeaters::new(timer));
        Some(group)
    }};
}
