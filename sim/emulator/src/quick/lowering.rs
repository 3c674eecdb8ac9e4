//! The brief form of decoded instructions, for those that have one ([`super::brief`]).

use super::brief::{Cell, Op};
use crate::chip::FLASH;
use crate::store::Store;
use rsemu::cpu::arm::v7m::isa::{
    BitfieldOp, Cond, DpOp, ExtendOp, Insn, MemOffset, Operand, Shift, ShiftType, Size,
};

const NOT_EQUAL: Cond = Cond(1);

/// The brief form, for those that have one.
pub(super) fn brief(instruction: &Insn, pc: u32, flash: &Store) -> Option<Op> {
    let here = pc.wrapping_add(4);
    Some(match *instruction {
        Insn::DataProc { op, s, rd, rn, operand } => return data(op, s, rd, rn, operand),
        Insn::Adr { rd, imm, add } if rd < 15 => {
            let base = here & !3;
            Op::Value { rd, value: if add { base.wrapping_add(imm) } else { base.wrapping_sub(imm) } }
        }
        Insn::MovImm16 { top: false, rd, imm } if rd < 15 => Op::Value { rd, value: imm.into() },
        Insn::MovImm16 { top: true, rd, imm } if rd < 15 => Op::Top { rd, value: u32::from(imm) << 16 },
        Insn::Branch { cond: None, offset } => Op::Branch { target: here.wrapping_add_signed(offset) },
        Insn::Branch { cond: Some(cond), offset } if cond.0 < 16 => {
            let target = here.wrapping_add_signed(offset);
            match spins(cond, target, pc, flash) {
                Some(rd) => Op::Spin { rd, target },
                None => Op::BranchIf { cond, target },
            }
        }
        Insn::BranchLink { offset } => Op::Call { target: here.wrapping_add_signed(offset) },
        Insn::Bx { rm } if rm < 15 => Op::Return { rm },
        Insn::Blx { rm } if rm < 15 => Op::CallBy { rm },
        Insn::Cbz { nonzero: false, rn, offset } if rn < 15 => {
            Op::IfZero { rn, target: here.wrapping_add(offset) }
        }
        Insn::Cbz { nonzero: true, rn, offset } if rn < 15 => {
            Op::IfNotZero { rn, target: here.wrapping_add(offset) }
        }
        Insn::LoadStore {
            load, size, signed: false, rt, rn, offset, index: true, add, wback: false, ..
        } if rt < 15 && rn < 15 => {
            let cell = match size {
                Size::Byte => Cell::Byte,
                Size::Half => Cell::Half,
                Size::Word => Cell::Word,
            };
            match (offset, load) {
                (MemOffset::Imm(by), true) => Op::Load { cell, rt, rn, offset: signed(by, add) },
                (MemOffset::Imm(by), false) => Op::Store { cell, rt, rn, offset: signed(by, add) },
                (MemOffset::Reg { rm, lsl }, true) if add && rm < 15 => {
                    Op::LoadIndexed { cell, rt, rn, rm, lsl }
                }
                (MemOffset::Reg { rm, lsl }, false) if add && rm < 15 => {
                    Op::StoreIndexed { cell, rt, rn, rm, lsl }
                }
                (MemOffset::Reg { .. }, _) => return None,
            }
        }
        Insn::LoadLiteral { size: Size::Word, signed: false, rt, imm, add } if rt < 15 => {
            let address = (here & !3).wrapping_add(signed(imm, add));
            let offset = address.checked_sub(FLASH.start)?;
            Op::Literal { rd: rt, value: flash.read(offset, 4)? }
        }
        Insn::LoadStoreMultiple { load: true, rn, list, wback, before } if rn < 15 => {
            Op::LoadBlock { rn, wback, before, list }
        }
        Insn::LoadStoreMultiple { load: false, rn, list, wback, before } if rn < 15 && list >> 15 == 0 => {
            Op::StoreBlock { rn, wback, before, list }
        }
        Insn::Mul { rd, rn, rm, ra: None, s: false, .. } if rd < 15 && rn < 15 && rm < 15 => {
            Op::Multiply { rd, rn, rm }
        }
        Insn::Extend { op: ExtendOp::Uxtb, rd, rn: 15, rm, rotate: 0 } if rd < 15 && rm < 15 => {
            Op::AndValue { rd, rn: rm, value: 0xff }
        }
        Insn::Extend { op: ExtendOp::Uxth, rd, rn: 15, rm, rotate: 0 } if rd < 15 && rm < 15 => {
            Op::AndValue { rd, rn: rm, value: 0xffff }
        }
        Insn::Bitfield { op: BitfieldOp::Ubfx, rd, rn, lsb, width } if rd < 15 && rn < 15 => {
            Op::Bits { rd, rn, low: lsb & 31, mask: u32::MAX >> (32 - u32::from(width).clamp(1, 32)) }
        }
        _ => return None,
    })
}

