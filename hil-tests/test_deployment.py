"""A whole deployment, and the ways in which one ends early."""

import time

import pytest

from bench import run
from zygote_wire import commands, postcard, reports
from zygote_wire.codes import Faulted, Refused
from zygote_wire.commands import Heat
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import Hello
from zygote_wire.link import CommandRefused, Link
from zygote_wire.reports import Entered, Event, Fault, State, StepDone, StepOpened, StepStarted, StepState

pytestmark = pytest.mark.faults

# Milliseconds; long enough for a machine that is busy with other things.
LINK_TIMEOUT = 600


def assert_all_off(link: Link, code: Faulted) -> reports.Status:
    """Safe for this reason, nothing energised."""
    status = link.status()
    assert (status.state, status.fault.code) == (State.SAFE, code)
    assert (status.heaters_on, status.main_switch) == (0, False)
    return status


@pytest.mark.deployment
@pytest.mark.brief
def test_a_deployment_opens_every_hinge_in_tree_order_and_tells_the_peaks(link, program, mcu):
    run.start(link, program, mcu)
    events = run.watch(link, patience=60.0)
    at = {event.kind: number for number, event in enumerate(events)}
    order = [event.kind for event in events]
    assert [kind for kind in order if isinstance(kind, Entered)] == [
        Entered(state) for state in (State.IDLE, State.LOADED, State.ARMED, State.RUNNING, State.FINISHED)
    ]
    done = {kind.step: kind for kind in order if isinstance(kind, StepDone)}
    for number, step in enumerate(program.steps):
        assert order.count(StepStarted(number)) == order.count(StepOpened(number)) == 1
        assert at[StepStarted(number)] < at[StepOpened(number)] < at[done[number]]
        for before in step.after:
            assert at[StepOpened(before)] < at[StepStarted(number)]
        if isinstance(step.action, Heat):
            assert step.action.target <= done[number].peak < step.action.max_temperature
        else:
            assert done[number].peak is None
    assert [event.at for event in events] == sorted(event.at for event in events)
    assert link.progress() == (StepState.DONE,) * len(program.steps)
    status = link.status()
    assert (status.state, status.opened, status.fault) == (State.FINISHED, len(program.steps), None)
    assert (status.heaters_on, status.main_switch) == (0, False)


@pytest.mark.brief
def test_a_stop_in_the_middle_turns_everything_off_and_latches(link, program, mcu):
    run.start(link, program, mcu)
    run.wait_for_heat(link)
    assert link.stop() < 1.0 * link.port.patience
    assert_all_off(link, Faulted.STOPPED)
    states = link.progress()
    assert StepState.INTERRUPTED in states and StepState.MOVING not in states
    for command in (
        commands.Start(run.RUN),
        commands.Arm(program.rig, program.limits(mcu), run.LIFETIME),
        commands.Upload(run.RUN, program.rig, 1, 0),
    ):
        with pytest.raises(CommandRefused) as refused:
            link.request(command)
        assert refused.value.refusal.code == Refused.WRONG_STATE
        assert refused.value.refusal.got == State.SAFE
    link.live(0.5)
    assert_all_off(link, Faulted.STOPPED)
    link.request(commands.Clear())
    assert link.status().state == State.IDLE
    assert link.progress() == states, "what became of the steps can still be asked"


def test_a_stop_is_told_as_an_urgent_fault(link, program, mcu):
    run.start(link, program, mcu)
    link.stop()
    assert link.notice(Fault).code == Faulted.STOPPED


def test_a_stop_needs_no_session(link, program, mcu):
    run.start(link, program, mcu)
    run.wait_for_heat(link)
    link.port.send(Frame(Kind.URGENT, session=0, seq=9, payload=b"\0"))
    acks = [frame for frame in link.port.listen(0.3) if frame.kind == Kind.URGENT_ACK]
    assert [(ack.session, ack.seq) for ack in acks] == [(0, 9)]
    assert_all_off(link, Faulted.STOPPED)


def test_an_urgent_frame_that_cannot_be_read_counts_as_a_stop(link, program, mcu):
    run.start(link, program, mcu)
    link.port.send(Frame(Kind.URGENT, link.session ^ 1, seq=1, payload=b"\xff\xff"))
    link.notice(Event, lambda event: event.kind == Entered(State.SAFE))
    assert_all_off(link, Faulted.STOPPED)


@pytest.mark.brief
def test_a_silent_host_loses_its_link_and_everything_goes_off(link, program, mcu, session):
    run.start(link, program, mcu, LINK_TIMEOUT)
    run.wait_for_heat(link)
    link.port.close()
    time.sleep(0.1)
    link.port.open()
    run.silence(link.port, LINK_TIMEOUT / 1000 + 0.3)
    again = Link(link.port, session ^ 1)
    again.hello()
    status = assert_all_off(again, Faulted.LINK_LOST)
    assert LINK_TIMEOUT <= status.fault.value <= LINK_TIMEOUT + 50
    assert status.fault.limit == LINK_TIMEOUT
    assert StepState.INTERRUPTED in again.progress()


def test_a_host_that_was_silent_can_go_on_in_its_session(link, program, mcu):
    run.start(link, program, mcu, LINK_TIMEOUT)
    run.silence(link.port, LINK_TIMEOUT / 1000 + 0.2)
    assert_all_off(link, Faulted.LINK_LOST)
    assert link.notice(Fault).code == Faulted.LINK_LOST


def test_hellos_alone_do_not_keep_a_run_alive(link, program, mcu):
    run.start(link, program, mcu, LINK_TIMEOUT)
    hello = Frame(Kind.HELLO, link.asked, payload=postcard.encode(Hello()))
    run.silence(link.port, LINK_TIMEOUT / 1000 + 0.3, lambda: link.port.send(hello))
    assert_all_off(link, Faulted.LINK_LOST)


def test_keep_alives_keep_a_run_alive(link, program, mcu):
    run.start(link, program, mcu, LINK_TIMEOUT)
    link.live(3 * LINK_TIMEOUT / 1000)
    assert link.status().state == State.RUNNING


def test_an_arming_expires(link, program, mcu):
    run.load(link, program)
    link.request(commands.Arm(program.rig, program.limits(mcu), 300))
    assert link.status().main_switch
    link.live(0.5)
    assert_all_off(link, Faulted.ARM_EXPIRED)


def test_disarming_turns_everything_off_and_keeps_the_program(link, program, mcu):
    run.start(link, program, mcu)
    run.wait_for_heat(link)
    link.request(commands.Disarm())
    status = link.status()
    assert (status.state, status.heaters_on, status.main_switch) == (State.LOADED, 0, False)
    run.arm(link, program, mcu)
    link.request(commands.Start(run.RUN))
    assert link.status().state == State.RUNNING
