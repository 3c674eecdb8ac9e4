//! Who calls whom in a program, read off its instructions: whether anything calls itself again, whether a call goes where the
//! instructions don't say, and how deep the stack can get.

use super::linked::{Line, Linked, LinkedError, Place};
use rsemu::cpu::arm::v7m::fpisa::FpInsn;
use rsemu::cpu::arm::v7m::isa::{DpOp, Insn, MemOffset, Operand};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

const SP: u8 = 13;
const LR: u8 = 14;
const PC: u8 = 15;
/// The frame pointer, where the compiler uses one.
const FP: u8 = 7;

/// Why the stack has no bound.
#[derive(Debug, thiserror::Error)]
pub enum CallsError {
    /// A function that calls itself, by others or not.
    #[error("recursion: {}", .0.join(" calls "))]
    Recursion(Vec<String>),
    /// A call or jump whose goal is in a register.
    #[error("{function} goes where a register says, at {at:#010x}")]
    Indirect {
        /// Who.
        function: String,
        /// The instruction.
        at: u32,
    },
    /// A branch into no function.
    #[error("{function} branches from {at:#010x} to {to:#010x}, where no function is")]
    Nowhere {
        /// Who.
        function: String,
        /// The instruction.
        at: u32,
        /// Its goal.
        to: u32,
    },
    /// The stack pointer comes from elsewhere than a constant.
    #[error("{function} takes an unknown number of bytes of stack, at {at:#010x}")]
    UnknownFrame {
        /// Who.
        function: String,
        /// The instruction.
        at: u32,
    },
    /// No such function.
    #[error(transparent)]
    Linked(#[from] LinkedError),
}

/// A function as its instructions have it.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Body {
    name: String,
    /// Everything that is ever taken off the stack pointer, at most.
    frame: u32,
    callees: BTreeSet<u32>,
}

/// The deepest that a stack can get.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Deepest {
    /// Bytes.
    pub bytes: u32,
    /// Each function on the way with the bytes of its own frame, the outermost first.
    pub path: Vec<(String, u32)>,
}

/// Everything that can be reached from some entries.
#[derive(Debug, Clone)]
pub struct Calls {
    bodies: BTreeMap<u32, Body>,
}

impl Calls {
    /// Follows every call and branch from the functions of these names on.
    ///
    /// # Errors
    /// An indirect call, a branch to nowhere, or a frame of unknown size. Recursion is found by [`Self::deepest`].
    pub fn from(linked: &Linked, entries: &[&str]) -> Result<Self, CallsError> {
        let mut open = entries.iter().map(|entry| linked.function(entry)).collect::<Result<Vec<_>, _>>()?;
        let mut bodies = BTreeMap::new();
        while let Some(start) = open.pop() {
            let Some(function) = linked.function_at(start) else { continue };
            if let Entry::Vacant(place) = bodies.entry(function.start) {
                let body = place.insert(body(linked, function)?);
                open.extend(&body.callees);
            }
        }
        Ok(Self { bodies })
    }

    /// How many functions there are.
    pub fn functions(&self) -> usize {
        self.bodies.len()
    }

    /// The deepest stack from an entry on.
    ///
    /// # Errors
    /// Recursion, with who calls whom.
    pub fn deepest(&self, linked: &Linked, entry: &str) -> Result<Deepest, CallsError> {
        let mut known = BTreeMap::new();
        self.visit(linked.function(entry)?, &mut Vec::new(), &mut known)?;
        let mut path = Vec::new();
        let mut next = Some(linked.function(entry)?);
        let bytes = next.and_then(|entry| known.get(&entry)).map_or(0, |(bytes, _)| *bytes);
        while let Some(at) = next {
            if let Some(body) = self.bodies.get(&at) {
                path.push((body.name.clone(), body.frame));
            }
            next = known.get(&at).and_then(|(_, deepest)| *deepest);
        }
        Ok(Deepest { bytes, path })
    }

    /// Depth first; `known` has the depth from each function on, and the callee that it comes from.
    fn visit(
        &self,
        at: u32,
        above: &mut Vec<u32>,
        known: &mut BTreeMap<u32, (u32, Option<u32>)>,
    ) -> Result<u32, CallsError> {
        if let Some((bytes, _)) = known.get(&at) {
            return Ok(*bytes);
        }
        let Some(body) = self.bodies.get(&at) else { return Ok(0) };
        let first = above.iter().position(|caller| *caller == at);
        above.push(at);
        if let Some(first) = first {
            let ring = above.iter().skip(first).filter_map(|at| self.bodies.get(at));
            return Err(CallsError::Recursion(ring.map(|body| body.name.clone()).collect()));
        }
        let mut deepest = (0, None);
        for callee in &body.callees {
            let bytes = self.visit(*callee, above, known)?;
            if bytes > deepest.0 {
                deepest = (bytes, Some(*callee));
            }
        }
        above.pop();
        known.insert(at, (body.frame + deepest.0, deepest.1));
        Ok(body.frame + deepest.0)
    }
}

fn body(linked: &Linked, function: &Place) -> Result<Body, CallsError> {
    let mut body = Body { name: function.name.clone(), frame: 0, callees: BTreeSet::new() };
    for line in linked.lines(function) {
        if is_indirect(line.insn) {
            return Err(CallsError::Indirect { function: body.name, at: line.at });
        }
        let Some(bytes) = pushed(line.insn) else {
            return Err(CallsError::UnknownFrame { function: body.name, at: line.at });
        };
        body.frame += bytes;
        if let Some((to, links)) = goal(line)
            && (links || !(function.start..function.start + function.size).contains(&to))
        {
            let Some(callee) = linked.function_at(to) else {
                return Err(CallsError::Nowhere { function: body.name, at: line.at, to });
            };
            body.callees.insert(callee.start);
        }
    }
    Ok(body)
}

