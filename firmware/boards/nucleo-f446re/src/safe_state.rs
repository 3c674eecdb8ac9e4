//! Every actuator off, by registers alone (S1, S9). Called before anything else at boot, and by whatever ends
//! the program. It needs no clock set-up, no driver and no memory, and may be repeated at any time.

use crate::pins::{ACTUATORS_A, ACTUATORS_B, ACTUATORS_C};
use embassy_stm32::pac::{
    GPIOA, GPIOB, GPIOC, RCC,
    gpio::{Gpio, vals::Moder},
};

/// Takes the actuator pins from whoever drives them and holds them low.
pub(crate) fn all_off() {
    RCC.ahb1enr().modify(|enable| {
        enable.set_gpioaen(true);
        enable.set_gpioben(true);
        enable.set_gpiocen(true);
    });
    hold_low(GPIOA, ACTUATORS_A);
    hold_low(GPIOB, ACTUATORS_B);
    hold_low(GPIOC, ACTUATORS_C);
}

fn hold_low(port: Gpio, pins: &[u8]) {
    for &pin in pins {
        // The level first: a pin that becomes an output shows it at once.
        port.bsrr().write(|set| set.set_br(pin.into(), true));
        port.moder().modify(|mode| mode.set_moder(pin.into(), Moder::OUTPUT));
    }
}
