"""What a board keeps of its actuators as they were measured."""

import dataclasses

from zygote_wire.postcard import I16, U16, U32


@dataclasses.dataclass(frozen=True)
class Heater:
    """The heater of this channel."""

    channel: U16


@dataclasses.dataclass(frozen=True)
class Servo:
    """The servo of this channel."""

    channel: U16


Actuator = Heater | Servo


@dataclasses.dataclass(frozen=True)
class HeaterCalibration:
    """A heater with its hinge."""

    current: U32
    gain: I16
    window: U32
    opens_at: I16 | None


@dataclasses.dataclass(frozen=True)
class ServoCalibration:
    """The pulses between which a servo moves without touching its ends."""

    shortest_us: U16
    longest_us: U16


@dataclasses.dataclass(frozen=True)
class CalibratedHeater:
    """What is known of a heater."""

    channel: U16
    known: HeaterCalibration | None


@dataclasses.dataclass(frozen=True)
class CalibratedServo:
    """What is known of a servo."""

    channel: U16
    known: ServoCalibration | None


Calibration = CalibratedHeater | CalibratedServo
