"""The golden bytes of `docs/src/protocol.md`, against this suite's own reader and writer."""

import re
from pathlib import Path

import pytest

from zygote_wire import calibration, cobs, codes, commands, frames, postcard, reports
from zygote_wire.codes import Faulted, Refused
from zygote_wire.commands import Heat, Pulse, Release, Step, Turn
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import SCHEMA, Hello, Limits, Settings

pytestmark = pytest.mark.smoke

BOOK = Path(__file__).parent.parent / "docs/src"
PAGE = (BOOK / "protocol.md").read_text()

FAULT = reports.Fault(Faulted.OVER_TEMPERATURE, at=5_000_000, step=3, channel=2, value=12_050, limit=-1)
STATUS = reports.Status(1_000_000, reports.State.SAFE, 7, FAULT, opened=3, heaters_on=0, main_switch=False)
FROZEN = reports.Fault(Faulted.SENSOR_FROZEN, at=5_000_000, step=3, channel=2, value=6_000, limit=1_500)
SNAPSHOT = reports.Snapshot(9, 5_000_000, reports.State.SAFE, 7, FROZEN, steps=5, states=(0x4A, 0x01), session=3)
LIMITS = Limits(max_temperature=12_000, max_on=30_000, min_rest=500, supply=2_000, link_timeout=1_000)
SETTINGS = Settings(LIMITS, shortest_pulse_us=500, longest_pulse_us=2_500)
HEAT = Heat(3, 9_500, 1_000, 20_000, 12_000, 4_500, 500, 500, 3_000, 200)
STEPS = (
    Step(300, (0, 2), HEAT),
    Step(1, (), Turn(2, 500, 1_500, 900, 150, 400, 50)),
    Step(2, (), Release(0, 200, 500, 1_000)),
)
HEATER = calibration.HeaterCalibration(current=200, gain=4_800, window=3_000, opens_at=7_800)
UNSEEN = calibration.HeaterCalibration(current=200, gain=4_800, window=3_000, opens_at=None)
SERVO = calibration.ServoCalibration(shortest_us=520, longest_us=2_480)
PULSED = (Step(4, (), Pulse(3, 250, 20_000, 9_500, 12_000, 4_500, 500, 150, 5_000, 200)),)
MOTIONS = (
    reports.Motion(0, reports.Heating(-5, 1_000)),
    reports.Motion(1, reports.Holding(9_600, 400)),
    reports.Motion(2, reports.Cooling(6_000)),
    reports.Motion(3, reports.Turning(1_200)),
    reports.Motion(4, reports.Releasing()),
)


def request(command: commands.Command) -> commands.Request:
    return commands.Request(513, command)


def response(reply: reports.Reply) -> reports.Response:
    return reports.Response(513, reports.Accepted(reply))


def event(kind: object) -> reports.Event:
    return reports.Event(300, kind)


