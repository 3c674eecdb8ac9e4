//! One ordinary instruction after the other (ARM DDI 0403, A7.7). An instruction that can't be finished here gives
//! `None` before it has changed anything.

use super::alu::{shifted, shifted_by, sum};
use crate::bus::Shared;
use crate::store::Store;
use rsemu::cpu::arm::v7m::ArmV7m;
use rsemu::cpu::arm::v7m::fp::Fpu;
use rsemu::cpu::arm::v7m::isa::{
    BitfieldOp, Cond, DpOp, ExtendOp, HintOp, Insn, MemOffset, MiscOp, Operand, Size,
};

pub(super) const N: u32 = 1 << 31;
pub(super) const Z: u32 = 1 << 30;
pub(super) const C: u32 = 1 << 29;
pub(super) const V: u32 = 1 << 28;
/// Where the state of an IT block stands.
pub(super) const IT: u32 = 0x3f << 10 | 3 << 25;
/// Special registers that are read in the course of things.
const IPSR: u8 = 5;
const PRIMASK: u8 = 16;
/// Targets from here on end an exception.
const EXCEPTION_RETURN: u32 = 0xf000_0000;

/// The state that ordinary instructions work on.
pub(super) struct Run<'a> {
    pub(super) r: [u32; 16],
    pub(super) xpsr: u32,
    pub(super) primask: bool,
    pub(super) exception: u32,
    pub(super) exclusive: Option<u32>,
    /// The registers of the floating-point unit, if they have been asked for since the core stepped.
    pub(super) fpu: &'a mut Option<Fpu>,
    pub(super) may_float: bool,
    pub(super) core: &'a ArmV7m,
    pub(super) flash: &'a Store,
    pub(super) ram: &'a Store,
    pub(super) shared: &'a Shared,
    pub(super) now: u64,
    /// Nothing happens by itself before.
    pub(super) horizon: u64,
    /// Instructions of loops that were executed at once.
    pub(super) skipped: u64,
    /// Where the program goes on.
    pub(super) next: u32,
    /// What the instruction takes.
    pub(super) cycles: u64,
    /// A peripheral was touched.
    pub(super) touched: bool,
}

