"""The supply of the actuators fails in the middle of a run: by a scenario where the board is simulated, by the bench's relay where it
is real."""

import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from bench import run, target as targets
from bench.bench_file import Target
from zygote_wire.codes import Faulted
from zygote_wire.commands import Heat
from zygote_wire.link import Link
from zygote_wire.reports import Fault, State

pytestmark = pytest.mark.faults

SCENARIO = Path(__file__).parent / "scenarios/supply-cut.toml"


@pytest.fixture
def failing(request, zygote, program, bench) -> Iterator[tuple[str, Callable[[], None]]]:
    """A device, and what cuts the supply of its actuators."""
    if bench.target is not Target.PORT:
        # It takes its course by itself once the first heater is warm.
        with targets.simulated(zygote, bench, program.rig_file, program.plan, SCENARIO) as device:
            yield device, lambda: None
        return
    if not bench.supply:
        pytest.skip(f"bench {bench.name} has no [supply] to switch")
    switch = bench.supply
    device = request.getfixturevalue("device")
    try:
        yield device, lambda: subprocess.run(switch.off, check=True, timeout=30)
    finally:
        subprocess.run(switch.on, check=True, timeout=30)
        time.sleep(switch.settle)


def test_a_supply_that_is_cut_while_a_hinge_is_heated_ends_the_run(failing, program, dial, session, measure):
    device, cut = failing
    link = Link(dial(device), session)
    mcu = link.hello()
    run.start(link, program, mcu)
    run.wait_for_heat(link)
    asked = link.status().at
    cut()
    fault = link.notice(Fault, patience=30.0)
    assert fault.code in (Faulted.NO_GAIN, Faulted.SENSOR_FROZEN)
    window = max(step.action.gain_window for step in program.steps if isinstance(step.action, Heat)) / 1000
    measure("fault after", (fault.at - asked) / 1e6, "s", high=2 * window + 5)
    status = link.status()
    assert (status.state, status.heaters_on, status.main_switch) == (State.SAFE, 0, False)
