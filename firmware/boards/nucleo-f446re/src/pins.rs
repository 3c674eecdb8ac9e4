//! Which pins move or heat something, for the moments in which nobody drives them. The table people wire from is
//! `docs/src/board-nucleo-f446re.md`; the drivers take their pins in [`crate::main`], and the compiler refuses a pin
//! that is taken twice.

use embassy_stm32::pac::{GPIOA, GPIOB, GPIOC};
use zygote_protocol::Channels;
use zygote_stm32f4::{Held, Level};

/// 16 heaters on timer PWM, each with its thermistor behind the multiplexer; 16 servos of one PCA9685; and 4 spring
/// releases on plain outputs.
pub(crate) const CHANNELS: Channels = Channels { heaters: 16, servos: 16, springs: 4 };

/// Every actuator pin, the switches first.
pub(crate) static ACTUATORS: [Held; 22] = [
    // Main switch, and the servos' enable pin.
    Held::switch(GPIOC, 10, Level::Low),
    Held::switch(GPIOC, 11, Level::High),
    // Heaters 0 to 3: TIM1.
    Held::low(GPIOA, 8),
    Held::low(GPIOA, 9),
    Held::low(GPIOA, 10),
    Held::low(GPIOA, 11),
    // Heaters 4 to 7: TIM3.
    Held::low(GPIOA, 6),
    Held::low(GPIOA, 7),
    Held::low(GPIOB, 0),
    Held::low(GPIOB, 1),
    // Heaters 8 to 11: TIM4.
    Held::low(GPIOB, 6),
    Held::low(GPIOB, 7),
    Held::low(GPIOB, 8),
    Held::low(GPIOB, 9),
    // Heaters 12 to 15: TIM8.
    Held::low(GPIOC, 6),
    Held::low(GPIOC, 7),
    Held::low(GPIOC, 8),
    Held::low(GPIOC, 9),
    // Springs.
    Held::low(GPIOB, 12),
    Held::low(GPIOB, 13),
    Held::low(GPIOB, 14),
    Held::low(GPIOB, 15),
];
