//! What a bad line or a bad host sends: each is refused or thrown away, and nothing has changed (S11).
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod a_board;

use zygote_core::{Core, Outputs};
use zygote_protocol::{
    Command, Decoder, Event, EventKind, FrameKind, Header, Hello, MAX_ENCODED, Micros, Millis, Reply, Report,
    Request, RigId, State, VERSION, WINDOW, decode_payload, encode,
};

type TheCore = Core<1, 1, 1, 4>;

const SESSION: u32 = 5;

/// A core with an open session, and the bytes between.
struct Bench {
    core: TheCore,
    now: Micros,
}

impl Bench {
    fn new() -> Self {
        let mut bench =
            Self { core: Core::new(a_board::config(1, 1, 1), Micros(0), None), now: Micros(1_000) };
        assert_eq!(bench.hello(SESSION).len(), 1);
        bench
    }

    /// Gives the core bytes and returns what it says to them.
    fn hear(&mut self, bytes: &[u8]) -> Vec<(Header, Vec<u8>)> {
        self.core.handle_bytes(self.now, bytes);
        self.said()
    }

    fn said(&mut self) -> Vec<(Header, Vec<u8>)> {
        let (mut frames, mut out) = (Vec::new(), [0; MAX_ENCODED]);
        loop {
            let length = self.core.poll_transmit(self.now, &mut out);
            if length == 0 {
                return frames;
            }
            let mut decoder = Decoder::new();
            let header = decoder.next(&mut &out[..length]).unwrap().unwrap();
            frames.push((header, decoder.payload().to_vec()));
        }
    }

    fn hello(&mut self, session: u32) -> Vec<(Header, Vec<u8>)> {
        let header = Header { kind: FrameKind::Hello, session, seq: 0, ack: 0 };
        self.hear(&frame(header, &postcard_of(&Hello::ours())))
    }

    /// What can be seen of the core from outside.
    fn view(&self) -> (State, Outputs<1, 1, 1>, usize) {
        (self.core.state(), self.core.outputs().clone(), self.core.step_states().count())
    }
}

fn postcard_of<T: serde::Serialize>(message: &T) -> Vec<u8> {
    let mut buffer = [0; 240];
    postcard::to_slice(message, &mut buffer).unwrap().to_vec()
}

fn frame(header: Header, payload: &[u8]) -> Vec<u8> {
    let mut out = [0; MAX_ENCODED];
    let length = encode(header, payload, &mut out).unwrap();
    out[..length].to_vec()
}

fn request(session: u32, seq: u8, ack: u8, command: Command) -> Vec<u8> {
    let header = Header { kind: FrameKind::Data, session, seq, ack };
    frame(header, &postcard_of(&Request { id: u16::from(seq), command }))
}

fn upload(run: u32) -> Command {
    Command::Upload { run, rig: RigId::try_from("r").unwrap(), steps: 1, crc: 0 }
}

fn kinds(said: &[(Header, Vec<u8>)]) -> Vec<FrameKind> {
    said.iter().map(|(header, _)| header.kind).collect()
}

/// The numbers of the requests that were answered.
fn answered(said: &[(Header, Vec<u8>)]) -> Vec<u16> {
    let response = |(header, payload): &(Header, Vec<u8>)| match decode_payload(payload) {
        Some(Report::Response(response)) if header.kind == FrameKind::Data => Some(response.id),
        _ => None,
    };
    said.iter().filter_map(response).collect()
}

/// The states that events tell of.
fn events(said: &[(Header, Vec<u8>)]) -> Vec<State> {
    let state = |(_, payload): &(Header, Vec<u8>)| match decode_payload(payload) {
        Some(Report::Event(Event { kind: EventKind::State(state), .. })) => Some(state),
        _ => None,
    };
    said.iter().filter(|(header, _)| header.kind == FrameKind::Data).filter_map(state).collect()
}

/// The run of the program that is being uploaded, as a Status says it.
fn run_in_store(said: &[(Header, Vec<u8>)]) -> Option<u32> {
    said.iter().find_map(|(_, payload)| match decode_payload(payload) {
        Some(Report::Response(response)) => match response.result {
            Ok(Reply::Status(status)) => status.run,
            _ => None,
        },
        _ => None,
    })
}

