"""Recordings of launched runs: complete by sequence numbers, read by the mcap package with the schema in the file, replayed byte
for byte; after the recorder was killed, of damaged files, and beside a recorder that stops or dies.

    recording.py DMISE [COPY]     COPY: where another test will find the recording of a whole run
"""

import collections
import contextlib
import faulthandler
import io
import itertools
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "build/python")]
os.environ["PYTHONPATH"] = str(ROOT / "build/python")
from harness import PATIENCE_S, Run, check, check_same, first_frame, main, wait_until, write_scenario  # noqa: E402

try:
    import mcap.reader
    import zmq
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
import dmise  # noqa: E402
from dmise import protocol  # noqa: E402
from dmise.master import Master  # noqa: E402
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory  # noqa: E402

faulthandler.dump_traceback_later(560, exit=True)  # says where it hangs
TICKS = 40  # lasting 5 s each
LONG = 4000  # ticks of a run with few frames
START_NS = 1516493700 * 10**9  # UTC, of the harness's scenarios


def address_of(out):
    announced = out / "logs/master.address"
    return wait_until(lambda: announced.exists() and announced.read_text().strip(), "the time-master's address")


def by_topic(recording):
    """Frames of messages by topic; without probes, whose number is of no account."""
    frames = collections.defaultdict(list)
    for message in recording.messages():
        if message.sequence:
            frames[message.topic].append(message.frames)
    return frames


def command(*arguments):
    return [sys.executable, "-m", "dmise", *map(str, arguments)]


def every_kind_has_a_field():
    fields = protocol.RecordedMessage.DESCRIPTOR.fields_by_number
    kinds = {kind: protocol.class_of_kind(kind) for kind in protocol.Kind.values()}
    lacking = [cls.DESCRIPTOR.name for kind, cls in kinds.items()
               if cls and (kind not in fields or fields[kind].message_type.full_name != cls.DESCRIPTOR.full_name)]
    check(not lacking, f"RecordedMessage has a field of each kind of message {lacking or ''}")


def records_a_run(binary, directory, reference):
    """Returns the recording of a whole run, with truth that a key allows."""
    keys, path = directory / "keys", directory / "run.mcap"
    scenario = write_scenario(directory, duration_s=5 * TICKS)
    for arguments in (["--scenario", scenario], ["tracker", "--truth"]):
        subprocess.run([binary, "keygen", keys, *arguments], check=True, stdout=subprocess.DEVNULL)
    out = directory / "out"
    with Run(binary, "launch", scenario, "--keys", keys, "--out", out) as run:
        recorded = dmise.record(address_of(out), path, truth=True, keys=keys, name="tracker")
        check(run.finish()[0] == 0, "the run is complete")
    check_same(out, reference, "recorded run")
    check(recorded.complete and not pathlib.Path(f"{path}.part").exists(), f"{recorded}")
    recording = dmise.open_recording(path)
    for topic, frames in by_topic(recording).items():
        numbers = [protocol.Envelope.FromString(frame[1]).sequence for frame in frames]
        check(numbers == list(range(1, len(frames) + 1)), f"{topic}: messages 1 to {len(frames)}")
    check(recording.finished and recording.run.phase == protocol.PHASE_ENDED, "the recording ends with the run")
    left = dmise.open_run(out)
    found = collections.Counter(type(record).__name__ for record in recording)
    check(found["Detection"] == len(left.detections) and found["FrameReport"] == len(left.frames)
          and found["Truth"] == len(left.truth), f"all records of the run's files are in it: {dict(found)}")
    return path