/// Where a branch goes, and whether it comes back.
fn goal(line: Line) -> Option<(u32, bool)> {
    let from = line.at.wrapping_add(4);
    match line.insn {
        Insn::BranchLink { offset } => Some((from.wrapping_add_signed(offset), true)),
        Insn::Branch { offset, .. } => Some((from.wrapping_add_signed(offset), false)),
        Insn::Cbz { offset, .. } => Some((from.wrapping_add(offset), false)),
        _ => None,
    }
}

/// Goes to an address that the instruction doesn't have: but for returns and table branches, whose goals are in the function.
fn is_indirect(insn: Insn) -> bool {
    match insn {
        Insn::Blx { .. } => true,
        Insn::Bx { rm } => rm != LR,
        Insn::LoadStore { load: true, rt: PC, rn, .. } => rn != SP,
        Insn::LoadStoreMultiple { load: true, list, rn, .. } => list & (1 << PC) != 0 && rn != SP,
        Insn::LoadLiteral { rt, .. } => rt == PC,
        Insn::DataProc { op, rd, .. } => rd == PC && !is_compare(op),
        _ => false,
    }
}

/// Comparisons have no destination.
fn is_compare(op: DpOp) -> bool {
    matches!(op, DpOp::Cmp | DpOp::Cmn | DpOp::Tst | DpOp::Teq)
}

/// Bytes that an instruction takes off the stack pointer, 0 for those that give some back; `None` where it doesn't say.
fn pushed(insn: Insn) -> Option<u32> {
    match insn {
        Insn::LoadStoreMultiple { rn: SP, wback: true, before: true, list, .. } => {
            Some(4 * list.count_ones())
        }
        Insn::Fp(FpInsn::Multi { rn: SP, writeback: true, add: false, count, .. }) => {
            Some(4 * u32::from(count))
        }
        Insn::LoadStore { rn: SP, wback: true, add: false, offset, .. } => match offset {
            MemOffset::Imm(bytes) => Some(bytes),
            MemOffset::Reg { .. } => None,
        },
        Insn::LoadStoreDual { rn: SP, wback: true, add: false, imm, .. } => Some(imm),
        Insn::DataProc { op, rd: SP, rn, operand, .. } if !is_compare(op) => match (op, rn, operand) {
            (DpOp::Sub, SP, Operand::Imm { value, .. }) => Some(value),
            // Back to where the frame was.
            (DpOp::Add, SP, Operand::Imm { .. }) | (DpOp::Sub, FP, Operand::Imm { .. }) => Some(0),
            _ => None,
        },
        _ => Some(0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::count::Bare;
    use crate::count::linked::FLASH;

    const PUSH_R4_LR: u16 = 0xb510;
    const POP_R4_PC: u16 = 0xbd10;

    /// `bl`, so many bytes on from its own address.
    fn bl(by: i32) -> [u16; 2] {
        let bits = (by - 4).cast_unsigned();
        let part = |shift: u32, mask: u32| u16::try_from(bits >> shift & mask).unwrap();
        [0xf000 | part(31, 1) << 10 | part(12, 0x3ff), 0xf800 | part(1, 0x7ff)]
    }

    /// `outer` takes 24 bytes and calls what lies 12 bytes on from its start, or before it.
    fn outer(by: i32) -> [u16; 6] {
        let [first, second] = bl(by);
        // sub sp, #16; bl; add sp, #16
        [PUSH_R4_LR, 0xb084, first, second, 0xb004, POP_R4_PC]
    }

    #[test]
    fn the_deepest_stack_is_the_one_that_is_seen() {
        let linked = Linked::of_code(&[("outer", &outer(8)), ("inner", &[PUSH_R4_LR, POP_R4_PC])]);
        let deepest = Calls::from(&linked, &["outer"]).unwrap().deepest(&linked, "outer").unwrap();
        assert_eq!(deepest, Deepest { bytes: 32, path: vec![("outer".into(), 24), ("inner".into(), 8)] });
        assert_eq!(Bare::new(linked).unwrap().call(FLASH, [0, 0]).unwrap().stack, 32);
    }

    #[test]
    fn recursion_is_found_with_who_calls_whom() {
        let linked = Linked::of_code(&[("outer", &outer(8)), ("inner", &outer(-16))]);
        let error = Calls::from(&linked, &["outer"]).unwrap().deepest(&linked, "outer").unwrap_err();
        assert_eq!(error.to_string(), "recursion: outer calls inner calls outer");
    }

    #[test]
    fn a_call_by_a_register_is_found() {
        // blx r3
        let linked = Linked::of_code(&[("it", &[PUSH_R4_LR, 0x4798, POP_R4_PC])]);
        let error = Calls::from(&linked, &["it"]).unwrap_err();
        assert!(matches!(error, CallsError::Indirect { at, .. } if at == FLASH + 2), "{error}");
    }

    #[test]
    fn a_frame_of_unknown_size_and_a_call_to_nowhere_are_found() {
        // mov sp, r3
        let linked = Linked::of_code(&[("it", &[0x469d, 0x4770])]);
        assert!(matches!(Calls::from(&linked, &["it"]), Err(CallsError::UnknownFrame { .. })));
        let linked = Linked::of_code(&[("it", &outer(400))]);
        assert!(matches!(Calls::from(&linked, &["it"]), Err(CallsError::Nowhere { .. })));
    }
}
