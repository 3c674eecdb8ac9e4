//! The board: the emulated chip, its sensors and its actuators on the plant, on one virtual clock.
//!
//! ```text
//!   host bytes --> USART2 -- the board's own program -- timers, pins --> Plant
//!                                     ^                                    |
//!                                     +---------------- ADC <--------------+      every SLICE, and at each change
//! ```

use crate::adc::Analog;
use crate::chip::{Chip, ChipError};
use crate::elf::Image;
use crate::pins::{Drive, HEATERS, SPRINGS};
use crate::probe::Latency;
use crate::rcc::Reset;
use core::time::Duration;
use std::collections::BTreeMap;
use zygote_core::ADC_FULL_SCALE;
use zygote_protocol::{Micros, RETAINED_WORDS, ResetCause, Retained, Snapshot};
use zygote_sim::plant::{Config as PlantConfig, Drive as PlantDrive, Plant, PlantError, Readings};
use zygote_sim::{Device, Stuck};

/// Longest time between two looks at the plant: what the program converts is at most so old.
const SLICE_PS: u64 = 1_000_000_000;
const MICROSECOND_PS: u64 = 1_000_000;

/// Full scale of the supply's divider (100 kOhm above 10 kOhm) and of the shunt amplifier (100 mV/A), at 3.3 V.
const SUPPLY_FULL_SCALE_MV: u32 = 36_300;
const CURRENT_FULL_SCALE_MA: u32 = 33_000;

/// Why the board can't go on.
#[derive(Debug, thiserror::Error)]
pub enum EmulatorError {
    /// The chip can't.
    #[error(transparent)]
    Chip(#[from] ChipError),
    /// The plant can't be, or can't do that.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// The rig needs more than the board has.
    #[error("the rig has {got} {kind}, the board has {most}")]
    Channels {
        /// Of what.
        kind: &'static str,
        /// How many the rig has.
        got: usize,
        /// How many the board has.
        most: usize,
    },
}

/// A board that runs its own program.
pub struct EmulatedBoard {
    chip: Chip,
    plant: Plant,
    /// Time up to which the plant has been worked out, in picoseconds.
    plant_ps: u64,
    retained: Option<u32>,
    snapshot: Option<Snapshot>,
    /// The pins changed at the end of the latest step of time; and in it, behind a change at its beginning, the program kept what
    /// it had decided.
    pins_changed: bool,
    kept_behind_pins: bool,
    /// What was kept before the latest reset, and the number of resets by then.
    stale: (Option<Snapshot>, usize),
}

impl EmulatedBoard {
    /// A board with a program on a plant, just switched on. The seed is that of what its memory holds by then.
    ///
    /// # Errors
    /// [`EmulatorError`] for a plant that can't be, or that the board has no pins for.
    pub fn new(image: &Image, plant: &PlantConfig, seed: u64) -> Result<Self, EmulatorError> {
        let most = |kind, got: usize, most| {
            if got <= most { Ok(()) } else { Err(EmulatorError::Channels { kind, got, most }) }
        };
        most("heaters", plant.heaters.len(), HEATERS)?;
        most("springs", plant.springs.len(), SPRINGS)?;
        most("servos", plant.servos.len(), Drive::OFF.servos.len())?;
        let mut board = Self {
            chip: Chip::new(image, seed)?,
            plant: Plant::new(plant)?,
            plant_ps: 0,
            retained: image.retained,
            snapshot: None,
            pins_changed: false,
            kept_behind_pins: false,
            stale: (None, 1),
        };
        board.sense();
        Ok(board)
    }

    /// Virtual time since the board was switched on.
    pub fn now(&self) -> Micros {
        Micros(self.chip.ps() / MICROSECOND_PS)
    }

    /// The physics, as they truly are.
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// The physics, to break something.
    pub fn plant_mut(&mut self) -> &mut Plant {
        &mut self.plant
    }

    /// What the pins do.
    pub fn drive(&self) -> Drive {
        self.chip.drive()
    }

    /// Instructions that the program has executed.
    pub fn instructions(&self) -> u64 {
        self.chip.instructions()
    }

    /// How long interrupts have waited for their handlers, by their numbers in the reference manual.
    pub fn latencies(&self) -> &BTreeMap<u16, Latency> {
        self.chip.latencies()
    }

    /// When the program began to read its sensors, in picoseconds, each time since this was last asked; from the first time
    /// on that it is.
    pub fn take_rounds(&mut self) -> Vec<u64> {
        self.chip.take_rounds()
    }

    /// From now on every instruction goes through the core's full model. Several times slower, and the same in every
    /// cycle, which is what it is for.
    pub fn do_not_hurry(&mut self) {
        self.chip.do_not_hurry();
    }

    /// Presses or releases the emergency stop button.
    pub fn press_stop(&mut self, pressed: bool) {
        self.chip.press_stop(pressed);
    }

    /// Times and causes of the resets so far, switching on included.
    pub fn resets(&self) -> impl Iterator<Item = (Micros, ResetCause)> {
        self.chip.resets().iter().map(|(ps, reset)| {
            let cause = match reset {
                Reset::Power => ResetCause::Power,
                Reset::Pin => ResetCause::Pin,
                Reset::Software => ResetCause::Software,
                Reset::Watchdog => ResetCause::Watchdog,
            };
            (Micros(ps / MICROSECOND_PS), cause)
        })
    }