def is_read_by_mcap(path):
    """The official reader, with the schemas of the file alone: no word of ours."""
    pools = {}
    counted, detections, strays = collections.Counter(), 0, 0
    with path.open("rb") as file:
        for schema, channel, message in mcap.reader.make_reader(file, validate_crcs=True).iter_messages():
            if schema.id not in pools:
                pools[schema.id] = descriptor_pool.DescriptorPool()
                for described in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
                    pools[schema.id].Add(described)
            descriptor = pools[schema.id].FindMessageTypeByName(schema.name)
            body = message_factory.GetMessageClass(descriptor).FromString(message.data)
            counted[channel.topic] += message.sequence > 0
            if schema.name == "dmise.v1.RecordedMessage":
                detections += len(body.detection_set.detections)
                strays += (body.envelope.sequence, body.envelope.time_ns) != (message.sequence, message.log_time - START_NS)
    check(counted["detection/alpha"] == TICKS + 1 and detections > 0 and not strays,
          f"mcap reads {sum(counted.values())} messages of {len(counted)} channels with their numbers and times, "
          f"{detections} detections")


def replays(path, directory):
    recording = dmise.open_recording(path)
    original = by_topic(recording)
    again = directory / "again.mcap"
    with Run(*command("replay", path, "--speed", "max")) as playing:
        address = playing.process.stdout.readline().strip()
        recorded = dmise.record(address, again, truth=True)
        code, _ = playing.finish()
    check(code == 0 and recorded.complete, f"a replay is recorded: {recorded}; {playing.stderr.strip()}")
    check(by_topic(dmise.open_recording(again)) == original, "the replayed messages are the recorded ones, byte for byte")

    replay = dmise.Replay(path, speed=float("inf"))
    thread = threading.Thread(target=replay.run)
    thread.start()
    heard = list(dmise.subscribe(replay.address, "detection/", "truth/"))
    thread.join()
    kept = [record for record in recording if isinstance(record, (dmise.Detection, dmise.Truth))]
    check(sorted(map(str, heard)) == sorted(map(str, kept)), f"a subscriber hears {len(heard)} detections and truths")

    began = time.monotonic()
    with Run(*command("replay", path, "--speed", 100)) as playing:
        ticks = [tick for tick, _ in dmise.subscribe(playing.process.stdout.readline().strip(), "env/common").ticks()]
        playing.finish()
    took_s = time.monotonic() - began
    check(ticks == list(range(TICKS + 1)) and took_s >= 5 * TICKS / 100, f"{5 * TICKS} s at 100 times the speed take {took_s:.1f} s")


def gateways_follow_a_replay(binary, path):
    """A replay begins when an observer has subscribed: here the live view alone."""
    with Run(*command("replay", path, "--speed", "max")) as playing:
        address = playing.process.stdout.readline().strip()
        asked = subprocess.run([binary, "clock", "pause", address], capture_output=True, text=True, check=False)
        check(asked.returncode == 1 and asked.stderr.strip().endswith("it can be observed, not controlled"),
              f"its clock is not controlled: {asked.returncode} {asked.stderr.strip()}")
        with Run(pathlib.Path(binary).with_name("dmise-gateway"), "--master", address, "--listen", "127.0.0.1:0"):
            code, _ = playing.finish()
    check(code == 0, f"a gateway follows a replay: {playing.stderr.strip()}")


def late_observers_are_caught_up(path):
    replay = dmise.Replay(path, speed=60.0)
    thread = threading.Thread(target=replay.run)
    thread.start()
    early = dmise.subscribe(replay.address, "env/common")
    next(itertools.dropwhile(lambda tick: tick[0] < 20, early.ticks()))
    states = next(iter(dmise.subscribe(replay.address, "state/objects")))
    states = states if isinstance(states, dmise.ObjectRoster) else states.roster
    check(states is not None and len(states.objects) > 100, "a late observer is given the roster")
    replay.close()
    thread.join()


def replays_ignore_rubbish(path):
    replay = dmise.Replay(path, speed=float("inf"))
    thread = threading.Thread(target=replay.run)
    thread.start()
    context = zmq.Context()
    master = Master(context, replay.address)
    run = master.ask_and_wait(10.0)
    strangers = [context.socket(kind) for kind in (zmq.DEALER, zmq.DEALER, zmq.XSUB)]
    for socket, address in zip(strangers, (replay.address, run.publishers[0].resend_endpoint, run.observe_endpoint)):
        socket.connect(address)
        for frames in ([b""], [b"\xff" * 1000], [b"", b"x", b"y"], [b"\x02" + b"y" * 100_000]):
            socket.send_multipart(frames)
    try:
        dmise.Node(replay.address, "alpha", ["env/common"])
        reason = None
    except dmise.Refused as refused:
        reason = str(refused)
    heard = [message.frames for message in dmise.subscribe(replay.address, "frame/alpha").messages()]
    thread.join()
    for socket in (master.socket, *strangers):
        socket.close(0)
    context.term()
    check(reason and len(heard) == TICKS, f"rubbish changes nothing in a replay of {len(heard)} frames; a node hears: {reason}")


