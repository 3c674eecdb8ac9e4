//! Sequences that are meant to be the worst, each for some reason.

use crate::call::CHANNELS;
use crate::config::CEILING;
use crate::host::{BOOT, BUFFER, Event, framed};
use heapless::{String, Vec as Few};
use zygote_protocol::{
    Action, CentiCelsius, Command, FrameKind, Header, Heat, Milliamps, Millis, NO_SESSION, Release,
    STEPS_PER_COMMAND, Step, Turn, Urgent, WINDOW, granted_session, program_crc,
};

/// Steps that fill a program.
pub(crate) const STEPS: usize = 3 * CHANNELS;
/// One run at a time.
pub(crate) const RUN: u32 = u32::MAX;

/// The rig with the longest name.
fn rig() -> zygote_protocol::RigId {
    String::try_from("a rig with thirty-two letters...").unwrap_or_default()
}

/// How the motions of a program follow on one another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shape {
    /// The first so many steps wait for nothing, each of the others for the last four of them.
    pub(crate) first: usize,
    /// What each motion draws, and a servo that holds.
    pub(crate) current: u32,
    pub(crate) hold_current: u32,
    /// Which kind comes first: 0 heaters, 1 servos, 2 springs.
    pub(crate) lead: usize,
}

/// A step for every channel.
pub(crate) fn steps(shape: Shape) -> Vec<Step> {
    let step = |at: usize| {
        let number = |value: usize| u16::try_from(value).unwrap_or(u16::MAX);
        let channel = number(at % CHANNELS);
        let after = if at < shape.first { 0..0 } else { shape.first.saturating_sub(4)..shape.first };
        let action = match (at / CHANNELS + shape.lead) % 3 {
            0 => Action::Heat(Heat {
                channel,
                target: CentiCelsius(9_000),
                hold: Millis(200),
                max_on: Millis(20_000),
                max_temperature: CentiCelsius(12_000),
                cool: CentiCelsius(4_500),
                rest: Millis(500),
                min_gain: CentiCelsius(500),
                gain_window: Millis(50),
                current: Milliamps(shape.current),
            }),
            1 => Action::Turn(Turn {
                channel,
                from_us: 500,
                to_us: 2_500,
                duration: Millis(20),
                settle: Millis(10),
                current: Milliamps(shape.current),
                hold_current: Milliamps(shape.hold_current),
            }),
            _ => Action::Release(Release {
                channel,
                pulse: Millis(20),
                settle: Millis(10),
                current: Milliamps(shape.current),
            }),
        };
        Step { hinge: number(0xff00 + at), after: after.map(number).collect::<Few<u16, 4>>(), action }
    };
    (0..STEPS).map(step).collect()
}

/// Everything up to a checked program.
pub(crate) fn upload(steps: &[Step]) -> Vec<Event> {
    let upload = Command::Upload {
        run: RUN,
        rig: rig(),
        steps: u16::try_from(steps.len()).unwrap_or(u16::MAX),
        crc: program_crc(steps),
    };
    let mut events = vec![Event::Hello(1), Event::Requests(vec![upload])];
    for (at, steps) in steps.chunks(STEPS_PER_COMMAND).enumerate() {
        let first = u16::try_from(at * STEPS_PER_COMMAND).unwrap_or(u16::MAX);
        let steps = steps.iter().cloned().collect();
        events.push(Event::Requests(vec![Command::Steps { first, steps }]));
    }
    events.push(request(Command::Commit));
    events
}

pub(crate) fn arm() -> Command {
    Command::Arm { rig: rig(), limits: CEILING, lifetime: Millis(600_000) }
}

/// Everything up to the first tick of a run.
pub(crate) fn start(shape: Shape) -> Vec<Event> {
    let mut events = upload(&steps(shape));
    events.extend([request(arm()), request(Command::Start { run: RUN })]);
    events
}

pub(crate) fn request(command: Command) -> Event {
    Event::Requests(vec![command])
}

pub(crate) const fn pass(ticks: u16, every_ms: u16) -> Event {
    Event::Pass { ticks, every_ms }
}

const ALL_AT_ONCE: Shape = Shape { first: STEPS, current: 100, hold_current: 100, lead: 0 };

/// Questions about all that there is to tell.
fn questions() -> [Event; 3] {
    [request(Command::Progress { first: 0 }), request(Command::LastRun), request(Command::Status)]
}

/// Each sequence with its reason.
pub(crate) fn sequences() -> Vec<(&'static str, Vec<Event>)> {
    vec![
        ("48 motions at once, to their end", whole_run(ALL_AT_ONCE)),
        ("32 motions at once, each after four", whole_run(Shape { first: CHANNELS, lead: 1, ..ALL_AT_ONCE })),
        (
            "47 steps wait for current",
            waiting(Shape { first: STEPS, current: 50_000, hold_current: 50_000, lead: 1 }),
        ),
        ("16 servos hold, 32 steps wait for current and for four each", {
            waiting(Shape { first: CHANNELS, current: 3_000, hold_current: 3_100, lead: 1 })
        }),
        ("16 servos hold, 16 heaters heat, 16 springs wait for current and for four each", {
            waiting(Shape { first: CHANNELS, current: 1_600, hold_current: 1_600, lead: 1 })
        }),
        ("all sensors fail at once", sensors_fail()),
        ("a host that doesn't listen, and then asks for everything again", deaf_host()),
        ("a stop in mid-run, and a reset", stopped()),
        (
            "another session in mid-run",
            [start(ALL_AT_ONCE), vec![pass(3, 2), Event::Hello(2), pass(2, 2)]].concat(),
        ),
        ("Commit, and whatever fits behind it", crowded()),
        ("armed and disarmed in turn, in one buffer", toggled()),
        ("no frames at all", noise()),
    ]
}

