//! S11, looked at exhaustively: two real links over a line that may drop, damage, repeat and reorder frames, with
//! timeouts, a host that reconnects and an MCU that is reset. Every state that can come of so many commands and so many
//! mishaps is visited, breadth first, and in none has a command been executed twice or before an earlier one.
//!
//! ```text
//!   host: commands 0, 1, .. -- Link == frames under way ==> Link -- executed: [..]  :MCU
//!                               <== frames under way ==
//! ```
//!
//! That the search can fail is shown with four ends that are wrong on purpose.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::HashSet;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use zygote_protocol::{
    Decoder, FrameKind, Header, Link, MAX_ENCODED, Micros, Received, decode_payload, encode, granted_session,
};

/// Frames that may be under way in one direction.
const ROOM: usize = 3;
/// More states than a test of some seconds can visit.
const TOO_MANY: usize = 600_000;
/// Longer than any timeout of a link.
const LONG: u64 = 2_000_000;

type Frame = Vec<u8>;

/// What may happen, and how often.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Budget {
    commands: u8,
    /// Frames dropped, damaged or repeated.
    mishaps: u8,
    /// Frames that overtake another.
    overtakings: u8,
    timeouts: u8,
    reconnects: u8,
    resets: u8,
    /// A reset MCU loses what was on its line.
    reset_clears_line: bool,
}

/// What is wrong on purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Mutant {
    None,
    /// The receiver doesn't look at numbers.
    TakesRepetitions,
    /// The MCU opens any session that it is asked for, also one that was replaced.
    OpensReplaced,
    /// Both ends use the number of the hello, whatever the boot.
    GrantsWhatIsAsked,
    /// The host sends the commands of the old session, for which it has no answer, again in the new one.
    ResendsAfterReconnect,
}

#[derive(Clone, Hash)]
struct World {
    host: Link,
    mcu: Link,
    to_mcu: Vec<Frame>,
    to_host: Vec<Frame>,
    /// Clocks, which only timeouts move on.
    host_now: u64,
    mcu_now: u64,
    left: Budget,
    next_command: u8,
    answered: Vec<u8>,
    /// By the MCU, over all its boots.
    executed: Vec<u8>,
    boot: u8,
    known_boot: Option<u8>,
    session: u32,
    is_open: bool,
}

/// A step from one state to the next.
#[derive(Debug, Clone, Copy)]
enum Event {
    Submit,
    HostSpeaks,
    McuSpeaks,
    ToMcu(Fate, usize),
    ToHost(Fate, usize),
    HostTimeout,
    McuTimeout,
    Reconnect,
    Reset,
}

/// What becomes of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fate {
    Arrives,
    ArrivesAndStays,
    IsDamaged,
    IsDropped,
}

impl World {
    fn new(left: Budget) -> Self {
        let mut world = Self {
            host: Link::new(Micros(0)),
            mcu: Link::new(Micros(0)),
            to_mcu: Vec::new(),
            to_host: Vec::new(),
            host_now: 0,
            mcu_now: 0,
            left,
            next_command: 0,
            answered: Vec::new(),
            executed: Vec::new(),
            boot: 1,
            known_boot: None,
            session: 1,
            is_open: false,
        };
        world.host.send_hello(1, &0_u8).unwrap();
        world
    }

    fn events(&self) -> Vec<Event> {
        let mut events = vec![Event::HostSpeaks, Event::McuSpeaks];
        if self.is_open && self.next_command < self.left.commands {
            events.push(Event::Submit);
        }
        let fates = |make: fn(Fate, usize) -> Event, count: usize, events: &mut Vec<Event>| {
            for at in 0..count {
                if at > 0 && self.left.overtakings == 0 {
                    break;
                }
                events.push(make(Fate::Arrives, at));
                if self.left.mishaps > 0 {
                    events.push(make(Fate::ArrivesAndStays, at));
                    if at == 0 {
                        events.extend([make(Fate::IsDamaged, 0), make(Fate::IsDropped, 0)]);
                    }
                }
            }
        };
        fates(Event::ToMcu, self.to_mcu.len(), &mut events);
        fates(Event::ToHost, self.to_host.len(), &mut events);
        if self.left.timeouts > 0 {
            events.extend([Event::HostTimeout, Event::McuTimeout]);
        }
        if self.left.reconnects > 0 {
            events.push(Event::Reconnect);
        }
        if self.left.resets > 0 {
            events.push(Event::Reset);
        }
        events
    }

