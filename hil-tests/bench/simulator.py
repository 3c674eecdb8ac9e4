"""`zygote sim` as a process."""

import contextlib
import select
import subprocess
from collections.abc import Iterator
from pathlib import Path

START = 20.0
END = 5.0


@contextlib.contextmanager
def simulator(zygote: Path, rig: Path, plan: Path, scenario: Path | None = None) -> Iterator[str]:
    """A simulated board that was just switched on; gives the device of its pseudo-terminal."""
    arguments: list[str | Path] = [zygote, "sim", "--rig", rig, "--plan", plan]
    if scenario:
        arguments += ["--scenario", scenario]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout
        assert process.stderr
        try:
            ready, _, _ = select.select([process.stdout], [], [], START)
            device = process.stdout.readline().strip() if ready else ""
            if not device:
                process.terminate()
                raise RuntimeError(f"zygote sim named no device within {START} s:\n{process.stderr.read()}")
            yield device
        finally:
            process.terminate()
            process.wait(END)
