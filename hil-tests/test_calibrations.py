"""What a board keeps of its heaters and servos as they were measured, and the steps that it refuses by it."""

import dataclasses

import pytest

from bench import run
from zygote_wire import commands
from zygote_wire.calibration import Actuator, CalibratedHeater, Calibration, Heater, HeaterCalibration
from zygote_wire.codes import Refused
from zygote_wire.commands import Heat
from zygote_wire.link import CommandRefused, Link
from zygote_wire.reports import Done, Refusal

pytestmark = pytest.mark.smoke


def known(link: Link, actuator: Actuator) -> Calibration:
    """What the board keeps of an actuator."""
    return link.request(commands.AskCalibration(actuator)).calibration


def refusal(link: Link, command: commands.Command) -> Refusal:
    """How a command is refused."""
    with pytest.raises(CommandRefused) as refused:
        link.request(command)
    return refused.value.refusal


@pytest.fixture
def step(program):
    """The first step that heats, and where it stands."""
    heats = [(at, step.action) for at, step in enumerate(program.steps) if isinstance(step.action, Heat)]
    if not heats:
        pytest.skip("no step of the bench's program heats")
    return heats[0]


@pytest.fixture
def calibrate(link, step):
    """Has the board keep something of that step's heater, which is left as it was found."""
    channel = step[1].channel
    before = known(link, Heater(channel))

    def calibrate(**changes: int) -> Calibration:
        heat = step[1]
        fitting = HeaterCalibration(heat.current, heat.min_gain, heat.gain_window, None)
        calibration = CalibratedHeater(channel, dataclasses.replace(fitting, **changes))
        assert link.request(commands.Calibrate(calibration)) == Done()
        assert known(link, Heater(channel)) == calibration
        return calibration

    yield calibrate
    link.request(commands.Calibrate(before))


def test_a_program_that_goes_with_what_was_measured_is_taken(link, program, calibrate):
    calibrate()
    run.load(link, program)


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"current": 10_000}, Refused.CALIBRATED_CURRENT),
        ({"gain": 30_000}, Refused.CALIBRATED_GAIN),
        ({"opens_at": 30_000}, Refused.CALIBRATED_TARGET),
    ],
)
def test_a_step_that_does_not_go_with_what_was_measured_is_refused(link, program, step, calibrate, changes, code):
    calibrate(**changes)
    with pytest.raises(CommandRefused) as refused:
        run.load(link, program)
    assert (refused.value.refusal.code, refused.value.refusal.at) == (code, step[0])


def test_values_and_channels_that_cannot_be_are_refused(link, mcu, step, calibrate):
    nothing = HeaterCalibration(current=0, gain=1, window=1, opens_at=None)
    channel, most = step[1].channel, mcu.channels.heaters
    asked = commands.Calibrate(CalibratedHeater(channel, nothing))
    assert refusal(link, asked) == Refusal(Refused.CALIBRATION_VALUE, channel, 1, 0)
    beyond = Refusal(Refused.UNKNOWN_CHANNEL, most, most - 1, most)
    assert refusal(link, commands.Calibrate(CalibratedHeater(most, None))) == beyond
    assert refusal(link, commands.AskCalibration(Heater(most))) == beyond
