//! The chip: core, memories, peripherals, and virtual time that passes with the cycles of what the program does. A core
//! that sleeps lets time jump to the next thing that happens.
//!
//! ```text
//!   Chip::run:  interrupts, next event --> instructions until then, or until an access asks for a look --+
//!                      ^                                                                                 |
//!                      +------------------------------ resets, watchdog <-------------------------------+
//! ```

use crate::adc::Analog;
use crate::bus::{FlashWindow, Shared, Window};
use crate::elf::Image;
use crate::flash::Flash;
use crate::peripherals::{Peripherals, Unmodelled};
use crate::pins::Drive;
use crate::probe::{Latency, Probe};
use crate::quick::{End, Quick, Start};
use crate::rcc::Reset;
use crate::store::Store;
use rsemu::core::device::{Device, ResetKind};
use rsemu::core::space::{AddressSpace, Region, RomStore, RomWrite};
use rsemu::cpu::arm::v7m::sys::{Exception, control, fpccr};
use rsemu::cpu::arm::v7m::{ArmV7m, Config, Regs, xpsr};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use zygote_sim::{Chance, Stuck};

/// 512 KiB of flash.
pub(crate) const FLASH: Range<u32> = 0x0800_0000..0x0808_0000;
/// 128 KiB of RAM.
pub(crate) const RAM: Range<u32> = 0x2000_0000..0x2002_0000;
const PERIPHERALS: Range<u32> = 0x4000_0000..0x5000_0000;
const DEBUG: Range<u32> = 0xe004_2000..0xe004_2400;
/// The page with the chip's number.
const SYSTEM: Range<u32> = 0x1fff_7800..0x1fff_8000;
const UNIQUE_ID: u32 = 0x1fff_7a10;
const NUMBER: &[u8; 12] = b"zygote-emul1";
/// The STM32F4 has 16 levels of priority.
const PRIORITY_BITS: u8 = 4;
/// Interrupts are numbered from here among the exceptions.
const FIRST_INTERRUPT: u16 = 16;
/// Bits of `CONTROL` that ask for an unprivileged thread or a stack of its own.
const OTHER_THREAD: u32 = 3;
/// Traps of `CCR` that change what ordinary instructions do: unaligned access, division by zero.
const TRAPS: u32 = 1 << 3 | 1 << 4;

/// Why the emulation can't go on.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ChipError {
    /// The program needs a peripheral that isn't there.
    #[error(
        "the program {} {address:#010x} (at instruction {pc:#010x}, after {seconds:.6} s), and nothing is modelled there",
        if *write { "writes" } else { "reads" },
        seconds = *ps as f64 / 1e12
    )]
    Unmodelled {
        /// The address.
        address: u32,
        /// It was a write.
        write: bool,
        /// Where the program was by then.
        pc: u32,
        /// When, in picoseconds.
        ps: u64,
    },
    /// The memory map doesn't fit together.
    #[error("the memory of the chip can't be laid out: {what}")]
    Map {
        /// What the emulator's core says.
        what: String,
    },
}

/// An STM32F446 with a program in it.
pub(crate) struct Chip {
    core: ArmV7m,
    shared: Arc<Shared>,
    quick: Quick,
    /// Ordinary instructions take the fast way.
    hurried: bool,
    /// Interrupts whose lines are raised.
    raised: Vec<Exception>,
    instructions: u64,
    probe: Probe,
    /// Handlers that are active, the innermost last.
    handlers: Vec<Exception>,
    /// What the resets were for, and when they were, in picoseconds.
    resets: Vec<(u64, Reset)>,
    hung: Option<Stuck>,
    /// The supply has failed.
    off: bool,
    ram: Arc<Store>,
}

