"""The host's end of the link: hello, requests, news, stop; go-back-N as the page tells it.

Nothing runs by itself: a link that isn't pumped is a host that is silent.
"""

import collections
import dataclasses
import time
from collections.abc import Callable
from typing import TypeVar

from zygote_wire import commands, postcard, reports
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import Hello, HelloReply, granted_session
from zygote_wire.port import Port

WINDOW = 8
REPEAT_AFTER = 0.3
KEEP_ALIVE = 0.2
HELLO_EVERY = 0.2
PATIENCE = 5.0
OURS = Hello()

Notice = reports.Event | reports.Fault | reports.Telemetry
N = TypeVar("N", reports.Event, reports.Fault, reports.Telemetry)


class NoAnswer(Exception):
    """What was waited for didn't come."""


class SessionLost(Exception):
    """The MCU knows no such session."""


class CommandRefused(Exception):
    """The MCU refused a command."""

    def __init__(self, command: commands.Command, refusal: reports.Refusal):
        super().__init__(f"{command}: {refusal}")
        self.refusal = refusal


@dataclasses.dataclass
class Packet:
    """A payload on its way."""

    payload: bytes
    sent: float | None = None


class Link:
    """A session with an MCU."""

    def __init__(self, port: Port, asked: int):
        self.port = port
        self.asked = asked
        self.session = asked
        self.notices: collections.deque[Notice] = collections.deque()
        self.responses: dict[int, reports.Accepted | reports.Rejected] = {}
        self._next_id = 0
        self._outbox: collections.deque[Packet] = collections.deque()
        self._oldest = 0
        self._urgent: collections.deque[Packet] = collections.deque()
        self._urgent_seq = 0
        self._urgent_acks: list[int] = []
        self._expected = 0
        self._owed: Kind | None = None
        self._last_said = 0.0
        self._gone_back = False
        self._broken = 0
        self._last_fault: reports.Fault | None = None

    def hello(self, hello: Hello = OURS, patience: float = PATIENCE) -> HelloReply:
        """Opens the session, or asks again who is there."""
        frame = Frame(Kind.HELLO, self.asked, payload=postcard.encode(hello))
        end = time.monotonic() + patience * self.port.patience
        while time.monotonic() < end:
            self.port.send(frame)
            again = time.monotonic() + HELLO_EVERY
            while (left := again - time.monotonic()) > 0:
                for answer in self.port.receive(left):
                    if answer.kind == Kind.HELLO_REPLY and answer.session == self.asked:
                        reply = postcard.decode(HelloReply, answer.payload)
                        self.session = granted_session(self.asked, reply.identity.boot)
                        return reply
                    self._take(answer)
        raise NoAnswer(f"{self.port.device}: no answer to a hello within {patience} s")

    def submit(self, command: commands.Command) -> int:
        """Sends a command without waiting for its response."""
        request = commands.Request(self._next_id, command)
        self._next_id = (self._next_id + 1) % 0x10000
        self._wait(lambda: len(self._outbox) < WINDOW, "room for a command")
        self._outbox.append(Packet(postcard.encode(request)))
        self._transmit()
        return request.id

    def response(self, number: int) -> reports.Accepted | reports.Rejected:
        """The response to a submitted command."""
        self._wait(lambda: number in self.responses, f"the response to request {number}")
        return self.responses.pop(number)

    def request(self, command: commands.Command) -> reports.Reply:
        """Sends a command and returns its reply."""
        match self.response(self.submit(command)):
            case reports.Accepted(reply):
                return reply
            case reports.Rejected(refusal):
                raise CommandRefused(command, refusal)

    def status(self) -> reports.Status:
        """How is the MCU?"""
        reply = self.request(commands.Status())
        assert isinstance(reply, reports.Status), reply
        return reply

    def progress(self) -> tuple[reports.StepState, ...]:
        """How far is each step of the program?"""
        states: tuple[reports.StepState, ...] = ()
        while True:
            reply = self.request(commands.Progress(len(states)))
            assert isinstance(reply, reports.Progress), reply
            if not reply.steps:
                return states
            states += reply.steps

    def stop(self) -> float:
        """Stops everything; returns the seconds until that was confirmed."""
        asked = time.monotonic()
        self._urgent.append(Packet(postcard.encode(commands.Urgent.STOP)))
        self._wait(lambda: not self._urgent, "the confirmation of a stop")
        return time.monotonic() - asked

    def notice(self, kind: type[N], wanted: Callable[[N], bool] = lambda _: True, patience: float = PATIENCE) -> N:
        """The next piece of news of this kind that is wanted; earlier news is dropped."""
        end = time.monotonic() + patience * self.port.patience
        while True:
            while self.notices:
                notice = self.notices.popleft()
                if isinstance(notice, kind) and wanted(notice):
                    return notice
            if time.monotonic() >= end:
                raise NoAnswer(f"no {kind.__name__} as wanted within {patience} s")
            self.pump(end - time.monotonic())

    def pump(self, seconds: float) -> None:
        """Sends what is due, takes what comes; returns at the first bytes, or when something more is due."""
        self._transmit()
        self._receive(min(seconds, KEEP_ALIVE / 2))
        self._transmit()

    def live(self, seconds: float) -> None:
        """Does nothing but keep the link alive, while the MCU's clock moves on by so much."""
        start = self.status().at
        while (left := seconds - (self.status().at - start) / 1e6) > 0:
            end = time.monotonic() + left
            while (wait := end - time.monotonic()) > 0:
                self.pump(wait)

    def _wait(self, done: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + PATIENCE * self.port.patience
        while not done():
            if time.monotonic() >= end:
                raise NoAnswer(f"{self.port.device}: {what} didn't come within {PATIENCE} s")
            self.pump(end - time.monotonic())

    def _receive(self, seconds: float) -> None:
        for frame in self.port.receive(seconds):
            self._take(frame)
        if self.port.splitter.broken != self._broken:
            self._broken = self.port.splitter.broken
            self._owed = Kind.NACK

    def _take(self, frame: Frame) -> None:
        if frame.session != self.session:
            return
        if frame.kind == Kind.RESET:
            raise SessionLost(f"{self.port.device}: the MCU knows no session {self.session}")
        if frame.kind not in (Kind.HELLO, Kind.HELLO_REPLY, Kind.URGENT_ACK):
            self._acknowledged(frame.ack)
        match frame.kind:
            case Kind.DATA:
                self._take_data(frame)
            case Kind.NACK if not self._gone_back:
                self._go_back()
                self._gone_back = True
            case Kind.URGENT:
                self._urgent_acks.append(frame.seq)
                fault = postcard.decode(reports.Fault, frame.payload)
                if fault != self._last_fault:
                    self._last_fault = fault
                    self.notices.append(fault)
            case Kind.URGENT_ACK if self._urgent and frame.seq == self._urgent_seq:
                self._urgent.popleft()
                self._urgent_seq = (self._urgent_seq + 1) % 256
            case Kind.TELEMETRY:
                self.notices.append(postcard.decode(reports.Telemetry, frame.payload))

    def _take_data(self, frame: Frame) -> None:
        ahead = (frame.seq - self._expected) % 256
        if ahead == 0:
            self._expected = (self._expected + 1) % 256
            self._owed = self._owed or Kind.ACK
            match postcard.decode(reports.Report, frame.payload):
                case reports.Response(number, result):
                    self.responses[number] = result
                case event:
                    self.notices.append(event)
        else:
            self._owed = Kind.NACK if ahead < WINDOW else self._owed or Kind.ACK

    def _acknowledged(self, ack: int) -> None:
        count = (ack - self._oldest) % 256
        if 0 < count <= len(self._outbox):
            for _ in range(count):
                self._outbox.popleft()
            self._oldest = ack
            self._gone_back = False

    def _go_back(self) -> None:
        for packet in self._outbox:
            packet.sent = None

    def _transmit(self) -> None:
        now = time.monotonic()
        for seq in self._urgent_acks:
            self._send(Kind.URGENT_ACK, seq)
        self._urgent_acks.clear()
        if self._urgent and _is_due(self._urgent[0], now):
            self._urgent[0].sent = now
            self._send(Kind.URGENT, self._urgent_seq, self._urgent[0].payload)
        if self._owed == Kind.NACK:
            self._send(Kind.NACK)
        if self._outbox and self._outbox[0].sent is not None and _is_due(self._outbox[0], now):
            self._go_back()
            self._gone_back = False
        for offset, packet in enumerate(self._outbox):
            if packet.sent is None:
                packet.sent = now
                self._send(Kind.DATA, (self._oldest + offset) % 256, packet.payload)
        if self._owed == Kind.ACK or now - self._last_said >= KEEP_ALIVE:
            self._send(Kind.ACK)

    def _send(self, kind: Kind, seq: int = 0, payload: bytes = b"") -> None:
        self.port.send(Frame(kind, self.session, seq, self._expected, payload))
        self._last_said = time.monotonic()
        if kind in (Kind.NACK, Kind.DATA, Kind.ACK):
            self._owed = None


def _is_due(packet: Packet, now: float) -> bool:
    return packet.sent is None or now - packet.sent >= REPEAT_AFTER
