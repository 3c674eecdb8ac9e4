//! What an MCU was doing when it was reset: it outlives the reset in memory, and is told on request (S9).

use crate::crc::crc32;
use crate::frame::{decode_payload, encode_payload};
use crate::{Fault, MAX_PAYLOAD, Micros, State, StepState};
use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Steps that a snapshot tells of; of a longer program those beyond count as not started.
pub const SNAPSHOT_STEPS: usize = 512;
/// Two bits a step.
const BYTES: usize = SNAPSHOT_STEPS / 4;

/// An MCU as it stood.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Snapshot {
    /// Its boot id then.
    pub boot: u32,
    /// Its time then.
    pub at: Micros,
    /// What it was doing.
    pub state: State,
    /// The run of its program.
    pub run: Option<u32>,
    /// Why it was in the safe state, if it was.
    pub fault: Option<Fault>,
    /// How many steps its program had.
    pub steps: u16,
    /// Two bits a step, the lowest first: 0 waiting, 1 moving or interrupted, 2 open. What is missing is waiting.
    pub states: Vec<u8, BYTES>,
    /// The session that was open: its hello may still be under way, and isn't to open it again (S11).
    pub session: Option<u32>,
}

impl Snapshot {
    /// A snapshot without its steps.
    pub fn new(boot: u32, at: Micros, state: State, run: Option<u32>, fault: Option<Fault>) -> Self {
        Self { boot, at, state, run, fault, steps: 0, states: Vec::new(), session: None }
    }

    /// Adds the state of the next step.
    pub fn push(&mut self, state: StepState) {
        let (byte, shift) = place(self.steps);
        self.steps = self.steps.saturating_add(1);
        let bits = match state {
            StepState::Waiting => return,
            StepState::Moving | StepState::Interrupted => 1,
            StepState::Opened | StepState::Done => 2,
        };
        while self.states.len() <= byte {
            if self.states.push(0).is_err() {
                return;
            }
        }
        if let Some(states) = self.states.get_mut(byte) {
            *states |= bits << shift;
        }
    }

    /// What had become of a step: Waiting, Interrupted or Done.
    pub fn step(&self, step: u16) -> StepState {
        let (byte, shift) = place(step);
        match self.states.get(byte).map_or(0, |states| states >> shift & 3) {
            0 => StepState::Waiting,
            1 => StepState::Interrupted,
            _ => StepState::Done,
        }
    }
}

/// Words of a [`Retained`].
pub const RETAINED_WORDS: usize = 2 + MAX_PAYLOAD / 4;

/// A snapshot as it lies in memory that a reset leaves alone. Any bytes may be there; those of a snapshot carry a checksum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Retained {
    crc: u32,
    length: u32,
    bytes: [u8; MAX_PAYLOAD],
}

impl Retained {
    /// No snapshot.
    pub const NOTHING: Self = Self { crc: 0, length: 0, bytes: [0; MAX_PAYLOAD] };

    /// A snapshot.
    pub fn new(snapshot: &Snapshot) -> Self {
        let Some(payload) = encode_payload(snapshot) else { return Self::NOTHING };
        let mut bytes = [0; MAX_PAYLOAD];
        for (to, from) in bytes.iter_mut().zip(&payload) {
            *to = *from;
        }
        Self { crc: crc32(&payload), length: u32::try_from(payload.len()).unwrap_or(0), bytes }
    }

    /// As words, for memory that is kept in words; [`Self::from_words`] gives it back.
    pub fn to_words(&self) -> [u32; RETAINED_WORDS] {
        let bytes = self.bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes));
        let mut words = [self.crc, self.length].into_iter().chain(bytes);
        core::array::from_fn(|_| words.next().unwrap_or(0))
    }

    /// Of words from memory, whatever they are.
    pub fn from_words(words: &[u32; RETAINED_WORDS]) -> Self {
        let [crc, length, payload @ ..] = words;
        let mut bytes = [0; MAX_PAYLOAD];
        for (bytes, word) in bytes.as_chunks_mut().0.iter_mut().zip(payload) {
            *bytes = word.to_le_bytes();
        }
        Self { crc: *crc, length: *length, bytes }
    }

    /// The snapshot, if there is one and it is whole.
    pub fn recall(&self) -> Option<Snapshot> {
        let payload = self.bytes.get(..usize::try_from(self.length).ok()?)?;
        if payload.is_empty() || crc32(payload) != self.crc {
            return None;
        }
        decode_payload(payload)
    }
}