impl Chip {
    /// Just switched on; what its RAM holds then is a matter of chance.
    pub(crate) fn new(image: &Image, seed: u64) -> Result<Self, ChipError> {
        let flash = Arc::new(Store::new(FLASH.len()));
        flash.fill(0, FLASH.end - FLASH.start, u32::MAX);
        for (at, byte) in (0..).zip(&image.flash) {
            flash.write(at, 1, (*byte).into());
        }
        let shared = Arc::new(Shared::new(Peripherals::new(Flash::new(Arc::clone(&flash)))));
        let space = AddressSpace::new("stm32f446", 32);
        let ram = Arc::new(Store::new(RAM.len()));
        let quick = Quick::new(Arc::clone(&flash), Arc::clone(&ram));
        fill_by_chance(&ram, seed);
        let mut system = vec![0xff; SYSTEM.len()];
        let number = (UNIQUE_ID - SYSTEM.start) as usize;
        if let Some(place) = system.get_mut(number..number + NUMBER.len()) {
            place.copy_from_slice(NUMBER);
        }
        let map = |region: Region, base: u32| {
            space.topology().map(region, base.into()).map(drop).map_err(map_error)
        };
        let window = FlashWindow { array: flash, shared: Arc::clone(&shared) };
        map(Region::io("flash", FLASH.len() as u64, Arc::new(window)), FLASH.start)?;
        map(Region::rom("system", Arc::new(RomStore::new(system)), RomWrite::Fault), SYSTEM.start)?;
        map(Region::io("ram", RAM.len() as u64, Arc::<Store>::clone(&ram)), RAM.start)?;
        for (name, range) in [("peripherals", PERIPHERALS), ("debug", DEBUG)] {
            let window = Window { base: range.start, shared: Arc::clone(&shared) };
            map(Region::io(name, range.len() as u64, Arc::new(window)), range.start)?;
        }
        let config = Config::CORTEX_M4F.with_priority_bits(PRIORITY_BITS).with_reset_vtor(FLASH.start);
        let core = ArmV7m::new(config);
        core.attach_space(Arc::new(space));
        Ok(Self {
            core,
            shared,
            quick,
            hurried: true,
            raised: Vec::new(),
            instructions: 0,
            probe: Probe::default(),
            handlers: Vec::new(),
            resets: vec![(0, Reset::Power)],
            hung: None,
            off: false,
            ram,
        })
    }

    /// Virtual time in picoseconds.
    pub(crate) fn ps(&self) -> u64 {
        self.shared.peripherals().clock.ps(self.shared.now())
    }

    /// Instructions executed so far.
    pub(crate) fn instructions(&self) -> u64 {
        self.instructions
    }

    /// What the pins do.
    pub(crate) fn drive(&self) -> Drive {
        self.shared.peripherals().drive
    }

    /// Resets so far, with when they were, in picoseconds.
    pub(crate) fn resets(&self) -> &[(u64, Reset)] {
        &self.resets
    }

    /// How long interrupts have waited, by their numbers.
    pub(crate) fn latencies(&self) -> &BTreeMap<u16, Latency> {
        self.probe.latencies()
    }

    /// When rounds of readings began, in picoseconds, since this was last asked; from the first time on that it is.
    pub(crate) fn take_rounds(&mut self) -> Vec<u64> {
        self.shared.peripherals().rounds.replace(Vec::new()).unwrap_or_default()
    }

    /// What lies at the converter's inputs from now on.
    pub(crate) fn apply(&mut self, analog: Analog) {
        self.shared.peripherals().analog = analog;
    }

    pub(crate) fn press_stop(&mut self, pressed: bool) {
        self.shared.peripherals().press_stop(pressed);
        self.shared.look();
    }

    /// Bytes for the program, which the line begins to carry now.
    pub(crate) fn send(&mut self, bytes: &[u8]) {
        self.shared.peripherals().usart.send(bytes, self.shared.now());
        self.shared.look();
    }

    /// Takes the bytes that the program has sent.
    pub(crate) fn take(&mut self, out: &mut Vec<u8>) {
        self.shared.peripherals().usart.take(out);
    }

    /// Leaves the fast way, to compare it with the core.
    pub(crate) fn do_not_hurry(&mut self) {
        self.hurried = false;
    }

    /// Stops the core between two instructions, or only what is no interrupt; peripherals go on. A reset ends it.
    pub(crate) fn hang(&mut self, stuck: Stuck) {
        self.hung = Some(stuck);
    }

    /// Words of RAM, as they are between two instructions.
    pub(crate) fn words<const N: usize>(&self, address: u32) -> Option<[u32; N]> {
        let mut words = [0; N];
        for (at, word) in (address.checked_sub(RAM.start)?..).step_by(4).zip(&mut words) {
            *word = self.ram.read(at, 4)?;
        }
        Some(words)
    }

