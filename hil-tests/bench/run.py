"""The verbs of a run, over a link."""

import time
from collections.abc import Callable

from bench.program import Program
from zygote_wire import commands, postcard, reports
from zygote_wire.commands import STEPS_PER_COMMAND, Step
from zygote_wire.frames import Kind
from zygote_wire.hello import HelloReply
from zygote_wire.link import CommandRefused, Link, NoAnswer
from zygote_wire.port import Port

RUN = 77
LIFETIME = 10_000


def upload(link: Link, rig: str, steps: tuple[Step, ...], run: int = RUN) -> None:
    """Uploads and commits a program; the steps go out without waiting for each answer."""
    link.request(commands.Upload(run, rig, len(steps), commands.program_crc(steps)))
    pending = []
    for first in range(0, len(steps), STEPS_PER_COMMAND):
        command = commands.Steps(first, steps[first : first + STEPS_PER_COMMAND])
        pending.append((command, link.submit(command)))
    for command, number in pending:
        match link.response(number):
            case reports.Rejected(refusal):
                raise CommandRefused(command, refusal)
    link.request(commands.Commit())


def load(link: Link, program: Program) -> None:
    """Uploads and commits the whole program."""
    upload(link, program.rig, program.steps)


def arm(link: Link, program: Program, mcu: HelloReply, link_timeout: int = 1_000) -> None:
    """Arms a loaded program."""
    link.request(commands.Arm(program.rig, program.limits(mcu, link_timeout), LIFETIME))


def start(link: Link, program: Program, mcu: HelloReply, link_timeout: int = 1_000) -> None:
    """Uploads, arms and starts the program."""
    load(link, program)
    arm(link, program, mcu, link_timeout)
    link.request(commands.Start(RUN))


def wait_for_heat(link: Link) -> None:
    """Waits until an SMA hinge is being heated, so that there is something to turn off."""
    link.notice(
        reports.Telemetry,
        lambda seen: any(
            isinstance(motion.phase, reports.Heating) and motion.phase.duty > 0 for motion in seen.motions
        ),
        patience=20.0,
    )
    status = link.status()
    assert (status.state, status.main_switch) == (reports.State.RUNNING, True)
    assert status.heaters_on > 0


def silence(port: Port, seconds: float, but: Callable[[], None] = lambda: None) -> None:
    """Says nothing but this until an MCU with an open session has told by telemetry that its clock moved on by so much."""
    first: int | None = None
    end = time.monotonic() + (seconds + 5) * port.patience
    while time.monotonic() < end:
        but()
        for frame in port.receive(0.1):
            if frame.kind == Kind.TELEMETRY:
                at = postcard.decode(reports.Telemetry, frame.payload).at
                first = at if first is None else first
                if at >= first + seconds * 1e6:
                    return
    raise NoAnswer(f"{port.device}: no telemetry of {seconds} s")


def watch(link: Link, patience: float) -> list[reports.Event]:
    """The events of a run up to its end."""
    events: list[reports.Event] = []
    end = time.monotonic() + patience * link.port.patience
    while not events or events[-1].kind != reports.Entered(reports.State.FINISHED):
        events.append(link.notice(reports.Event, patience=(end - time.monotonic()) / link.port.patience))
    return events
