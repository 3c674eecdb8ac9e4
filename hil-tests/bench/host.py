"""`zygote deploy` as a process, and what it leaves behind."""

import json
import subprocess
import time
from pathlib import Path
from typing import Any

from bench.program import Program


class Deploy:
    """One run of the real host."""

    def __init__(
        self, zygote: Path, folder: Path, patience: float, program: Program, device: str, clear: bool = True
    ):
        self.patience = patience
        self.log = folder / "events.jsonl"
        self.report_file = folder / "report.json"
        arguments: list[str | Path] = [zygote, "deploy", program.plan, "--rig", program.rig_file, "--port", device]
        arguments += ["--clear"] if clear else []
        arguments += ["--log", self.log, "--report", self.report_file]
        self.process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait_for_opened(self, count: int, patience: float = 30.0) -> None:
        """Waits until so many hinges are open."""
        end = time.monotonic() + patience * self.patience
        while self.opened() < count:
            if time.monotonic() > end or self.process.poll() is not None:
                raise AssertionError(f"{self.opened()} hinges opened, expected {count}: {self.finish()}")
            time.sleep(0.02)

    def opened(self) -> int:
        """Hinges that the log says are open."""
        return self.log.read_text().count('"opened","mcu_us"') if self.log.exists() else 0

    def finish(self, patience: float = 60.0) -> tuple[int, str, str]:
        """Waits for the end: exit code, output, error output."""
        try:
            out, error = self.process.communicate(timeout=patience * self.patience)
        except subprocess.TimeoutExpired:
            self.process.kill()
            out, error = self.process.communicate()
            raise AssertionError(f"still running after {patience * self.patience} s\n{out}\n{error}") from None
        return self.process.returncode, out, error

    def report(self) -> dict[str, Any]:
        """The report that it wrote."""
        return json.loads(self.report_file.read_text())
