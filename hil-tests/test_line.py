"""What a bad line does: noise, repetitions, torn and oversized frames."""

import collections
import random
import time

import pytest

from bench import run
from zygote_wire import commands, postcard, reports
from zygote_wire.codes import Refused
from zygote_wire.frames import LONGEST_PAYLOAD, Frame, Kind
from zygote_wire.link import WINDOW, Link, SessionLost
from zygote_wire.postcard import varint
from zygote_wire.reports import Rejected, State

pytestmark = pytest.mark.smoke

UNKNOWN_KIND = 9


def noise(rng: random.Random, count: int) -> bytes:
    """Random bytes, with delimiters as often as frames have them."""
    return bytes(rng.choices(range(256), weights=[8] + [1] * 255, k=count))


def test_noise_on_an_idle_line_leaves_the_mcu_able_to_answer(port, session, rng):
    for _ in range(20):
        port.send(noise(rng, 400))
        port.receive(0)
    port.send(b"\0")
    link = Link(port, session)
    link.hello()
    assert link.status().state == State.IDLE


@pytest.mark.faults
def test_noise_between_frames_of_a_run_changes_nothing(link, program, mcu, rng):
    for step in (
        lambda: run.load(link, program),
        lambda: run.arm(link, program, mcu),
        lambda: link.request(commands.Start(run.RUN)),
    ):
        link.port.send(noise(rng, 1000) + b"\0")
        step()
    end = time.monotonic() + 1.5
    while time.monotonic() < end:
        link.port.send(noise(rng, 100) + b"\0")
        assert link.status().state == State.RUNNING


def test_a_line_that_loses_a_third_of_all_frames_carries_a_program(link, program, rng):
    lossless = link.port.send
    link.port.send = lambda frame: None if rng.random() < 1 / 3 else lossless(frame)
    run.load(link, program)
    link.port.send = lossless
    status = link.status()
    assert (status.state, status.run) == (State.LOADED, run.RUN)


@pytest.mark.faults
def test_a_line_that_sends_everything_twice_executes_once(link, program, mcu):
    once = link.port.send

    def twice(frame: Frame) -> None:
        once(frame)
        once(frame)

    link.port.send = twice
    # Done twice, Steps would be out of sequence, and Start, Disarm and Clear in the wrong state.
    run.start(link, program, mcu)
    link.request(commands.Disarm())
    assert link.status().state == State.LOADED
    entered = [
        notice.kind.state
        for notice in link.notices
        if isinstance(notice, reports.Event) and isinstance(notice.kind, reports.Entered)
    ]
    assert entered == [State.IDLE, State.LOADED, State.ARMED, State.RUNNING, State.LOADED]


def test_a_request_that_comes_again_long_after_is_not_executed_again(port, session, program):
    link = Link(port, session)
    link.hello()
    command = commands.Upload(run.RUN, program.rig, 1, 0)
    request = Frame(Kind.DATA, link.session, payload=postcard.encode(commands.Request(0, command)))
    port.send(request)
    first = [frame for frame in port.listen(0.2) if frame.kind == Kind.DATA]
    assert first, "the first one is answered"
    # Acknowledged, so that only what is new would come as Data.
    port.send(Frame(Kind.ACK, link.session, ack=max(frame.seq for frame in first) + 1))
    port.listen(0.1)
    port.send(request)
    again = port.listen(0.3)
    assert not [frame for frame in again if frame.kind == Kind.DATA]
    assert {frame.ack for frame in again} == {1}


def test_a_gap_is_asked_for_with_a_nack(port, session):
    link = Link(port, session)
    link.hello()
    status = postcard.encode(commands.Request(5, commands.Status()))
    port.send(Frame(Kind.DATA, link.session, seq=1, payload=status))
    heard = port.listen(0.3)
    assert [frame.ack for frame in heard if frame.kind == Kind.NACK] == [0]
    assert not [frame for frame in heard if frame.kind == Kind.DATA]


