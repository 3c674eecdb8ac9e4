"""The first exchange."""

import dataclasses
import enum
from typing import Annotated

from zygote_wire.postcard import I16, U8, U16, U32, Raw, Text

VERSION = 5
SCHEMA = 0x7A13A429


class ResetCause(enum.IntEnum):
    """Why the MCU last started."""

    POWER = 0
    PIN = 1
    WATCHDOG = 2
    SOFTWARE = 3
    UNKNOWN = 4
    DEAD_MAN = 5


@dataclasses.dataclass(frozen=True)
class Hello:
    """Host to MCU; also the front of every hello and answer of any version."""

    min: U16 = VERSION
    current: U16 = VERSION
    schema: U32 = SCHEMA


@dataclasses.dataclass(frozen=True)
class Identity:
    """Who an MCU is."""

    boot: U32
    firmware: Text
    git: Text
    board: Text
    unique_id: Annotated[bytes, Raw(12)]
    reset: ResetCause


@dataclasses.dataclass(frozen=True)
class Limits:
    """What no hinge and no host may exceed: 0.01 °C, ms, ms, mA, ms."""

    max_temperature: I16
    max_on: U32
    min_rest: U32
    supply: U32
    link_timeout: U32


@dataclasses.dataclass(frozen=True)
class Settings:
    """What a board keeps over power cycles."""

    ceiling: Limits
    shortest_pulse_us: U16
    longest_pulse_us: U16


@dataclasses.dataclass(frozen=True)
class Channels:
    """How many actuators of each kind there are."""

    heaters: U16
    servos: U16
    springs: U16


@dataclasses.dataclass(frozen=True)
class Buffers:
    """How much an MCU can take in."""

    steps: U16
    window: U8
    payload: U16


@dataclasses.dataclass(frozen=True)
class HelloReply:
    """MCU to host."""

    min: U16
    current: U16
    schema: U32
    identity: Identity
    ceiling: Limits
    channels: Channels
    buffers: Buffers


def granted_session(asked: int, boot: int) -> int:
    """The session that an MCU of this boot opens for a hello."""
    return (asked ^ boot * 0x9E3779B9 & 0xFFFFFFFF) or asked
