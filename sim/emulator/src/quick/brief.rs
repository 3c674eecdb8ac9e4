//! The commonest instructions in eight bytes each, with what their address says already worked out: most of what a program
//! executes, and small enough for the host's cache. The rest is executed as it was decoded ([`super::exec`]).

use super::alu::{shifted_by, sum};
use super::exec::{C, N, Run, V, Z};
use rsemu::cpu::arm::v7m::isa::{Cond, Shift};

/// A width in memory; signed ones are seldom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cell {
    Byte,
    Half,
    Word,
}

impl Cell {
    #[inline]
    const fn bytes(self) -> u32 {
        match self {
            Self::Byte => 1,
            Self::Half => 2,
            Self::Word => 4,
        }
    }
}

/// An instruction. None of its registers is the program counter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Op {
    /// As decoded, at this place of the list.
    Whole(u32),
    Value {
        rd: u8,
        value: u32,
    },
    ValueFlags {
        rd: u8,
        value: u32,
    },
    Top {
        rd: u8,
        value: u32,
    },
    /// A literal that lies in the flash.
    Literal {
        rd: u8,
        value: u32,
    },
    Copy {
        rd: u8,
        rm: u8,
    },
    AddValue {
        rd: u8,
        rn: u8,
        value: u32,
    },
    AddValueFlags {
        rd: u8,
        rn: u8,
        value: u32,
    },
    /// Adds the inverse and one.
    LessValueFlags {
        rd: u8,
        rn: u8,
        inverse: u32,
    },
    CompareValue {
        rn: u8,
        inverse: u32,
    },
    Add {
        rd: u8,
        rn: u8,
        rm: u8,
        shift: Shift,
    },
    AddFlags {
        rd: u8,
        rn: u8,
        rm: u8,
    },
    Less {
        rd: u8,
        rn: u8,
        rm: u8,
    },
    LessFlags {
        rd: u8,
        rn: u8,
        rm: u8,
    },
    Compare {
        rn: u8,
        rm: u8,
    },
    AndValue {
        rd: u8,
        rn: u8,
        value: u32,
    },
    OrValue {
        rd: u8,
        rn: u8,
        value: u32,
    },
    TestValue {
        rn: u8,
        value: u32,
    },
    And {
        rd: u8,
        rn: u8,
        rm: u8,
        shift: Shift,
    },
    Or {
        rd: u8,
        rn: u8,
        rm: u8,
        shift: Shift,
    },
    Xor {
        rd: u8,
        rn: u8,
        rm: u8,
        shift: Shift,
    },
    /// A shift, or no shift, by what stands in the instruction.
    Shifted {
        rd: u8,
        rm: u8,
        shift: Shift,
    },
    ShiftedFlags {
        rd: u8,
        rm: u8,
        shift: Shift,
    },
    /// Bits from `low` on, of which the mask tells how many.
    Bits {
        rd: u8,
        rn: u8,
        low: u8,
        mask: u32,
    },
    Multiply {
        rd: u8,
        rn: u8,
        rm: u8,
    },
    Load {
        cell: Cell,
        rt: u8,
        rn: u8,
        offset: u32,
    },
    Store {
        cell: Cell,
        rt: u8,
        rn: u8,
        offset: u32,
    },
    LoadIndexed {
        cell: Cell,
        rt: u8,
        rn: u8,
        rm: u8,
        lsl: u8,
    },
    StoreIndexed {
        cell: Cell,
        rt: u8,
        rn: u8,
        rm: u8,
        lsl: u8,
    },
    LoadBlock {
        rn: u8,
        wback: bool,
        before: bool,
        list: u16,
    },
    StoreBlock {
        rn: u8,
        wback: bool,
        before: bool,
        list: u16,
    },
    Branch {
        target: u32,
    },
    BranchIf {
        cond: Cond,
        target: u32,
    },
    /// A branch back to the instruction before, which takes one off a register: a program that lets time pass.
    Spin {
        rd: u8,
        target: u32,
    },
    IfZero {
        rn: u8,
        target: u32,
    },
    IfNotZero {
        rn: u8,
        target: u32,
    },
    Call {
        target: u32,
    },
    CallBy {
        rm: u8,
    },
    Return {
        rm: u8,
    },
}