def holds_messages(part):
    """Whether what is on disk of a recording can be read up to a first message."""
    try:
        with contextlib.redirect_stderr(io.StringIO()):  # it says each time that the file is not finished
            return any(message.sequence for message in dmise.open_recording(part).messages())
    except (OSError, ValueError):
        return False


def killed_recorders_leave_files(binary, directory, reference):
    path, out = directory / "killed.mcap", directory / "killed"
    part = pathlib.Path(f"{path}.part")
    with Run(binary, "launch", write_scenario(directory, duration_s=5 * TICKS), "--out", out) as run:
        with Run(*command("record", address_of(out), path)) as recorder:
            first_frame(out)
            wait_until(lambda: holds_messages(part), "a recorder's first messages")
            os.kill(recorder.process.pid, signal.SIGKILL)
            recorder.finish()
        check(run.finish()[0] == 0, "the run is complete")
    check_same(out, reference, "beside a recorder that was killed")
    recording = dmise.open_recording(part)
    messages = [message for message in recording.messages() if message.sequence]
    check(messages and not recording.finished and not path.exists(), f"it leaves {len(messages)} messages, under another name")
    with Run(*command("replay", part, "--speed", "max")) as playing:
        again = dmise.record(playing.process.stdout.readline().strip(), directory / "killed-again.mcap")
        playing.finish()
    check(by_topic(recording) == by_topic(dmise.open_recording(again.path)) and again.phase == "failed",
          f"which are replayed: {again}")


def stopped_recorders_change_nothing(binary, directory, reference):
    path, out = directory / "stopped.mcap", directory / "stopped"
    with Run(binary, "launch", write_scenario(directory, duration_s=5 * TICKS), "--out", out) as run:
        with Run(*command("record", address_of(out), path, "--topics", "frame/,detection/")) as recorder:
            wait_until(lambda: pathlib.Path(f"{path}.part").exists(), "a recorder's file")
            os.kill(recorder.process.pid, signal.SIGSTOP)
            check(run.finish()[0] == 0, "a run is complete beside a recorder that stopped")
            os.kill(recorder.process.pid, signal.SIGCONT)
            code, _ = recorder.finish()
    check_same(out, reference, "beside a recorder that stopped")
    told = recorder.stderr.strip().splitlines()[-1]
    recording = dmise.open_recording(path if path.exists() else f"{path}.part")
    numbers = collections.Counter(message.topic for message in recording.messages() if message.sequence)
    check(told and recording.finished, f"it says what it has: code {code}: {told} {dict(numbers)}")


