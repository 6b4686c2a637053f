"""What a program of the user's said in a recorded run takes its place in another: the same bytes, without the program.

    own_replay.py DMISE
"""

import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "build/python")]
os.environ["PYTHONPATH"] = str(ROOT / "build/python")
from harness import PATIENCE_S, Run, check, check_same, main, wait_until  # noqa: E402
import own_sensor  # noqa: E402
import own_tracker  # noqa: E402
from own_actor import dmise, program, write  # noqa: E402

try:
    import mcap.stream_reader
    import mcap.writer
    import zmq  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
import dmise as client  # noqa: E402

NODE = program("walk", sleep_s=0.02) + ", period_ticks: 4"


def recorded(binary, scenario, out, path):
    with Run(binary, "launch", scenario, "--allow-programs", "--out", out) as run:
        address = out / "logs/master.address"
        wait_until(lambda: address.exists() and address.read_text().strip(), "the time-master")
        told = client.record(address.read_text().strip(), path)
        code, _ = run.finish(PATIENCE_S)
    check(code == 0 and told.complete, f"{told}")
    return told


def copy(path, to, keep=lambda topic, number: True, compression=mcap.writer.CompressionType.ZSTD):
    """The messages of a recording that are to be kept, by their topic and sequence number."""
    ids = {}
    with path.open("rb") as file, to.open("wb") as copied:
        writer = mcap.writer.Writer(copied, compression=compression)
        writer.start()
        for record in mcap.stream_reader.StreamReader(file).records:
            if isinstance(record, mcap.records.Schema):
                ids["schema", record.id] = writer.register_schema(record.name, record.encoding, record.data)
            elif isinstance(record, mcap.records.Channel):
                schema = ids["schema", record.schema_id]
                ids[record.id] = writer.register_channel(record.topic, record.message_encoding, schema), record.topic
            elif isinstance(record, mcap.records.Message):
                channel, topic = ids[record.channel_id]
                if keep(topic, record.sequence):
                    writer.add_message(channel, record.log_time, record.data, record.publish_time, record.sequence)
        writer.finish()
    return to


def replays(binary, directory, scenario, out, path):
    again = directory / "again"
    dmise(binary, "run", "--replay-node", f"gnc={path}", scenario, "--out", again)
    check_same(again, out, "a replayed node, without leave for programs")
    check(not (again / "logs/gnc.log").exists(), "its program was not started")
    for compression in (mcap.writer.CompressionType.NONE, mcap.writer.CompressionType.ZSTD):
        other = copy(path, directory / "copy.mcap", compression=compression)
        dmise(binary, "run", scenario, "--replay-node", f"gnc={other}", "--out", again, "--force")
        check_same(again, out, f"from a file with chunks by {compression.name}")


def refuses(binary, directory, scenario, path):
    def told(words, recording=path, of=scenario, node="gnc"):
        said = dmise(binary, "run", of, "--replay-node", f"{node}={recording}", "--out", directory / "refused", code=2)
        last = said.strip().splitlines()[-1]
        check(re.search(words, last), last)

    told(r"no-such.mcap: No such file", directory / "no-such.mcap")
    told(r"probe.oem: not an MCAP file", directory / "probe.oem")
    told(r"--replay-node: must be NODE=FILE with a node of `nodes`, got gnd=", node="gnd")
    text = scenario.read_text()
    for name, old, new, words in (
            ("digest", "seed: 1", "seed: 2", "is of another scenario, seed, plan or file: digest [0-9a-f]{32}"),
            ("ticks", "tick_s: 1", "tick_s: 2", "its ticks have 1000000000 ns, those of the scenario 2000000000")):
        other = scenario.with_name(f"{name}.yaml")
        other.write_text(text.replace(old, new))
        told(words, of=other)
    topic = "state/actor/gnc"
    told("has nothing of node gnc", copy(path, directory / "none.mcap", lambda name, _: name != topic))
    told("does not say of which run it is", copy(path, directory / "no-run.mcap", lambda name, _: name != "run"))
    gap = copy(path, directory / "gap.mcap", lambda name, number: name != topic or number != 9)
    told("lacks tick 8 of node gnc", gap)
    short = copy(path, directory / "short.mcap", lambda name, number: name != topic or number < 9)
    told("ends after tick 7 of node gnc, the run has 20", short)
    dmise(binary, "run", scenario, "--replay-node", f"gnc={short}", "--out", directory / "again", "--force", code=2)
    check_same(directory / "again", directory / "recorded", "products are lost by no refused recording")
    # Plain, because a packed chunk may end in the first third of a file: schemas are in its summary again.
    plain = copy(path, directory / "plain.mcap", compression=mcap.writer.CompressionType.NONE).read_bytes()
    for size in (9, 100, len(plain) // 3):
        (directory / "cut.mcap").write_bytes(plain[:size])
        told("does not say of which run|has nothing of|ends after tick", directory / "cut.mcap")
    whole = path.read_bytes()
    for place in range(len(whole) // 10, len(whole) // 2, len(whole) // 10):
        (directory / "wrong.mcap").write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1:])
        code_of_damage(binary, directory, scenario, directory / "wrong.mcap")


