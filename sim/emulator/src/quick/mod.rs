//! The fast way through ordinary instructions: each is decoded once, and runs of them are executed without going through
//! the core's model of interrupts and faults. What isn't ordinary is left to the core, untouched.
//!
//! The two give the same state and the same number of cycles after every instruction; a test runs them side by side
//! over the board's program.

mod alu;
mod brief;
mod exec;
mod float;
mod lowering;
mod memory;

use crate::bus::Shared;
use crate::chip::FLASH;
use crate::store::Store;
use brief::Op;
use exec::{IT, Run};
use lowering::brief;
use rsemu::cpu::arm::v7m::fp::Fpu;
use rsemu::cpu::arm::v7m::isa::{Insn, decode, is_32bit};
use rsemu::cpu::arm::v7m::{ArmV7m, Regs};
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
    op: Op,
    length: u32,
}

const EMPTY: Slot = Slot { op: Op::Whole(0), length: 0 };

/// What a run starts from.
pub(crate) struct Start {
    /// Nothing happens by itself before this cycle.
    pub(crate) horizon: u64,
    /// Interrupts are masked, and one waits.
    pub(crate) masked: bool,
    /// The context uses the floating-point unit already, and none is owed its registers.
    pub(crate) may_float: bool,
}

/// The program as decoded so far, and the memories.
pub(crate) struct Quick {
    flash: Arc<Store>,
    ram: Arc<Store>,
    slots: Vec<Slot>,
    /// All instructions, as decoded, and where each place of the flash has its own.
    whole: Vec<Insn>,
    places: Vec<u32>,
    /// The registers of the floating-point unit, while the core's are out of date.
    fpu: Option<Fpu>,
    /// What the latest exclusive load marked, if the core hasn't stepped since.
    exclusive: Option<u32>,
}

impl Quick {
    pub(crate) fn new(flash: Arc<Store>, ram: Arc<Store>) -> Self {
        let places = FLASH.len() / 2;
        Self {
            flash,
            ram,
            slots: vec![EMPTY; places],
            whole: Vec::new(),
            places: vec![0; places],
            fpu: None,
            exclusive: None,
        }
    }

    /// The flash is not as it was.
    pub(crate) fn forget(&mut self) {
        self.slots.fill(EMPTY);
        self.whole.clear();
    }

    /// The core is about to step by itself, or to be reset.
    pub(crate) fn hand_over(&mut self, core: &ArmV7m) {
        self.exclusive = None;
        if let Some(fpu) = self.fpu.take() {
            float::to_core(&fpu, core);
        }
    }

    /// Executes until the horizon, from a state in thread mode or a handler on the main stack, privileged. Counts the instructions.
    pub(crate) fn run(
        &mut self,
        regs: &mut Regs,
        core: &ArmV7m,
        shared: &Shared,
        start: &Start,
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
            fpu: &mut self.fpu,
            may_float: start.may_float,
            core,
            flash: &self.flash,
            ram: &self.ram,
            shared,
            now: shared.now(),
            horizon: start.horizon,
            skipped: 0,
            next: regs.r[15],
            cycles: 0,
            touched: false,
        };
        let mut executed = 0;
        let end = loop {
            if run.now >= start.horizon {
                break End::Horizon;
            }
            let pc = run.next;
            let at = (pc.wrapping_sub(FLASH.start) / 2) as usize;
            let Some(slot) = self.slots.get_mut(at) else { break End::Core };
            if slot.length == 0 {
                let (instruction, length) = decoded(&self.flash, at);
                let place = u32::try_from(self.whole.len()).unwrap_or(u32::MAX);
                let op = brief(&instruction, pc, &self.flash).unwrap_or(Op::Whole(place));
                *slot = Slot { op, length };
                self.whole.push(instruction);
                if let Some(of) = self.places.get_mut(at) {
                    *of = place;
                }
            }
            let Slot { op, length } = *slot;
            let done = match op {
                op if run.xpsr & IT != 0 || matches!(op, Op::Whole(_)) => {
                    let place =
                        if let Op::Whole(place) = op { Some(place) } else { self.places.get(at).copied() };
                    let Some(instruction) = place.and_then(|place| self.whole.get(place as usize)) else {
                        break End::Core;
                    };
                    run.step(pc, instruction, length)
                }
                op => run.brief(op, pc, length),
            };
            if done.is_none() {
                run.next = pc;
                break End::Core;
            }
            executed += 1;
            if run.touched {
                run.touched = false;
                if shared.wants_look() {
                    break End::Look;
                }
            }
            if start.masked && !run.primask {
                break End::Look;
            }
        };
        shared.set_now(run.now);
        regs.r = run.r;
        regs.r[15] = run.next;
        regs.msp = run.r[13];
        regs.xpsr = run.xpsr;
        regs.primask = run.primask;
        self.exclusive = run.exclusive;
        *instructions += executed + run.skipped;
        end
    }
}

/// An instruction, with its length in bytes.
#[cold]
fn decoded(flash: &Store, at: usize) -> (Insn, u32) {
    let half = |at: usize| {
        let value = u32::try_from(2 * at).ok().and_then(|at| flash.read(at, 2)).unwrap_or(0);
        u16::try_from(value).unwrap_or(0)
    };
    let first = half(at);
    let wide = is_32bit(first);
    let second = if wide { half(at + 1) } else { 0 };
    (decode(first, second), if wide { 4 } else { 2 })
}
