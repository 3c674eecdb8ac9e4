//! The clock tree: 166 MHz from the internal oscillator, so that a bare chip (or an emulator) starts.
//!
//! 166 MHz because a quarter of it, the clock of USART2, is within 0.1 % of 45 times 921,600 baud; the internal
//! oscillator adds up to 1 %.

use embassy_stm32::{
    Config,
    rcc::{AHBPrescaler, APBPrescaler, LsConfig, Pll, PllMul, PllPDiv, PllPreDiv, PllSource, Sysclk},
};

/// 16 MHz / 8 * 166 / 2 = 166 MHz; APB1 41.5 MHz (timers 83 MHz), APB2 83 MHz (timers 166 MHz, ADC 20.75 MHz).
pub fn internal() -> Config {
    let mut config = Config::default();
    config.rcc.hsi = true;
    config.rcc.pll_src = PllSource::HSI;
    config.rcc.pll = Some(Pll {
        prediv: PllPreDiv::DIV8,
        mul: PllMul::MUL166,
        divp: Some(PllPDiv::DIV2),
        divq: None,
        divr: None,
    });
    config.rcc.sys = Sysclk::PLL1_P;
    config.rcc.ahb_pre = AHBPrescaler::DIV1;
    config.rcc.apb1_pre = APBPrescaler::DIV4;
    config.rcc.apb2_pre = APBPrescaler::DIV2;
    // No calendar is kept, and the watchdog starts its own oscillator.
    config.rcc.ls = LsConfig::off();
    config
}
