"""Who may open a session, and what the MCU says of itself."""

import time

import pytest

from bench import run
from bench.bench_file import Target
from zygote_wire import commands, postcard, reports
from zygote_wire.codes import Faulted
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import SCHEMA, VERSION, Hello, HelloReply, granted_session
from zygote_wire.link import Link, SessionLost


pytestmark = pytest.mark.smoke


def answer(port, frame: Frame) -> tuple[Frame, HelloReply]:
    """The answer to a hello frame."""
    port.send(frame)
    answers = [frame for frame in port.listen(0.5) if frame.kind == Kind.HELLO_REPLY]
    assert len(answers) == 1
    return answers[0], postcard.decode(HelloReply, answers[0].payload)


@pytest.mark.brief
def test_a_hello_is_answered_with_versions_schema_channels_limits_and_boot(port, session):
    frame, reply = answer(port, Frame(Kind.HELLO, session, payload=postcard.encode(Hello())))
    assert frame.session == session
    assert (reply.min, reply.current, reply.schema) == (VERSION, VERSION, SCHEMA)
    assert reply.identity.board and reply.identity.firmware
    assert reply.identity.boot != 0
    assert reply.channels.heaters + reply.channels.servos + reply.channels.springs > 0
    assert reply.ceiling.link_timeout <= 5_000
    assert (reply.buffers.window, reply.buffers.payload) == (8, 240)


def test_a_repeated_hello_does_not_restart_its_session(link):
    first = link.hello()
    before = link.status()
    assert link.hello() == first
    # The numbers of both ends go on, or this would never be answered.
    assert link.status().at > before.at


def test_a_program_outlives_its_session(link, program):
    run.load(link, program)
    other = Link(link.port, link.session ^ 1)
    other.hello()
    status = other.status()
    assert (status.state, status.run) == (reports.State.LOADED, run.RUN)


@pytest.mark.faults
def test_another_session_turns_off_what_one_had_armed(link, program, mcu):
    run.load(link, program)
    run.arm(link, program, mcu)
    other = Link(link.port, link.session ^ 1)
    other.hello()
    status = other.status()
    assert (status.state, status.fault.code) == (reports.State.SAFE, Faulted.SESSION_ENDED)
    assert (status.heaters_on, status.main_switch) == (0, False)
    with pytest.raises(SessionLost):
        link.status()


@pytest.mark.parametrize(
    "hello",
    [
        pytest.param(Hello(VERSION + 1, VERSION + 2, 0x11223344), id="newer"),
        pytest.param(Hello(0, VERSION - 1, 0x11223344), id="older"),
        pytest.param(Hello(schema=SCHEMA ^ 1), id="same version, other messages"),
    ],
)
@pytest.mark.parametrize("more", [b"", b"\1\2\3"], ids=["", "with more fields"])
def test_a_hello_of_another_version_is_told_ours_and_opens_nothing(port, session, hello, more):
    _, reply = answer(port, Frame(Kind.HELLO, session, payload=postcard.encode(hello) + more))
    assert (reply.min, reply.current, reply.schema) == (VERSION, VERSION, SCHEMA)
    assert_unknown(port, granted_session(session, reply.identity.boot))


def test_a_hello_of_session_0_opens_nothing(port):
    frame, reply = answer(port, Frame(Kind.HELLO, session=0, payload=postcard.encode(Hello())))
    assert frame.session == 0
    assert_unknown(port, 0)
    assert_unknown(port, granted_session(0, reply.identity.boot))


def test_a_hello_of_another_version_leaves_the_open_session_alone(link):
    newer = Hello(VERSION + 1, VERSION + 1, 0x11223344)
    answer(link.port, Frame(Kind.HELLO, link.session ^ 1, payload=postcard.encode(newer)))
    link.status()


def test_frames_of_a_session_that_is_not_open_are_answered_with_reset(link):
    stale = link.session ^ 1
    request = postcard.encode(commands.Request(1, commands.Clear()))
    for kind, payload in ((Kind.DATA, request), (Kind.ACK, b""), (Kind.NACK, b"")):
        link.port.send(Frame(kind, stale, payload=payload))
        resets = [frame for frame in link.port.listen(0.3) if frame.kind == Kind.RESET]
        assert [reset.session for reset in resets] == [stale]
    link.status()


def test_the_boot_number_and_the_clock_of_an_mcu_that_goes_on_stay(link, bench):
    before, start = link.hello().identity.boot, time.monotonic()
    first = link.status().at
    link.live(1.0)
    passed = (link.status().at - first) / 1e6
    assert link.hello().identity.boot == before
    on_the_wall = time.monotonic() - start
    # An emulated chip's clock is behind where the machine is busy, never ahead.
    behind = on_the_wall if bench.target is Target.EMULATOR else 0.3
    assert on_the_wall - behind <= passed <= on_the_wall + 0.3


def assert_unknown(port, session: int) -> None:
    """The MCU knows no such session."""
    port.send(Frame(Kind.ACK, session))
    heard = {(frame.kind, frame.session) for frame in port.listen(0.3)}
    assert (Kind.RESET, session) in heard
    assert not {kind for kind, number in heard if number == session} - {Kind.RESET}
