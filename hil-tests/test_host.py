"""The real host, `zygote deploy --port`, on this line and on lines with nobody sensible at the other end."""

import signal

import pytest

from bench.fake_mcu import fake_mcu, silence
from bench.host import Deploy
from bench.recording import check_cut, check_whole
from zygote_wire import postcard
from zygote_wire.codes import Faulted
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import SCHEMA, VERSION, Buffers, Channels, HelloReply, Identity, Limits, ResetCause
from zygote_wire.link import Link
from zygote_wire.port import Port
from zygote_wire.reports import State, StepState

HINGES_BEFORE_THE_STOP = 2
THEIRS = VERSION + 6


def test_the_host_deploys_and_ends_with_0(zygote, program, device, tmp_path):
    deploy = Deploy(zygote, program, device, tmp_path)
    code, out, error = deploy.finish()
    assert code == 0, error
    assert out.startswith(f"deployed: {len(program.steps)} of {len(program.steps)} hinges are open")
    report = deploy.report()
    assert report["outcome"] == "deployed"
    assert {hinge["outcome"] for hinge in report["hinges"]} == {"opened"}
    check_whole(deploy, program)


@pytest.mark.parametrize("interrupt", [signal.SIGINT, signal.SIGTERM], ids=["ctrl-c", "terminate"])
def test_an_interrupted_host_stops_the_rig_and_ends_with_1(
    zygote, program, device, baud, session, tmp_path, interrupt
):
    deploy = Deploy(zygote, program, device, tmp_path)
    deploy.wait_for_opened(HINGES_BEFORE_THE_STOP)
    deploy.process.send_signal(interrupt)
    code, out, error = deploy.finish()
    assert (code, error) == (1, "error: the shape is not deployed\n")
    assert out.startswith("stopped: ")
    report = deploy.report()
    assert report["outcome"] == "stopped"
    opened = [hinge for hinge in report["hinges"] if hinge["outcome"] == "opened"]
    assert HINGES_BEFORE_THE_STOP <= len(opened) < len(program.steps)

    link = Link(Port(device, baud), session)
    link.hello()
    status = link.status()
    assert (status.state, status.fault.code) == (State.SAFE, Faulted.STOPPED)
    assert (status.heaters_on, status.main_switch) == (0, False)
    states = link.progress()
    assert states.count(StepState.DONE) == len(opened)
    link.port.close()


def test_a_killed_host_loses_its_link_and_the_rig_is_off(zygote, program, device, baud, session, tmp_path):
    deploy = Deploy(zygote, program, device, tmp_path)
    deploy.wait_for_opened(1)
    deploy.process.kill()
    deploy.process.communicate()
    check_cut(deploy)
    port = Port(device, baud)
    # The rig's link timeout is 1 s; nothing is said before it is over.
    port.listen(1.3)
    link = Link(port, session)
    link.hello()
    status = link.status()
    assert (status.state, status.fault.code) == (State.SAFE, Faulted.LINK_LOST)
    assert (status.heaters_on, status.main_switch) == (0, False)
    port.close()


def test_the_host_refuses_a_rig_in_safe_until_it_is_cleared(zygote, program, link, device, tmp_path):
    link.stop()
    link.port.close()
    deploy = Deploy(zygote, program, device, tmp_path, clear=False)
    code, _, error = deploy.finish()
    assert code == 1
    assert "F02" in error and "--clear" in error
    link.port.open()


def test_the_host_names_the_device_on_which_nobody_answers(zygote, program, tmp_path):
    with fake_mcu(silence) as device:
        code, _, error = Deploy(zygote, program, device, tmp_path).finish()
    assert code == 1
    assert error.startswith(f"error: {device}: no answer to a hello")


def test_the_host_names_both_versions_when_they_differ(zygote, program, tmp_path):
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
        code, _, error = Deploy(zygote, program, device, tmp_path).finish()
    assert code == 1
    assert error.startswith(f"error: {device}: ")
    assert f"speaks protocol {THEIRS} to {THEIRS}, this program {VERSION} to {VERSION}" in error