    /// Resets the chip.
    pub(crate) fn reset(&mut self, reset: Reset) {
        let now = self.shared.now();
        self.shared.peripherals().reset(reset, now);
        self.quick.hand_over(&self.core);
        self.core.reset(ResetKind::Cold);
        self.hung = None;
        self.handlers.clear();
        self.resets.push((self.ps(), reset));
        self.shared.look();
    }

    /// Off, and on again.
    pub(crate) fn power_cycle(&mut self, seed: u64) {
        fill_by_chance(&self.ram, seed);
        self.off = false;
        self.reset(Reset::Power);
    }

    /// The supply fails in the `count`-th thing that the flash is told to do.
    pub(crate) fn cut_power_in_flash(&mut self, count: u32) {
        self.shared.peripherals().flash.fail_in(count);
    }

    pub(crate) fn is_off(&self) -> bool {
        self.off
    }

    /// Bytes of the flash; none outside of it.
    pub(crate) fn flash(&self, address: u32, count: u32) -> Vec<u8> {
        let array = &self.shared.peripherals().flash.array;
        let from = address.wrapping_sub(FLASH.start);
        (from..from.saturating_add(count)).map_while(|at| Some(array.read(at, 1)?.to_le_bytes()[0])).collect()
    }

    /// Turns bits of a byte of the flash over.
    pub(crate) fn spoil_flash(&mut self, address: u32, bits: u8) {
        self.shared.peripherals().flash.spoil(address, bits);
        self.shared.look();
    }

    /// Lets the program run until a time in picoseconds, or until its outputs change.
    pub(crate) fn run(&mut self, until_ps: u64) -> Result<(), ChipError> {
        let before = self.drive();
        loop {
            let now = self.shared.now();
            let (until, horizon) = self.look(now, until_ps);
            if now >= until || self.drive() != before {
                return Ok(());
            }
            self.shared.set_horizon(horizon);
            self.execute(horizon)?;
        }
    }

    /// Looks at interrupts and the watchdog; the end in cycles, and when next something happens.
    fn look(&mut self, now: u64, until_ps: u64) -> (u64, u64) {
        if self.shared.peripherals().watchdog_due().is_some_and(|due| due <= now) {
            self.reset(Reset::Watchdog);
        }
        self.shared.take_look();
        if self.shared.peripherals().flash.has_failed() && !self.off {
            // Everything loses its power: pins, peripherals, the watchdog; the core stands still.
            self.reset(Reset::Power);
            self.off = true;
            self.hung = Some(Stuck::Everything);
        }
        let mut peripherals = self.shared.peripherals();
        if peripherals.flash.take_changed() {
            self.quick.forget();
        }
        self.raised.clear();
        for (number, raised) in peripherals.interrupts(now) {
            self.core.set_irq(number, raised);
            self.probe.line(number, raised, now);
            if raised {
                self.raised.push(Exception(FIRST_INTERRUPT + number));
            }
        }
        let until = peripherals.clock.cycles(until_ps);
        let next = peripherals.next_event().map_or(until, |next| next.min(until));
        // Something that was due already is served by now.
        (until, next.max(now + 1))
    }

    /// Instructions until `horizon`, or until something has to be looked at.
    fn execute(&mut self, horizon: u64) -> Result<(), ChipError> {
        while self.shared.now() < horizon {
            let ordinary = self.is_ordinary();
            let stuck = match self.hung {
                None => false,
                Some(Stuck::Everything) => true,
                // Until an interrupt of the hardware is due, or one is handled: tasks run in the thread, or in a handler that
                // a program pends by itself.
                Some(Stuck::Tasks) => ordinary.is_some() && !is_of_hardware(self.core.current_exception()),
            };
            if stuck {
                self.shared.set_now(horizon);
                return Ok(());
            }
            if self.hurried
                && let Some(masked) = ordinary
            {
                let mut regs = self.core.regs();
                let start = Start { horizon, masked, may_float: self.may_float(&regs) };
                let end = self.quick.run(&mut regs, &self.core, &self.shared, &start, &mut self.instructions);
                self.core.set_regs(regs);
                if end != End::Core {
                    if self.shared.take_look() {
                        return self.refused();
                    }
                    continue;
                }
            }
            let before = self.core.current_exception();
            self.quick.hand_over(&self.core);
            let cycles = self.step_core();
            self.instructions += 1;
            self.shared.set_now(self.shared.now() + cycles);
            self.note_entry(before);
            // A wait is an instruction of one cycle.
            if cycles == 1 && (self.core.is_asleep() || self.core.is_locked_up()) {
                self.shared.set_now(self.shared.now().max(horizon));
                return self.refused();
            }
            if self.core.reset_requested() {
                self.reset(Reset::Software);
                return Ok(());
            }
            if self.shared.take_look() {
                return self.refused();
            }
        }
        Ok(())
    }