    /// The state after an event.
    fn after(&self, event: Event, mutant: Mutant) -> Self {
        let mut world = self.clone();
        match event {
            Event::Submit => {
                if world.host.send(&world.next_command).is_ok() {
                    world.next_command += 1;
                }
            }
            Event::HostSpeaks => speak(&mut world.host, world.host_now, &mut world.to_mcu),
            Event::McuSpeaks => speak(&mut world.mcu, world.mcu_now, &mut world.to_host),
            Event::ToMcu(fate, at) => {
                let frame = meet(&mut world.to_mcu, &mut world.left, fate, at);
                world.mcu_hears(&frame, mutant);
            }
            Event::ToHost(fate, at) => {
                let frame = meet(&mut world.to_host, &mut world.left, fate, at);
                world.host_hears(&frame, mutant);
            }
            Event::HostTimeout => {
                world.left.timeouts -= 1;
                world.host_now += LONG;
                if !world.is_open {
                    world.host.send_hello(world.session, &0_u8).unwrap();
                }
            }
            Event::McuTimeout => {
                world.left.timeouts -= 1;
                world.mcu_now += LONG;
            }
            Event::Reconnect => world.reconnect(mutant),
            Event::Reset => {
                world.left.resets -= 1;
                world.boot += 1;
                world.mcu = Link::new(Micros(world.mcu_now));
                if world.left.reset_clears_line {
                    world.to_mcu.clear();
                }
            }
        }
        world
    }

    /// The host says hello under another number. What it has no answer for stays open: it may have been executed.
    fn reconnect(&mut self, mutant: Mutant) {
        self.left.reconnects = self.left.reconnects.saturating_sub(1);
        self.session += 1;
        self.is_open = false;
        self.host.close();
        self.host.send_hello(self.session, &0_u8).unwrap();
        if mutant == Mutant::ResendsAfterReconnect {
            self.next_command = u8::try_from(self.answered.len()).unwrap();
        }
    }

    fn mcu_hears(&mut self, frame: &[u8], mutant: Mutant) {
        let frame =
            if mutant == Mutant::TakesRepetitions { renumbered(frame, &self.mcu) } else { frame.to_vec() };
        let mut bytes = frame.as_slice();
        while let Some(received) = self.mcu.receive_with_room(Micros(self.mcu_now), &mut bytes) {
            match received {
                Received::Hello(asked, _) => {
                    let session = granted(asked, self.boot, mutant);
                    let replaced = self.mcu.was_replaced(session) && mutant != Mutant::OpensReplaced;
                    if self.mcu.session() != Some(session) && !replaced {
                        self.mcu.open(session, Micros(self.mcu_now));
                    }
                    self.mcu.send_hello_reply(asked, &self.boot).unwrap();
                }
                Received::Message(payload) => {
                    let command: u8 = decode_payload(payload).unwrap();
                    self.executed.push(command);
                    self.mcu.send(&command).unwrap();
                }
                Received::HelloReply(..) | Received::Urgent(_) | Received::Telemetry(_) | Received::Reset => {
                }
            }
        }
    }

