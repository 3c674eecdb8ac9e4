//! The firmware core on an STM32F4: everything but pins, clocks and identity, which a board adds.
//!
//! ```text
//!   timer and pin interrupts     dead man's switch, stop button, serial line, time
//!   high executor (interrupt)    control tick, receive, transmit: all that touches the core
//!   low executor (thread)        servo bus, which may wait for its bus; supervisor, which feeds the watchdog
//! ```
//!
//! What is decided is decided in `zygote-core`; nothing here decides.
#![no_std]

mod actuators;
mod board;
pub mod clocks;
mod dead_man;
mod memory;
mod reset;
mod safe_state;
mod sensors;
mod servo_bus;
mod servo_gate;
mod shell;
mod standstill;
mod stop;
mod supervisor;
mod tasks;

pub use actuators::{Actuators, FourHeaters, HEATER_PIN, HEATER_PWM, Heaters};
pub use board::{Board, HEATERS, SERVOS, SPRINGS, first, low, run};
pub use safe_state::{Held, Level};
pub use sensors::Sensors;
pub use servo_bus::ServoBus;
pub use stop::{Edge, on_edge as on_stop_edge, watch as watch_stop};

/// What [`four_heaters`] needs in the board's crate.
#[doc(hidden)]
pub use static_cell::StaticCell;