# In the order of the page's table.
MESSAGES = [
    (Hello, Hello(1, 1, 0x12345678)),
    (commands.Request, request(commands.Status())),
    (commands.Request, request(commands.Progress(64))),
    (commands.Request, request(commands.Upload(7, "bench-1", 13, 0xDEADBEEF))),
    (commands.Request, request(commands.Steps(4, STEPS))),
    (commands.Request, request(commands.Commit())),
    (commands.Request, request(commands.Arm("bench-1", LIMITS, 60_000))),
    (commands.Request, request(commands.Start(7))),
    (commands.Request, request(commands.Disarm())),
    (commands.Request, request(commands.Clear())),
    (commands.Request, request(commands.LastRun())),
    (commands.Request, request(commands.AskSettings())),
    (commands.Request, request(commands.Configure(SETTINGS))),
    (commands.Request, request(commands.Steps(0, PULSED))),
    (commands.Request, request(commands.Readings(16))),
    (commands.Request, request(commands.Memory())),
    (commands.Request, request(commands.AskCalibration(calibration.Heater(3)))),
    (commands.Request, request(commands.AskCalibration(calibration.Servo(300)))),
    (commands.Request, request(commands.Calibrate(calibration.CalibratedHeater(3, HEATER)))),
    (commands.Request, request(commands.Calibrate(calibration.CalibratedHeater(3, UNSEEN)))),
    (commands.Request, request(commands.Calibrate(calibration.CalibratedHeater(3, None)))),
    (commands.Urgent, commands.Urgent.STOP),
    (reports.Report, response(reports.Done())),
    (reports.Report, response(STATUS)),
    (
        reports.Report,
        response(
            reports.Progress(0, (reports.StepState.WAITING, reports.StepState.DONE, reports.StepState.INTERRUPTED))
        ),
    ),
    (
        reports.Report,
        reports.Response(513, reports.Rejected(reports.Refusal(Refused.LIMIT_ABOVE_CEILING, 3, 2_000, 3_000))),
    ),
    (reports.Report, response(reports.LastRun(None))),
    (reports.Report, response(reports.LastRun(SNAPSHOT))),
    (reports.Report, response(reports.SettingsReport(300, SETTINGS, SETTINGS))),
    (
        reports.Report,
        response(
            reports.Readings(300, 4_950, 620, 16, (reports.Reading(2_345, 250), reports.Reading(None, 0)))
        ),
    ),
    (reports.Report, response(reports.MemoryReport(reports.MemoryState.OTHER_VERSION, 300))),
    (reports.Report, response(reports.CalibrationReport(calibration.CalibratedServo(3, SERVO)))),
    (reports.Report, response(reports.CalibrationReport(calibration.CalibratedServo(3, None)))),
    (reports.Report, event(reports.Entered(reports.State.RUNNING))),
    (reports.Report, event(reports.StepStarted(1))),
    (reports.Report, event(reports.StepOpened(1))),
    (reports.Report, event(reports.StepDone(1, 9_700))),
    (reports.Fault, FAULT),
    (reports.Fault, FROZEN),
    (reports.Fault, reports.Fault(Faulted.UNPLANNED_CURRENT, at=5_000_000, step=None, channel=None, value=800, limit=400)),
    (
        reports.Telemetry,
        reports.Telemetry(70_000_000_000, reports.State.RUNNING, 4_950, 620, 9, MOTIONS),
    ),
]


def golden_rows() -> list[tuple[str, str]]:
    """What the page's table of golden bytes says: message and hex."""
    table = PAGE.split("## Golden bytes")[1]
    return re.findall(r"^\| (.+) \| `([0-9a-f]+)` \|$", table, re.MULTILINE)


def test_the_page_has_golden_bytes_for_every_message_here():
    assert len(golden_rows()) == len(MESSAGES)


@pytest.mark.parametrize(
    ("hint", "message", "expected"),
    [
        pytest.param(hint, message, bytes.fromhex(row[1]), id=row[0].split(",")[0])
        for (hint, message), row in zip(MESSAGES, golden_rows(), strict=False)
    ],
)
def test_golden_bytes_are_read_and_written(hint, message, expected):
    assert postcard.decode(hint, expected) == message
    assert postcard.encode(message, hint) == expected


def test_the_example_frame_is_read_and_written():
    wire = bytes.fromhex(re.search(r"^wire   ([0-9a-f ]+)$", PAGE, re.MULTILINE)[1])
    frame = Frame(Kind.DATA, session=0x01020304, seq=5, ack=0, payload=b"\0\1\0")
    assert frame.encode() == wire
    assert frames.decode(wire[:-1]) == frame


def test_the_page_tells_the_schema_hash():
    assert f"schema hash is **`0x{SCHEMA:08x}`**" in PAGE


def test_the_page_tells_every_code():
    page = (BOOK / "faults.md").read_text()
    for letter, kind in (("R", codes.Refused), ("F", codes.Faulted)):
        told = re.findall(rf"^\| {letter}(\d\d) \| (\w+) \|", page, re.MULTILINE)
        expected = [(f"{code + 1:02}", code.name.title().replace("_", "")) for code in kind]
        assert told == expected


def test_cobs_gives_back_what_it_was_given(rng):
    for _ in range(500):
        raw = bytes(rng.choices(range(256), weights=[20] + [1] * 255, k=rng.randrange(600)))
        encoded = cobs.encode(raw)
        assert 0 not in encoded
        assert cobs.decode(encoded) == raw


def test_numbers_at_the_ends_of_their_range_are_read_and_written():
    for hint, ends in (
        (postcard.U16, (0, 0xFFFF)),
        (postcard.U64, (0, 0xFFFF_FFFF_FFFF_FFFF)),
        (postcard.I16, (-0x8000, 0x7FFF)),
        (postcard.I64, (-(1 << 63), (1 << 63) - 1)),
    ):
        for value in ends:
            assert postcard.decode(hint, postcard.encode(value, hint)) == value
    with pytest.raises(postcard.PostcardError):
        postcard.decode(postcard.U16, b"\xff\xff\x07")
