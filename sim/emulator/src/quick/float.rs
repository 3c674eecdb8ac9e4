//! Instructions of the floating-point unit (ARM DDI 0403, A7.7). What they compute is the core's own arithmetic; here it only
//! comes without the way through its fetching, decoding and interrupts.

use super::exec::Run;
use rsemu::cpu::arm::v7m::ArmV7m;
use rsemu::cpu::arm::v7m::fp::{self, Fpu};
use rsemu::cpu::arm::v7m::fpisa::{DataOp, FpInsn, UnaryOp};
use rsemu::float::{Env, Flags, Round};

/// Condition flags, at the same place in `FPSCR` and `xPSR`.
const NZCV: u32 = 0xf << 28;
/// The register that `VMRS` reads in the course of things.
const FPSCR: u8 = 1;

/// The unit's registers, as the core holds them.
pub(super) fn of_core(core: &ArmV7m) -> Fpu {
    let mut fpu = Fpu { s: [0; 32], fpscr: core.fpscr() };
    for (number, place) in (0..).zip(&mut fpu.s) {
        *place = core.s(number);
    }
    fpu
}

/// The core gets them back.
pub(super) fn to_core(fpu: &Fpu, core: &ArmV7m) {
    for (number, value) in (0..).zip(fpu.s) {
        core.set_s(number, value);
    }
    core.set_fpscr(fpu.fpscr);
}

impl Run<'_> {
    /// Only in a context that uses the unit already, and when no earlier one is owed its registers.
    pub(super) fn float(&mut self, instruction: FpInsn) -> Option<()> {
        if !self.may_float {
            return None;
        }
        let core = self.core;
        let fpu = self.fpu.get_or_insert_with(|| of_core(core));
        match instruction {
            FpInsn::Data { op, d, n, m } => {
                let (value, flags) = data(op, (fpu.s(d), fpu.s(n), fpu.s(m)), fpu.env())?;
                fpu.finish(d, value, flags);
                self.cycles += match op {
                    DataOp::Div => 13,
                    DataOp::Add | DataOp::Sub | DataOp::Mul | DataOp::Nmul => 0,
                    _ => 2,
                };
            }
            FpInsn::Unary { op, d, m } => {
                let value = fpu.s(m);
                let (value, flags) = match op {
                    UnaryOp::Mov => (value, Flags::NONE),
                    UnaryOp::Abs => (fp::abs(value), Flags::NONE),
                    UnaryOp::Neg => (fp::neg(value), Flags::NONE),
                    UnaryOp::Sqrt => fp::sqrt(value, fpu.env()),
                    UnaryOp::RintR | UnaryOp::RintZ | UnaryOp::RintX => return None,
                };
                fpu.finish(d, value, flags);
                self.cycles += if op == UnaryOp::Sqrt { 13 } else { 0 };
            }
            FpInsn::MovImm { d, imm } => fpu.set_s(d, imm),
            FpInsn::Cmp { d, m, with_zero, signal_all } => {
                let b = if with_zero { 0 } else { fpu.s(m) };
                let (order, flags) = fp::compare(fpu.s(d), b, signal_all, fpu.env());
                fpu.fpscr = fpu.fpscr & !NZCV | order;
                fp::accumulate(&mut fpu.fpscr, flags);
            }
            FpInsn::CvtInt { d, m, to_int, signed, round_zero } => {
                let env = if round_zero { fpu.env().round(Round::TowardZero) } else { fpu.env() };
                let (value, flags) = if to_int {
                    fp::to_fixed(fpu.s(m), 32, !signed, 0, env)
                } else {
                    fp::from_fixed(fpu.s(m), 32, !signed, 0, fpu.env())
                };
                fpu.finish(d, value, flags);
            }
            FpInsn::MovCore { to_fp: true, rt, n } => fpu.set_s(n, self.r[usize::from(rt & 15)]),
            FpInsn::MovCore { to_fp: false, rt, n } if rt < 15 => self.r[usize::from(rt)] = fpu.s(n),
            FpInsn::Sys { to_core: true, rt: 15, reg: FPSCR } => {
                self.xpsr = self.xpsr & !NZCV | fpu.fpscr & NZCV;
            }
            FpInsn::Mem { load, d, rn, imm, add, double } => {
                let base = if rn == 15 { self.r[15] & !3 } else { self.r[usize::from(rn & 15)] };
                let from = if add { base.wrapping_add(imm) } else { base.wrapping_sub(imm) };
                self.move_block(load, d, 1 + u8::from(double), from)?;
            }
            FpInsn::Multi { load, d, rn, count, add, writeback, .. } if rn < 15 => {
                let bytes = 4 * u32::from(count);
                let base = self.r[usize::from(rn)];
                let from = if add { base } else { base.wrapping_sub(bytes) };
                self.move_block(load, d, count, from)?;
                if writeback {
                    self.r[usize::from(rn)] = if add { base.wrapping_add(bytes) } else { from };
                }
            }
            _ => return None,
        }
        Some(())
    }

    /// Registers from `d` on, to or from memory without side effects.
    fn move_block(&mut self, load: bool, d: u8, count: u8, from: u32) -> Option<()> {
        let bytes = 4 * u32::from(count);
        if !from.is_multiple_of(4) || !Self::is_plain(from, bytes, !load) {
            return None;
        }
        for (number, address) in (d..).zip((from..from + bytes).step_by(4)) {
            if load {
                let value = self.load(address, 4)?;
                self.fpu.as_mut()?.set_s(number, value);
            } else {
                self.store(address, 4, self.fpu.as_ref()?.s(number))?;
            }
        }
        Some(())
    }
}

/// An operation on the destination's old value and two operands. The chained ones round twice.
fn data(op: DataOp, (a, b, c): (u32, u32, u32), env: Env) -> Option<(u32, Flags)> {
    let chained = |addend, negate: bool| {
        let (product, first) = fp::mul(b, c, env);
        let (value, second) = fp::add(addend, if negate { fp::neg(product) } else { product }, env);
        (value, first | second)
    };
    Some(match op {
        DataOp::Add => fp::add(b, c, env),
        DataOp::Sub => fp::sub(b, c, env),
        DataOp::Mul => fp::mul(b, c, env),
        DataOp::Nmul => {
            let (value, flags) = fp::mul(b, c, env);
            (fp::neg(value), flags)
        }
        DataOp::Div => fp::div(b, c, env),
        DataOp::Mla => chained(a, false),
        DataOp::Mls => chained(a, true),
        DataOp::Nmla => chained(fp::neg(a), true),
        DataOp::Nmls => chained(fp::neg(a), false),
        DataOp::Fma => fp::mul_add(a, b, c, env),
        DataOp::Fms => fp::mul_add(a, fp::neg(b), c, env),
        DataOp::Fnma => fp::mul_add(fp::neg(a), fp::neg(b), c, env),
        DataOp::Fnms => fp::mul_add(fp::neg(a), b, c, env),
        DataOp::Maxnm | DataOp::Minnm => return None,
    })
}
