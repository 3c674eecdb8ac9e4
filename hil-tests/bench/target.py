"""How a bench's board is had: a process that serves a pseudo-terminal, or a serial port that nobody else uses."""

import contextlib
import fcntl
import os
import re
import select
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

from serial.tools import list_ports

from bench.bench_file import Bench, BenchError, Target
from zygote_wire.frames import Frame, Kind
from zygote_wire.port import Port

START = 20.0
END = 5.0


@contextlib.contextmanager
def simulated(zygote: Path, bench: Bench, rig: Path, plan: Path, scenario: Path | None = None) -> Iterator[str]:
    """A simulated or emulated board that was just switched on; gives the device of its pseudo-terminal."""
    arguments: list[str | Path] = [zygote, "sim", "--rig", rig, "--plan", plan]
    if scenario:
        arguments += ["--scenario", scenario]
    if bench.target is Target.EMULATOR:
        assert bench.elf
        arguments += ["--emulate", bench.elf]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout
        assert process.stderr
        try:
            ready, _, _ = select.select([process.stdout], [], [], START * bench.patience)
            device = process.stdout.readline().strip() if ready else ""
            if not device:
                process.terminate()
                raise RuntimeError(f"zygote sim named no device:\n{process.stderr.read()}")
            if bench.target is Target.EMULATOR:
                _wait_until_awake(device, bench)
            yield device
        finally:
            process.terminate()
            process.wait(END * bench.patience)


def _wait_until_awake(device: str, bench: Bench) -> None:
    """What is sent while a board's program is still starting is lost; one that runs answers a stray frame."""
    stray = Frame(Kind.ACK, session=0xFFFFFFFF)
    with contextlib.closing(Port(device, bench.board.baud)) as port:
        for _ in range(int(10 * bench.patience)):
            port.send(stray)
            if port.receive(0.1):
                port.listen(0.1)
                return
    raise RuntimeError(f"{device}: the emulated board doesn't answer")


def find_port(bench: Bench) -> str:
    """The serial port of a bench's board: the one that is named, or the one with its USB serial number."""
    if bench.board.port:
        if not Path(bench.board.port).exists():
            raise BenchError(f"{bench.board.port}: no such device; is the board plugged in?")
        return bench.board.port
    if not bench.board.serial:
        raise BenchError(f"bench {bench.name}: name its port by --port, or by `port` or `serial` in [board]")
    found = list_ports.comports()
    for port in found:
        if port.serial_number == bench.board.serial:
            return port.device
    there = ", ".join(f"{port.device} ({port.serial_number or 'no number'})" for port in found) or "none"
    raise BenchError(f"bench {bench.name}: no serial port with USB serial number {bench.board.serial}; there are: {there}")


@contextlib.contextmanager
def alone(device: str) -> Iterator[None]:
    """Two runs on one board would move hinges under each other's hands: the second one is refused."""
    # Not the device itself: opened for the whole run, it would stay locked for the program under test.
    name = re.sub(r"\W", "-", os.path.realpath(device))
    path = Path(tempfile.gettempdir()) / f"zygote-hil{name}.lock"
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            owner = os.pread(descriptor, 32, 0).decode(errors="replace").strip()
            raise BenchError(f"{device}: another run of the suite is on it (process {owner})") from None
        os.ftruncate(descriptor, 0)
        os.pwrite(descriptor, f"{os.getpid()}\n".encode(), 0)
        yield
    finally:
        os.close(descriptor)