def replays_detectors_and_trackers(binary, directory):
    """Each alone and both: tracks, tasks, the frames of the telescope that follows them, detections."""
    (directory / "detector.py").write_bytes((ROOT / "clients/python/examples/detector.py").read_bytes())
    scenario = own_tracker.write(directory, "both.yaml", own_tracker.program("follow", sleep_s=0.02), duration_s=60)
    text = scenario.read_text().replace("nodes: [", f"nodes: [{{name: peaks, run: [{sys.executable}, detector.py], "
                                        "options: {threshold: 8, most: 50}}, ")
    for sensor in ("{name: eye,", "name: scope\n"):
        text = text.replace(sensor, sensor + (" detection: {node: peaks}," if "{" in sensor else "    detection: {node: peaks}\n"))
    scenario.write_text(text)
    out, path = directory / "both", directory / "both.mcap"
    recorded(binary, scenario, out, path)
    made = [len((out / name).read_text().splitlines()) for name in ("tracks.jsonl", "tasks.jsonl", "detections.jsonl", "scope/frames.jsonl")]
    check(min(made) > 0, f"{made} tracks, tasks, detections, frames of the telescope")
    for nodes in (["mine"], ["peaks"], ["mine", "peaks"]):
        replayed = [word for node in nodes for word in ("--replay-node", f"{node}={path}")]
        leave = ["--allow-programs"] if len(nodes) == 1 else []
        dmise(binary, "run", scenario, *replayed, *leave, "--out", directory / "both-again", "--force")
        check_same(directory / "both-again", out, f"{' and '.join(nodes)} replayed")
    for node, topic, numbers, words in (("mine", "track/fusion-node", [9], "lacks tracks of tick 8"),
                                        ("peaks", "detection/eye", range(3, 11), "lacks frame [0-9]+ of sensor eye")):
        gap = copy(path, directory / "gap.mcap", lambda name, sequence: name != topic or sequence not in numbers)
        said = dmise(binary, "run", scenario, "--replay-node", f"{node}={gap}", "--allow-programs", "--out", directory / "refused", code=2)
        check(re.search(words, said), said.strip().splitlines()[-1])


def replays_sensors(binary, directory):
    """Both of the scenario: frames, detections, and the tracks that are made of them."""
    scenario = own_sensor.write(directory, "sensors.yaml", own_sensor.program("ranging", **own_sensor.RANGING), duration_s=40)
    out, path = directory / "sensors", directory / "sensors.mcap"
    recorded(binary, scenario, out, path)
    made = [len((out / name).read_text().splitlines()) for name in ("ranger/detections.jsonl", "lidar/detections.jsonl", "tracks.jsonl")]
    check(min(made) > 0, f"{made} detections of both, tracks")
    dmise(binary, "run", scenario, *(word for node in ("laser", "blind") for word in ("--replay-node", f"{node}={path}")),
          "--out", directory / "sensors-again")
    check_same(directory / "sensors-again", out, "sensors replayed, without leave for programs")
    gap = copy(path, directory / "gap.mcap", lambda name, sequence: name != "frame/ranger" or sequence < 3)
    said = dmise(binary, "run", scenario, "--replay-node", f"laser={gap}", "--allow-programs", "--out", directory / "refused", code=2)
    check(re.search("lacks frame [0-9]+ of sensor ranger", said), said.strip().splitlines()[-1])


def code_of_damage(binary, directory, scenario, path):
    """A flipped byte is found by the checksums of chunks, or is of no account."""
    with Run(binary, "run", scenario, "--replay-node", f"gnc={path}", "--out", directory / "damaged", "--force") as run:
        code, _ = run.finish(PATIENCE_S)
        check(code in (0, 2), f"a flipped byte: code {code}: {run.stderr.strip().splitlines()[-1]}")


def test(binary, directory):
    (directory / "probe.oem").write_text("")
    scenario = write(directory, "replay.yaml", node=NODE)
    out, path = directory / "recorded", directory / "run.mcap"
    told = recorded(binary, scenario, out, path)
    check(told.topics["state/actor/gnc"] == 21, f"{told}")
    replays(binary, directory, scenario, out, path)
    refuses(binary, directory, scenario, path)
    replays_detectors_and_trackers(binary, directory)
    replays_sensors(binary, directory)


if __name__ == "__main__":
    main(test)
