"""Commands that the MCU refuses, with code, place, expected and got; each changes nothing."""

import dataclasses

import pytest

from bench import run
from bench.program import Program
from zygote_wire import commands
from zygote_wire.codes import Refused
from zygote_wire.commands import Heat, Step, program_crc
from zygote_wire.link import CommandRefused, Link
from zygote_wire.reports import Refusal, State


pytestmark = pytest.mark.smoke


def refusal(link: Link, command: commands.Command) -> Refusal:
    """How a command is refused; the state stays what it was."""
    before = link.status()
    with pytest.raises(CommandRefused) as refused:
        link.request(command)
    after = link.status()
    assert (after.state, after.run, after.main_switch) == (before.state, before.run, before.main_switch)
    return refused.value.refusal


@pytest.mark.brief
def test_nothing_starts_that_is_not_armed(link, program):
    start = commands.Start(run.RUN)
    assert refusal(link, start) == Refusal(Refused.WRONG_STATE, 0, State.ARMED, State.IDLE)
    run.load(link, program)
    assert refusal(link, start) == Refusal(Refused.WRONG_STATE, 0, State.ARMED, State.LOADED)


def test_nothing_is_armed_that_is_not_loaded(link, program, mcu):
    arm = commands.Arm(program.rig, program.limits(mcu), run.LIFETIME)
    assert refusal(link, arm) == Refusal(Refused.WRONG_STATE, 0, State.LOADED, State.IDLE)


def test_nothing_is_cleared_or_disarmed_without_need(link):
    assert refusal(link, commands.Clear()) == Refusal(Refused.WRONG_STATE, 0, State.SAFE, State.IDLE)
    assert refusal(link, commands.Disarm()) == Refusal(Refused.WRONG_STATE, 0, State.ARMED, State.IDLE)


def test_an_arming_for_another_rig_is_refused(link, program, mcu):
    run.load(link, program)
    arm = commands.Arm(program.rig + "2", program.limits(mcu), run.LIFETIME)
    assert refusal(link, arm).code == Refused.RIG_MISMATCH


def test_no_limit_can_be_raised_above_its_ceiling(link, program, mcu):
    run.load(link, program)
    for at, field in enumerate(dataclasses.fields(mcu.ceiling)):
        ceiling = getattr(mcu.ceiling, field.name)
        laxer = ceiling - 1 if field.name == "min_rest" else ceiling + 1
        if laxer < 0:
            continue  # No rest at all is what this board begins with.
        limits = dataclasses.replace(mcu.ceiling, **{field.name: laxer})
        arm = commands.Arm(program.rig, limits, run.LIFETIME)
        assert refusal(link, arm) == Refusal(Refused.LIMIT_ABOVE_CEILING, at, ceiling, laxer)


def test_steps_are_held_against_the_limits_of_the_arming(link, program, mcu):
    run.load(link, program)
    currents = [step.action.current for step in program.steps]
    current = max(currents)
    at = currents.index(current)
    limits = dataclasses.replace(program.limits(mcu), supply=current - 1)
    arm = commands.Arm(program.rig, limits, run.LIFETIME)
    assert refusal(link, arm) == Refusal(Refused.STEP_OVER_CURRENT, at, current - 1, current)


def test_an_arming_may_not_last_longer_than_ten_minutes(link, program, mcu):
    run.load(link, program)
    arm = commands.Arm(program.rig, program.limits(mcu), 600_001)
    assert refusal(link, arm) == Refusal(Refused.LIFETIME_TOO_LONG, 0, 600_000, 600_001)


@pytest.mark.faults
def test_a_program_of_another_run_does_not_start(link, program, mcu):
    run.load(link, program)
    run.arm(link, program, mcu)
    assert refusal(link, commands.Start(run.RUN + 1)) == Refusal(Refused.RUN_MISMATCH, 0, run.RUN, run.RUN + 1)


def test_steps_out_of_sequence_are_refused(link, program):
    steps = program.steps
    assert refusal(link, commands.Steps(0, steps[:1])).code == Refused.NO_UPLOAD
    link.request(commands.Upload(run.RUN, program.rig, 3, program_crc(steps[:3])))
    out_of_sequence = Refusal(Refused.STEPS_OUT_OF_SEQUENCE, 1, 0, 1)
    assert refusal(link, commands.Steps(1, steps[1:3])) == out_of_sequence
    link.request(commands.Steps(0, steps[:2]))
    incomplete = Refusal(Refused.PROGRAM_INCOMPLETE, 2, 3, 2)
    assert refusal(link, commands.Commit()) == incomplete
    assert refusal(link, commands.Steps(2, steps[2:4])) == Refusal(Refused.TOO_MANY_STEPS, 2, 3, 4)
    link.request(commands.Steps(2, steps[2:3]))
    link.request(commands.Commit())