def test_all_that_was_not_heard_is_said_again_again_and_again(port, session):
    link = Link(port, session)
    link.hello()
    for number in range(WINDOW):
        status = commands.Request(number, commands.Status())
        port.send(Frame(Kind.DATA, link.session, seq=number, payload=postcard.encode(status)))
    heard = collections.Counter()
    # Some of them mean the same loss as the one before.
    for _ in range(5 * WINDOW):
        port.send(Frame(Kind.NACK, link.session))
        heard.update(frame.seq for frame in port.listen(0.03) if frame.kind == Kind.DATA)
    assert sorted(heard) == list(range(WINDOW)) and min(heard.values()) >= 3


def test_torn_frames_are_not_taken_and_the_next_frame_is(port):
    stop = Frame(Kind.URGENT, session=0, seq=3, payload=b"\0").encode()
    for length in range(1, len(stop) - 1):
        port.send(stop[:length] + b"\0")
    assert not port.listen(0.3)
    port.send(stop)
    assert [frame.kind for frame in port.listen(0.3)] == [Kind.URGENT_ACK]


def test_a_frame_with_any_byte_changed_is_not_taken(port, session):
    Link(port, session).hello()
    stop = Frame(Kind.URGENT, session, seq=3, payload=b"\0").encode()
    for at in range(len(stop) - 1):
        changed = bytearray(stop)
        changed[at] ^= 0x10
        port.send(bytes(changed))
    assert not [frame for frame in port.listen(0.3) if frame.kind == Kind.URGENT_ACK]
    link = Link(port, session ^ 1)
    link.hello()
    assert link.status().state == State.IDLE


def test_frames_of_an_unknown_kind_are_not_taken(link):
    link.port.send(Frame(UNKNOWN_KIND, link.session, payload=b"\0"))
    heard = {frame.kind for frame in link.port.listen(0.3)}
    assert Kind.NACK in heard and Kind.URGENT_ACK not in heard
    assert link.status().state == State.IDLE


def test_the_longest_frame_is_taken_and_one_byte_more_is_not(port, session):
    for length, taken in ((LONGEST_PAYLOAD, True), (LONGEST_PAYLOAD + 1, False), (3_000, False)):
        # Urgent frames say whether they arrived, whatever is in them.
        port.send(Frame(Kind.URGENT, 0, seq=length % 256, payload=b"\xa5" * length))
        acks = [frame.seq for frame in port.listen(0.2) if frame.kind == Kind.URGENT_ACK]
        assert acks == ([length % 256] if taken else [])
    link = Link(port, session)
    link.hello()
    assert link.status().state == State.SAFE


def test_requests_that_cannot_be_read_are_refused_and_the_next_one_is_answered(port, session):
    link = Link(port, session)
    link.hello()
    unreadable = [
        varint(7) + b"\x63",
        postcard.encode(commands.Request(8, commands.Upload(1, "r" * 33, 1, 0))),
        postcard.encode(commands.Request(9, commands.Status())) + b"\0",
    ]
    readable = postcard.encode(commands.Request(10, commands.Status()))
    for seq, payload in enumerate([*unreadable, readable]):
        port.send(Frame(Kind.DATA, link.session, seq, payload=payload))
    answers = [
        postcard.decode(reports.Report, frame.payload) for frame in port.listen(0.3) if frame.kind == Kind.DATA
    ]
    # Not acknowledged, so they may have come more than once.
    refused = {answer.id: answer.result.refusal.code for answer in answers if isinstance(answer.result, Rejected)}
    assert refused == {7: Refused.UNREADABLE, 8: Refused.UNREADABLE, 9: Refused.UNREADABLE}
    assert 10 in {answer.id for answer in answers}


def test_a_host_that_stops_reading_holds_nothing_up(port, session):
    link = Link(port, session)
    link.hello()
    status = Frame(Kind.DATA, link.session, 0, payload=postcard.encode(commands.Request(1, commands.Status())))
    # Telemetry, events and repeated answers pile up in a line that nobody reads, for longer than it has room.
    end = time.monotonic() + 3
    while time.monotonic() < end:
        for _ in range(50):
            port.send(status)
        time.sleep(0.05)
    port.serial.reset_input_buffer()
    other = Link(port, session ^ 1)
    other.hello()
    assert other.status().state == State.IDLE


def test_a_session_that_was_replaced_does_not_come_back(link):
    other = Link(link.port, link.session ^ 1)
    other.hello()
    link.hello()
    with pytest.raises(SessionLost):
        link.status()
    assert other.status().state == State.IDLE
