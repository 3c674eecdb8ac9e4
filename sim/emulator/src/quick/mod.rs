//! The fast way through ordinary instructions: each is decoded once, and runs of them are executed without going through
//! the core's model of interrupts, faults and floating point. What isn't ordinary is left to the core, untouched.
//!
//! The two give the same state and the same number of cycles after every instruction; a test runs them side by side
//! over the board's program.

mod alu;
mod exec;
mod memory;

use crate::bus::Shared;
use crate::chip::FLASH;
use exec::Run;
use rsemu::core::space::RamStore;
use rsemu::core::value::{Endian, Width};
use rsemu::cpu::arm::v7m::Regs;
use rsemu::cpu::arm::v7m::isa::{Insn, decode, is_32bit};
use std::sync::Arc;

/// Thumb state.
const THUMB: u32 = 1 << 24;

/// Why a run of instructions ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// It is time for something else.
    Horizon,
    /// The latest instruction touched a peripheral, or unmasked interrupts.
    Look,
    /// The next instruction is the core's.
    Core,
}

/// An instruction with its length in bytes; 0 where nothing has been decoded yet.
#[derive(Clone, Copy)]
struct Slot {
    instruction: Insn,
    length: u32,
}

const EMPTY: Slot = Slot { instruction: Insn::Undefined, length: 0 };

/// The program as decoded so far, and the memories.
pub(crate) struct Quick {
    flash: Arc<RamStore>,
    ram: Arc<RamStore>,
    slots: Vec<Slot>,
    /// What the latest exclusive load marked, if the core hasn't stepped since.
    exclusive: Option<u32>,
}

impl Quick {
    pub(crate) fn new(flash: Arc<RamStore>, ram: Arc<RamStore>) -> Self {
        let slots = vec![EMPTY; FLASH.len() / 2];
        Self { flash, ram, slots, exclusive: None }
    }

    /// The flash is not as it was.
    pub(crate) fn forget(&mut self) {
        self.slots.fill(EMPTY);
    }

    /// The core has stepped by itself, perhaps into an interrupt or out of one.
    pub(crate) fn core_stepped(&mut self) {
        self.exclusive = None;
    }

    /// Executes until `horizon`, from a state in thread mode or a handler on the main stack, privileged. With `masked`,
    /// interrupts are masked and one waits. Counts the instructions.
    pub(crate) fn run(
        &mut self,
        regs: &mut Regs,
        shared: &Shared,
        horizon: u64,
        masked: bool,
        instructions: &mut u64,
    ) -> End {
        if regs.xpsr & THUMB == 0 {
            return End::Core;
        }
        let mut run = Run {
            r: regs.r,
            xpsr: regs.xpsr,
            primask: regs.primask,
            exception: regs.xpsr & 0x1ff,
            exclusive: self.exclusive,
            flash: &self.flash,
            ram: &self.ram,
            shared,
            now: shared.now(),
            next: 0,
            cycles: 0,
            touched: false,
        };
        let mut executed = 0;
        let end = loop {
            if run.now >= horizon {
                break End::Horizon;
            }
            let pc = run.r[15];
            let at = (pc.wrapping_sub(FLASH.start) / 2) as usize;
            let Some(slot) = self.slots.get_mut(at) else { break End::Core };
            if slot.length == 0 {
                *slot = decoded(&self.flash, at);
            }
            if run.step(pc, &slot.instruction, slot.length).is_none() {
                run.r[15] = pc;
                break End::Core;
            }
            executed += 1;
            if run.touched {
                run.touched = false;
                if shared.wants_look() {
                    break End::Look;
                }
            }
            if masked && !run.primask {
                break End::Look;
            }
        };
        shared.set_now(run.now);
        regs.r = run.r;
        regs.msp = run.r[13];
        regs.xpsr = run.xpsr;
        regs.primask = run.primask;
        self.exclusive = run.exclusive;
        *instructions += executed;
        end
    }
}

#[cold]
fn decoded(flash: &RamStore, at: usize) -> Slot {
    let half = |at: usize| {
        let value = flash.read_value(2 * at as u64, Width::U16, Endian::Little).unwrap_or(0);
        u16::try_from(value).unwrap_or(0)
    };
    let first = half(at);
    let wide = is_32bit(first);
    let second = if wide { half(at + 1) } else { 0 };
    Slot { instruction: decode(first, second), length: if wide { 4 } else { 2 } }
}
