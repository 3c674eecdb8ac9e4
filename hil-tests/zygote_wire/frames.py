"""Frames: header, payload and CRC-32, in COBS, ended by a zero."""

import dataclasses
import enum
import struct
import zlib

from zygote_wire import cobs

HEADER = struct.Struct("<BIBB")
CRC = struct.Struct("<I")
LONGEST_PAYLOAD = 240
LONGEST_ENCODED = HEADER.size + LONGEST_PAYLOAD + CRC.size + 1


class Kind(enum.IntEnum):
    """What a frame is for."""

    HELLO = 0
    HELLO_REPLY = 1
    DATA = 2
    ACK = 3
    NACK = 4
    URGENT = 5
    URGENT_ACK = 6
    TELEMETRY = 7
    RESET = 8


class FrameError(ValueError):
    """Bytes between two zeros that are no frame."""


@dataclasses.dataclass(frozen=True)
class Frame:
    """One frame."""

    kind: Kind
    session: int
    seq: int = 0
    ack: int = 0
    payload: bytes = b""

    def encode(self) -> bytes:
        """The frame on the wire, its delimiter included."""
        body = HEADER.pack(self.kind, self.session, self.seq, self.ack) + self.payload
        return cobs.encode(body + CRC.pack(zlib.crc32(body))) + b"\0"


def decode(encoded: bytes) -> Frame:
    """The frame that stood between two zeros."""
    if len(encoded) > LONGEST_ENCODED:
        raise FrameError(f"{len(encoded)} bytes, a frame has at most {LONGEST_ENCODED}")
    try:
        raw = cobs.decode(encoded)
    except cobs.CobsError as error:
        raise FrameError("no COBS") from error
    if len(raw) < HEADER.size + CRC.size:
        raise FrameError(f"{len(raw)} bytes are no header and CRC")
    body, (crc,) = raw[: -CRC.size], CRC.unpack(raw[-CRC.size :])
    if zlib.crc32(body) != crc:
        raise FrameError(f"CRC {crc:08x}, expected {zlib.crc32(body):08x}")
    kind, session, seq, ack = HEADER.unpack(body[: HEADER.size])
    if kind not in iter(Kind):
        raise FrameError(f"unknown kind {kind}")
    return Frame(Kind(kind), session, seq, ack, body[HEADER.size :])


class Splitter:
    """Cuts a stream of bytes into frames."""

    def __init__(self) -> None:
        self.rest = b""
        self.broken = 0

    def feed(self, data: bytes) -> list[Frame]:
        """The good frames that end in `data`."""
        *whole, self.rest = (self.rest + data).split(b"\0")
        frames = []
        for encoded in filter(None, whole):
            try:
                frames.append(decode(encoded))
            except FrameError:
                self.broken += 1
        return frames