    fn host_hears(&mut self, frame: &[u8], mutant: Mutant) {
        let mut bytes = frame;
        while let Some(received) = self.host.receive(Micros(self.host_now), &mut bytes, true) {
            match received {
                Received::HelloReply(session, payload) if session == self.session => {
                    let boot: u8 = decode_payload(payload).unwrap();
                    if self.is_open && self.known_boot != Some(boot) {
                        // The boot id tells: this session began before the reset.
                        return self.reconnect(mutant);
                    }
                    if !self.is_open {
                        self.is_open = true;
                        self.known_boot = Some(boot);
                        self.host.open(granted(session, boot, mutant), Micros(self.host_now));
                    }
                }
                Received::Message(payload) => self.answered.push(decode_payload(payload).unwrap()),
                Received::Reset => return self.reconnect(mutant),
                Received::HelloReply(..)
                | Received::Hello(..)
                | Received::Urgent(_)
                | Received::Telemetry(_) => {}
            }
        }
    }

    /// What is wrong in this state.
    fn flaw(&self) -> Option<String> {
        let rises = |numbers: &[u8]| numbers.windows(2).all(|pair| matches!(pair, [a, b] if a < b));
        if !rises(&self.executed) {
            return Some(format!("executed {:?}", self.executed));
        }
        if !rises(&self.answered) || !self.answered.iter().all(|answer| self.executed.contains(answer)) {
            return Some(format!("answered {:?}, executed {:?}", self.answered, self.executed));
        }
        None
    }

    fn fingerprint(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.hash(&mut hasher);
        hasher.finish()
    }
}

/// The session that an MCU of this boot opens.
fn granted(asked: u32, boot: u8, mutant: Mutant) -> u32 {
    if mutant == Mutant::GrantsWhatIsAsked { asked } else { granted_session(asked, boot.into()) }
}

/// One frame, where one is due.
fn speak(link: &mut Link, now: u64, line: &mut Vec<Frame>) {
    let mut frame = [0; MAX_ENCODED];
    // A full line holds its sender up, as a full serial buffer does.
    if line.len() < ROOM {
        let length = link.poll_transmit(Micros(now), &mut frame);
        if length > 0 {
            line.push(frame[..length].to_vec());
        }
    }
}

/// What is left of the frame at this place when it arrives.
fn meet(line: &mut Vec<Frame>, left: &mut Budget, fate: Fate, at: usize) -> Frame {
    left.overtakings -= u8::from(at > 0);
    left.mishaps -= u8::from(fate != Fate::Arrives);
    match fate {
        Fate::Arrives => line.remove(at),
        Fate::ArrivesAndStays => line[at].clone(),
        Fate::IsDropped => {
            line.remove(at);
            Vec::new()
        }
        Fate::IsDamaged => {
            let mut frame = line.remove(at);
            frame[1] ^= 0x80;
            frame
        }
    }
}

/// A Data frame as if it were the one that is waited for.
fn renumbered(frame: &[u8], receiver: &Link) -> Frame {
    let mut decoder = Decoder::new();
    let Some(Ok(header)) = decoder.next(&mut &*frame) else { return frame.to_vec() };
    if header.kind != FrameKind::Data {
        return frame.to_vec();
    }
    // What the receiver waits for stands in any frame that it would send.
    let mut probe = receiver.clone();
    let mut out = [0; MAX_ENCODED];
    let length = probe.poll_transmit(Micros(u64::MAX / 2), &mut out);
    let Some(Ok(own)) = Decoder::new().next(&mut &out[..length]) else { return frame.to_vec() };
    let length = encode(Header { seq: own.ack, ..header }, decoder.payload(), &mut out).unwrap();
    out[..length].to_vec()
}

struct Search {
    states: usize,
    depth: usize,
    /// Most commands that were answered in any state.
    answered: usize,
    flaw: Option<String>,
}

/// Visits every state, breadth first, until one has a flaw.
fn explore(budget: Budget, mutant: Mutant) -> Search {
    let start = World::new(budget);
    let mut seen = HashSet::from([start.fingerprint()]);
    let mut front = vec![Box::new(start)];
    let mut search = Search { states: 1, depth: 0, answered: 0, flaw: None };
    while !front.is_empty() {
        let mut next = Vec::new();
        for world in front {
            for event in world.events() {
                let after = world.after(event, mutant);
                if !seen.insert(after.fingerprint()) {
                    continue;
                }
                search.answered = search.answered.max(after.answered.len());
                if let Some(flaw) = after.flaw() {
                    search.flaw =
                        Some(format!("{flaw} after {} steps, the last {event:?}", search.depth + 1));
                    search.states = seen.len();
                    return search;
                }
                next.push(Box::new(after));
            }
        }
        assert!(seen.len() < TOO_MANY, "more than {TOO_MANY} states");
        front = next;
        search.depth += 1;
    }
    search.states = seen.len();
    search
}

