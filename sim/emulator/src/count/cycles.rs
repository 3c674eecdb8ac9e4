//! What an instruction costs at the most on a Cortex-M4F: the tables of ARM's Technical Reference Manual (DDI 0439, chapters 3.3 and
//! 7.2), and where it says "from .. to ..", the greater number.
//!
//! | | cycles |
//! |---|---|
//! | most | 1 |
//! | multiply and accumulate | 2 |
//! | divide | 12 |
//! | load or store | 2, with a byte address out of line up to 2 more |
//! | of several registers | 1 and 1 each |
//! | branch that is taken | 1 and the refill of the pipeline, 1 to 3: 3 |
//! | table branch | 2 and the refill |
//! | floating point | 2, since the next one may wait for the result; 4 with accumulation; 15 for division and root |

use rsemu::cpu::arm::v7m::fpisa::{DataOp, FpInsn, UnaryOp};
use rsemu::cpu::arm::v7m::isa::{Insn, MemOffset};

/// Filling the pipeline after a branch.
const REFILL: u64 = 3;

/// What an instruction reads or writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Access {
    pub(crate) at: u32,
    /// Bytes of one of them.
    pub(crate) width: u32,
    pub(crate) count: u32,
    pub(crate) load: bool,
}

/// Where an instruction goes in memory, with the registers before it is executed.
pub(crate) fn access(insn: Insn, registers: &[u32; 16]) -> Option<Access> {
    let register = |number: u8| registers.get(usize::from(number)).copied().unwrap_or(0);
    // As a base, the PC reads four bytes on, and in line.
    let base = |number: u8| if number == 15 { register(15).wrapping_add(4) & !3 } else { register(number) };
    let moved =
        |from: u32, by: u32, add: bool| if add { from.wrapping_add(by) } else { from.wrapping_sub(by) };
    match insn {
        Insn::LoadStore { load, size, rn, offset, index, add, .. } => {
            let by = match offset {
                MemOffset::Imm(by) => by,
                MemOffset::Reg { rm, lsl } => register(rm) << lsl,
            };
            let at = if index { moved(base(rn), by, add) } else { base(rn) };
            Some(Access { at, width: size.bytes(), count: 1, load })
        }
        Insn::LoadLiteral { size, imm, add, .. } => {
            Some(Access { at: moved(base(15), imm, add), width: size.bytes(), count: 1, load: true })
        }
        Insn::LoadStoreDual { load, rn, imm, index, add, .. } => {
            let at = if index { moved(base(rn), imm, add) } else { base(rn) };
            Some(Access { at, width: 4, count: 2, load })
        }
        Insn::LoadStoreMultiple { load, rn, list, before, .. } => {
            let count = list.count_ones();
            Some(Access {
                at: moved(base(rn), if before { 4 * count } else { 0 }, false),
                width: 4,
                count,
                load,
            })
        }
        Insn::Fp(FpInsn::Mem { load, rn, imm, add, double, .. }) => {
            Some(Access { at: moved(base(rn), imm, add), width: 4, count: if double { 2 } else { 1 }, load })
        }
        Insn::Fp(FpInsn::Multi { load, rn, count, add, .. }) => {
            let count = u32::from(count);
            Some(Access {
                at: moved(base(rn), if add { 0 } else { 4 * count }, false),
                width: 4,
                count,
                load,
            })
        }
        _ => None,
    }
}

/// Cycles without wait states; `None` for what no program of ours should have: exceptions, barriers, exclusive access.
pub(crate) fn at_most(insn: Insn, access: Option<Access>, branches: bool) -> Option<u64> {
    let refill = if branches { REFILL } else { 0 };
    let memory = access.map_or(0, |access| {
        let penalty = match (access.width, access.at % access.width.max(1)) {
            (_, 0) => 0,
            (4, 1 | 3) => 2,
            _ => 1,
        };
        1 + u64::from(access.count) + penalty
    });
    Some(match insn {
        Insn::LoadStore { .. }
        | Insn::LoadLiteral { .. }
        | Insn::LoadStoreDual { .. }
        | Insn::LoadStoreMultiple { .. }
        | Insn::Fp(FpInsn::Mem { .. } | FpInsn::Multi { .. }) => memory + refill,
        Insn::Fp(FpInsn::Data { op, .. }) => match op {
            DataOp::Add | DataOp::Sub | DataOp::Mul | DataOp::Nmul => 2,
            DataOp::Div => 15,
            _ => 4,
        },
        Insn::Fp(FpInsn::Unary { op: UnaryOp::Sqrt, .. }) => 15,
        Insn::Fp(_) | Insn::Mul { ra: Some(_), .. } | Insn::MulLong { accumulate: true, .. } => 2,
        Insn::Div { .. } => 12,
        Insn::TableBranch { .. } => 2 + refill,
        Insn::LoadStoreExclusive { .. }
        | Insn::ClearExclusive
        | Insn::Mrs { .. }
        | Insn::Msr { .. }
        | Insn::Cps { .. }
        | Insn::Barrier { .. }
        | Insn::Bkpt { .. }
        | Insn::Svc { .. }
        | Insn::Udf { .. }
        | Insn::Coproc { .. }
        | Insn::Undefined => return None,
        _ => 1 + refill,
    })
}
