"""What went over a test's lines: everything that happened, and the last ten seconds of telemetry; written down if it fails."""

import collections
import dataclasses
import enum
import json
import time
from pathlib import Path
from typing import Any

from zygote_wire import commands, postcard, reports
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import HelloReply

KEPT_US = 10_000_000
# A test that talks for hours keeps what came last.
MOST_EVENTS = 20_000


class Flight:
    """The recorder of one test."""

    def __init__(self) -> None:
        self.start = time.monotonic()
        self.events: collections.deque[dict[str, Any]] = collections.deque(maxlen=MOST_EVENTS)
        self.telemetry: collections.deque[tuple[float, reports.Telemetry]] = collections.deque()
        self.hello: HelloReply | None = None

    def sent(self, data: bytes | Frame) -> None:
        """Takes down what the suite sends."""
        if not isinstance(data, Frame):
            self._log("sent", f"{len(data)} bytes")
        elif data.kind == Kind.DATA:
            self._log("sent", *_read(commands.Request, data))
        elif data.kind not in (Kind.ACK, Kind.URGENT_ACK):
            self._log("sent", getattr(data.kind, "name", f"kind {data.kind}"))

    def heard(self, frame: Frame) -> None:
        """Takes down what came."""
        match frame.kind:
            case Kind.TELEMETRY:
                for look in _read(reports.Telemetry, frame):
                    self._look(look)
            case Kind.DATA:
                self._log("heard", *_read(reports.Report, frame))
            case Kind.URGENT:
                self._log("heard", *_read(reports.Fault, frame))
            case Kind.HELLO_REPLY:
                for reply in _read(HelloReply, frame):
                    self.hello = reply if isinstance(reply, HelloReply) else self.hello
                    self._log("heard", reply)
            case Kind.NACK | Kind.RESET:
                self._log("heard", frame.kind.name)

    def write(self, folder: Path) -> list[Path]:
        """Writes events and telemetry, a line each; returns the files."""
        folder.mkdir(parents=True, exist_ok=True)
        events, telemetry = folder / "events.jsonl", folder / "telemetry.jsonl"
        events.write_text("".join(json.dumps(event) + "\n" for event in self.events))
        looks = ({"s": round(at, 6), **plain(look)} for at, look in self.telemetry)
        telemetry.write_text("".join(json.dumps(look) + "\n" for look in looks))
        return [events, telemetry]

    def _look(self, look: Any) -> None:
        if not isinstance(look, reports.Telemetry):
            self._log("heard", look)
            return
        # A board that was reset begins anew.
        while self.telemetry and not 0 <= look.at - self.telemetry[0][1].at <= KEPT_US:
            self.telemetry.popleft()
        self.telemetry.append((time.monotonic() - self.start, look))

    def _log(self, way: str, *what: Any) -> None:
        for each in what:
            self.events.append({"s": round(time.monotonic() - self.start, 6), way: plain(each)})


def _read(hint: Any, frame: Frame) -> list[Any]:
    """The message of a frame; tests send, and a broken board may, what is none."""
    try:
        return [postcard.decode(hint, frame.payload)]
    except (postcard.PostcardError, UnicodeDecodeError) as error:
        return [f"{frame.kind.name} {frame.payload.hex()}: {error}"]


def plain(value: Any) -> Any:
    """A message as JSON has it: what a dataclass is called stands beside its fields."""
    if dataclasses.is_dataclass(value):
        fields = {field.name: plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
        return {"is": type(value).__name__, **fields}
    if isinstance(value, enum.Enum):
        return value.name
    if isinstance(value, bytes):
        return value.hex()
    return [plain(each) for each in value] if isinstance(value, tuple) else value
