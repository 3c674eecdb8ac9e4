//! The plant against physics on paper: closed forms, balances and data sheets, not against itself.

mod actuators;
mod faults;
mod guide;
mod rig;
mod sensors;
mod supply;
mod thermal;
mod transformation;
