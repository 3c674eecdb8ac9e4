"""Every actuator of the rig by itself, at low power: a heater at a quarter of its power until it is a little above the room, a servo by
a few degrees, a release for a moment."""

import dataclasses

import pytest

from bench import run
from bench.bench_file import Hinges
from zygote_wire.commands import Heat, Pulse, Release, Step, Turn
from zygote_wire.reports import Entered, Event, State, StepDone, StepOpened, Telemetry

pytestmark = pytest.mark.actuators

# 0.01 °C: what a hand feels, and what no alloy of a hinge begins to move at.
WARM = 3_500
MOST_WARM = 4_500
COOL = 3_000
# Microseconds of pulse: under ten degrees.
NUDGE = 60
# Thousandths of a heater's power; milliseconds; 0.01 K that a hinge on a bench surely gains in the rig's window.
QUARTER = 250
LONGEST = 10_000
LEAST_GAIN = 50
# Milliseconds.
SHORT_PULSE = 20


def gentle(step: Step) -> Step:
    """The same actuator, moved a little."""
    action = step.action
    match action:
        case Heat():
            action = Pulse(
                channel=action.channel,
                duty=QUARTER,
                duration=min(LONGEST, action.max_on),
                target=WARM,
                max_temperature=MOST_WARM,
                cool=COOL,
                rest=action.rest,
                min_gain=LEAST_GAIN,
                gain_window=min(action.gain_window, LONGEST, action.max_on),
                current=action.current,
            )
        case Turn():
            way = NUDGE if action.to_us >= action.from_us else -NUDGE
            action = dataclasses.replace(action, to_us=action.from_us + way, duration=200)
        case Release():
            action = dataclasses.replace(action, pulse=SHORT_PULSE)
    return Step(step.hinge, (), action)


def test_every_actuator_alone_moves_a_little_and_is_off_after(link, program, mcu, bench, measure):
    for step in program.steps:
        if isinstance(step.action, Release) and bench.hinges is Hinges.REAL:
            continue  # A burnt wire doesn't hold again.
        one = gentle(step)
        run.upload(link, program.rig, (one,))
        run.arm(link, program, mcu)
        run.begin(link)
        events, looks = run.watch_all(link, patience=30.0)
        kinds = [event.kind for event in events]
        assert StepOpened(0) in kinds
        done = next(kind for kind in kinds if isinstance(kind, StepDone))
        name = f"hinge {step.hinge}, {type(one.action).__name__.lower()} {step.action.channel}"
        started = next(event.at for event in events if event.kind == Entered(State.RUNNING))
        opened = next(event.at for event in events if event.kind == StepOpened(0))
        measure(f"{name}: time", (opened - started) / 1e6, "s", high=20)
        if isinstance(one.action, Pulse):
            measure(f"{name}: peak", done.peak / 100, "°C", WARM / 100, MOST_WARM / 100)
        most = max((look.current for look in looks), default=0)
        measure(f"{name}: current", most, "mA", high=program.limits(mcu).supply)
        status = link.status()
        assert (status.heaters_on, status.main_switch) == (0, False)
