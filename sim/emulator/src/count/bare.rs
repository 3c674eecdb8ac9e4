//! A Cortex-M4F with flash, RAM and nothing else, which calls one function of a program at a time and counts what that takes.
//!
//! Three counts: instructions; cycles at the most, as [`super::cycles`] has them; and cycles from a flash that answers five wait
//! states late whenever instructions come from another line of 16 bytes, or a constant is read, as that of an STM32F446 above 150 MHz
//! does where its accelerator has nothing (RM0390, 3.4).

use super::cycles::{Access, access, at_most};
use super::linked::{FLASH, Line, Linked, RAM};
use rsemu::core::error::Error as SpaceError;
use rsemu::core::space::{AddressSpace, RamStore, Region, RomStore, RomWrite};
use rsemu::cpu::arm::v7m::isa::Insn;
use rsemu::cpu::arm::v7m::{ArmV7m, Config, Regs};
use std::sync::Arc;

/// Bytes of RAM; the stack begins at their end.
const RAM_BYTES: u32 = 128 * 1024;
/// Where a function returns to: outside of all memory.
const RETURN: u32 = 0x1000_0000;
/// No function runs for longer.
const MOST: u64 = 10_000_000;
const WAIT_STATES: u64 = 5;
const FLASH_LINE: u32 = 16;

/// Why a call has no end, or no count.
#[derive(Debug, thiserror::Error)]
pub enum BareError {
    /// Memory that can't be laid out.
    #[error("no memory: {0:?}")]
    Memory(SpaceError),
    /// An address outside of RAM, or a fault in the program.
    #[error("exception {exception} at {pc:#010x} in {function}")]
    Fault {
        /// Its number.
        exception: u16,
        /// The instruction that it came from.
        pc: u32,
        /// Where that is.
        function: String,
    },
    /// It runs too long.
    #[error("{function} goes on after {MOST} instructions")]
    Endless {
        /// Where it still is.
        function: String,
    },
    /// An instruction that no core should have.
    #[error("{insn:?} at {pc:#010x} has no count of cycles")]
    Uncounted {
        /// What.
        insn: Insn,
        /// Where.
        pc: u32,
    },
    /// The stack has grown into the statics.
    #[error("the stack takes {bytes} bytes and meets the statics in {function}")]
    Stack {
        /// So far.
        bytes: u32,
        /// Who took the last of them.
        function: String,
    },
    /// Bytes that aren't in RAM.
    #[error("{bytes} bytes at {at:#010x} aren't in RAM")]
    NotInRam {
        /// Where.
        at: u32,
        /// How many.
        bytes: usize,
    },
}

/// What one call took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Taken {
    /// Instructions executed.
    pub instructions: u64,
    /// Cycles at the most, from memory without wait states.
    pub cycles: u64,
    /// Cycles at the most, from flash whose accelerator has nothing.
    pub cycles_from_flash: u64,
    /// Bytes of stack.
    pub stack: u32,
}

impl Taken {
    /// The greater of each.
    #[must_use]
    pub fn most(self, other: Self) -> Self {
        Self {
            instructions: self.instructions.max(other.instructions),
            cycles: self.cycles.max(other.cycles),
            cycles_from_flash: self.cycles_from_flash.max(other.cycles_from_flash),
            stack: self.stack.max(other.stack),
        }
    }
}

/// A processor with a program.
#[derive(Debug)]
pub struct Bare {
    cpu: ArmV7m,
    ram: Arc<RamStore>,
    linked: Linked,
    /// The instruction at each half-word of flash, decoded when it first runs.
    lines: Vec<Option<Line>>,
}

impl Bare {
    /// With all of RAM zero.
    ///
    /// # Errors
    /// No memory.
    pub fn new(linked: Linked) -> Result<Self, BareError> {
        let ram = Arc::new(RamStore::new(u64::from(RAM_BYTES)));
        let rom = Arc::new(RomStore::from_slice(&linked.flash));
        let space = AddressSpace::new("bare", 32);
        {
            let mut topology = space.topology();
            topology
                .map(Region::rom("flash", rom, RomWrite::Ignore), u64::from(FLASH))
                .map_err(BareError::Memory)?;
            topology.map(Region::ram("ram", Arc::clone(&ram)), u64::from(RAM)).map_err(BareError::Memory)?;
        }
        let cpu = ArmV7m::new(Config::CORTEX_M4F);
        cpu.attach_space(Arc::new(space));
        // The reset sequence finds no vectors, which doesn't matter: every call sets all registers.
        cpu.step();
        // Coprocessors 10 and 11, the floating-point unit, are for everyone.
        cpu.with_sys(|sys| sys.cpacr = 0xf << 20);
        let lines = vec![None; linked.flash.len().div_ceil(2)];
        Ok(Self { cpu, ram, linked, lines })
    }

    /// The program.
    pub fn linked(&self) -> &Linked {
        &self.linked
    }

    /// Writes RAM.
    ///
    /// # Errors
    /// Not in RAM.
    pub fn write(&self, at: u32, bytes: &[u8]) -> Result<(), BareError> {
        let written = self.ram.write_at(u64::from(at.wrapping_sub(RAM)), bytes);
        written.map_err(|_| BareError::NotInRam { at, bytes: bytes.len() })
    }

    /// Reads RAM.
    ///
    /// # Errors
    /// Not in RAM.
    pub fn read(&self, at: u32, bytes: &mut [u8]) -> Result<(), BareError> {
        let read = self.ram.read_at(u64::from(at.wrapping_sub(RAM)), bytes);
        read.map_err(|_| BareError::NotInRam { at, bytes: bytes.len() })
    }