#[test]
fn s11_a_frame_cut_anywhere_changes_nothing_and_is_asked_for_again() {
    let whole = request(SESSION, 0, 0, upload(1));
    for length in 1..whole.len() - 1 {
        let mut bench = Bench::new();
        let before = bench.view();
        let said = bench.hear(&[&whole[..length], &[0]].concat());
        assert_eq!(kinds(&said), [FrameKind::Nack], "cut after {length} bytes");
        assert_eq!(bench.view(), before);
        assert_eq!(answered(&bench.hear(&whole)), [0], "the whole frame afterwards");
    }
}

#[test]
fn s11_a_frame_longer_than_any_changes_nothing_and_the_next_one_is_taken() {
    let mut bench = Bench::new();
    for length in [MAX_ENCODED, 1_000, 100_000] {
        let before = bench.view();
        let said = bench.hear(&[vec![0x11; length], vec![0]].concat());
        assert_eq!(kinds(&said), [FrameKind::Nack], "{length} bytes");
        assert_eq!(bench.view(), before);
    }
    assert_eq!(answered(&bench.hear(&request(SESSION, 0, 0, upload(1)))), [0]);
}

#[test]
fn s11_a_repeated_command_is_executed_and_answered_once() {
    let mut bench = Bench::new();
    let upload = request(SESSION, 0, 0, upload(1));
    assert_eq!(answered(&bench.hear(&upload)), [0]);
    for _ in 0..20 {
        // Repeated at once, so that the answer isn't due again yet: only the acknowledgement is.
        assert_eq!(kinds(&bench.hear(&upload)), [FrameKind::Ack]);
    }
}

#[test]
fn s11_commands_out_of_order_wait_for_the_one_that_is_missing() {
    let mut bench = Bench::new();
    let [first, second] = [request(SESSION, 0, 0, upload(1)), request(SESSION, 1, 0, upload(2))];
    let before = bench.view();
    let said = bench.hear(&second);
    assert_eq!((kinds(&said), bench.view()), (vec![FrameKind::Nack], before));
    assert_eq!(answered(&bench.hear(&first)), [0]);
    assert_eq!(answered(&bench.hear(&second)), [1]);
    assert_eq!(run_in_store(&bench.hear(&request(SESSION, 2, 4, Command::Status))), Some(2));
}

#[test]
fn s11_a_command_of_a_session_that_was_replaced_is_answered_with_reset_and_not_executed() {
    let mut bench = Bench::new();
    bench.hello(SESSION + 1);
    let before = bench.view();
    let said = bench.hear(&request(SESSION, 0, 0, upload(1)));
    assert_eq!(
        said.iter().map(|(header, _)| (header.kind, header.session)).collect::<Vec<_>>(),
        [(FrameKind::Reset, SESSION)]
    );
    assert_eq!(bench.view(), before);
}

#[test]
fn s11_an_old_hello_that_comes_late_is_answered_and_leaves_the_new_session_open() {
    let mut bench = Bench::new();
    assert_eq!(answered(&bench.hear(&request(SESSION, 0, 0, upload(1)))), [0]);
    bench.hello(SESSION + 1);
    assert_eq!(kinds(&bench.hello(SESSION)), [FrameKind::HelloReply]);
    // Its command, repeated with it, would be new in a session that was opened again.
    assert_eq!(kinds(&bench.hear(&request(SESSION, 0, 0, upload(9)))), [FrameKind::Reset]);
    let said = bench.hear(&request(SESSION + 1, 0, 0, Command::Status));
    assert_eq!((answered(&said), run_in_store(&said)), (vec![0], Some(1)));
}

#[test]
fn s11_a_hello_of_another_version_leaves_an_open_session_alone() {
    let mut bench = Bench::new();
    let other = Hello { min: VERSION + 1, current: VERSION + 2, schema: 1 };
    let header = Header { kind: FrameKind::Hello, session: SESSION + 1, seq: 0, ack: 0 };
    assert_eq!(kinds(&bench.hear(&frame(header, &postcard_of(&other)))), [FrameKind::HelloReply]);
    assert_eq!(answered(&bench.hear(&request(SESSION, 0, 0, Command::Status))), [0]);
}