const NOTHING: Budget = Budget {
    commands: 2,
    mishaps: 0,
    overtakings: 0,
    timeouts: 0,
    reconnects: 0,
    resets: 0,
    reset_clears_line: false,
};

/// Every state is good, and the commands did get through in some.
#[expect(clippy::print_stdout, reason = "how much was looked at is the figure of this test")]
fn assert_holds(name: &str, budget: Budget) {
    let search = explore(budget, Mutant::None);
    println!("{name}: {} states, {} steps deep", search.states, search.depth);
    assert_eq!(search.flaw, None, "{name}");
    assert_eq!(search.answered, usize::from(budget.commands), "{name}: no state in which all is answered");
}

/// The search finds what is wrong.
#[expect(clippy::print_stdout, reason = "what was found is the figure of this test")]
fn assert_caught(budget: Budget, mutant: Mutant) {
    let search = explore(budget, mutant);
    println!("{mutant:?}: {:?} in {} states", search.flaw, search.states);
    assert!(search.flaw.is_some_and(|flaw| flaw.starts_with("executed")), "{mutant:?} isn't caught");
}

#[test]
fn s11_on_a_line_that_drops_damages_repeats_and_reorders() {
    let budget = Budget { mishaps: 2, overtakings: 1, ..NOTHING };
    assert_holds("one session", budget);
    assert_holds("one session, with a timeout", Budget { mishaps: 1, timeouts: 1, ..budget });
}

#[test]
fn s11_when_the_host_reconnects_while_frames_of_the_old_session_are_under_way() {
    let budget = Budget { mishaps: 2, overtakings: 1, reconnects: 1, ..NOTHING };
    assert_holds("reconnecting host", budget);
}

#[test]
fn s11_when_the_mcu_is_reset_and_frames_of_before_still_arrive() {
    let budget = Budget { mishaps: 1, timeouts: 1, reconnects: 1, resets: 1, ..NOTHING };
    assert_holds("reset", budget);
}

#[test]
fn s11_when_the_mcu_is_reset_and_its_line_reorders_but_loses_what_was_under_way() {
    let budget = Budget { mishaps: 1, overtakings: 1, resets: 1, reset_clears_line: true, ..NOTHING };
    assert_holds("reset of MCU and line", budget);
}

#[test]
fn a_link_that_takes_repetitions_is_caught() {
    assert_caught(Budget { mishaps: 1, ..NOTHING }, Mutant::TakesRepetitions);
}

#[test]
fn an_mcu_that_opens_a_replaced_session_again_is_caught() {
    let budget = Budget { commands: 1, mishaps: 2, overtakings: 2, reconnects: 1, ..NOTHING };
    assert_caught(budget, Mutant::OpensReplaced);
}

#[test]
fn a_host_that_sends_unanswered_commands_again_after_a_reset_is_caught() {
    assert_caught(Budget { timeouts: 1, resets: 1, ..NOTHING }, Mutant::ResendsAfterReconnect);
}

/// A line that keeps frames over a reset and says them again in any order: a session belongs to one boot.
#[test]
fn s11_when_frames_of_before_a_reset_come_again_after_it_in_any_order() {
    assert_holds("replay over a reset", REPLAYED);
}

#[test]
fn ends_that_keep_the_session_over_a_reset_are_caught() {
    assert_caught(REPLAYED, Mutant::GrantsWhatIsAsked);
}

const REPLAYED: Budget = Budget { commands: 1, mishaps: 2, overtakings: 2, resets: 1, ..NOTHING };
