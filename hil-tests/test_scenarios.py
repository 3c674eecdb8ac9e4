"""Scenario files served on a pseudo-terminal: faults that no test can cause from the line alone, and the real host on it."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from bench import program as programs
from bench import target as targets
from bench.bench_file import Target
from bench.program import Program
from zygote_wire.codes import Faulted
from zygote_wire.link import Link
from zygote_wire.reports import State

pytestmark = pytest.mark.faults

REPOSITORY = Path(__file__).parent.parent
SCENARIOS = REPOSITORY / "sim/scenarios"


@pytest.fixture(scope="module")
def cube(zygote, tmp_path_factory) -> Program:
    """The six panels of a cube on the rig of the SMA scenarios."""
    folder = tmp_path_factory.mktemp("cube")
    return programs.make(zygote, REPOSITORY / "models/cube6.txt", SCENARIOS / "rigs/sma.toml", folder, 1)


@pytest.fixture
def staged(request, zygote, cube, bench) -> Iterator[str]:
    """The device of a simulated board on which the scenario of this test takes its course."""
    if bench.target is Target.PORT:
        pytest.skip("a board's thermistors are not broken by a file")
    scenario = SCENARIOS / f"{request.param}.toml"
    with targets.simulated(zygote, bench, cube.rig_file, cube.plan, scenario) as device:
        yield device


@pytest.mark.parametrize(
    ("staged", "code"),
    [
        ("s05-thermistor-open", Faulted.SENSOR_OPEN),
        ("s05-thermistor-shorted", Faulted.SENSOR_SHORTED),
        ("s08-stop-button", Faulted.STOP_BUTTON),
    ],
    indirect=["staged"],
)
def test_a_fault_of_a_scenario_ends_the_run_of_the_real_host(deploy, cube, staged, code, session, dial):
    ended, out, error = deploy(cube, staged).finish()
    assert ended == 1, error
    assert f"F{code.value + 1:02}" in out
    link = Link(dial(staged), session)
    link.hello()
    status = link.status()
    assert (status.state, status.fault.code) == (State.SAFE, code)
    assert (status.heaters_on, status.main_switch) == (0, False)
