"""The line that the tests run on: a fresh `zygote sim` for every test, or a board at `--port`."""

import contextlib
import os
import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from bench import program as programs
from bench.program import Program
from bench.simulator import simulator
from zygote_wire import commands, reports
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import HelloReply
from zygote_wire.link import Link
from zygote_wire.port import Port

SUITE = Path(__file__).parent
REPOSITORY = SUITE.parent
STOP = Frame(Kind.URGENT, session=0, payload=b"\0")


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("zygote")
    group.addoption(
        "--port", metavar="DEV", help="a board's serial port; without it, the simulator. HINGES WILL MOVE"
    )
    group.addoption("--baud", type=int, default=921_600, help="speed of the port [921600]")
    group.addoption("--rig", type=Path, default=SUITE / "quick.toml", help="rig file [hil-tests/quick.toml]")
    group.addoption("--seed", type=int, help="seed of the random tests [another one each time]")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--seed") is None:
        config.option.seed = random.SystemRandom().randrange(1 << 32)


def pytest_report_header(config: pytest.Config) -> str:
    where = config.getoption("--port") or "simulator"
    return f"zygote: {where}, rig {config.getoption('--rig').name}, --seed {config.getoption('--seed')}"


@pytest.fixture(scope="session")
def zygote() -> Path:
    """The program: `$ZYGOTE`, else the debug build of this repository."""
    path = Path(os.environ.get("ZYGOTE") or REPOSITORY / "target/debug/zygote")
    if not path.is_file():
        pytest.exit(f"{path}: no such program; run `cargo build -p zygote-cli`, or set ZYGOTE", returncode=2)
    return path


@pytest.fixture(scope="session")
def program(zygote: Path, pytestconfig: pytest.Config, tmp_path_factory: pytest.TempPathFactory) -> Program:
    """The 14 panels of three voxels, planned and scheduled for the rig."""
    model = REPOSITORY / "models/i14.txt"
    return programs.make(zygote, model, pytestconfig.getoption("--rig"), tmp_path_factory.mktemp("program"))


@pytest.fixture
def device(zygote: Path, program: Program, pytestconfig: pytest.Config) -> Iterator[str]:
    """The serial device of an MCU: a simulated board that was just switched on, or the real one."""
    if board := pytestconfig.getoption("--port"):
        yield board
        return
    with simulator(zygote, program.rig_file, program.plan) as simulated:
        yield simulated


@pytest.fixture
def rng(pytestconfig: pytest.Config) -> random.Random:
    """Chance, from the seed that the report's header tells."""
    return random.Random(pytestconfig.getoption("--seed"))


@pytest.fixture
def baud(pytestconfig: pytest.Config) -> int:
    """Speed of the line."""
    return pytestconfig.getoption("--baud")


@pytest.fixture
def port(device: str, baud: int) -> Iterator[Port]:
    """The line to the MCU, without a session."""
    with contextlib.closing(Port(device, baud)) as line:
        yield line


@pytest.fixture
def session() -> int:
    """A number that no session had before."""
    return random.SystemRandom().randrange(1, 1 << 32)


@pytest.fixture
def link(port: Port, session: int) -> Iterator[Link]:
    """An open session with an MCU that isn't in Safe; whatever the test did, it ends with everything off."""
    link = Link(port, session)
    link.hello()
    if link.status().state == reports.State.SAFE:
        link.request(commands.Clear())
    yield link
    port.send(STOP)


@pytest.fixture
def mcu(link: Link) -> HelloReply:
    """What the MCU says of itself."""
    return link.hello()
