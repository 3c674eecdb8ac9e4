//! Programs for a Cortex-M4F, run instruction by instruction.

pub mod count;