impl Run<'_> {
    /// Executes one instruction.
    #[inline]
    pub(super) fn step(&mut self, pc: u32, instruction: &Insn, length: u32) -> Option<()> {
        self.r[15] = pc.wrapping_add(4);
        self.next = pc.wrapping_add(length);
        self.cycles = 1;
        let block = self.xpsr & IT != 0;
        if !block {
            self.execute(instruction, true)?;
        } else if let Insn::It { .. } = instruction {
            return None;
        } else {
            let state = self.it_state();
            if Cond(state >> 4).passes(self.xpsr) {
                // Short instructions leave the flags alone in a block.
                self.execute(instruction, length == 4)?;
            }
            self.set_it_state(if state.trailing_zeros() >= 3 { 0 } else { state & 0xe0 | state << 1 & 0x1f });
        }
        self.now += self.cycles;
        Some(())
    }

    #[expect(clippy::too_many_lines, reason = "one arm an instruction")]
    #[inline]
    fn execute(&mut self, instruction: &Insn, may_flag: bool) -> Option<()> {
        match *instruction {
            Insn::DataProc { op, s, rd, rn, operand } => {
                self.data(op, s && (may_flag || op.is_test()), rd, rn, operand)?;
            }
            Insn::ShiftReg { ty, s, rd, rn, rm } => {
                let (result, carry) = shifted(ty, self.get(rn), self.get(rm) & 0xff, self.flag(C));
                self.set(rd, result);
                if s && may_flag {
                    self.set_nz(result);
                    self.set_flag(C, carry);
                }
            }
            Insn::Adr { rd, imm, add } => self.set(rd, moved(self.r[15] & !3, imm, add)),
            Insn::MovImm16 { top: false, rd, imm } => self.set(rd, imm.into()),
            Insn::MovImm16 { top: true, rd, imm } => {
                self.set(rd, self.get(rd) & 0xffff | u32::from(imm) << 16);
            }
            Insn::Branch { cond, offset } => {
                if cond.is_none_or(|cond| cond.passes(self.xpsr)) {
                    self.branch(self.r[15].wrapping_add_signed(offset));
                }
            }
            Insn::BranchLink { offset } => {
                self.r[14] = self.next | 1;
                self.branch(self.r[15].wrapping_add_signed(offset));
            }
            Insn::Bx { rm } => {
                let target = Self::code(self.get(rm))?;
                self.branch(target);
            }
            Insn::Blx { rm } => {
                let target = Self::code(self.get(rm))?;
                self.r[14] = self.next | 1;
                self.branch(target);
            }
            Insn::Cbz { nonzero, rn, offset } => {
                if (self.get(rn) != 0) == nonzero {
                    self.branch(self.r[15].wrapping_add(offset));
                }
            }
            Insn::TableBranch { rn, rm, half } => {
                let scale = u32::from(half);
                let entry = self.get(rn).wrapping_add(self.get(rm) << scale);
                let offset = self.load_plain(entry, 1 + scale)?;
                self.branch(self.r[15].wrapping_add(2 * offset));
            }
            Insn::It { cond, mask } => self.set_it_state(cond.0 << 4 | mask),
            Insn::LoadStore { load, size, signed, rt, rn, offset, index, add, wback, unpriv: _ } => {
                let by = match offset {
                    MemOffset::Imm(by) => by,
                    MemOffset::Reg { rm, lsl } => self.get(rm) << lsl,
                };
                let base = self.get(rn);
                let there = moved(base, by, add);
                let address = if index { there } else { base };
                let base_after = wback.then_some(there);
                if load {
                    self.load_register(address, size, signed, rt, (rn, base_after))?;
                } else {
                    self.store(address, size.bytes(), self.get(rt))?;
                    if let Some(base) = base_after {
                        self.set(rn, base);
                    }
                }
            }
            Insn::LoadLiteral { size, signed, rt, imm, add } => {
                let address = moved(self.r[15] & !3, imm, add);
                self.load_register(address, size, signed, rt, (0, None))?;
            }
            Insn::LoadStoreDual { load, rt, rt2, rn, imm, index, add, wback } => {
                let base = if rn == 15 { self.r[15] & !3 } else { self.get(rn) };
                let there = moved(base, imm, add);
                let address = if index { there } else { base };
                if !address.is_multiple_of(4) || !Self::is_plain(address, 8, !load) {
                    return None;
                }
                if load {
                    let (first, second) = (self.load(address, 4)?, self.load(address + 4, 4)?);
                    self.set(rt, first);
                    self.set(rt2, second);
                } else {
                    self.store(address, 4, self.get(rt))?;
                    self.store(address + 4, 4, self.get(rt2))?;
                }
                if wback && rn != 15 {
                    self.set(rn, there);
                }
            }
            Insn::LoadStoreExclusive { load, size, rd, rt, rn, imm } => {
                let address = self.get(rn).wrapping_add(imm);
                if !address.is_multiple_of(size.bytes()) || !Self::is_plain(address, size.bytes(), !load) {
                    return None;
                }
                if load {
                    let value = self.load(address, size.bytes())?;
                    self.exclusive = Some(address);
                    self.set(rt, value);
                } else {
                    let held = self.exclusive.take() == Some(address);
                    if held {
                        self.store(address, size.bytes(), self.get(rt))?;
                    }
                    self.set(rd, u32::from(!held));
                }
            }
            Insn::ClearExclusive => self.exclusive = None,
            Insn::LoadStoreMultiple { load, rn, list, wback, before } => {
                self.block(load, rn, list, wback, before)?;
            }
            Insn::Mul { rd, rn, rm, ra, sub, s } => {
                let product = self.get(rn).wrapping_mul(self.get(rm));
                let result = match ra.map(|ra| self.get(ra)) {
                    None => product,
                    Some(addend) if sub => addend.wrapping_sub(product),
                    Some(addend) => addend.wrapping_add(product),
                };
                self.set(rd, result);
                if s && may_flag {
                    self.set_nz(result);
                }
            }
            Insn::MulLong { signed, accumulate, rdlo, rdhi, rn, rm, umaal: false } => {
                let (a, b) = (self.get(rn), self.get(rm));
                let product = if signed {
                    (i64::from(a.cast_signed()) * i64::from(b.cast_signed())).cast_unsigned()
                } else {
                    u64::from(a) * u64::from(b)
                };
                let before = u64::from(self.get(rdhi)) << 32 | u64::from(self.get(rdlo));
                let result = product.wrapping_add(if accumulate { before } else { 0 });
                self.set_pair(rdlo, rdhi, result);
                self.cycles += 1;
            }
            Insn::Div { signed, rd, rn, rm } => {
                let (a, b) = (self.get(rn), self.get(rm));
                let result = match (b, signed) {
                    (0, _) => 0,
                    (_, true) => a.cast_signed().wrapping_div(b.cast_signed()).cast_unsigned(),
                    (_, false) => a / b,
                };
                self.set(rd, result);
                self.cycles += 2;
            }
            Insn::Extend { op, rd, rn, rm, rotate } => {
                let value = self.get(rm).rotate_right(rotate.into());
                let [low, high, ..] = value.to_le_bytes();
                let extended = match op {
                    ExtendOp::Sxtb => i32::from(low.cast_signed()).cast_unsigned(),
                    ExtendOp::Sxth => i32::from(i16::from_le_bytes([low, high])).cast_unsigned(),
                    ExtendOp::Uxtb => low.into(),
                    ExtendOp::Uxth => u16::from_le_bytes([low, high]).into(),
                    ExtendOp::Sxtb16 | ExtendOp::Uxtb16 => return None,
                };
                let addend = if rn == 15 { 0 } else { self.get(rn) };
                self.set(rd, addend.wrapping_add(extended));
            }
            Insn::Misc { op, rd, rm } => {
                let value = self.get(rm);
                let [a, b, c, d] = value.to_le_bytes();
                self.set(
                    rd,
                    match op {
                        MiscOp::Clz => value.leading_zeros(),
                        MiscOp::Rbit => value.reverse_bits(),
                        MiscOp::Rev => value.swap_bytes(),
                        MiscOp::Rev16 => u32::from_le_bytes([b, a, d, c]),
                        MiscOp::Revsh => i32::from(i16::from_le_bytes([b, a])).cast_unsigned(),
                    },
                );
            }
            Insn::Bitfield { op, rd, rn, lsb, width } => {
                let mask = u32::MAX >> (32 - u32::from(width).clamp(1, 32));
                let lsb = u32::from(lsb & 31);
                let field = self.get(rn) >> lsb & mask;
                let kept = self.get(rd) & !(mask << lsb);
                self.set(
                    rd,
                    match op {
                        BitfieldOp::Ubfx => field,
                        BitfieldOp::Sbfx => {
                            let unused = mask.leading_zeros();
                            ((field << unused).cast_signed() >> unused).cast_unsigned()
                        }
                        BitfieldOp::Bfi => kept | (self.get(rn) & mask) << lsb,
                        BitfieldOp::Bfc => kept,
                    },
                );
            }
            Insn::Mrs { rd, sysm: PRIMASK } => self.set(rd, self.primask.into()),
            Insn::Mrs { rd, sysm: IPSR } => self.set(rd, self.exception),
            Insn::Cps { enable, i: true, f: false } => self.primask = !enable,
            Insn::Fp(instruction) => self.float(instruction)?,
            Insn::Barrier { .. } | Insn::Hint { op: HintOp::Nop | HintOp::Yield } => {}
            _ => return None,
        }
        Some(())
    }

    #[inline]
    fn data(&mut self, op: DpOp, flags: bool, rd: u8, rn: u8, operand: Operand) -> Option<()> {
        let carry = self.flag(C);
        let (b, carry_out) = match operand {
            Operand::Imm { value, carry: of } => (value, of.unwrap_or(carry)),
            Operand::Reg { rm, shift } => shifted_by(shift, self.get(rm), carry),
        };
        let a = self.get(rn);
        let logic = |result| (result, carry_out, self.flag(V));
        let (result, carry, overflow) = match op {
            DpOp::And | DpOp::Tst => logic(a & b),
            DpOp::Bic => logic(a & !b),
            DpOp::Orr => logic(a | b),
            DpOp::Orn => logic(a | !b),
            DpOp::Eor | DpOp::Teq => logic(a ^ b),
            DpOp::Mov => logic(b),
            DpOp::Mvn => logic(!b),
            DpOp::Add | DpOp::Cmn => sum(a, b, false),
            DpOp::Adc => sum(a, b, carry),
            DpOp::Sub | DpOp::Cmp => sum(a, !b, true),
            DpOp::Sbc => sum(a, !b, carry),
            DpOp::Rsb => sum(!a, b, true),
        };
        if flags {
            if rd == 15 && !op.is_test() {
                return None;
            }
            self.set_nz(result);
            self.set_flag(C, carry);
            self.set_flag(V, overflow);
        }
        if op.is_test() {
            return Some(());
        }
        if rd == 15 {
            self.branch(result & !1);
        } else {
            self.set(rd, result);
        }
        Some(())
    }

    #[inline]
    fn load_register(
        &mut self,
        address: u32,
        size: Size,
        signed: bool,
        rt: u8,
        (rn, base): (u8, Option<u32>),
    ) -> Option<()> {
        if rt == 15 {
            let target = Self::code(self.peek(address, 4)?)?;
            self.cycles += 1;
            self.branch(target);
        } else {
            let value = self.load(address, size.bytes())?;
            let [low, high, ..] = value.to_le_bytes();
            self.r[usize::from(rt)] = match (size, signed) {
                (Size::Byte, true) => i32::from(low.cast_signed()).cast_unsigned(),
                (Size::Half, true) => i32::from(i16::from_le_bytes([low, high])).cast_unsigned(),
                (Size::Byte | Size::Half | Size::Word, _) => value,
            };
        }
        if let Some(base) = base
            && rn != rt
        {
            self.set(rn, base);
        }
        Some(())
    }

    /// `LDM`, `STM`, `PUSH`, `POP`.
    #[inline]
    pub(super) fn block(&mut self, load: bool, rn: u8, list: u16, wback: bool, before: bool) -> Option<()> {
        let bytes = 4 * list.count_ones();
        let base = self.get(rn);
        let start = if before { base.wrapping_sub(bytes) } else { base };
        let after = if before { start } else { base.wrapping_add(bytes) };
        if list == 0 || !start.is_multiple_of(4) || !Self::is_plain(start, bytes, !load) {
            return None;
        }
        // The last of them, before anything has changed.
        let target = if load && list >> 15 == 1 {
            Some(Self::code(self.peek(start.wrapping_add(bytes - 4), 4)?)?)
        } else {
            None
        };
        if load && wback {
            self.set(rn, after);
        }
        let mut address = start;
        let mut left = list;
        while left != 0 {
            let register = left.trailing_zeros() as usize;
            left &= left - 1;
            if load {
                let value = self.load(address, 4)?;
                if register != 15 {
                    self.r[register] = value;
                }
            } else {
                self.store(address, 4, self.r[register])?;
            }
            address = address.wrapping_add(4);
        }
        if !load && wback {
            self.set(rn, after);
        }
        if let Some(target) = target {
            self.branch(target);
        }
        Some(())
    }

    /// A table in memory without side effects.
    fn load_plain(&mut self, address: u32, bytes: u32) -> Option<u32> {
        if !address.is_multiple_of(bytes) || !Self::is_plain(address, bytes, false) {
            return None;
        }
        self.load(address, bytes)
    }

    /// A target that stays in the program; the end of an exception, and code of another state, are the core's.
    #[inline]
    pub(super) fn code(target: u32) -> Option<u32> {
        (target & 1 == 1 && target < EXCEPTION_RETURN).then_some(target & !1)
    }

    #[inline]
    pub(super) fn branch(&mut self, target: u32) {
        self.next = target;
        self.cycles += 2;
    }

    #[inline]
    fn get(&self, register: u8) -> u32 {
        self.r[usize::from(register & 15)]
    }

    #[inline]
    fn set(&mut self, register: u8, value: u32) {
        if register != 15 {
            self.r[usize::from(register & 15)] = value;
        }
    }

    fn set_pair(&mut self, low: u8, high: u8, value: u64) {
        let [a, b, c, d, e, f, g, h] = value.to_le_bytes();
        self.set(low, u32::from_le_bytes([a, b, c, d]));
        self.set(high, u32::from_le_bytes([e, f, g, h]));
    }

    #[inline]
    fn flag(&self, flag: u32) -> bool {
        self.xpsr & flag != 0
    }

    #[inline]
    fn set_flag(&mut self, flag: u32, on: bool) {
        self.xpsr = if on { self.xpsr | flag } else { self.xpsr & !flag };
    }

    #[inline]
    fn set_nz(&mut self, value: u32) {
        self.xpsr = self.xpsr & !(N | Z) | value & N | if value == 0 { Z } else { 0 };
    }

    #[inline]
    fn it_state(&self) -> u8 {
        let [_, low, _, high] = self.xpsr.to_le_bytes();
        low & 0xfc | high >> 1 & 3
    }

    #[inline]
    fn set_it_state(&mut self, state: u8) {
        let state = u32::from(state);
        self.xpsr = self.xpsr & !IT | (state >> 2) << 10 | (state & 3) << 25;
    }
}

/// An address with an offset.
#[inline]
fn moved(base: u32, by: u32, add: bool) -> u32 {
    if add { base.wrapping_add(by) } else { base.wrapping_sub(by) }
}
