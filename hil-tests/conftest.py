"""Options of the suite, and the line that its tests run on."""

import contextlib
import dataclasses
import functools
import os
import random
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from bench import bench_file, program as programs, target as targets
from bench.bench_file import Bench, BenchError, Level, Target
from bench.flight import Flight
from bench.host import Deploy
from bench.measurement import Measurement
from bench.program import Program
from bench.record import FLIGHT, MEASURED, Record
from zygote_wire import commands, reports
from zygote_wire.frames import Frame, Kind
from zygote_wire.hello import HelloReply
from zygote_wire.link import Link
from zygote_wire.port import Port

SUITE = Path(__file__).parent
REPOSITORY = SUITE.parent
STOP = Frame(Kind.URGENT, session=0, payload=b"\0")
RECORD = "zygote-record"
BENCH = pytest.StashKey[Bench]()


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("zygote")
    group.addoption("--target", choices=list(Target), help="what to test, as benches/TARGET.toml says [sim]")
    group.addoption("--bench", type=Path, metavar="FILE", help="a bench file, where it isn't one of those")
    group.addoption(
        "--level",
        action="append",
        choices=list(Level),
        help="may be repeated [all that the bench allows but soak]",
    )
    group.addoption("--port", metavar="DEV", help="a board's serial port, instead of the bench file's")
    group.addoption("--baud", type=int, help="speed of the port, instead of the bench file's")
    group.addoption("--rig", type=Path, help="rig file, instead of the bench file's")
    group.addoption("--elf", type=Path, help="the board's program, instead of the bench file's")
    group.addoption("--out", type=Path, metavar="DIR", help="write records there: junit.xml, record.json, failures/")
    group.addoption("--seed", type=int, help="seed of the random tests [another one each time]")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--seed") is None:
        config.option.seed = random.SystemRandom().randrange(1 << 32)
    try:
        bench = config.stash[BENCH] = _bench(config)
    except BenchError as error:
        raise pytest.UsageError(str(error)) from error
    if out := config.getoption("--out"):
        out.mkdir(parents=True, exist_ok=True)
        config.option.xmlpath = config.option.xmlpath or str(out / "junit.xml")
    config.pluginmanager.register(Record(bench, config.getoption("--seed"), out, REPOSITORY), RECORD)


def _bench(config: pytest.Config) -> Bench:
    """The bench that the options choose."""
    asked, port = config.getoption("--target"), config.getoption("--port")
    target = asked or (Target.PORT if port else Target.SIM)
    bench = bench_file.read(config.getoption("--bench") or SUITE / f"benches/{target}.toml")
    if asked and bench.target != asked:
        raise BenchError(f"--target {asked}: bench {bench.name} is of target {bench.target}")
    if port and bench.target is not Target.PORT:
        raise BenchError(f"--port {port}: bench {bench.name} is of target {bench.target}")
    board = dataclasses.replace(
        bench.board, port=port or bench.board.port, baud=config.getoption("--baud") or bench.board.baud
    )
    rig, elf = config.getoption("--rig") or bench.rig, config.getoption("--elf") or bench.elf
    bench = dataclasses.replace(bench, board=board, rig=rig, elf=elf)
    if bench.target is Target.EMULATOR and not (elf and elf.is_file()):
        raise BenchError(f"--target emulator: {elf or 'no --elf'}: no such program; `cargo xtask firmware` builds it")
    if not rig.is_file():
        raise BenchError(f"{rig}: no such rig file")
    for level in config.getoption("--level") or ():
        if level not in bench.levels:
            raise BenchError(f"--level {level}: bench {bench.name} allows {', '.join(bench.levels)}")
    return bench


