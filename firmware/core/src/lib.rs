//! Every decision that the MCU takes: may this hinge be heated, is that step done, is the host still there.
//!
//! No hardware, no executor, no clock: bytes, readings and the time come in, bytes and actuator commands go
//! out. The boards under `firmware/boards` and the simulator run this same crate.
//!
//! ```text
//!   bytes --> Link --> handlers --> Program --> Sequencer --> SmaHeater, ServoMover, SpringRelease --> Outputs
//!   Inputs --> ThermalGuard, SupplyGuard, link silence, stop button --> everything off
//! ```
#![no_std]
#![warn(clippy::indexing_slicing, clippy::as_conversions)]

mod calibration;
mod config;
mod core;
mod event_queue;
mod handlers;
mod io;
mod mode;
mod program;
mod sequencer;
mod servo_mover;
mod settings;
mod sma_heater;
mod spring_release;
mod supply_guard;
mod thermal_guard;
mod thermistor;
mod trip;

pub use config::Config;
pub use core::Core;
pub use io::{ADC_FULL_SCALE, Duty, Inputs, Outputs, PulseMicros};
pub use thermistor::{NTC_10K, Thermistor};
