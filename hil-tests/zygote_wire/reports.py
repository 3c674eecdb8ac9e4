"""What an MCU tells a host."""

import dataclasses
import enum

from zygote_wire.calibration import Calibration
from zygote_wire.codes import Faulted, Refused
from zygote_wire.hello import Settings
from zygote_wire.postcard import I16, I64, U8, U16, U32, U64


class State(enum.IntEnum):
    """What an MCU is doing."""

    IDLE = 0
    LOADED = 1
    ARMED = 2
    RUNNING = 3
    FINISHED = 4
    SAFE = 5


class StepState(enum.IntEnum):
    """How far a step is."""

    WAITING = 0
    MOVING = 1
    OPENED = 2
    DONE = 3
    INTERRUPTED = 4


@dataclasses.dataclass(frozen=True)
class Fault:
    """Why everything was turned off."""

    code: Faulted
    at: U64
    step: U16 | None
    channel: U16 | None
    value: I64
    limit: I64


@dataclasses.dataclass(frozen=True)
class Done:
    """The answer to a command that asks nothing."""


@dataclasses.dataclass(frozen=True)
class Status:
    """The MCU as it stands."""

    at: U64
    state: State
    run: U32 | None
    fault: Fault | None
    opened: U16
    heaters_on: U16
    main_switch: bool


@dataclasses.dataclass(frozen=True)
class Progress:
    """How far the steps are, from `first` on."""

    first: U16
    steps: tuple[StepState, ...]


@dataclasses.dataclass(frozen=True)
class Snapshot:
    """The MCU as it stood when it was reset; `states` has two bits a step, the lowest first."""

    boot: U32
    at: U64
    state: State
    run: U32 | None
    fault: Fault | None
    steps: U16
    states: tuple[U8, ...]
    session: U32 | None

    def step(self, number: int) -> int:
        """What had become of a step: 0 waiting, 1 interrupted, 2 open."""
        byte, place = divmod(number, 4)
        return self.states[byte] >> 2 * place & 3 if byte < len(self.states) else 0


@dataclasses.dataclass(frozen=True)
class LastRun:
    """What the MCU was doing before it was reset."""

    snapshot: Snapshot | None


@dataclasses.dataclass(frozen=True)
class SettingsReport:
    """What holds, and the most that can be set."""

    at: U64
    in_force: Settings
    compiled: Settings


@dataclasses.dataclass(frozen=True)
class Reading:
    """One heater and its thermistor; no temperature where it can't be believed."""

    temperature: I16 | None
    duty: U16


@dataclasses.dataclass(frozen=True)
class Readings:
    """Heaters from `first` on."""

    at: U64
    supply: U32
    current: U32
    first: U16
    channels: tuple[Reading, ...]


class MemoryState(enum.IntEnum):
    """Whether settings are kept."""

    KEPT = 0
    BLANK = 1
    OTHER_VERSION = 2
    UNUSABLE = 3


@dataclasses.dataclass(frozen=True)
class MemoryReport:
    """What became of what the board keeps over power cycles."""

    state: MemoryState
    damaged: U16


@dataclasses.dataclass(frozen=True)
class CalibrationReport:
    """What the board knows of an actuator."""

    calibration: Calibration


Reply = Done | Status | Progress | LastRun | SettingsReport | Readings | MemoryReport | CalibrationReport


@dataclasses.dataclass(frozen=True)
class Refusal:
    """Why a command was refused."""

    code: Refused
    at: U16
    expected: I64
    got: I64


@dataclasses.dataclass(frozen=True)
class Accepted:
    """The good half of a result."""

    reply: Reply


@dataclasses.dataclass(frozen=True)
class Rejected:
    """The bad half of a result."""

    refusal: Refusal


@dataclasses.dataclass(frozen=True)
class Response:
    """The answer to the request of this number."""

    id: U16
    result: Accepted | Rejected


@dataclasses.dataclass(frozen=True)
class Entered:
    """The MCU went into this state."""

    state: State


@dataclasses.dataclass(frozen=True)
class StepStarted:
    """A hinge starts to move."""

    step: U16


@dataclasses.dataclass(frozen=True)
class StepOpened:
    """A hinge is open."""

    step: U16


@dataclasses.dataclass(frozen=True)
class StepDone:
    """A step is over."""

    step: U16
    peak: I16 | None


@dataclasses.dataclass(frozen=True)
class Event:
    """Something happened."""

    at: U64
    kind: Entered | StepStarted | StepOpened | StepDone


Report = Response | Event


@dataclasses.dataclass(frozen=True)
class Heating:
    """A heater raises an SMA hinge to its target."""

    temperature: I16
    duty: U16


@dataclasses.dataclass(frozen=True)
class Holding:
    """A heater keeps an SMA hinge at its target."""

    temperature: I16
    duty: U16


@dataclasses.dataclass(frozen=True)
class Cooling:
    """An open SMA hinge cools."""

    temperature: I16


@dataclasses.dataclass(frozen=True)
class Turning:
    """A servo moves."""

    pulse_us: U16


@dataclasses.dataclass(frozen=True)
class Releasing:
    """A spring is being released, or opens."""


@dataclasses.dataclass(frozen=True)
class Motion:
    """A step under way."""

    step: U16
    phase: Heating | Holding | Cooling | Turning | Releasing


@dataclasses.dataclass(frozen=True)
class Telemetry:
    """A look at the rig."""

    at: U64
    state: State
    supply: U32
    current: U32
    opened: U16
    motions: tuple[Motion, ...]
