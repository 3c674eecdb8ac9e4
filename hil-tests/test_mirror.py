"""This suite's implementation of the protocol against the Rust one, on thousands of random messages."""

import random
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from zygote_wire import chance, commands, frames, hello, postcard, reports
from zygote_wire.frames import FrameError, Frame, Kind

pytestmark = pytest.mark.smoke

MESSAGES = 1_000
KINDS = {
    "hello": hello.Hello,
    "hello-reply": hello.HelloReply,
    "request": commands.Request,
    "urgent": commands.Urgent,
    "report": reports.Report,
    "fault": reports.Fault,
    "telemetry": reports.Telemetry,
}

Mirror = Callable[[str, bytes], bytes | None]


@pytest.fixture(scope="module")
def mirror(zygote) -> Iterator[Mirror]:
    """What Rust encodes of what it decoded, or nothing if it refuses it."""
    program = Path(zygote).parent / "examples/mirror"
    if not program.is_file():
        pytest.skip(f"{program} isn't there; `cargo build -p zygote-protocol --example mirror` builds it")
    with subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:

        def mirror(kind: str, data: bytes) -> bytes | None:
            process.stdin.write(f"{kind} {data.hex()}\n")
            process.stdin.flush()
            answer = process.stdout.readline().strip()
            return None if answer == "refused" else bytes.fromhex(answer)

        yield mirror
        process.stdin.close()


def own(hint: Any, data: bytes) -> bytes | None:
    """What this suite encodes of what it decoded, or nothing if it refuses it."""
    try:
        return postcard.encode(postcard.decode(hint, data), hint)
    except (postcard.PostcardError, UnicodeDecodeError):
        return None


def damaged(data: bytes, rng: random.Random) -> bytes:
    """The bytes with one changed, taken out or put in."""
    at = rng.randrange(len(data))
    change = bytes([rng.randrange(256)])
    return rng.choice([data[:at] + change + data[at + 1 :], data[:at] + data[at + 1 :], data[:at] + change + data[at:]])


@pytest.mark.parametrize("kind", KINDS)
def test_rust_reads_what_python_writes_and_python_what_rust_writes(kind, mirror, rng):
    hint = KINDS[kind]
    for _ in range(MESSAGES):
        message = chance.message(hint, rng)
        written = postcard.encode(message, hint)
        back = mirror(kind, written)
        assert back == written, message
        assert postcard.decode(hint, back) == message


@pytest.mark.parametrize("kind", KINDS)
def test_both_refuse_the_same_damaged_messages(kind, mirror, rng):
    hint = KINDS[kind]
    refused = 0
    for _ in range(MESSAGES):
        data = damaged(postcard.encode(chance.message(hint, rng), hint), rng)
        here, there = own(hint, data), mirror(kind, data)
        if there is None and here is not None:
            # Only the receiver's room is less than what this suite takes.
            assert is_roomy(postcard.decode(hint, data)), data.hex()
        else:
            assert here == there, data.hex()
        refused += there is None
    assert refused > MESSAGES / 100


def is_roomy(value: Any) -> bool:
    """Whether a text or a list in it is longer than the shortest that some receiver must take."""
    if isinstance(value, str):
        return len(value.encode()) > chance.SHORTEST_TEXT
    if isinstance(value, tuple):
        return len(value) > chance.SHORTEST_LIST or any(map(is_roomy, value))
    return any(map(is_roomy, vars(value).values())) if hasattr(value, "__dataclass_fields__") else False


def test_frames_are_the_same_and_damaged_ones_refused_by_both(mirror, rng):
    for _ in range(MESSAGES):
        length = rng.choice([0, rng.randrange(20), rng.randrange(frames.LONGEST_PAYLOAD + 1), frames.LONGEST_PAYLOAD])
        payload = bytes(rng.choices(range(256), weights=[20] + [1] * 255, k=length))
        frame = Frame(rng.choice(list(Kind)), rng.getrandbits(32), rng.getrandbits(8), rng.getrandbits(8), payload)
        wire = frame.encode()
        assert mirror("frame", wire) == wire
        broken = damaged(wire[:-1], rng)
        if broken == wire[:-1] or 0 in broken:
            continue
        assert mirror("frame", broken + b"\0") is None
        with pytest.raises(FrameError):
            frames.decode(broken)