def stalled_recorders_count_what_they_missed(binary, directory):
    """The broker keeps 1000 messages for who does not read, publishers some ticks; the run does not wait."""
    scenario = write_scenario(directory, duration_s=5 * LONG, name="long.yaml")
    scenario.write_text(scenario.read_text().replace("cadence_s: 5", "cadence_s: 1000"))
    reference, out, path = directory / "long-reference", directory / "long", directory / "long.mcap"
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0, "an undisturbed long run is complete")
    context = zmq.Context()
    with Run(binary, "launch", scenario, "--out", out) as run:
        address = address_of(out)
        with Run(*command("record", address, path, "--topics", "env/common,state/objects")) as recorder:
            wait_until(lambda: pathlib.Path(f"{path}.part").exists(), "a recorder's file")
            os.kill(recorder.process.pid, signal.SIGSTOP)
            master = Master(context, address)
            wait_until(lambda: master.ask_and_wait(10.0).granted_tick > LONG * 3 // 4, "most of the run")
            os.kill(recorder.process.pid, signal.SIGCONT)
            check(run.finish()[0] == 0, "a run is complete beside a recorder that stalls")
            code, _ = recorder.finish()
        master.socket.close(0)
    context.term()
    check_same(out, reference, "beside a recorder that stalls")
    gaps = [(topic, int(first), int(last)) for topic, first, last in
            re.findall(r"(\S+): \d+ messages are lost, from number (\d+) to (\d+)", recorder.stderr)]
    for topic, frames in by_topic(dmise.open_recording(path)).items():
        numbers = [protocol.Envelope.FromString(frame[1]).sequence for frame in frames]
        missed = [number for name, first, last in gaps if name == topic for number in range(first, last + 1)]
        check(sorted(numbers + missed) == list(range(1, max(numbers) + 1)) and missed and code == 1,
              f"{topic}: {len(numbers)} messages and {len(missed)} lost are the numbers 1 to {max(numbers)}")
    print("ok:", recorder.stderr.strip().splitlines()[-1])


def gaps_are_told(path, directory):
    """A replay without some messages, and without publishers that could send them again."""
    class Lossy(dmise.Replay):
        def _publish(self, message):
            if not (message.topic == "frame/alpha" and 10 <= message.sequence < 15):
                super()._publish(message)

    replay = Lossy(path, speed=float("inf"))
    thread = threading.Thread(target=replay.run)
    thread.start()
    recorded = dmise.record(replay.address, directory / "lossy.mcap")
    thread.join()
    check([(gap.topic, gap.first, gap.last) for gap in recorded.gaps] == [("frame/alpha", 10, 14)]
          and "5 lost (frame/alpha 10 to 14)" in str(recorded), f"gaps are told: {recorded}")


def bad_files_have_one_line(path, directory):
    whole = path.read_bytes()
    damaged = bytearray(whole)
    damaged[len(whole) // 2] ^= 0x10
    for name, contents, words in (("damaged", bytes(damaged), "damaged"), ("empty", b"", "not an MCAP file"),
                                  ("text", b"this is no recording at all\n" * 9, "not an MCAP file"),
                                  ("cut", whole[:len(whole) // 2], "not finished: it ends after message"),
                                  ("nothing", None, "No such file")):
        bad = directory / f"{name}.mcap"
        if contents is not None:
            bad.write_bytes(contents)
        done = subprocess.run(command("replay", bad, "--observers", 0, "--speed", "max"), capture_output=True, text=True,
                              timeout=PATIENCE_S)
        said = sorted(set(done.stderr.strip().splitlines()[:2]))
        told = [line for line in done.stderr.splitlines() if "replayed" not in line]
        check(len(set(told)) == 1 and str(bad) in told[0] and words in told[0] and (done.returncode == 1 or name == "cut"),
              f"{name}: code {done.returncode}: {said}")
    for arguments, words in ((["record", "tcp://127.0.0.1:1", path], "--force"), (["replay", path, "--speed", "0"], "max")):
        done = subprocess.run(command(*arguments), capture_output=True, text=True, timeout=PATIENCE_S)
        check(done.returncode != 0 and words in done.stderr, f"{done.stderr.strip().splitlines()[-1]}")


def test(binary, directory):
    reference = directory / "reference"
    with Run(binary, "run", write_scenario(directory, duration_s=5 * TICKS), "--out", reference) as run:
        check(run.finish()[0] == 0, "an undisturbed run is complete")
    every_kind_has_a_field()
    path = records_a_run(binary, directory, reference)
    is_read_by_mcap(path)
    for copy in map(pathlib.Path, sys.argv[2:]):
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, copy)
    replays(path, directory)
    gateways_follow_a_replay(binary, path)
    late_observers_are_caught_up(path)
    replays_ignore_rubbish(path)
    gaps_are_told(path, directory)
    bad_files_have_one_line(path, directory)
    killed_recorders_leave_files(binary, directory, reference)
    stopped_recorders_change_nothing(binary, directory, reference)
    stalled_recorders_count_what_they_missed(binary, directory)


if __name__ == "__main__":
    main(test)
