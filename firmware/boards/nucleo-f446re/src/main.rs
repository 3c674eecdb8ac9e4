//! The firmware core on a NUCLEO-F446RE: takes the pins, starts the clocks and three tasks. What is decided is
//! decided in `zygote-core`; the wiring stands in `docs/src/board-nucleo-f446re.md`.
#![no_std]
#![no_main]

mod actuators;
mod clocks;
mod dead_man;
mod identity;
mod pins;
mod reset;
mod safe_state;
mod sensors;
mod shell;
mod tasks;

use actuators::{Actuators, BoardOutputs, FourHeaters, HEATER_PIN, HEATER_PWM};
use defmt_rtt as _;
use embassy_executor::{Executor, Spawner};
use embassy_stm32::{
    Peri, Peripherals,
    adc::Adc,
    bind_interrupts,
    gpio::{Input, Level, Output, Pin, Pull, Speed},
    peripherals::USART2,
    timer::{
        low_level::CountingMode::EdgeAlignedUp,
        simple_pwm::{PwmPin, SimplePwm},
    },
    usart::{self, BufferedUart},
    wdg::IndependentWatchdog,
};
use sensors::Sensors;
use shell::{BoardCore, Shell};
use static_cell::{ConstStaticCell, StaticCell};
use zygote_protocol::ResetCause;

/// Rate of the line to the ST-LINK's virtual COM port.
const BAUD: u32 = 921_600;
/// The watchdog's clock is between 17 and 47 kHz, nominally 32: a reset comes after 170 to 470 ms (S9: 500 ms).
const WATCHDOG_US: u32 = 250_000;

bind_interrupts!(struct Interrupts {
    USART2 => usart::BufferedInterruptHandler<USART2>;
});

#[cortex_m_rt::entry]
fn main() -> ! {
    static EXECUTOR: StaticCell<Executor> = StaticCell::new();

    safe_state::all_off();
    let peripherals = embassy_stm32::init(clocks::config());
    EXECUTOR.init(Executor::new()).run(|spawner| spawner.spawn(defmt::unwrap!(start(spawner, peripherals))))
}

/// Gives every pin to its driver, the core its identity, and the tasks their parts.
#[embassy_executor::task]
async fn start(spawner: Spawner, p: Peripherals) {
    // More than 10 ms of line in, one frame out.
    static RECEIVED: ConstStaticCell<[u8; 1024]> = ConstStaticCell::new([0; 1024]);
    static TO_SEND: ConstStaticCell<[u8; 128]> = ConstStaticCell::new([0; 128]);
    static SHELL: StaticCell<Shell> = StaticCell::new();

    let mut watchdog = IndependentWatchdog::new(p.IWDG, WATCHDOG_US);
    watchdog.unleash();

    macro_rules! four_heaters {
        ($timer:ident: $ch1:ident, $ch2:ident, $ch3:ident, $ch4:ident) => {
            FourHeaters::new(SimplePwm::new(
                p.$timer,
                Some(PwmPin::new_with_config(p.$ch1, HEATER_PIN)),
                Some(PwmPin::new_with_config(p.$ch2, HEATER_PIN)),
                Some(PwmPin::new_with_config(p.$ch3, HEATER_PIN)),
                Some(PwmPin::new_with_config(p.$ch4, HEATER_PIN)),
                HEATER_PWM,
                EdgeAlignedUp,
            ))
        };
    }
    let actuators = Actuators {
        heaters_0: four_heaters!(TIM1: PA8, PA9, PA10, PA11),
        heaters_4: four_heaters!(TIM3: PA6, PA7, PB0, PB1),
        heaters_8: four_heaters!(TIM4: PB6, PB7, PB8, PB9),
        heaters_12: four_heaters!(TIM8: PC6, PC7, PC8, PC9),
        springs: [low(p.PB12), low(p.PB13), low(p.PB14), low(p.PB15)],
        main_switch: low(p.PC10),
        applied: BoardOutputs::OFF,
    };
    let mut sensors = Sensors {
        adc: Adc::new(p.ADC1),
        thermistor: p.PA0,
        supply: p.PA1,
        current: p.PA4,
        select: [low(p.PC0), low(p.PC1), low(p.PC2), low(p.PC3)],
        stop: Input::new(p.PC13, Pull::None),
        thermistors: [0; pins::HEATERS],
    };

    let (cause, kept) = (reset::cause(), reset::kept());
    // After power was off memory holds anything, even something that looks whole.
    let kept = kept.filter(|_| cause != ResetCause::Power);
    let config = identity::config(reset::boot_id(sensors.noise()), cause);
    let core = BoardCore::new(config, shell::now(), kept);
    let shell = SHELL.init(Shell::new(core, actuators));
    dead_man::watch();

    let mut config = usart::Config::default();
    config.baudrate = BAUD;
    let line = BufferedUart::new(p.USART2, p.PA3, p.PA2, TO_SEND.take(), RECEIVED.take(), Interrupts, config);
    let (transmitter, receiver) = defmt::unwrap!(line).split();

    spawner.spawn(defmt::unwrap!(tasks::control(shell, sensors, watchdog)));
    spawner.spawn(defmt::unwrap!(tasks::receive(shell, receiver)));
    spawner.spawn(defmt::unwrap!(tasks::transmit(shell, transmitter)));
}

/// An output that is low from the start.
fn low(pin: Peri<'static, impl Pin>) -> Output<'static> {
    Output::new(pin, Level::Low, Speed::Low)
}
