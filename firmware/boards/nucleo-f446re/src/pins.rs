//! Which pin does what. The table people wire from is `docs/src/board-nucleo-f446re.md`; the drivers take their
//! pins in [`crate::main`], and the compiler refuses a pin that is taken twice.

use zygote_protocol::Channels;

/// Actuator pins of port A: heaters 0 to 3 (8 to 11, TIM1) and heaters 4 and 5 (6 and 7, TIM3).
pub(crate) const ACTUATORS_A: &[u8] = &[6, 7, 8, 9, 10, 11];
/// Actuator pins of port B: heaters 6 and 7 (0 and 1, TIM3), heaters 8 to 11 (6 to 9, TIM4), springs (12 to 15).
pub(crate) const ACTUATORS_B: &[u8] = &[0, 1, 6, 7, 8, 9, 12, 13, 14, 15];
/// Actuator pins of port C: heaters 12 to 15 (6 to 9, TIM8), main switch (10).
pub(crate) const ACTUATORS_C: &[u8] = &[6, 7, 8, 9, 10];

/// What is fitted: 16 heaters on timer PWM, each with its thermistor behind the multiplexer, and 4 spring releases
/// on plain outputs. No servos, as long as no PCA9685 stands behind I2C2 (PB10, PC12).
pub(crate) const CHANNELS: Channels = Channels { heaters: 16, servos: 0, springs: 4 };

pub(crate) const HEATERS: usize = CHANNELS.heaters as usize;
pub(crate) const SERVOS: usize = CHANNELS.servos as usize;
pub(crate) const SPRINGS: usize = CHANNELS.springs as usize;
/// Steps of one program: at most one for each channel.
pub(crate) const STEPS: usize = HEATERS + SERVOS + SPRINGS;