def test_a_program_whose_checksum_differs_is_refused(link, program):
    crc = program_crc(program.steps[:1])
    link.request(commands.Upload(run.RUN, program.rig, 1, crc ^ 1))
    link.request(commands.Steps(0, program.steps[:1]))
    assert refusal(link, commands.Commit()) == Refusal(Refused.PROGRAM_CHECKSUM, 0, crc ^ 1, crc)


def test_programs_of_no_steps_and_of_too_many_are_refused(link, program, mcu):
    room = mcu.buffers.steps
    empty = Refusal(Refused.PROGRAM_EMPTY, 0, 1, 0)
    assert refusal(link, commands.Upload(run.RUN, program.rig, 0, 0)) == empty
    too_many = Refusal(Refused.TOO_MANY_STEPS, 0, room, room + 1)
    assert refusal(link, commands.Upload(run.RUN, program.rig, room + 1, 0)) == too_many


def heat_of(program: Program) -> Heat:
    """A step's heat that the board allows."""
    return next(step.action for step in program.steps if isinstance(step.action, Heat))


def test_a_step_that_breaks_a_rule_is_refused_with_its_number(link, program, mcu):
    heat, ceiling, heaters = heat_of(program), mcu.ceiling, mcu.channels.heaters
    cases = [
        ("channel", heaters, Refused.UNKNOWN_CHANNEL, heaters - 1),
        ("max_temperature", ceiling.max_temperature + 1, Refused.STEP_OVER_TEMPERATURE, ceiling.max_temperature),
        ("target", heat.max_temperature, Refused.STEP_OVER_TEMPERATURE, heat.max_temperature),
        ("cool", heat.target, Refused.STEP_OVER_TEMPERATURE, heat.target),
        ("min_gain", 0, Refused.STEP_OVER_TEMPERATURE, 1),
        ("max_on", ceiling.max_on + 1, Refused.STEP_OVER_ON_TIME, ceiling.max_on),
        ("hold", heat.max_on, Refused.STEP_OVER_ON_TIME, heat.max_on),
        ("gain_window", heat.max_on + 1, Refused.STEP_OVER_ON_TIME, heat.max_on),
        ("rest", ceiling.min_rest - 1, Refused.STEP_OVER_ON_TIME, ceiling.min_rest),
        ("current", ceiling.supply + 1, Refused.STEP_OVER_CURRENT, ceiling.supply),
    ]
    good = Step(0, (), dataclasses.replace(heat, channel=0))
    for field, value, code, bound in cases:
        if value < 0:
            continue  # The board asks no rest.
        bad = Step(1, (), dataclasses.replace(heat, **{"channel": 1, field: value}))
        assert refused_upload(link, program, good, bad) == Refusal(code, 1, bound, value)


def test_two_steps_share_no_hinge_and_no_channel(link, program):
    heat = heat_of(program)
    first, second = dataclasses.replace(heat, channel=0), dataclasses.replace(heat, channel=1)
    same_hinge = refused_upload(link, program, Step(5, (), first), Step(5, (), second))
    assert same_hinge == Refusal(Refused.HINGE_TAKEN, 1, 5, 5)
    same_channel = refused_upload(link, program, Step(5, (), second), Step(6, (), second))
    assert same_channel == Refusal(Refused.CHANNEL_TAKEN, 1, 1, 1)


def test_a_step_that_waits_for_a_later_one_is_refused(link, program):
    heat = heat_of(program)
    first, second = dataclasses.replace(heat, channel=0), dataclasses.replace(heat, channel=1)
    waits_for_itself = refused_upload(link, program, Step(0, (), first), Step(1, (1,), second))
    assert waits_for_itself == Refusal(Refused.ORDER_VIOLATED, 1, 0, 1)


def refused_upload(link: Link, program: Program, *steps: Step) -> Refusal:
    """How a program of these steps is refused; none is in force then."""
    with pytest.raises(CommandRefused) as refused:
        run.upload(link, program.rig, steps)
    assert link.status().state == State.IDLE
    return refused.value.refusal
