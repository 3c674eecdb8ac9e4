//! The core on the emulated processor: its entries, and what goes in and out of them.

use crate::call::{BYTES, CHANNELS, Call};
use std::mem::offset_of;
use zygote_core::Inputs;
use zygote_emulator::count::{Bare, BareError, Linked, LinkedError, Taken};
use zygote_protocol::{Micros, RETAINED_WORDS};

/// What a board calls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Entry {
    New,
    HandleBytes,
    Tick,
    PollTransmit,
    Apply,
    Keep,
}

impl Entry {
    pub(crate) const ALL: [Self; 6] =
        [Self::New, Self::HandleBytes, Self::Tick, Self::PollTransmit, Self::Apply, Self::Keep];

    pub(crate) const fn symbol(self) -> &'static str {
        match self {
            Self::New => "figures_new",
            Self::HandleBytes => "figures_handle_bytes",
            Self::Tick => "figures_tick",
            Self::PollTransmit => "figures_poll_transmit",
            Self::Apply => "figures_apply",
            Self::Keep => "figures_keep",
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::New => "new, after a reset",
            Self::HandleBytes => "handle_bytes, 128 bytes",
            Self::Tick => "tick",
            Self::PollTransmit => "poll_transmit",
            Self::Apply => "outputs, dead_line, poll_timeout",
            Self::Keep => "snapshot, as kept",
        }
    }
}

/// What the actuators are to do, and when the board is to look again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Applied {
    pub(crate) heaters: [u16; CHANNELS],
    pub(crate) servos: [u16; CHANNELS],
    pub(crate) springs: [u16; CHANNELS],
    pub(crate) main_switch: bool,
    pub(crate) changes: u32,
    pub(crate) dead_line: u64,
    pub(crate) due: u64,
}

pub(crate) type Words = [u32; RETAINED_WORDS];

/// The core's RAM and the processor that works on it.
pub(crate) struct Target {
    bare: Bare,
    core: u32,
    call: u32,
    entries: [u32; Entry::ALL.len()],
}

impl Target {
    pub(crate) fn new(linked: Linked) -> Result<Self, TargetError> {
        let mut entries = [0; Entry::ALL.len()];
        for (place, entry) in entries.iter_mut().zip(Entry::ALL) {
            *place = linked.function(entry.symbol())?;
        }
        let core = linked.static_named("FIGURES_CORE")?.start;
        let call = linked.static_named("FIGURES_CALL")?.start;
        Ok(Self { bare: Bare::new(linked)?, core, call, entries })
    }

    pub(crate) fn reset(&mut self, now: Micros, boot: u32, kept: &Words) -> Result<Taken, TargetError> {
        self.put(offset_of!(Call, boot), &boot.to_le_bytes())?;
        let bytes: Vec<u8> = kept.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.put(offset_of!(Call, retained), &bytes)?;
        self.run(Entry::New, now)
    }

    pub(crate) fn handle_bytes(&mut self, now: Micros, bytes: &[u8]) -> Result<Taken, TargetError> {
        let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        self.put(offset_of!(Call, length), &length.to_le_bytes())?;
        self.put(offset_of!(Call, bytes), bytes)?;
        self.run(Entry::HandleBytes, now)
    }

    pub(crate) fn tick(&mut self, now: Micros, inputs: &Inputs<'_>) -> Result<Taken, TargetError> {
        let bytes: Vec<u8> = inputs.thermistors.iter().flat_map(|counts| counts.to_le_bytes()).collect();
        self.put(offset_of!(Call, thermistors), &bytes)?;
        self.put(offset_of!(Call, supply), &inputs.supply.0.to_le_bytes())?;
        self.put(offset_of!(Call, current), &inputs.current.0.to_le_bytes())?;
        self.put(offset_of!(Call, stop_pressed), &u32::from(inputs.stop_pressed).to_le_bytes())?;
        self.run(Entry::Tick, now)
    }

    pub(crate) fn poll_transmit(&mut self, now: Micros) -> Result<(Vec<u8>, Taken), TargetError> {
        let taken = self.run(Entry::PollTransmit, now)?;
        let length = usize::try_from(self.word(offset_of!(Call, length))?).unwrap_or(usize::MAX);
        let mut bytes = vec![0; length.min(BYTES)];
        self.get(offset_of!(Call, bytes), &mut bytes)?;
        Ok((bytes, taken))
    }

    pub(crate) fn apply(&mut self, now: Micros) -> Result<(Applied, Taken), TargetError> {
        let taken = self.run(Entry::Apply, now)?;
        let applied = Applied {
            heaters: self.halves(offset_of!(Call, heaters))?,
            servos: self.halves(offset_of!(Call, servos))?,
            springs: self.halves(offset_of!(Call, springs))?,
            main_switch: self.word(offset_of!(Call, main_switch))? != 0,
            changes: self.word(offset_of!(Call, changes))?,
            dead_line: self.long(offset_of!(Call, dead_line))?,
            due: self.long(offset_of!(Call, due))?,
        };
        Ok((applied, taken))
    }

    pub(crate) fn keep(&mut self, now: Micros) -> Result<(Words, Taken), TargetError> {
        let taken = self.run(Entry::Keep, now)?;
        let mut words = [0; RETAINED_WORDS];
        for (at, word) in words.iter_mut().enumerate() {
            *word = self.word(offset_of!(Call, retained) + 4 * at)?;
        }
        Ok((words, taken))
    }

    fn run(&mut self, entry: Entry, now: Micros) -> Result<Taken, TargetError> {
        self.put(offset_of!(Call, now), &now.0.to_le_bytes())?;
        let places = Entry::ALL.iter().zip(self.entries);
        let at = places.into_iter().find(|(other, _)| **other == entry).map_or(0, |(_, at)| at);
        Ok(self.bare.call(at, [self.core, self.call])?)
    }

    fn place(&self, offset: usize) -> u32 {
        self.call.saturating_add(u32::try_from(offset).unwrap_or(u32::MAX))
    }

    fn put(&self, offset: usize, bytes: &[u8]) -> Result<(), TargetError> {
        Ok(self.bare.write(self.place(offset), bytes)?)
    }

    fn get(&self, offset: usize, bytes: &mut [u8]) -> Result<(), TargetError> {
        Ok(self.bare.read(self.place(offset), bytes)?)
    }

    fn word(&self, offset: usize) -> Result<u32, TargetError> {
        let mut bytes = [0; 4];
        self.get(offset, &mut bytes)?;
        Ok(u32::from_le_bytes(bytes))
    }

    fn long(&self, offset: usize) -> Result<u64, TargetError> {
        let mut bytes = [0; 8];
        self.get(offset, &mut bytes)?;
        Ok(u64::from_le_bytes(bytes))
    }

    fn halves(&self, offset: usize) -> Result<[u16; CHANNELS], TargetError> {
        let mut bytes = [0; 2 * CHANNELS];
        self.get(offset, &mut bytes)?;
        let mut halves = [0; CHANNELS];
        for (half, bytes) in halves.iter_mut().zip(bytes.as_chunks::<2>().0) {
            *half = u16::from_le_bytes(*bytes);
        }
        Ok(halves)
    }
}

/// Why the core can't be called.
#[derive(Debug, thiserror::Error)]
pub(crate) enum TargetError {
    #[error(transparent)]
    Linked(#[from] LinkedError),
    #[error(transparent)]
    Bare(#[from] BareError),
}
