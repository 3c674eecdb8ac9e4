//! The firmware core on an STM32F4DISCOVERY (MB997, STM32F407VG): pins, clocks and identity; the rest is in `zygote-stm32f4`. The
//! wiring stands in `docs/src/board-stm32f4-discovery.md`.
#![no_std]
#![no_main]

mod identity;
mod pins;

use embassy_stm32::{
    Peripherals,
    adc::{Adc, AdcChannel},
    bind_interrupts,
    gpio::{Input, Level, Output, Pull, Speed},
    i2c::I2c,
    interrupt, pac,
    peripherals::USART2,
    usart::{self, BufferedUart},
};
use static_cell::ConstStaticCell;
use zygote_stm32f4::{Actuators, Board, Edge, Sensors, ServoBus, clocks, four_heaters, low};

/// Rate of the line to a USB adapter.
const BAUD: u32 = 921_600;
/// The blue button, PA0.
const STOP_LINE: u8 = 0;

bind_interrupts!(struct Interrupts {
    USART2 => usart::BufferedInterruptHandler<USART2>;
});

#[cortex_m_rt::entry]
fn main() -> ! {
    zygote_stm32f4::first(&pins::ACTUATORS);
    zygote_stm32f4::run(board(embassy_stm32::init(clocks::internal())))
}

/// Gives every pin to its driver.
fn board(p: Peripherals) -> Board {
    // More than 10 ms of line in, one frame out.
    static RECEIVED: ConstStaticCell<[u8; 1024]> = ConstStaticCell::new([0; 1024]);
    static TO_SEND: ConstStaticCell<[u8; 128]> = ConstStaticCell::new([0; 128]);

    let actuators = Actuators::new(
        [
            four_heaters!(p.TIM1, TIM1: p.PE9, p.PE11, p.PE13, p.PE14),
            four_heaters!(p.TIM4, TIM4: p.PD12, p.PD13, p.PD14, p.PD15),
            four_heaters!(p.TIM8, TIM8: p.PC6, p.PC7, p.PC8, p.PC9),
            None,
        ],
        [low(p.PE7), low(p.PE8), low(p.PE10), low(p.PE12)],
        low(p.PE15),
    );
    let sensors = Sensors {
        adc: Adc::new(p.ADC1),
        thermistor: p.PC1.degrade_adc(),
        supply: p.PC4.degrade_adc(),
        current: p.PC5.degrade_adc(),
        select: [low(p.PD8), low(p.PD9), low(p.PD10), low(p.PD11)],
        // Pulled down on the board, high when pressed.
        stop: Input::new(p.PA0, Pull::None),
        stop_pressed: Level::High,
        thermistors: [0; zygote_stm32f4::HEATERS],
    };
    zygote_stm32f4::watch_stop(0, STOP_LINE, Edge::Rising, pac::Interrupt::EXTI0);

    let mut config = usart::Config::default();
    config.baudrate = BAUD;
    let line = BufferedUart::new(p.USART2, p.PA3, p.PA2, TO_SEND.take(), RECEIVED.take(), Interrupts, config);
    let (transmitter, receiver) = defmt::unwrap!(line).split();
    Board {
        config: identity::config,
        actuators,
        sensors,
        receiver,
        transmitter,
        servos: ServoBus {
            // With the pull-ups of the sound chip, which has another address.
            i2c: I2c::new_blocking(p.I2C1, p.PB6, p.PB9, ServoBus::config()),
            clock: (pac::GPIOB, 6),
        },
        servos_enable: Output::new(p.PD7, Level::High, Speed::Low),
        flash: p.FLASH,
    }
}

/// The stop button.
#[interrupt]
fn EXTI0() {
    zygote_stm32f4::on_stop_edge(STOP_LINE);
}