    /// Pulls the reset pin for a moment.
    pub fn reset(&mut self) {
        self.chip.reset(Reset::Pin);
    }

    /// Stops the program from now on, until a reset.
    pub fn hang(&mut self, stuck: Stuck) {
        self.chip.hang(stuck);
    }

    /// What the program says that it is doing: the snapshot that it keeps for after a reset, from its RAM. Nothing before it
    /// has kept one.
    pub fn snapshot(&self) -> Option<&Snapshot> {
        self.snapshot.as_ref()
    }

    /// The latest step of time began with a change of the pins, and the program kept the decision behind it only then: what
    /// [`Self::snapshot`] says now held from the beginning.
    pub fn kept_behind_pins(&self) -> bool {
        self.kept_behind_pins
    }

    /// Switches the board off and on again: only the flash keeps what it held. The seed is that of what the memory holds then.
    pub fn power_cycle(&mut self, seed: u64) {
        self.chip.power_cycle(seed);
        self.snapshot = None;
        self.stale = (None, self.chip.resets().len());
    }

    /// The supply fails while the program does its `count`-th thing with the flash from now on, 1 the next: programming a word,
    /// or erasing a sector. That is left half done, and the board is off until [`Self::power_cycle`].
    pub fn cut_power_in_flash(&mut self, count: u32) {
        self.chip.cut_power_in_flash(count);
    }

    /// The supply has failed, and the board is off.
    pub fn is_off(&self) -> bool {
        self.chip.is_off()
    }

    /// Bytes of the flash from an address on; none where there is no flash.
    pub fn flash(&self, address: u32, count: u32) -> Vec<u8> {
        self.chip.flash(address, count)
    }

    /// Turns bits of a byte of the flash over, as age or radiation would.
    pub fn spoil_flash(&mut self, address: u32, bits: u8) {
        self.chip.spoil_flash(address, bits);
    }

    /// Takes bytes from the host, now.
    pub fn receive(&mut self, bytes: &[u8]) {
        self.chip.send(bytes);
    }

    /// Appends the bytes that the program has sent.
    pub fn transmit(&mut self, out: &mut Vec<u8>) {
        self.chip.take(out);
    }

    /// Moves time on to `until`, or less far.
    ///
    /// # Errors
    /// [`EmulatorError`].
    pub fn advance(&mut self, until: Micros) -> Result<(), EmulatorError> {
        let drive = self.chip.drive();
        let until_ps = (until.0 * MICROSECOND_PS).min(self.plant_ps + SLICE_PS);
        self.chip.run(until_ps)?;
        let now_ps = self.chip.ps();
        // Whole nanoseconds, so that no time is lost between two steps of the plant.
        let span = Duration::from_nanos((now_ps - self.plant_ps) / 1000);
        self.plant_ps += u64::try_from(span.as_nanos()).unwrap_or(u64::MAX) * 1000;
        self.plant.advance(
            span,
            &PlantDrive {
                heaters: &drive.heaters,
                servos: &drive.servos,
                springs: &drive.springs,
                main_switch: drive.main_switch,
            },
        )?;
        self.sense();
        let kept = self.recall();
        self.kept_behind_pins = self.pins_changed && kept;
        self.pins_changed = self.chip.drive() != drive;
        Ok(())
    }

    /// A snapshot that is just being written is not whole: the one before it stands until it is. After a reset it is the
    /// one from before for a moment. Whether there is a new one.
    fn recall(&mut self) -> bool {
        let resets = self.chip.resets().len();
        if self.stale.1 != resets {
            self.stale = (self.snapshot.take(), resets);
        }
        let words = self.retained.and_then(|address| self.chip.words::<RETAINED_WORDS>(address));
        let kept = words.and_then(|words| Retained::from_words(&words).recall());
        let is_new = kept.is_some() && kept != self.stale.0 && kept != self.snapshot;
        if is_new {
            self.snapshot = kept;
        }
        is_new
    }

    fn sense(&mut self) {
        let Readings { thermistors, supply, current } = self.plant.sense();
        // A multiplexer input with nothing on it is pulled up.
        let mut analog = Analog { thermistors: [ADC_FULL_SCALE; HEATERS], ..Analog::default() };
        for (place, reading) in analog.thermistors.iter_mut().zip(thermistors) {
            *place = reading;
        }
        analog.supply = counts(supply.0, SUPPLY_FULL_SCALE_MV);
        analog.current = counts(current.0, CURRENT_FULL_SCALE_MA);
        self.chip.apply(analog);
    }
}

/// What the converter makes of a value.
fn counts(value: u32, full_scale: u32) -> u16 {
    let counts =
        (u64::from(value) * u64::from(ADC_FULL_SCALE) + u64::from(full_scale) / 2) / u64::from(full_scale);
    u16::try_from(counts).map_or(ADC_FULL_SCALE, |counts| counts.min(ADC_FULL_SCALE))
}

impl Device for EmulatedBoard {
    type Error = EmulatorError;

    fn now(&self) -> Micros {
        Self::now(self)
    }

    fn advance(&mut self, until: Micros) -> Result<(), EmulatorError> {
        Self::advance(self, until)
    }

    fn receive(&mut self, bytes: &[u8]) {
        Self::receive(self, bytes);
    }

    fn transmit(&mut self, out: &mut Vec<u8>) {
        Self::transmit(self, out);
    }
}
