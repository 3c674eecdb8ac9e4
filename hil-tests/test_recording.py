"""The recording of a run, read by MCAP's own reader for Python: whole, and after the host was killed."""

import json
from pathlib import Path
from typing import Any

from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader

from bench.host import Deploy


def events_of(recording: Path) -> list[dict[str, Any]]:
    """Events as far as the file goes, by a reader that needs no index."""
    topics: dict[int, str] = {}
    events = []
    with recording.open("rb") as file:
        try:
            for record in StreamReader(file, validate_crcs=True).records:
                match type(record).__name__:
                    case "Channel":
                        topics[record.id] = record.topic
                    case "Message" if topics[record.channel_id] == "/events":
                        events.append(json.loads(record.data))
        except EndOfFile:
            pass
    return events


def test_another_reader_finds_the_whole_run(zygote, program, device, tmp_path):
    deploy = Deploy(zygote, program, device, tmp_path)
    code, _, error = deploy.finish()
    assert code == 0, error
    with deploy.recording.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "x-zygote"
        files = {attachment.name: attachment.data for attachment in reader.iter_attachments()}
        assert json.loads(files["report.json"]) == deploy.report()
        assert files["rig.toml"] == Path(program.rig_file).read_bytes()
        seen = [(schema.name, channel.topic) for schema, channel, _ in reader.iter_messages()]
    for known in [("foxglove.SceneUpdate", "/panels"), ("foxglove.FrameTransforms", "/frames"), ("foxglove.Log", "/log")]:
        assert known in seen
    log = [json.loads(line) for line in deploy.log.read_text().splitlines()]
    assert events_of(deploy.recording) == [line for line in log if line["kind"] != "telemetry"]
    assert seen.count(("zygote.Telemetry", "/telemetry")) == sum(line["kind"] == "telemetry" for line in log)


def test_a_killed_host_leaves_a_recording_up_to_its_last_second(zygote, program, device, tmp_path):
    deploy = Deploy(zygote, program, device, tmp_path)
    deploy.wait_for_opened(1)
    deploy.process.kill()
    deploy.process.communicate()
    log = [json.loads(line) for line in deploy.log.read_text().splitlines() if line.endswith("}")]
    told = [line for line in log if line["kind"] != "telemetry"]
    saved = events_of(deploy.recording)
    assert saved == told[: len(saved)]
    assert all(log[-1]["host_us"] - line["host_us"] <= 1_200_000 for line in told[len(saved) :])
