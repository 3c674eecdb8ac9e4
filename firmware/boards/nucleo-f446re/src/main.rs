//! The firmware core on a NUCLEO-F446RE: pins, clocks and identity; the rest is in `zygote-stm32f4`. The wiring stands
//! in `docs/src/board-nucleo-f446re.md`.
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

/// Rate of the line to the ST-LINK's virtual COM port.
const BAUD: u32 = 921_600;
/// The blue button, PC13.
const STOP_LINE: u8 = 13;

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
            four_heaters!(p.TIM1, TIM1: p.PA8, p.PA9, p.PA10, p.PA11),
            four_heaters!(p.TIM3, TIM3: p.PA6, p.PA7, p.PB0, p.PB1),
            four_heaters!(p.TIM4, TIM4: p.PB6, p.PB7, p.PB8, p.PB9),
            four_heaters!(p.TIM8, TIM8: p.PC6, p.PC7, p.PC8, p.PC9),
        ],
        [low(p.PB12), low(p.PB13), low(p.PB14), low(p.PB15)],
        low(p.PC10),
    );
    let sensors = Sensors {
        adc: Adc::new(p.ADC1),
        thermistor: p.PA0.degrade_adc(),
        supply: p.PA1.degrade_adc(),
        current: p.PA4.degrade_adc(),
        select: [low(p.PC0), low(p.PC1), low(p.PC2), low(p.PC3)],
        // Pulled up on the board, low when pressed.
        stop: Input::new(p.PC13, Pull::None),
        stop_pressed: Level::Low,
        thermistors: [0; zygote_stm32f4::HEATERS],
    };
    zygote_stm32f4::watch_stop(2, STOP_LINE, Edge::Falling, pac::Interrupt::EXTI15_10);

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
            i2c: I2c::new_blocking(p.I2C2, p.PB10, p.PC12, ServoBus::config()),
            clock: (pac::GPIOB, 10),
        },
        servos_enable: Output::new(p.PC11, Level::High, Speed::Low),
        flash: p.FLASH,
    }
}

/// The stop button.
#[interrupt]
fn EXTI15_10() {
    zygote_stm32f4::on_stop_edge(STOP_LINE);
}
