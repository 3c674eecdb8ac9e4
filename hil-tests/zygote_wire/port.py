"""A serial port as frames: what the link uses, and tests that send what no link would."""

import time
from typing import Protocol

import serial

from zygote_wire.frames import Frame, Splitter


class Recorder(Protocol):
    """Takes down what goes over a line."""

    def sent(self, data: bytes | Frame) -> None: ...

    def heard(self, frame: Frame) -> None: ...


class Port:
    """An open serial port, or a pseudo-terminal."""

    def __init__(self, device: str, baud: int = 921_600, patience: float = 1.0, recorder: Recorder | None = None):
        self.device = device
        # How many times as long as a board in real time the other end may take for everything.
        self.patience = patience
        self.recorder = recorder
        self.serial = serial.Serial(device, baud, timeout=0, write_timeout=2)
        self.splitter = Splitter()

    def close(self) -> None:
        """Closes the port; the other end hears nothing any more."""
        self.serial.close()

    def open(self) -> None:
        """Opens the port again; what came in between is lost."""
        self.serial.open()
        self.serial.reset_input_buffer()

    def send(self, data: bytes | Frame) -> None:
        """Sends bytes as they are, or a frame."""
        if self.recorder:
            self.recorder.sent(data)
        self.serial.write(data.encode() if isinstance(data, Frame) else data)

    def receive(self, seconds: float) -> list[Frame]:
        """The frames that end in what comes next; waits no longer than this for the first byte."""
        self.serial.timeout = max(seconds, 0.0)
        data = self.serial.read(1)
        frames = self.splitter.feed(data + self.serial.read(self.serial.in_waiting)) if data else []
        for frame in frames if self.recorder else ():
            self.recorder.heard(frame)
        return frames

    def listen(self, seconds: float) -> list[Frame]:
        """Every frame that comes while an MCU's clock surely moves on by so much."""
        end = time.monotonic() + seconds * self.patience
        frames = []
        while (left := end - time.monotonic()) > 0:
            frames += self.receive(left)
        return frames