/// The byte of a step, and how far up its bits are.
fn place(step: u16) -> (usize, u16) {
    (usize::from(step / 4), step % 4 * 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATES: [StepState; 5] =
        [StepState::Waiting, StepState::Moving, StepState::Opened, StepState::Done, StepState::Interrupted];

    fn snapshot(states: impl Iterator<Item = StepState>) -> Snapshot {
        let mut snapshot = Snapshot::new(1, Micros(2), State::Running, Some(3), None);
        states.for_each(|state| snapshot.push(state));
        snapshot
    }

    #[test]
    fn what_was_pushed_is_told() {
        let snapshot = snapshot(STATES.into_iter().cycle().take(SNAPSHOT_STEPS));
        for (step, state) in (0..).zip(STATES.into_iter().cycle().take(SNAPSHOT_STEPS)) {
            let expected = match state {
                StepState::Waiting => StepState::Waiting,
                StepState::Moving | StepState::Interrupted => StepState::Interrupted,
                StepState::Opened | StepState::Done => StepState::Done,
            };
            assert_eq!(snapshot.step(step), expected, "step {step}");
        }
    }

    #[test]
    fn steps_beyond_its_room_are_counted_and_count_as_waiting() {
        let snapshot = snapshot([StepState::Done].into_iter().cycle().take(SNAPSHOT_STEPS + 10));
        assert_eq!(usize::from(snapshot.steps), SNAPSHOT_STEPS + 10);
        assert_eq!(snapshot.step(511), StepState::Done);
        assert_eq!(snapshot.step(512), StepState::Waiting);
    }

    #[test]
    fn a_retained_one_is_recalled_and_a_damaged_one_is_not() {
        let snapshot = snapshot(STATES.into_iter());
        let retained = Retained::new(&snapshot);
        assert_eq!(retained.recall(), Some(snapshot));
        assert_eq!(Retained::from_words(&retained.to_words()), retained);
        assert_eq!(Retained::NOTHING.recall(), None);
        let length = usize::try_from(retained.length).unwrap();
        for bit in 0..8 * length {
            let mut damaged = retained;
            damaged.bytes[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(damaged.recall(), None, "bit {bit}");
        }
        for length in [0, retained.length + 1, 241, u32::MAX] {
            assert_eq!(Retained { length, ..retained }.recall(), None, "length {length}");
        }
    }

    #[test]
    fn its_words_are_no_more_than_its_bytes_need() {
        assert_eq!(4 * RETAINED_WORDS, size_of::<Retained>());
    }

    #[test]
    fn a_full_one_fits_a_frame() {
        let reply = crate::Report::Response(crate::Response {
            id: u16::MAX,
            result: Ok(crate::Reply::LastRun(Some(Snapshot {
                boot: u32::MAX,
                at: Micros(u64::MAX),
                run: Some(u32::MAX),
                steps: u16::MAX,
                session: Some(u32::MAX),
                fault: Some(Fault {
                    code: crate::FaultCode::SensorFrozen,
                    at: Micros(u64::MAX),
                    step: Some(u16::MAX),
                    channel: Some(u16::MAX),
                    value: i64::MIN,
                    limit: i64::MIN,
                }),
                ..snapshot([StepState::Done].into_iter().cycle().take(SNAPSHOT_STEPS))
            }))),
        });
        assert!(crate::frame::encode_payload(&reply).is_some());
    }
}
