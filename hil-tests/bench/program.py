"""A plan with its schedule, made by `zygote`, and its steps in the words of the wire."""

import dataclasses
import json
import subprocess
from pathlib import Path
from typing import Any

from bench import bench_file
from zygote_wire.commands import Heat, Release, Step, Turn
from zygote_wire.hello import HelloReply, Limits


@dataclasses.dataclass(frozen=True)
class Program:
    """Files for `zygote`, and the schedule that stands in the plan."""

    plan: Path
    rig_file: Path
    schedule: dict[str, Any]
    bench: bench_file.Limits = bench_file.Limits()

    @property
    def rig(self) -> str:
        """The rig's name."""
        return self.schedule["rig"]

    @property
    def steps(self) -> tuple[Step, ...]:
        """The steps for the MCU."""
        return tuple(map(_wire_step, self.schedule["steps"]))

    def beyond_the_bench(self) -> str | None:
        """What of the program is more than the bench takes."""
        for number, step in enumerate(self.steps):
            action, most = step.action, self.bench
            if most.supply and action.current > most.supply:
                return f"step {number} takes {action.current} mA, the bench {most.supply} mA at most"
            if isinstance(action, Heat):
                if most.max_temperature and action.max_temperature > most.max_temperature * 100:
                    return f"step {number} may reach {action.max_temperature / 100} °C, the bench takes {most.max_temperature} °C"
                if most.max_on and action.max_on > most.max_on * 1000:
                    return f"step {number} may heat for {action.max_on / 1000} s, the bench takes {most.max_on} s"
        return None

    def limits(self, mcu: HelloReply, link_timeout: int = 1_000) -> Limits:
        """The board's ceiling and the bench's with the schedule's supply, and this link timeout in milliseconds."""
        own, ceiling = self.bench, mcu.ceiling
        return dataclasses.replace(
            ceiling,
            max_temperature=min(ceiling.max_temperature, round((own.max_temperature or 1e9) * 100)),
            max_on=min(ceiling.max_on, round((own.max_on or 1e9) * 1000)),
            supply=min(self.schedule["supply_limit_ma"], own.supply or 1 << 30),
            link_timeout=link_timeout,
        )


def make(
    zygote: Path,
    model: Path,
    rig: Path,
    folder: Path,
    piles: int = 2,
    bench: bench_file.Limits = bench_file.Limits(),
) -> Program:
    """Plans a model in so many piles and schedules it for a rig."""
    plan = folder / "plan.fold"
    _run(zygote, "plan", model, "--piles", piles, "--free", "ideal", "--output", plan)
    _run(zygote, "schedule", plan, "--rig", rig, "--parallel", 4)
    return Program(plan, rig, json.loads(plan.read_text())["zygote:schedule"], bench)


def _run(zygote: Path, *arguments: Any) -> None:
    done = subprocess.run([zygote, *map(str, arguments)], capture_output=True, text=True, timeout=60, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"zygote {arguments[0]} ended with {done.returncode}:\n{done.stderr}")


def _wire_step(step: dict[str, Any]) -> Step:
    motion, channel, current = step["motion"], step["channel"], step["current_ma"]
    action: Heat | Turn | Release
    match motion["kind"]:
        case "sma":
            action = Heat(
                channel=channel,
                target=motion["target_centi_celsius"],
                hold=motion["hold_ms"],
                max_on=motion["max_on_ms"],
                max_temperature=motion["max_temperature_centi_celsius"],
                cool=motion["cool_to_centi_celsius"],
                rest=motion["rest_ms"],
                min_gain=motion["min_gain_centi_celsius"],
                gain_window=motion["gain_window_ms"],
                current=current,
            )
        case "servo":
            action = Turn(
                channel=channel,
                from_us=motion["from_us"],
                to_us=motion["to_us"],
                duration=motion["move_ms"],
                settle=motion["settle_ms"],
                current=current,
                hold_current=step["hold_current_ma"],
            )
        case "spring":
            action = Release(channel=channel, pulse=motion["pulse_ms"], settle=motion["settle_ms"], current=current)
        case kind:
            raise ValueError(f"hinge {step['hinge']}: unknown kind of motion {kind}")
    return Step(step["hinge"], tuple(step["after"]), action)
