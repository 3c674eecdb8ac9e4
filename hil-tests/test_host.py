"""The real host, `zygote deploy --port`, on this line and on lines with nobody sensible at the other end."""

import signal

import pytest

from bench import run
from bench.fake_mcu import fake_mcu, silence
from zygote_wire import postcard
from zygote_wire.codes import Faulted
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import SCHEMA, VERSION, Buffers, Channels, HelloReply, Identity, Limits, ResetCause
from zygote_wire.link import Link
from zygote_wire.reports import State, StepState

pytestmark = pytest.mark.smoke

HINGES_BEFORE_THE_STOP = 2
THEIRS = VERSION + 6


@pytest.mark.deployment
def test_the_host_deploys_and_ends_with_0(deploy, program, device):
    host = deploy(program, device)
    code, out, error = host.finish()
    assert code == 0, error
    assert out.startswith(f"deployed: {len(program.steps)} of {len(program.steps)} hinges are open")
    report = host.report()
    assert report["outcome"] == "deployed"
    assert {hinge["outcome"] for hinge in report["hinges"]} == {"opened"}


@pytest.mark.faults
@pytest.mark.parametrize("interrupt", [signal.SIGINT, signal.SIGTERM], ids=["ctrl-c", "terminate"])
def test_an_interrupted_host_stops_the_rig_and_ends_with_1(
    deploy, program, device, dial, session, interrupt
):
    host = deploy(program, device)
    host.wait_for_opened(HINGES_BEFORE_THE_STOP)
    host.process.send_signal(interrupt)
    code, out, error = host.finish()
    assert (code, error) == (1, "error: the shape is not deployed\n")
    assert out.startswith("stopped: ")
    report = host.report()
    assert report["outcome"] == "stopped"
    opened = [hinge for hinge in report["hinges"] if hinge["outcome"] == "opened"]
    assert HINGES_BEFORE_THE_STOP <= len(opened) < len(program.steps)

    link = Link(dial(device), session)
    link.hello()
    status = link.status()
    assert (status.state, status.fault.code) == (State.SAFE, Faulted.STOPPED)
    assert (status.heaters_on, status.main_switch) == (0, False)
    states = link.progress()
    assert states.count(StepState.DONE) == len(opened)


@pytest.mark.faults
def test_a_killed_host_loses_its_link_and_the_rig_is_off(deploy, program, device, dial, session):
    host = deploy(program, device)
    host.wait_for_opened(1)
    host.process.kill()
    host.process.communicate()
    port = dial(device)
    # The rig's link timeout is 1 s; nothing is said before it is over.
    run.silence(port, 1.2)
    link = Link(port, session)
    link.hello()
    status = link.status()
    assert (status.state, status.fault.code) == (State.SAFE, Faulted.LINK_LOST)
    assert (status.heaters_on, status.main_switch) == (0, False)


def test_the_host_refuses_a_rig_in_safe_until_it_is_cleared(deploy, program, link, device):
    link.stop()
    link.port.close()
    host = deploy(program, device, clear=False)
    code, _, error = host.finish()
    assert code == 1
    assert "F02" in error and "--clear" in error
    link.port.open()


def test_the_host_names_the_device_on_which_nobody_answers(deploy, program):
    with fake_mcu(silence) as device:
        code, _, error = deploy(program, device).finish()
    assert code == 1
    assert error.startswith(f"error: {device}: no answer to a hello")


def test_the_host_names_both_versions_when_they_differ(deploy, program):
    reply = postcard.encode(
        HelloReply(
            THEIRS,
            THEIRS,
            SCHEMA ^ 1,
            Identity(1, "9.9.9", "abcdef0", "fake", bytes(12), ResetCause.POWER),
            Limits(12_000, 20_000, 500, 1_000, 1_000),
            Channels(16, 16, 4),
            Buffers(64, 8, 240),
        )
    )

    def answer(frame: Frame) -> bytes:
        # A later version may say more than this one can read.
        return Frame(Kind.HELLO_REPLY, frame.session, payload=reply + b"\1\2\3").encode()

    with fake_mcu(answer) as device:
        code, _, error = deploy(program, device).finish()
    assert code == 1
    assert error.startswith(f"error: {device}: ")
    assert f"speaks protocol {THEIRS} to {THEIRS}, this program {VERSION} to {VERSION}" in error