    /// Calls the function at `entry` with two words, and runs it to its end.
    ///
    /// # Errors
    /// A fault, no end, no stack left, or an instruction that can't be counted.
    pub fn call(&mut self, entry: u32, arguments: [u32; 2]) -> Result<Taken, BareError> {
        let top = RAM + RAM_BYTES;
        let mut before = Regs { msp: top, ..Regs::new() };
        let [first, second] = arguments;
        before.r = [first, second, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, top, RETURN | 1, entry & !1];
        self.cpu.set_regs(before);

        let (mut taken, mut stalls, mut flash_line) = (Taken::default(), 0, None);
        while pc(&before) != RETURN {
            let line = self.line(pc(&before));
            self.cpu.step();
            let after = self.cpu.regs();
            if after.exception().0 != 0 || self.cpu.is_locked_up() {
                let (exception, function) = (after.exception().0, self.function(line.at));
                return Err(BareError::Fault { exception, pc: line.at, function });
            }

            let access = access(line.insn, &before.r);
            let branches = pc(&after) != line.at + line.size;
            let cycles = at_most(line.insn, access, branches);
            taken.cycles += cycles.ok_or(BareError::Uncounted { insn: line.insn, pc: line.at })?;
            taken.instructions += 1;
            stalls += new_lines(&mut flash_line, line) + constants(access);
            taken.stack = taken.stack.max(top - after.msp);
            if after.msp < self.linked.statics_end {
                return Err(BareError::Stack { bytes: taken.stack, function: self.function(line.at) });
            }
            if taken.instructions > MOST {
                return Err(BareError::Endless { function: self.function(line.at) });
            }
            before = after;
        }
        taken.cycles_from_flash = taken.cycles + stalls * WAIT_STATES;
        Ok(taken)
    }

    fn line(&mut self, at: u32) -> Line {
        let Some(known) = self.lines.get_mut((at.wrapping_sub(FLASH) / 2) as usize) else {
            return self.linked.line(at);
        };
        *known.get_or_insert_with(|| self.linked.line(at))
    }

    fn function(&self, at: u32) -> String {
        self.linked.function_at(at).map_or_else(|| format!("{at:#010x}"), |function| function.name.clone())
    }
}

fn pc(registers: &Regs) -> u32 {
    let [.., pc] = registers.r;
    pc
}

/// Lines of flash that an instruction is fetched from and the one before it wasn't.
fn new_lines(current: &mut Option<u32>, line: Line) -> u64 {
    let (first, last) = (line.at / FLASH_LINE, (line.at + line.size - 1) / FLASH_LINE);
    let fetched = u64::from(*current != Some(first)) + u64::from(last != first);
    *current = Some(last);
    fetched
}

/// Reads of constants: one each, wherever they lie.
fn constants(access: Option<Access>) -> u64 {
    let from_flash = access.filter(|access| access.load && (FLASH..RAM).contains(&access.at));
    from_flash.map_or(0, |access| u64::from(access.count))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BX_LR: u16 = 0x4770;

    fn call(code: &[u16]) -> Result<Taken, BareError> {
        let mut bare = Bare::new(Linked::of_code(&[("it", code)])).unwrap();
        bare.call(FLASH, [RAM, 7])
    }

    #[test]
    fn an_addition_and_a_return_take_five_cycles_and_one_line_of_flash() {
        let taken = call(&[0x1840, BX_LR]).unwrap();
        assert_eq!(
            taken,
            Taken { instructions: 2, cycles: 1 + 4, cycles_from_flash: 5 + WAIT_STATES, stack: 0 }
        );
    }

    #[test]
    fn a_frame_is_seen_and_what_is_pushed_costs_a_cycle_each() {
        // push {r4, lr}; sub sp, #16; add sp, #16; pop {r4, pc}
        let taken = call(&[0xb510, 0xb084, 0xb004, 0xbd10]).unwrap();
        assert_eq!((taken.stack, taken.cycles), (24, 3 + 1 + 1 + 6));
    }

    #[test]
    fn a_constant_is_read_late_and_a_static_is_not() {
        // ldr r2, [pc, #0]; bx lr; the constant
        let from_flash = call(&[0x4a00, BX_LR, 1, 0]).unwrap();
        // ldr r2, [r0, #0]; bx lr
        let from_ram = call(&[0x6802, BX_LR]).unwrap();
        assert_eq!(from_flash.cycles, from_ram.cycles);
        assert_eq!(from_flash.cycles_from_flash, from_ram.cycles_from_flash + WAIT_STATES);
    }

    #[test]
    fn what_a_function_writes_is_read_back() {
        // str r1, [r0, #0]; bx lr
        let mut bare = Bare::new(Linked::of_code(&[("it", &[0x6001, BX_LR])])).unwrap();
        bare.call(FLASH, [RAM + 8, 0x0102_0304]).unwrap();
        let mut bytes = [0; 4];
        bare.read(RAM + 8, &mut bytes).unwrap();
        assert_eq!(bytes, [4, 3, 2, 1]);
    }

    #[test]
    fn a_fault_and_a_loop_without_end_are_told() {
        // ldr r2, [r1, #0] from address 7, where nothing is
        assert!(matches!(call(&[0x680a, BX_LR]), Err(BareError::Fault { pc: FLASH, .. })));
        // b .
        assert!(matches!(call(&[0xe7fe]), Err(BareError::Endless { .. })));
    }
}
