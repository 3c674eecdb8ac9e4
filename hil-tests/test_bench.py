"""Bench files that can't be used, the guard of a port, and what a record makes of a value: no board is needed."""

import pytest

from bench import bench_file, target as targets
from bench.bench_file import Bench, BenchError, Board, Hinges, Level, Target
from bench.measurement import Measurement
from zygote_wire.hello import Identity, ResetCause

pytestmark = pytest.mark.smoke

GOOD = 'version = 1\ntarget = "port"\nrig = "rig.toml"\nhinges = "dummy"\n'


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        (GOOD.replace("1", "2"), "version: expected 1, got 2"),
        (GOOD.replace("port", "moon"), "target: expected sim, emulator, port, got 'moon'"),
        (GOOD.replace('hinges = "dummy"', ""), "`hinges` is missing"),
        (GOOD.replace("dummy", "simulated"), "hinges: `simulated` can't be on target `port`"),
        (GOOD + "rigg = 1\n", "unknown key `rigg`"),
        (GOOD + 'levels = ["smoke", "all"]\n', "levels: expected smoke"),
        (GOOD + "patience = -1\n", "patience: expected more than 0, got -1.0"),
        (GOOD + "[limits]\nsupply = true\n", "[limits]: supply: expected int, got True"),
        (GOOD + "[board]\nbaud\n", "line 6"),
    ],
)
def test_a_bench_file_that_cannot_be_used_is_refused_with_its_place(tmp_path, text, complaint):
    path = tmp_path / "bench.toml"
    path.write_text(text)
    with pytest.raises(BenchError) as refused:
        bench_file.read(path)
    assert str(refused.value).startswith(f"{path}: ")
    assert complaint in str(refused.value)


def test_a_port_without_levels_allows_only_what_moves_nothing(tmp_path):
    path = tmp_path / "bench.toml"
    path.write_text(GOOD + "[limits]\nsupply = 500\nmax-on = 2\n")
    bench = bench_file.read(path)
    assert (bench.levels, bench.limits.supply, bench.limits.max_on) == ((Level.SMOKE,), 500, 2.0)


def test_a_port_is_given_to_one_run_at_a_time(tmp_path):
    device = str(tmp_path / "tty")
    with targets.alone(device), pytest.raises(BenchError, match="another run"), targets.alone(device):
        pass
    with targets.alone(device):
        pass


def test_another_board_than_the_bench_expects_is_told(tmp_path):
    who = Identity(1, "0.1.0", "abc", "nucleo-f446re", bytes(12), ResetCause.POWER)

    def bench(**board: str) -> Bench:
        return Bench("b", Target.PORT, tmp_path, (Level.SMOKE,), Hinges.DUMMY, board=Board(**board))

    assert targets.not_expected(bench(name="nucleo-f446re", unique_id="00" * 12), who) is None
    assert "expects other, found nucleo-f446re" in targets.not_expected(bench(name="other"), who)
    assert "unique id" in targets.not_expected(bench(unique_id="01" * 12), who)


@pytest.mark.parametrize(
    ("value", "low", "high", "passed", "marginal"),
    [
        (5.0, 0, 10, True, False),
        (9.5, 0, 10, True, True),
        (0.5, 0, 10, True, True),
        (10.5, 0, 10, False, False),
        (-1, 0, None, False, False),
        (95, None, 100, True, True),
        (5, None, None, True, False),
    ],
)
def test_a_value_near_a_limit_passes_as_marginal(value, low, high, passed, marginal):
    measurement = Measurement("x", value, "mA", low, high)
    assert (measurement.passed, measurement.marginal) == (passed, marginal)
