"""A serial port as frames: what the link uses, and tests that send what no link would."""

import time

import serial

from zygote_wire.frames import Frame, Splitter


class Port:
    """An open serial port, or a pseudo-terminal."""

    def __init__(self, device: str, baud: int = 921_600):
        self.device = device
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
        self.serial.write(data.encode() if isinstance(data, Frame) else data)

    def receive(self, seconds: float) -> list[Frame]:
        """The frames that end in what comes next; waits no longer than this for the first byte."""
        self.serial.timeout = max(seconds, 0.0)
        data = self.serial.read(1)
        return self.splitter.feed(data + self.serial.read(self.serial.in_waiting)) if data else []

    def listen(self, seconds: float) -> list[Frame]:
        """Every frame that comes in this time."""
        end = time.monotonic() + seconds
        frames = []
        while (left := end - time.monotonic()) > 0:
            frames += self.receive(left)
        return frames
