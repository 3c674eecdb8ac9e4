"""The recording of a run, read by MCAP's own reader for Python: whole, or after the host was killed."""

import json
from pathlib import Path
from typing import Any

from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader

from bench.host import Deploy
from bench.program import Program

SHOWN_BY_FOXGLOVE = {
    ("foxglove.SceneUpdate", "/panels"),
    ("foxglove.FrameTransforms", "/frames"),
    ("foxglove.Log", "/log"),
}
# A chunk is written once a second, and telemetry comes ten times a second of a board that isn't slow.
MOST_LOST_US = 1_200_000


def events(recording: Path) -> list[dict[str, Any]]:
    """Events as far as the file goes, by a reader that needs no index."""
    topics: dict[int, str] = {}
    found = []
    with recording.open("rb") as file:
        try:
            for record in StreamReader(file, validate_crcs=True).records:
                match type(record).__name__:
                    case "Channel":
                        topics[record.id] = record.topic
                    case "Message" if topics[record.channel_id] == "/events":
                        found.append(json.loads(record.data))
        except EndOfFile:
            pass
    return found


def check_whole(deploy: Deploy, program: Program) -> None:
    """The recording holds what log and report hold, the rig, and what Foxglove shows."""
    with deploy.recording.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "x-zygote"
        files = {attachment.name: attachment.data for attachment in reader.iter_attachments()}
        seen = [(schema.name, channel.topic) for schema, channel, _ in reader.iter_messages()]
    assert json.loads(files["report.json"]) == deploy.report()
    assert files["rig.toml"] == Path(program.rig_file).read_bytes()
    assert SHOWN_BY_FOXGLOVE <= set(seen)
    log = log_of(deploy)
    assert events(deploy.recording) == [line for line in log if line["kind"] != "telemetry"]
    assert seen.count(("zygote.Telemetry", "/telemetry")) == sum(line["kind"] == "telemetry" for line in log)


def check_cut(deploy: Deploy) -> None:
    """The recording of a host that was killed lacks its last second at most."""
    log = log_of(deploy)
    told = [line for line in log if line["kind"] != "telemetry"]
    saved = events(deploy.recording)
    assert saved and saved == told[: len(saved)]
    most_us = MOST_LOST_US * deploy.patience
    assert all(log[-1]["host_us"] - line["host_us"] <= most_us for line in told[len(saved) :])


def log_of(deploy: Deploy) -> list[dict[str, Any]]:
    """The event log's lines, less one that was cut."""
    return [json.loads(line) for line in deploy.log.read_text().splitlines() if line.endswith("}")]
