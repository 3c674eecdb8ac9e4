"""What a host asks of an MCU, and the steps of a program."""

import dataclasses
import enum
import zlib
from collections.abc import Iterable

from zygote_wire import calibration, postcard
from zygote_wire.hello import Limits, Settings
from zygote_wire.postcard import I16, U16, U32, Text

STEPS_PER_COMMAND = 4


@dataclasses.dataclass(frozen=True)
class Heat:
    """Heat an SMA hinge to a temperature, hold it, let it cool."""

    channel: U16
    target: I16
    hold: U32
    max_on: U32
    max_temperature: I16
    cool: I16
    rest: U32
    min_gain: I16
    gain_window: U32
    current: U32


@dataclasses.dataclass(frozen=True)
class Turn:
    """Lead a servo from one pulse to another."""

    channel: U16
    from_us: U16
    to_us: U16
    duration: U32
    settle: U32
    current: U32
    hold_current: U32


@dataclasses.dataclass(frozen=True)
class Release:
    """Release a spring."""

    channel: U16
    pulse: U32
    settle: U32
    current: U32


@dataclasses.dataclass(frozen=True)
class Pulse:
    """Heat an SMA hinge at constant power for a while, let it cool."""

    channel: U16
    duty: U16
    duration: U32
    target: I16
    max_temperature: I16
    cool: I16
    rest: U32
    min_gain: I16
    gain_window: U32
    current: U32


@dataclasses.dataclass(frozen=True)
class Step:
    """The motion of one hinge."""

    hinge: U16
    after: tuple[U16, ...]
    action: Heat | Turn | Release | Pulse


def program_crc(steps: Iterable[Step]) -> int:
    """What `Upload` declares of its steps."""
    return zlib.crc32(b"".join(map(postcard.encode, steps)))


@dataclasses.dataclass(frozen=True)
class Status:
    """How are you?"""


@dataclasses.dataclass(frozen=True)
class Progress:
    """How far is each step, from this one on?"""

    first: U16


@dataclasses.dataclass(frozen=True)
class Upload:
    """A program follows."""

    run: U32
    rig: Text
    steps: U16
    crc: U32


@dataclasses.dataclass(frozen=True)
class Steps:
    """The next steps of the program."""

    first: U16
    steps: tuple[Step, ...]


@dataclasses.dataclass(frozen=True)
class Commit:
    """The program is complete: check it."""


@dataclasses.dataclass(frozen=True)
class Arm:
    """Allow motion."""

    rig: Text
    limits: Limits
    lifetime: U32


@dataclasses.dataclass(frozen=True)
class Start:
    """Execute the program."""

    run: U32


@dataclasses.dataclass(frozen=True)
class Disarm:
    """Everything off."""


@dataclasses.dataclass(frozen=True)
class Clear:
    """Leave the safe state: a person has looked."""


@dataclasses.dataclass(frozen=True)
class LastRun:
    """What were you doing before you were reset?"""


@dataclasses.dataclass(frozen=True)
class AskSettings:
    """Which limits are in force, and which are compiled in?"""


@dataclasses.dataclass(frozen=True)
class Configure:
    """Keep these settings for good."""

    settings: Settings


@dataclasses.dataclass(frozen=True)
class Readings:
    """What do the heaters' thermistors read, from this channel on?"""

    first: U16


@dataclasses.dataclass(frozen=True)
class Memory:
    """What became of what you keep over power cycles?"""


@dataclasses.dataclass(frozen=True)
class AskCalibration:
    """What do you know of this actuator?"""

    actuator: calibration.Actuator


@dataclasses.dataclass(frozen=True)
class Calibrate:
    """Keep this for good, or forget what you knew."""

    calibration: calibration.Calibration


Command = (
    Status
    | Progress
    | Upload
    | Steps
    | Commit
    | Arm
    | Start
    | Disarm
    | Clear
    | LastRun
    | AskSettings
    | Configure
    | Readings
    | Memory
    | AskCalibration
    | Calibrate
)


@dataclasses.dataclass(frozen=True)
class Request:
    """A command with the number that its response repeats."""

    id: U16
    command: Command


class Urgent(enum.IntEnum):
    """What overtakes everything."""

    STOP = 0