#[test]
fn s11_a_host_that_stops_reading_has_its_commands_turned_away_until_it_reads_again() {
    let mut bench = Bench::new();
    let mut executed = 0;
    for seq in 0..40 {
        // `ack` stays 0: nothing that the core says arrives.
        executed += answered(&bench.hear(&request(SESSION, seq, 0, upload(u32::from(seq))))).len();
        if usize::from(seq) > executed {
            break;
        }
    }
    assert!((1..=WINDOW).contains(&executed), "{executed} answers are kept for a host that doesn't read");
    let before = bench.view();
    let next = u8::try_from(executed).unwrap();
    for _ in 0..100 {
        bench.hear(&request(SESSION, next, 0, upload(99)));
        assert_eq!(bench.view(), before);
    }
    // It reads again: what it has missed comes once more, and the command that was turned away is executed.
    bench.now = bench.now.plus(Millis(2_000));
    let missed = bench.said();
    let heard = missed.iter().filter(|(header, _)| header.kind == FrameKind::Data).count();
    assert!(heard >= executed, "{heard} of {executed}");
    let said = bench.hear(&request(SESSION, next, u8::try_from(heard).unwrap(), upload(99)));
    assert_eq!(answered(&said), [u16::from(next)]);
}

#[test]
fn a_stop_of_a_host_that_does_not_read_acts_all_the_same() {
    let mut bench = Bench::new();
    for seq in 0..40 {
        bench.hear(&request(SESSION, seq, 0, upload(1)));
    }
    let stop = frame(Header { kind: FrameKind::Urgent, session: 0, seq: 0, ack: 0 }, &[0]);
    assert_eq!(kinds(&bench.hear(&stop)).first(), Some(&FrameKind::UrgentAck));
    assert_eq!(bench.core.state(), State::Safe);
}

#[test]
fn s11_a_hello_that_comes_twice_leaves_its_session_as_it_is() {
    let mut bench = Bench::new();
    assert_eq!(answered(&bench.hear(&request(SESSION, 0, 0, upload(1)))), [0]);
    assert_eq!(kinds(&bench.hello(SESSION))[0], FrameKind::HelloReply);
    assert_eq!(answered(&bench.hear(&request(SESSION, 1, 2, Command::Status))), [1]);
}

#[test]
fn an_event_leaves_the_last_two_places_to_responses() {
    let mut bench = Bench::new();
    for seq in 0..WINDOW - 3 {
        let seq = u8::try_from(seq).unwrap();
        assert_eq!(answered(&bench.hear(&request(SESSION, seq, 0, Command::Status))), [u16::from(seq)]);
    }
    // The upload's response leaves room for two; its event waits, so two more requests are answered.
    for (seq, command) in [(5, upload(1)), (6, Command::Status), (7, Command::Status)] {
        let said = bench.hear(&request(SESSION, seq, 0, command));
        assert_eq!(answered(&said), [u16::from(seq)], "request {seq}");
    }
    // Once the host acknowledges, the event follows.
    let said = bench.hear(&request(SESSION, 8, 8, Command::Status));
    assert_eq!(answered(&said), [8]);
    assert_eq!(events(&said), [State::Idle]);
}

#[test]
fn the_next_session_is_not_told_the_events_of_the_one_before() {
    let mut bench = Bench::new();
    // Not sent yet.
    bench.core.handle_bytes(bench.now, &request(SESSION, 0, 0, upload(1)));
    assert_eq!(kinds(&bench.hello(SESSION + 1)), [FrameKind::HelloReply]);
    let said = bench.hear(&request(SESSION + 1, 0, 0, Command::Status));
    assert_eq!((answered(&said), events(&said)), (vec![0], vec![]));
}

#[test]
fn the_core_says_when_it_wants_to_send_next() {
    let mut bench = Bench::new();
    bench.hear(&request(SESSION, 0, 0, Command::Status));
    let due = bench.core.poll_timeout(bench.now).unwrap();
    assert!(due > bench.now, "everything was sent");
    bench.now = Micros(due.0 - 1);
    assert_eq!(bench.said(), []);
    bench.now = due;
    assert_ne!(bench.said(), [], "the answer once more, or a sign of life");
    assert_eq!(Core::<1, 1, 1, 4>::new(a_board::config(1, 1, 1), due, None).poll_timeout(due), None);
}