/// The register that a loop of two instructions counts down by one, if it does nothing else.
fn spins(cond: Cond, target: u32, pc: u32, flash: &Store) -> Option<u8> {
    let at = (target.checked_sub(FLASH.start)? / 2) as usize;
    let back = pc.wrapping_sub(target);
    if cond != NOT_EQUAL || !matches!(back, 2 | 4) {
        return None;
    }
    match super::decoded(flash, at) {
        (
            Insn::DataProc { op: DpOp::Sub, s: true, rd, rn, operand: Operand::Imm { value: 1, .. } },
            length,
        ) if length == back && rd == rn && rd < 13 => Some(rd),
        _ => None,
    }
}

fn signed(by: u32, add: bool) -> u32 {
    if add { by } else { by.wrapping_neg() }
}

/// Arithmetic with a register or a value.
fn data(op: DpOp, flags: bool, rd: u8, rn: u8, operand: Operand) -> Option<Op> {
    let moves = matches!(op, DpOp::Mov | DpOp::Mvn);
    if !op.is_test() && rd >= 15 || !moves && rn >= 15 {
        return None;
    }
    match operand {
        Operand::Imm { value, carry } => value_op(op, flags, rd, rn, value, carry.is_some()),
        Operand::Reg { rm, shift } if rm < 15 => register_op(op, flags, rd, rn, rm, shift),
        Operand::Reg { .. } => None,
    }
}

/// `carries`: the value's own carry goes to the flags of what is no sum.
fn value_op(op: DpOp, flags: bool, rd: u8, rn: u8, value: u32, carries: bool) -> Option<Op> {
    Some(match (op, flags) {
        (DpOp::Mov, false) => Op::Value { rd, value },
        (DpOp::Mov, true) if !carries => Op::ValueFlags { rd, value },
        (DpOp::Mvn, false) => Op::Value { rd, value: !value },
        (DpOp::Add, false) => Op::AddValue { rd, rn, value },
        (DpOp::Sub, false) => Op::AddValue { rd, rn, value: value.wrapping_neg() },
        (DpOp::Add, true) => Op::AddValueFlags { rd, rn, value },
        (DpOp::Sub, true) => Op::LessValueFlags { rd, rn, inverse: !value },
        (DpOp::Cmp, true) => Op::CompareValue { rn, inverse: !value },
        (DpOp::And, false) => Op::AndValue { rd, rn, value },
        (DpOp::Bic, false) => Op::AndValue { rd, rn, value: !value },
        (DpOp::Orr, false) => Op::OrValue { rd, rn, value },
        (DpOp::Tst, true) if !carries => Op::TestValue { rn, value },
        _ => return None,
    })
}

fn register_op(op: DpOp, flags: bool, rd: u8, rn: u8, rm: u8, shift: Shift) -> Option<Op> {
    let plain = shift.is_none();
    // The carry comes into what is shifted.
    if shift.ty == ShiftType::Rrx {
        return None;
    }
    Some(match (op, flags) {
        (DpOp::Mov, false) if plain => Op::Copy { rd, rm },
        (DpOp::Mov, false) => Op::Shifted { rd, rm, shift },
        (DpOp::Mov, true) => Op::ShiftedFlags { rd, rm, shift },
        (DpOp::Add, false) => Op::Add { rd, rn, rm, shift },
        (DpOp::Add, true) if plain => Op::AddFlags { rd, rn, rm },
        (DpOp::Sub, false) if plain => Op::Less { rd, rn, rm },
        (DpOp::Sub, true) if plain => Op::LessFlags { rd, rn, rm },
        (DpOp::Cmp, true) if plain => Op::Compare { rn, rm },
        (DpOp::And, false) => Op::And { rd, rn, rm, shift },
        (DpOp::Orr, false) => Op::Or { rd, rn, rm, shift },
        (DpOp::Eor, false) => Op::Xor { rd, rn, rm, shift },
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_touches_the_program_counter_or_needs_the_carry_has_no_brief_form() {
        let flash = Store::new(16);
        let shift = Shift { ty: ShiftType::Rrx, amount: 1 };
        for (op, rd, rn, operand) in [
            (DpOp::Mov, 15, 0, Operand::Reg { rm: 14, shift: Shift { ty: ShiftType::Lsl, amount: 0 } }),
            (DpOp::Add, 0, 15, Operand::Imm { value: 4, carry: None }),
            (DpOp::Mov, 0, 0, Operand::Reg { rm: 1, shift }),
            (DpOp::Adc, 0, 1, Operand::Imm { value: 4, carry: None }),
        ] {
            let instruction = Insn::DataProc { op, s: false, rd, rn, operand };
            assert_eq!(brief(&instruction, FLASH.start, &flash), None, "{instruction:?}");
        }
    }
}
