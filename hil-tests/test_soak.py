"""Many deployments on one board that is not switched off in between: nothing wears, drifts or is lost."""

import statistics

import pytest

from bench import run
from zygote_wire.reports import Entered, State, StepDone, StepState

pytestmark = pytest.mark.soak

# How far the last deployments may be from the first: kelvin and seconds.
MOST_DRIFT_K = 2.0
MOST_DRIFT_S = 1.0


def drift(values: list[float]) -> float:
    """How far the last quarter's mean is from the first's."""
    part = max(len(values) // 4, 1)
    return statistics.mean(values[-part:]) - statistics.mean(values[:part])


def test_the_last_deployment_is_like_the_first(link, program, mcu, bench, pytestconfig, measure):
    count = pytestconfig.getoption("--deployments")
    peaks, times, broken = [], [], link.port.splitter.broken
    for _ in range(count):
        run.load(link, program)
        run.arm(link, program, mcu)
        run.begin(link)
        events = run.watch(link, patience=120.0)
        began = next(event.at for event in events if event.kind == Entered(State.RUNNING))
        times.append((events[-1].at - began) / 1e6)
        done = (event.kind for event in events if isinstance(event.kind, StepDone))
        peaks.append(max((kind.peak for kind in done if kind.peak is not None), default=0) / 100)
        assert link.progress() == (StepState.DONE,) * len(program.steps)
        status = link.status()
        assert (status.fault, status.heaters_on, status.main_switch) == (None, 0, False)
    measure("deployments", count, "", 1)
    # The first one begins with cold hinges.
    peaks, times = peaks[1:] or peaks, times[1:] or times
    measure("hottest", max(peaks), "°C")
    measure("drift of the peaks", drift(peaks), "K", -MOST_DRIFT_K, MOST_DRIFT_K)
    measure("longest", max(times), "s")
    measure("drift of the time", drift(times), "s", -MOST_DRIFT_S, MOST_DRIFT_S)
    measure("broken frames", link.port.splitter.broken - broken, "", high=0)
    assert link.hello().identity.boot == mcu.identity.boot, "it was never reset"
