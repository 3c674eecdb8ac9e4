//! Which pins move or heat something, for the moments in which nobody drives them. The table people wire from is
//! `docs/src/board-stm32f4-discovery.md`; the drivers take their pins in [`crate::main`].

use embassy_stm32::pac::{GPIOC, GPIOD, GPIOE};
use zygote_protocol::Channels;
use zygote_stm32f4::{Held, Level};

/// 12 heaters on timer PWM, each with its thermistor behind the multiplexer; 16 servos of one PCA9685; and 4 spring
/// releases on plain outputs. The pins of a fourth timer belong to chips on this board.
pub(crate) const CHANNELS: Channels = Channels { heaters: 12, servos: 16, springs: 4 };

/// Every actuator pin, the switches first.
pub(crate) static ACTUATORS: [Held; 18] = [
    // Main switch, and the servos' enable pin.
    Held::switch(GPIOE, 15, Level::Low),
    Held::switch(GPIOD, 7, Level::High),
    // Heaters 0 to 3: TIM1.
    Held::low(GPIOE, 9),
    Held::low(GPIOE, 11),
    Held::low(GPIOE, 13),
    Held::low(GPIOE, 14),
    // Heaters 4 to 7: TIM4, the four LEDs.
    Held::low(GPIOD, 12),
    Held::low(GPIOD, 13),
    Held::low(GPIOD, 14),
    Held::low(GPIOD, 15),
    // Heaters 8 to 11: TIM8.
    Held::low(GPIOC, 6),
    Held::low(GPIOC, 7),
    Held::low(GPIOC, 8),
    Held::low(GPIOC, 9),
    // Springs.
    Held::low(GPIOE, 7),
    Held::low(GPIOE, 8),
    Held::low(GPIOE, 10),
    Held::low(GPIOE, 12),
];
