"""A device that is there but no zygote of ours: silent, or of another version."""

import contextlib
import os
import pty
import select
import threading
import tty
from collections.abc import Callable, Iterator

from zygote_wire.frames import Frame, Splitter

Answer = Callable[[Frame], bytes]


@contextlib.contextmanager
def fake_mcu(answer: Answer) -> Iterator[str]:
    """A pseudo-terminal on which every frame gets `answer`'s bytes; gives its device."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    woken, wake = os.pipe()
    thread = threading.Thread(target=_serve, args=(master, woken, answer), daemon=True)
    thread.start()
    try:
        yield os.ttyname(slave)
    finally:
        os.write(wake, b"\0")
        thread.join()
        for descriptor in (master, slave, woken, wake):
            os.close(descriptor)


def silence(_: Frame) -> bytes:
    """Nobody there."""
    return b""


def _serve(master: int, woken: int, answer: Answer) -> None:
    splitter = Splitter()
    while woken not in (ready := select.select([master, woken], [], [])[0]):
        if master in ready:
            for frame in splitter.feed(os.read(master, 4096)):
                os.write(master, answer(frame))
