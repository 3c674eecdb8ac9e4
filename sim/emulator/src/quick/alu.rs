//! Arithmetic of the instruction set (ARM DDI 0403, A2.2.1 and A7.4): sums with carry and overflow, shifts with the bit
//! that falls out.

use rsemu::cpu::arm::v7m::isa::{Shift, ShiftType};

/// A sum with its carry and its overflow.
pub(super) fn sum(a: u32, b: u32, carry: bool) -> (u32, bool, bool) {
    let wide = u64::from(a) + u64::from(b) + u64::from(carry);
    let result = low_word(wide);
    (result, wide >> 32 != 0, ((a ^ result) & (b ^ result)) >> 31 != 0)
}

/// A value shifted, and the last bit that fell out; the carry as it was where none did.
pub(super) fn shifted(kind: ShiftType, value: u32, by: u32, carry: bool) -> (u32, bool) {
    if kind == ShiftType::Rrx {
        return (value >> 1 | u32::from(carry) << 31, value & 1 != 0);
    }
    if by == 0 {
        return (value, carry);
    }
    match kind {
        // One place further than 32 leaves nothing.
        ShiftType::Lsl => {
            let wide = u64::from(value).checked_shl(by).unwrap_or(0);
            (low_word(wide), wide >> 32 & 1 != 0 && by <= 32)
        }
        ShiftType::Lsr => {
            let wide = (u64::from(value) << 1).checked_shr(by).unwrap_or(0);
            (low_word(wide >> 1), wide & 1 != 0)
        }
        ShiftType::Asr => {
            let wide = (i64::from(value.cast_signed()) << 1) >> by.min(33);
            (low_word((wide >> 1).cast_unsigned()), wide & 1 != 0)
        }
        ShiftType::Ror | ShiftType::Rrx => {
            let result = value.rotate_right(by & 31);
            (result, result >> 31 != 0)
        }
    }
}

/// A value shifted by what stands in the instruction.
pub(super) fn shifted_by(shift: Shift, value: u32, carry: bool) -> (u32, bool) {
    if shift.is_none() { (value, carry) } else { shifted(shift.ty, value, shift.amount.into(), carry) }
}

#[expect(clippy::cast_possible_truncation, reason = "the low half is what is asked for")]
fn low_word(wide: u64) -> u32 {
    wide as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_know_their_carry_and_their_overflow() {
        assert_eq!(sum(u32::MAX, 1, false), (0, true, false));
        assert_eq!(sum(0x7fff_ffff, 1, false), (0x8000_0000, false, true));
        assert_eq!(sum(5, !3, true), (2, true, false), "a difference is a sum with the inverse");
        assert_eq!(sum(3, !5, true), (0xffff_fffe, false, false));
        assert_eq!(sum(0x8000_0000, !1, true), (0x7fff_ffff, true, true));
    }

    #[test]
    fn shifts_by_a_whole_word_and_more_leave_the_right_carry() {
        assert_eq!(shifted(ShiftType::Lsl, 0x8000_0001, 1, false), (2, true));
        assert_eq!(shifted(ShiftType::Lsl, 1, 32, false), (0, true));
        assert_eq!(shifted(ShiftType::Lsl, u32::MAX, 33, true), (0, false));
        assert_eq!(shifted(ShiftType::Lsl, u32::MAX, 255, true), (0, false));
        assert_eq!(shifted(ShiftType::Lsr, 3, 1, false), (1, true));
        assert_eq!(shifted(ShiftType::Lsr, 0x8000_0000, 32, false), (0, true));
        assert_eq!(shifted(ShiftType::Lsr, u32::MAX, 33, true), (0, false));
        assert_eq!(shifted(ShiftType::Asr, 0x8000_0000, 255, false), (u32::MAX, true));
        assert_eq!(shifted(ShiftType::Asr, 0x8000_0002, 2, false), (0xe000_0000, true));
        assert_eq!(shifted(ShiftType::Ror, 1, 32, false), (1, false));
        assert_eq!(shifted(ShiftType::Ror, 3, 1, false), (0x8000_0001, true));
        assert_eq!(shifted(ShiftType::Rrx, 1, 1, true), (0x8000_0000, true));
        assert_eq!(shifted(ShiftType::Lsl, 7, 0, true), (7, true));
    }
}