    /// The core is in a state in which ordinary instructions are just that, and no interrupt is due; says whether one
    /// waits to be unmasked.
    fn is_ordinary(&self) -> Option<bool> {
        let priority = self.core.execution_priority();
        let waits = self.core.with_sys(|system| {
            let counts = system.cyccnt_enabled() || system.syst_csr & 1 == 1;
            if counts || system.mpu_ctrl & 1 == 1 || system.ccr & TRAPS != 0 {
                return None;
            }
            let raised =
                self.raised.iter().filter(|line| system.is_enabled(**line) && !system.is_active(**line));
            let raised = raised.map(|line| system.priority_of(*line));
            let pending = system.highest_pending().map(|(_, priority)| priority);
            Some(raised.chain(pending).min())
        })?;
        let regs = self.core.regs();
        let due = waits.is_some_and(|waiting| waiting < priority);
        let ordinary = !due
            && regs.control & OTHER_THREAD == 0
            && !self.core.is_asleep()
            && !self.core.is_locked_up()
            && !self.core.reset_pending();
        ordinary.then_some(waits.is_some() && regs.primask)
    }

    /// The running context uses the floating-point unit already, and no earlier one has registers that are yet to be stacked.
    fn may_float(&self, regs: &Regs) -> bool {
        let context = regs.control & control::FPCA != 0;
        context && self.core.with_sys(|system| system.fpccr & fpccr::LSPACT == 0 && system.fp_enabled(true))
    }

    /// Steps the core. It forgets the state of an IT block when an interrupt comes in the middle of one, and would execute
    /// the rest whatever its condition says: interrupts wait until the block is over, four instructions at most.
    fn step_core(&self) -> u64 {
        let regs = self.core.regs();
        if regs.xpsr & xpsr::IT_MASK == 0 || regs.primask {
            return self.core.step();
        }
        self.core.set_regs(Regs { primask: true, ..regs });
        let cycles = self.core.step();
        self.core.set_regs(Regs { primask: false, ..self.core.regs() });
        cycles
    }

    fn note_entry(&mut self, before: Exception) {
        let handler = self.core.current_exception();
        if handler == before {
            return;
        }
        if let Some(at) = self.handlers.iter().position(|outer| *outer == handler) {
            // Back in a handler that others had interrupted.
            self.handlers.truncate(at + 1);
        } else if handler == Exception::THREAD {
            self.handlers.clear();
        } else {
            // One that is chained to another comes in its place.
            self.handlers.retain(|outer| self.core.with_sys(|system| system.is_active(*outer)));
            self.handlers.push(handler);
            let number = handler.0.wrapping_sub(FIRST_INTERRUPT);
            let clock = self.shared.peripherals().clock;
            self.probe.entered(number, self.shared.now(), |cycles| clock.ps(cycles));
        }
    }

    fn refused(&self) -> Result<(), ChipError> {
        let refused = self.shared.peripherals().refused;
        refused.map_or(Ok(()), |Unmodelled { address, write }| {
            Err(ChipError::Unmodelled { address, write, pc: self.core.pc(), ps: self.ps() })
        })
    }
}

/// A handler of an interrupt that a peripheral can raise.
fn is_of_hardware(handler: Exception) -> bool {
    let number = handler.0.checked_sub(FIRST_INTERRUPT);
    number.is_some_and(|number| Peripherals::INTERRUPTS.contains(&number))
}

/// What memory holds when it gets its power.
fn fill_by_chance(memory: &Store, seed: u64) {
    let mut chance = Chance::new(seed);
    for at in (0..RAM.end - RAM.start).step_by(8) {
        let [a, b, c, d, e, f, g, h] = chance.bits().to_le_bytes();
        memory.write(at, 4, u32::from_le_bytes([a, b, c, d]));
        memory.write(at + 4, 4, u32::from_le_bytes([e, f, g, h]));
    }
}

fn map_error(error: impl std::fmt::Display) -> ChipError {
    ChipError::Map { what: error.to_string() }
}
