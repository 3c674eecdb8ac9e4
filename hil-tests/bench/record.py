"""Records of a run: JUnit XML with properties, JSON in the shape of OpenHTF's, and what a failed test saw."""

import json
import re
import shutil
import subprocess
import time
from pathlib import Path
from typing import Any

import pytest

from bench.bench_file import Bench
from bench.flight import Flight
from bench.measurement import Measurement
from zygote_wire.hello import SCHEMA, VERSION, HelloReply

OUTCOMES = {"passed": "PASS", "failed": "FAIL", "skipped": "SKIP"}
FLIGHT = pytest.StashKey[Flight]()
MEASURED = pytest.StashKey[list[Measurement]]()


class Record:
    """Gathers the phases of a run, a test each, and writes them down."""

    def __init__(self, bench: Bench, seed: int, out: Path | None, repository: Path):
        self.bench, self.seed, self.out = bench, seed, out
        self.git = _git(repository)
        self.start = _now()
        self.hello: HelloReply | None = None
        self.phases: dict[str, dict[str, Any]] = {}

    def properties(self) -> dict[str, str]:
        """What was tested, with what."""
        told = {"target": self.bench.target.value, "bench": self.bench.name, "rig": self.bench.rig.name}
        told |= {"seed": str(self.seed), "git": self.git, "protocol": str(VERSION), "schema": f"{SCHEMA:#010x}"}
        if self.hello:
            who = self.hello.identity
            told |= {"board": who.board, "firmware": who.firmware, "firmware_git": who.git}
            told |= {"unique_id": who.unique_id.hex(), "firmware_schema": f"{self.hello.schema:#010x}"}
        return told

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo):
        report = yield
        self._take(item, report)
        return report

    def pytest_sessionfinish(self) -> None:
        if self.out:
            path = self.out / "record.json"
            path.write_text(json.dumps(self._whole(), indent=1) + "\n")

    def _take(self, item: pytest.Item, report: pytest.TestReport) -> None:
        flight = item.stash.get(FLIGHT, None)
        if flight and flight.hello:
            self.hello = flight.hello
        phase = self.phases.setdefault(
            item.nodeid,
            {
                "name": item.nodeid,
                "start_time_millis": round(report.start * 1000),
                "outcome": "PASS",
                "outcome_details": [],
                "measurements": {},
                "attachments": {},
            },
        )
        phase["end_time_millis"] = round(report.stop * 1000)
        measured = item.stash.get(MEASURED, [])
        phase["measurements"] = {one.name: one.record() for one in measured}
        phase["marginal"] = any(one.marginal for one in measured)
        if report.when == "call":
            report.user_properties.extend((one.name, f"{one.value:g} {one.unit}") for one in measured)
        if report.outcome == "passed":
            return
        # A test that breaks before or after its own part is no verdict on the board.
        broken = report.failed and report.when != "call"
        phase["outcome"] = "ERROR" if broken else OUTCOMES[report.outcome]
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longreprtext
        phase["outcome_details"].append(reason)
        if report.failed and self.out:
            folder = self.out / "failures" / re.sub(r"[^\w.-]+", "-", item.nodeid.split("/")[-1])
            phase["attachments"] |= _evidence(item, flight, folder)

    def _whole(self) -> dict[str, Any]:
        phases = list(self.phases.values())
        outcomes = {phase["outcome"] for phase in phases}
        worst = next((outcome for outcome in ("ERROR", "FAIL") if outcome in outcomes), "PASS")
        told = self.properties()
        return {
            "dut_id": told.get("unique_id", self.bench.name),
            "station_id": self.bench.name,
            "start_time_millis": self.start,
            "end_time_millis": _now(),
            "outcome": worst if phases else "ABORTED",
            "marginal": any(phase.get("marginal") for phase in phases),
            "metadata": {"test_name": "zygote-hil", **told},
            "phases": phases,
        }


def _evidence(item: pytest.Item, flight: Flight | None, folder: Path) -> dict[str, str]:
    """What the line carried, and what the real host wrote down."""
    files = flight.write(folder) if flight else []
    tmp_path = getattr(item, "funcargs", {}).get("tmp_path")
    for log in sorted(tmp_path.glob("*.json*")) if tmp_path else []:
        files.append(Path(shutil.copy(log, folder / f"host-{log.name}")))
    return {file.name: f"failures/{folder.name}/{file.name}" for file in files}


def _git(repository: Path) -> str:
    """The commit of the suite, with a mark where files were changed."""
    command = ["git", "-C", str(repository), "describe", "--always", "--dirty", "--abbrev=10", "--exclude=*"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:
        return "unknown"
    return done.stdout.strip() or "unknown"


def _now() -> int:
    return round(time.time() * 1000)