def pytest_report_header(config: pytest.Config) -> str:
    bench = config.stash[BENCH]
    where = f"{bench.target} {bench.board.port or bench.board.serial or ''}".strip()
    return f"zygote: {where}, bench {bench.name}, rig {bench.rig.name}, --seed {config.getoption('--seed')}"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Every test is of one level; those of other levels than asked for are left out."""
    bench = config.stash[BENCH]
    wanted = config.getoption("--level") or [level for level in bench.levels if level is not Level.SOAK]
    chosen, left_out = [], []
    for item in items:
        levels = [mark.name for mark in item.iter_markers() if mark.name in list(Level)]
        # The nearest mark counts: a test's own before that of its file.
        if not levels:
            raise pytest.UsageError(f"{item.nodeid}: expected a mark of {', '.join(Level)}")
        (chosen if levels[0] in wanted else left_out).append(item)
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = chosen


@pytest.fixture(scope="session")
def bench(pytestconfig: pytest.Config) -> Bench:
    """What stands on the bench, and what may be done with it."""
    return pytestconfig.stash[BENCH]


@pytest.fixture(scope="session", autouse=True)
def properties_of_the_run(
    pytestconfig: pytest.Config, record_testsuite_property: Callable[[str, object], None]
) -> Iterator[None]:
    """What was tested, with what, into the JUnit file; who the board is comes out in the course of the run."""
    yield
    record = pytestconfig.pluginmanager.get_plugin(RECORD)
    for name, value in record.properties().items():
        record_testsuite_property(name, value)


@pytest.fixture(scope="session")
def zygote() -> Path:
    """The program: `$ZYGOTE`, else the debug build of this repository."""
    path = Path(os.environ.get("ZYGOTE") or REPOSITORY / "target/debug/zygote")
    if not path.is_file():
        pytest.exit(f"{path}: no such program; run `cargo build -p zygote-cli`, or set ZYGOTE", returncode=2)
    return path


@pytest.fixture(scope="session")
def program(zygote: Path, bench: Bench, tmp_path_factory: pytest.TempPathFactory) -> Program:
    """The 14 panels of three voxels, planned and scheduled for the rig."""
    model = REPOSITORY / "models/i14.txt"
    return programs.make(zygote, model, bench.rig, tmp_path_factory.mktemp("program"))


@pytest.fixture(scope="session")
def board(bench: Bench) -> Iterator[str]:
    """The serial port of the bench's board, for this run alone."""
    try:
        device = targets.find_port(bench)
        with targets.alone(device):
            yield device
    except BenchError as error:
        pytest.exit(str(error), returncode=2)


@pytest.fixture
def flight(request: pytest.FixtureRequest) -> Flight:
    """Takes down what goes over the lines of a test."""
    return request.node.stash.setdefault(FLIGHT, Flight())


@pytest.fixture
def measure(request: pytest.FixtureRequest) -> Callable[..., None]:
    """Puts a value with its limits into the record, and fails the test where it is beyond them."""
    measured = request.node.stash.setdefault(MEASURED, [])

    def measure(name: str, value: float, unit: str, low: float | None = None, high: float | None = None) -> None:
        measurement = Measurement(name, value, unit, low, high)
        measured.append(measurement)
        assert measurement.passed, measurement

    return measure


@pytest.fixture
def dial(bench: Bench, flight: Flight) -> Iterator[Callable[[str], Port]]:
    """Opens the line to a device; every line is closed in the end."""
    with contextlib.ExitStack() as lines:

        def dial(device: str) -> Port:
            port = Port(device, bench.board.baud, bench.patience, flight)
            return lines.enter_context(contextlib.closing(port))

        yield dial


@pytest.fixture
def deploy(zygote: Path, bench: Bench, tmp_path: Path) -> Callable[..., Deploy]:
    """Starts the real host on a program and a device."""
    return functools.partial(Deploy, zygote, tmp_path, bench.patience)


@pytest.fixture
def device(request: pytest.FixtureRequest, zygote: Path, program: Program, bench: Bench) -> Iterator[str]:
    """The serial device of an MCU: one that was just switched on, or the real one, idle."""
    if bench.target is not Target.PORT:
        with targets.simulated(zygote, bench, program.rig_file, program.plan) as device:
            yield device
        return
    board = request.getfixturevalue("board")
    with contextlib.closing(Port(board, bench.board.baud, bench.patience)) as port:
        # What the test before left: its program, its session, Safe or not.
        port.send(STOP)
        link = Link(port, fresh_session())
        link.hello()
        link.request(commands.Clear())
    yield board


@pytest.fixture
def rng(pytestconfig: pytest.Config) -> random.Random:
    """Chance, from the seed that the report's header tells."""
    return random.Random(pytestconfig.getoption("--seed"))


@pytest.fixture
def port(device: str, dial: Callable[[str], Port]) -> Port:
    """The line to the MCU, without a session."""
    return dial(device)


def fresh_session() -> int:
    """A number that no session had before."""
    return random.SystemRandom().randrange(1, 1 << 32)


@pytest.fixture
def session() -> int:
    """A number that no session had before."""
    return fresh_session()


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