fn whole_run(shape: Shape) -> Vec<Event> {
    let mut events = start(shape);
    for _ in 0..24 {
        events.push(pass(10, 2));
        events.extend(questions());
    }
    // Hold, cool, rest.
    events.extend([pass(60, 5), pass(200, 5), pass(20, 50)]);
    events.extend(questions());
    events
}

fn waiting(shape: Shape) -> Vec<Event> {
    let mut events = start(shape);
    events.extend([pass(60, 2), Event::StopButton(true), pass(3, 2)]);
    events.extend(questions());
    events
}

fn sensors_fail() -> Vec<Event> {
    let mut events = Vec::new();
    for counts in [4_095, 0, 1_000] {
        events.extend(start(ALL_AT_ONCE));
        events.extend([pass(5, 2), Event::Readings(Some([counts; CHANNELS])), pass(5, 2)]);
        events.extend([Event::Readings(None), pass(5, 2), request(Command::Clear)]);
    }
    events
}

fn deaf_host() -> Vec<Event> {
    let mut events = start(ALL_AT_ONCE);
    events.extend([Event::Listens(false), pass(40, 2)]);
    events.extend((0..WINDOW).map(|_| request(Command::LastRun)));
    let nack = |seq| Event::Frame { kind: FrameKind::Nack, session: 1, seq, payload: Vec::new() };
    events.extend((0..4).map(nack));
    // Its timeout, twice.
    events.extend([pass(400, 5), pass(100, 10)]);
    events
}

fn stopped() -> Vec<Event> {
    let mut payload = [0; 8];
    let stop = postcard::to_slice(&Urgent::Stop, &mut payload).map_or(&[][..], |bytes| bytes).to_vec();
    let mut events = start(ALL_AT_ONCE);
    events.push(pass(50, 2));
    for session in [1, NO_SESSION] {
        events.push(Event::Frame { kind: FrameKind::Urgent, session, seq: 1, payload: stop.clone() });
    }
    events.extend([pass(2, 2), Event::Reset, Event::Hello(3)]);
    events.extend(questions());
    events.extend([Event::StopButton(true), pass(2, 2), request(Command::Clear)]);
    events
}

fn crowded() -> Vec<Event> {
    let mut events = upload(&steps(ALL_AT_ONCE));
    events.pop();
    for fill in [Command::Progress { first: 0 }, Command::LastRun, Command::Status, arm()] {
        let mut all = vec![Command::Commit];
        all.extend(std::iter::repeat_n(fill, WINDOW - 1));
        events.push(Event::Requests(all));
        events.push(request(Command::Disarm));
        events.extend(upload(&steps(ALL_AT_ONCE)).into_iter().skip(1));
        events.pop();
    }
    events
}

fn toggled() -> Vec<Event> {
    let mut events = start(ALL_AT_ONCE);
    // Buffers end where they end: begin with either.
    for first in 0..2 {
        let turns = [arm(), Command::Disarm, arm(), Command::Disarm, arm(), Command::Disarm, arm()];
        events.push(Event::Requests(turns.into_iter().skip(first).collect()));
        events.extend([request(Command::Start { run: RUN }), pass(2, 2)]);
    }
    events
}

fn noise() -> Vec<Event> {
    let raw = |what, bytes| Event::Raw(what, bytes);
    let session = granted_session(1, BOOT);
    let ack = framed(Header { kind: FrameKind::Ack, session, seq: 0, ack: 0 }, &[]);
    let stranger = framed(Header { kind: FrameKind::Data, session: 9, seq: 0, ack: 0 }, &[]);
    let urgent = framed(Header { kind: FrameKind::Urgent, session: 9, seq: 0, ack: 0 }, &[]);
    let often = |bytes: &[u8]| bytes.iter().copied().cycle().take(BUFFER).collect();
    let mut longest = framed(Header { kind: FrameKind::Data, session, seq: 9, ack: 0 }, &[7; 240]);
    longest.resize(2 * BUFFER, 0);
    vec![
        Event::Hello(1),
        raw("inside of a frame", vec![255; BUFFER]),
        raw("inside of a frame", vec![1; BUFFER]),
        raw("frames too short", often(&[0, 2, 1])),
        raw("delimiters", vec![0; BUFFER]),
        raw("acknowledgements", often(&ack)),
        raw("frames of strangers", often(&stranger)),
        raw("urgent frames", often(&urgent)),
        raw("the longest frame, out of order", longest),
    ]
}
