//! One core twice: on the emulated processor, counted, and on this machine. Both must do the same to the bit.

use crate::call::CHANNELS;
use crate::config::{config, kept};
use crate::target::{Applied, Entry, Target, TargetError, Words};
use std::collections::BTreeMap;
use zygote_core::{Core, Duty, Inputs};
use zygote_emulator::count::{Linked, Taken};
use zygote_protocol::{MAX_ENCODED, Micros, RETAINED_WORDS, Retained, State};

type NativeCore = Core<CHANNELS, CHANNELS, CHANNELS, { 3 * CHANNELS }>;

/// Why a sequence can't go on.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PairError {
    #[error(transparent)]
    Target(#[from] TargetError),
    #[error("{what} at {now}: {target} on the emulated processor, {native} on this machine", now = .now.0)]
    Differs { what: &'static str, now: Micros, target: String, native: String },
}

/// What a call is counted under.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Kind {
    pub(crate) entry: Entry,
    /// What it was called with.
    pub(crate) what: &'static str,
    /// Something might be energised: Armed or Running.
    pub(crate) energised: bool,
}

/// The most that was seen of a kind of call, and what it was about.
#[derive(Debug, Clone, Default)]
pub(crate) struct Most {
    /// Each the most for itself.
    pub(crate) taken: Taken,
    /// What was going on when the most cycles were taken.
    pub(crate) during: String,
}

/// Both cores, and what was seen of the emulated one.
pub(crate) struct Pair {
    native: NativeCore,
    target: Target,
    kept: Words,
    changes: u32,
    energised: bool,
    state: State,
    pub(crate) most: BTreeMap<Kind, Most>,
    /// The sequence that is played.
    pub(crate) sequence: String,
    /// Runs that came to their end: without any, nothing that was seen is the worst.
    pub(crate) finished: u64,
    pub(crate) calls: u64,
    pub(crate) instructions: u64,
}

impl Pair {
    pub(crate) fn new(linked: Linked) -> Result<Self, PairError> {
        let mut pair = Self {
            native: Core::new(config(0), Micros(0), None),
            target: Target::new(linked)?,
            kept: [0; RETAINED_WORDS],
            changes: 0,
            energised: false,
            state: State::Idle,
            most: BTreeMap::new(),
            sequence: String::new(),
            finished: 0,
            calls: 0,
            instructions: 0,
        };
        pair.power_off(Micros(0), 1)?;
        Ok(pair)
    }

    /// Both start, and nothing was kept.
    pub(crate) fn power_off(&mut self, now: Micros, boot: u32) -> Result<(), PairError> {
        self.kept = [0; RETAINED_WORDS];
        self.reset(now, boot)
    }

    /// Both start with what they have kept.
    pub(crate) fn reset(&mut self, now: Micros, boot: u32) -> Result<(), PairError> {
        self.native = Core::new(config(boot), now, Retained::from_words(&self.kept).recall());
        self.native.restore(kept());
        let taken = self.target.reset(now, boot, &self.kept)?;
        self.note(Entry::New, "", taken);
        (self.changes, self.energised) = (0, false);
        self.apply(now)?;
        Ok(())
    }

    pub(crate) fn handle_bytes(
        &mut self,
        now: Micros,
        what: &'static str,
        bytes: &[u8],
    ) -> Result<Applied, PairError> {
        self.native.handle_bytes(now, bytes);
        let taken = self.target.handle_bytes(now, bytes)?;
        self.note(Entry::HandleBytes, what, taken);
        self.apply(now)
    }

    pub(crate) fn tick(&mut self, now: Micros, inputs: &Inputs<'_>) -> Result<Applied, PairError> {
        self.native.tick(now, inputs);
        let taken = self.target.tick(now, inputs)?;
        self.note(Entry::Tick, "", taken);
        self.apply(now)
    }

    /// The next frame; empty when nothing is due.
    pub(crate) fn poll_transmit(&mut self, now: Micros) -> Result<Vec<u8>, PairError> {
        let mut out = [0; MAX_ENCODED];
        let length = self.native.poll_transmit(now, &mut out);
        let (bytes, taken) = self.target.poll_transmit(now)?;
        self.note(Entry::PollTransmit, "", taken);
        same("a frame", now, bytes.as_slice(), out.get(..length).unwrap_or_default())?;
        self.apply(now)?;
        Ok(bytes)
    }

    /// What a board does after each call.
    fn apply(&mut self, now: Micros) -> Result<Applied, PairError> {
        let (applied, taken) = self.target.apply(now)?;
        self.note(Entry::Apply, "", taken);
        let outputs = self.native.outputs();
        let native = Applied {
            heaters: outputs.heaters.map(Duty::per_mille),
            servos: outputs.servos.map(|pulse| pulse.map_or(0, |pulse| pulse.0)),
            springs: outputs.springs.map(u16::from),
            main_switch: outputs.main_switch,
            changes: self.native.changes(),
            dead_line: self.native.dead_line().map_or(u64::MAX, |at| at.0),
            due: self.native.poll_timeout(now).map_or(u64::MAX, |at| at.0),
        };
        same("what is applied", now, &applied, &native)?;
        let state = self.native.state();
        if applied.changes != self.changes {
            self.changes = applied.changes;
            let (words, taken) = self.target.keep(now)?;
            self.note(Entry::Keep, "", taken);
            same("what is kept", now, &words, &Retained::new(&self.native.snapshot(now)).to_words())?;
            self.kept = words;
        }
        if state != self.state {
            self.state = state;
            self.finished += u64::from(state == State::Finished);
        }
        self.energised = applied.dead_line != u64::MAX;
        Ok(applied)
    }

    fn note(&mut self, entry: Entry, what: &'static str, taken: Taken) {
        self.calls += 1;
        self.instructions += taken.instructions;
        let most = self.most.entry(Kind { entry, what, energised: self.energised }).or_default();
        if taken.cycles_from_flash > most.taken.cycles_from_flash {
            most.during.clone_from(&self.sequence);
        }
        most.taken = most.taken.most(taken);
    }
}

fn same<T: std::fmt::Debug + PartialEq + ?Sized>(
    what: &'static str,
    now: Micros,
    target: &T,
    native: &T,
) -> Result<(), PairError> {
    if target == native {
        return Ok(());
    }
    Err(PairError::Differs { what, now, target: format!("{target:?}"), native: format!("{native:?}") })
}
