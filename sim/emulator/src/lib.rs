//! The board's own program, the ELF file that is flashed, on an emulated STM32F446, closed loop with the simulated plant.
//!
//! ```text
//!   Image (elf) --> Chip: core (rsemu), Peripherals --+
//!                                                     +-- EmulatedBoard -- bytes of the line
//!                                          Plant -----+
//! ```
//!
//! What is emulated and what isn't stands in `docs/src/emulator.md`.

mod adc;
mod board;
mod bus;
mod chip;
pub mod count;
mod elf;
mod exti;
mod flash;
mod gpio;
mod i2c;
mod pca9685;
mod peripherals;
mod pins;
mod plain;
mod probe;
mod quick;
mod rcc;
mod store;
mod time;
mod timers;
mod usart;
mod watchdog;

pub use board::{EmulatedBoard, EmulatorError};
pub use chip::ChipError;
pub use elf::{ElfError, Image};
pub use pins::Drive;
pub use probe::Latency;
