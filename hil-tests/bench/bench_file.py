"""A bench file: what stands on a bench, and what may be done with it. `docs/src/hil.md` tells every key."""

import dataclasses
import enum
import tomllib
from pathlib import Path
from typing import Any

VERSION = 1


class BenchError(ValueError):
    """A bench file that can't be used, or a bench that isn't there."""


class Target(enum.StrEnum):
    """What the tests talk to."""

    SIM = "sim"
    EMULATOR = "emulator"
    PORT = "port"


class Level(enum.StrEnum):
    """How much a test moves."""

    SMOKE = "smoke"
    ACTUATORS = "actuators"
    FAULTS = "faults"
    DEPLOYMENT = "deployment"
    SOAK = "soak"


class Hinges(enum.StrEnum):
    """What hangs on the channels."""

    SIMULATED = "simulated"
    DUMMY = "dummy"
    REAL = "real"


@dataclasses.dataclass(frozen=True)
class Board:
    """Where a board is, and who it must say that it is."""

    port: str | None = None
    serial: str | None = None
    baud: int = 921_600
    name: str | None = None
    unique_id: str | None = None


@dataclasses.dataclass(frozen=True)
class Limits:
    """The most that this bench takes: mA, °C, s. A board's own limits hold besides."""

    supply: int | None = None
    max_temperature: float | None = None
    max_on: float | None = None


@dataclasses.dataclass(frozen=True)
class Supply:
    """Commands that switch the supply of the actuators, and the seconds that a relay takes."""

    off: tuple[str, ...]
    on: tuple[str, ...]
    settle: float = 0.5


@dataclasses.dataclass(frozen=True)
class Bench:
    """One bench."""

    name: str
    target: Target
    rig: Path
    levels: tuple[Level, ...]
    hinges: Hinges
    elf: Path | None = None
    board: Board = Board()
    limits: Limits = Limits()
    supply: Supply | None = None
    # How many times as long as on a board in real time to wait for things.
    patience: float = 1.0

    @property
    def moves_for_real(self) -> bool:
        """Whether something on a table gets hot or moves."""
        return self.target is Target.PORT


def read(path: Path) -> Bench:
    """The bench of a file; paths in it are relative to it."""
    try:
        content = tomllib.loads(path.read_text())
    except OSError as error:
        raise BenchError(f"{path}: {error.strerror}") from error
    except tomllib.TOMLDecodeError as error:
        raise BenchError(f"{path}: {error}") from error
    table = _Table(str(path), content)
    if (version := table.take("version", int)) != VERSION:
        raise BenchError(f"{path}: version: expected {VERSION}, got {version}")
    target = table.choice("target", Target)
    real = target is Target.PORT
    usual = [Level.SMOKE] if real else list(Level)
    levels = table.take("levels", list, [level.value for level in usual])
    elf = table.take("elf", str, None)
    bench = Bench(
        name=path.stem,
        target=target,
        rig=path.parent / table.take("rig", str),
        levels=tuple(table.one_of("levels", level, Level) for level in levels),
        hinges=table.choice("hinges", Hinges, None if real else Hinges.SIMULATED),
        elf=path.parent / elf if elf else None,
        board=table.part("board", Board),
        limits=table.part("limits", Limits),
        supply=table.part("supply", Supply) if "supply" in content else None,
        patience=table.take("patience", float, 1.0),
    )
    table.end()
    if real == (bench.hinges is Hinges.SIMULATED):
        raise BenchError(f"{path}: hinges: `{bench.hinges}` can't be on target `{target}`")
    return bench


class _Table:
    """A table of a file, which says where it is wrong."""

    def __init__(self, place: str, content: dict[str, Any]):
        self.place = place
        self.content = dict(content)

    def take(self, key: str, kind: type, *default: Any) -> Any:
        """The value of a key."""
        if key not in self.content:
            if default:
                return default[0]
            raise BenchError(f"{self.place}: `{key}` is missing")
        value = self.content.pop(key)
        if kind is float and type(value) is int:
            value = float(value)
        if type(value) is not kind:
            raise BenchError(f"{self.place}: {key}: expected {kind.__name__}, got {value!r}")
        if kind in (int, float) and value <= 0:
            raise BenchError(f"{self.place}: {key}: expected more than 0, got {value!r}")
        return value

    def choice(self, key: str, kind: type[enum.StrEnum], default: Any = None) -> Any:
        """One of a few words."""
        word = self.take(key, str, *([default.value] if default else []))
        return self.one_of(key, word, kind)

    def one_of(self, key: str, word: Any, kind: type[enum.StrEnum]) -> Any:
        """The word as what it stands for."""
        if word not in list(kind):
            raise BenchError(f"{self.place}: {key}: expected {', '.join(kind)}, got {word!r}")
        return kind(word)

    def part(self, key: str, kind: type) -> Any:
        """A table in this one, as a dataclass of plain values; keys have dashes for underscores."""
        inner = _Table(f"{self.place}: [{key}]", self.take(key, dict, {}))
        values = {}
        for field in dataclasses.fields(kind):
            name = field.name.replace("_", "-")
            if field.type == tuple[str, ...]:
                values[field.name] = tuple(map(str, inner.take(name, list)))
            elif name in inner.content:
                plain = next(part for part in (int, float, str) if part in (field.type, *_members(field.type)))
                values[field.name] = inner.take(name, plain)
        inner.end()
        return kind(**values)

    def end(self) -> None:
        """Nothing is left over."""
        if self.content:
            raise BenchError(f"{self.place}: unknown key `{next(iter(self.content))}`")


def _members(hint: Any) -> tuple[Any, ...]:
    return getattr(hint, "__args__", ())
