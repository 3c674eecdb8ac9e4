//! Sequences that nobody thought of: the fuzz corpus, random ones, and random changes to those that took longer than any before.

use crate::call::CHANNELS;
use crate::host::{BUFFER, Event, Host};
use crate::pair::{Pair, PairError};
use crate::worst::{self, RUN, STEPS, Shape, arm, pass, request, start, steps, upload};
use std::fs;
use std::path::Path;
use zygote_protocol::{Command, FrameKind};
use zygote_sim::Chance;

const KINDS: [FrameKind; 9] = [
    FrameKind::Hello,
    FrameKind::HelloReply,
    FrameKind::Data,
    FrameKind::Ack,
    FrameKind::Nack,
    FrameKind::Urgent,
    FrameKind::UrgentAck,
    FrameKind::Telemetry,
    FrameKind::Reset,
];
/// Events of a random sequence.
const LENGTH: usize = 40;

/// Plays so many sequences, each a change of one that took longest or a new one.
pub(crate) fn run(pair: &mut Pair, sequences: usize, seed: u64) -> Result<(), PairError> {
    let mut chance = Chance::new(seed);
    let mut pool: Vec<Vec<Event>> = worst::sequences().into_iter().map(|(_, events)| events).collect();
    for number in 0..sequences {
        let events = match chance.below(3) {
            0 => random(&mut chance),
            _ => changed(&mut chance, &pool),
        };
        pair.sequence = format!("random sequence {number}");
        let before = longest(pair);
        Host::new(pair)?.play(&events)?;
        if longest(pair) != before {
            pool.push(events);
        }
    }
    Ok(())
}

fn longest(pair: &Pair) -> Vec<u64> {
    pair.most.values().map(|most| most.taken.cycles_from_flash).collect()
}

/// Every file of a folder, as the fuzz target for the core reads it: `fuzz/bodies/core.rs` has the table.
pub(crate) fn corpus(pair: &mut Pair, folder: &Path) -> std::io::Result<Result<usize, PairError>> {
    let mut files = fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    files.sort_by_key(fs::DirEntry::path);
    for file in &files {
        pair.sequence = format!("corpus {}", file.file_name().to_string_lossy());
        let events = events(&fs::read(file.path())?);
        if let Err(error) = Host::new(pair).and_then(|mut host| host.play(&events)) {
            return Ok(Err(error));
        }
    }
    Ok(Ok(files.len()))
}

fn events(mut data: &[u8]) -> Vec<Event> {
    std::iter::from_fn(|| event(&mut data)).collect()
}

fn event(data: &mut &[u8]) -> Option<Event> {
    Some(match byte(data)? % 6 {
        0 => Event::Raw("any bytes", bytes(data)?),
        1 => {
            let kind = *KINDS.get(usize::from(byte(data)?) % KINDS.len())?;
            Event::Frame { kind, session: byte(data)?.into(), seq: byte(data)?, payload: bytes(data)? }
        }
        2 => pass(word(data)? % 2_000 / 5, 5),
        3 => {
            let (first, second) = (word(data)?, word(data)?);
            // The stop button of that rig is left alone here: `worst` presses it.
            byte(data)?;
            Event::Readings(Some(std::array::from_fn(|at| if at % 2 == 0 { first } else { second })))
        }
        4 => Event::Payload(bytes(data)?),
        _ => Event::Hello(byte(data)?.into()),
    })
}

fn byte(data: &mut &[u8]) -> Option<u8> {
    let (first, rest) = data.split_first()?;
    *data = rest;
    Some(*first)
}

fn word(data: &mut &[u8]) -> Option<u16> {
    Some(u16::from_le_bytes([byte(data)?, byte(data)?]))
}

fn bytes(data: &mut &[u8]) -> Option<Vec<u8>> {
    let length = usize::from(byte(data)?).min(data.len());
    let (front, rest) = data.split_at_checked(length)?;
    *data = rest;
    Some(front.to_vec())
}

fn random(chance: &mut Chance) -> Vec<Event> {
    let mut events = if chance.happens(0.7) { start(shape(chance)) } else { vec![Event::Hello(1)] };
    for _ in 0..LENGTH {
        let next = any(chance);
        events.push(next);
    }
    events
}

fn changed(chance: &mut Chance, pool: &[Vec<Event>]) -> Vec<Event> {
    let mut events = pool.get(chance.below(pool.len())).cloned().unwrap_or_default();
    for _ in 0..=chance.below(4) {
        let at = chance.below(events.len().max(1));
        match chance.below(4) {
            0 => events.truncate(at),
            1 if at < events.len() => _ = events.remove(at),
            2 => {
                let again = upload(&steps(shape(chance)));
                events.splice(at.min(events.len())..at.min(events.len()), again);
            }
            _ => events.insert(at.min(events.len()), any(chance)),
        }
    }
    events
}

fn shape(chance: &mut Chance) -> Shape {
    let currents = [0, 100, 1_000, 1_500, 2_000, 3_000, 10_000, 50_000];
    Shape {
        first: chance.below(STEPS + 1),
        current: chance.one_of(&currents).unwrap_or(0),
        hold_current: chance.one_of(&currents).unwrap_or(0),
        lead: chance.below(3),
    }
}

fn any(chance: &mut Chance) -> Event {
    let small = |chance: &mut Chance, limit: usize| u16::try_from(chance.below(limit)).unwrap_or(0);
    match chance.below(12) {
        0 | 1 => pass(small(chance, 20), small(chance, 6)),
        2 => pass(small(chance, 100), small(chance, 50)),
        3 => Event::Hello(u32::from(small(chance, 4))),
        4 | 5 => request(command(chance)),
        6 => Event::Requests((0..=chance.below(8)).map(|_| command(chance)).collect()),
        7 => Event::Listens(chance.happens(0.5)),
        8 => {
            let any = std::array::from_fn::<u16, CHANNELS, _>(|_| small(chance, 4_096));
            Event::Readings(chance.happens(0.3).then_some(any))
        }
        9 => {
            let payload = (0..chance.below(64)).map(|_| chance.bits().to_le_bytes()[0]).collect();
            let kind = chance.one_of(&KINDS).unwrap_or(FrameKind::Ack);
            Event::Frame {
                kind,
                session: u32::from(small(chance, 3)),
                seq: chance.bits().to_le_bytes()[0],
                payload,
            }
        }
        10 => Event::Raw("any bytes", (0..BUFFER).map(|_| chance.bits().to_le_bytes()[0] & 3).collect()),
        _ => match chance.below(3) {
            0 => Event::Reset,
            1 => Event::StopButton(chance.happens(0.3)),
            _ => Event::Current(u32::from(small(chance, 2)) * 60_000),
        },
    }
}

fn command(chance: &mut Chance) -> Command {
    match chance.below(9) {
        0 => Command::Status,
        1 => Command::Progress { first: 0 },
        2 => Command::LastRun,
        3 => Command::Commit,
        4 | 5 => arm(),
        6 => Command::Start { run: RUN },
        7 => Command::Disarm,
        _ => Command::Clear,
    }
}