/// Cycles of a round of such a loop: the branch that is taken, and the subtraction.
const ROUND: u64 = 4;

/// Which of the sixteen values of the flags let a condition pass, a bit each.
const PASSES: [u16; 16] = {
    let mut table = [0; 16];
    let mut at = 0;
    while at < 256 {
        #[expect(clippy::cast_possible_truncation, reason = "below 16")]
        let cond = Cond(at as u8 & 15);
        if cond.passes(at >> 4 << 28) {
            table[(at & 15) as usize] |= 1 << (at >> 4);
        }
        at += 1;
    }
    table
};

impl Run<'_> {
    /// Executes one outside of an IT block; one that can't be finished gives `None` before it has changed anything.
    #[expect(clippy::too_many_lines, reason = "one arm an instruction")]
    #[inline]
    pub(super) fn brief(&mut self, op: Op, pc: u32, length: u32) -> Option<()> {
        self.next = pc.wrapping_add(length);
        self.cycles = 1;
        match op {
            // Not these.
            Op::Whole(_) => return None,
            Op::Value { rd, value } => self.put(rd, value),
            Op::ValueFlags { rd, value } => {
                self.put(rd, value);
                self.sign(value);
            }
            Op::Top { rd, value } => self.put(rd, self.at(rd) & 0xffff | value),
            Op::Literal { rd, value } => {
                self.put(rd, value);
                self.cycles = 2;
            }
            Op::Copy { rd, rm } => self.put(rd, self.at(rm)),
            Op::AddValue { rd, rn, value } => self.put(rd, self.at(rn).wrapping_add(value)),
            Op::AddValueFlags { rd, rn, value } => {
                let result = self.summed(self.at(rn), value, false);
                self.put(rd, result);
            }
            Op::LessValueFlags { rd, rn, inverse } => {
                let result = self.summed(self.at(rn), inverse, true);
                self.put(rd, result);
            }
            Op::CompareValue { rn, inverse } => {
                self.summed(self.at(rn), inverse, true);
            }
            Op::Add { rd, rn, rm, shift } => {
                self.put(rd, self.at(rn).wrapping_add(self.shifted(rm, shift)));
            }
            Op::AddFlags { rd, rn, rm } => {
                let result = self.summed(self.at(rn), self.at(rm), false);
                self.put(rd, result);
            }
            Op::Less { rd, rn, rm } => self.put(rd, self.at(rn).wrapping_sub(self.at(rm))),
            Op::LessFlags { rd, rn, rm } => {
                let result = self.summed(self.at(rn), !self.at(rm), true);
                self.put(rd, result);
            }
            Op::Compare { rn, rm } => {
                self.summed(self.at(rn), !self.at(rm), true);
            }
            Op::AndValue { rd, rn, value } => self.put(rd, self.at(rn) & value),
            Op::OrValue { rd, rn, value } => self.put(rd, self.at(rn) | value),
            Op::TestValue { rn, value } => self.sign(self.at(rn) & value),
            Op::And { rd, rn, rm, shift } => self.put(rd, self.at(rn) & self.shifted(rm, shift)),
            Op::Or { rd, rn, rm, shift } => self.put(rd, self.at(rn) | self.shifted(rm, shift)),
            Op::Xor { rd, rn, rm, shift } => self.put(rd, self.at(rn) ^ self.shifted(rm, shift)),
            Op::Shifted { rd, rm, shift } => self.put(rd, self.shifted(rm, shift)),
            Op::ShiftedFlags { rd, rm, shift } => {
                let (result, carry) = shifted_by(shift, self.at(rm), self.xpsr & C != 0);
                self.put(rd, result);
                self.sign(result);
                self.xpsr = self.xpsr & !C | if carry { C } else { 0 };
            }
            Op::Bits { rd, rn, low, mask } => self.put(rd, self.at(rn) >> low & mask),
            Op::Multiply { rd, rn, rm } => self.put(rd, self.at(rn).wrapping_mul(self.at(rm))),
            Op::Load { cell, rt, rn, offset } => {
                let value = self.load(self.at(rn).wrapping_add(offset), cell.bytes())?;
                self.put(rt, value);
            }
            Op::Store { cell, rt, rn, offset } => {
                self.store(self.at(rn).wrapping_add(offset), cell.bytes(), self.at(rt))?;
            }
            Op::LoadIndexed { cell, rt, rn, rm, lsl } => {
                let value = self.load(self.at(rn).wrapping_add(self.at(rm) << lsl), cell.bytes())?;
                self.put(rt, value);
            }
            Op::StoreIndexed { cell, rt, rn, rm, lsl } => {
                self.store(self.at(rn).wrapping_add(self.at(rm) << lsl), cell.bytes(), self.at(rt))?;
            }
            Op::LoadBlock { rn, wback, before, list } => self.block(true, rn, list, wback, before)?,
            Op::StoreBlock { rn, wback, before, list } => self.block(false, rn, list, wback, before)?,
            Op::Branch { target } => self.branch(target),
            Op::BranchIf { cond, target } => {
                if PASSES[usize::from(cond.0 & 15)] >> (self.xpsr >> 28) & 1 == 1 {
                    self.branch(target);
                }
            }
            Op::Spin { rd, target } => {
                if self.xpsr & Z == 0 {
                    self.spin(rd);
                    self.branch(target);
                }
            }
            Op::IfZero { rn, target } => {
                if self.at(rn) == 0 {
                    self.branch(target);
                }
            }
            Op::IfNotZero { rn, target } => {
                if self.at(rn) != 0 {
                    self.branch(target);
                }
            }
            Op::Call { target } => {
                self.r[14] = self.next | 1;
                self.branch(target);
            }
            Op::CallBy { rm } => {
                let target = Self::code(self.at(rm))?;
                self.r[14] = self.next | 1;
                self.branch(target);
            }
            Op::Return { rm } => {
                let target = Self::code(self.at(rm))?;
                self.branch(target);
            }
        }
        self.now += self.cycles;
        Some(())
    }

    /// The rounds of a loop that only counts, at once: all but the last, as far as nothing else happens meanwhile.
    fn spin(&mut self, rd: u8) {
        let value = self.at(rd);
        let time = self.horizon.saturating_sub(self.now + 1) / ROUND;
        let rounds = value.saturating_sub(1).min(u32::try_from(time).unwrap_or(u32::MAX));
        if rounds > 0 {
            let left = self.summed(value - rounds + 1, !1, true);
            self.put(rd, left);
            self.now += u64::from(rounds) * ROUND;
            self.skipped += u64::from(rounds) * 2;
        }
    }

    #[inline]
    fn at(&self, register: u8) -> u32 {
        self.r[usize::from(register & 15)]
    }

    #[inline]
    fn put(&mut self, register: u8, value: u32) {
        self.r[usize::from(register & 15)] = value;
    }

    #[inline]
    fn shifted(&self, rm: u8, shift: Shift) -> u32 {
        shifted_by(shift, self.at(rm), false).0
    }

    /// Sign and zero.
    #[inline]
    fn sign(&mut self, value: u32) {
        self.xpsr = self.xpsr & !(N | Z) | value & N | u32::from(value == 0) << 30;
    }

    /// A sum that sets all flags.
    #[inline]
    fn summed(&mut self, a: u32, b: u32, carry: bool) -> u32 {
        let (result, carry, overflow) = sum(a, b, carry);
        self.xpsr = self.xpsr & !(N | Z | C | V)
            | result & N
            | u32::from(result == 0) << 30
            | u32::from(carry) << 29
            | u32::from(overflow) << 28;
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instruction_takes_eight_bytes() {
        assert_eq!(size_of::<Op>(), 8);
    }

    #[test]
    fn conditions_pass_as_the_core_says() {
        for cond in (0..16).map(Cond) {
            for flags in 0..16_u32 {
                let passes = PASSES[usize::from(cond.0)] >> flags & 1 == 1;
                assert_eq!(passes, cond.passes(flags << 28), "{cond:?}, flags {flags:04b}");
            }
        }
    }
}
