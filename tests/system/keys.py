"""A run with keys: every connection by CURVE, the same bytes also behind agents, and nobody without a key is let in.

    keys.py DMISE
"""

import pathlib
import subprocess
import sys

import zmq

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "build/python"))
from dmise.frame_endpoint import FrameEndpoint  # noqa: E402
from dmise.keys import Keys  # noqa: E402
from dmise.master import Master  # noqa: E402

from harness import Run, check, check_same, main, wait_until, write_scenario


def says(binary, *arguments):
    done = subprocess.run([str(binary), *map(str, arguments)], capture_output=True, text=True, timeout=20)
    return done.returncode, done.stdout, done.stderr.strip()


def serves_frames(out, keys, name="operator"):
    """A frame of alpha, from its own endpoint: the bytes of its file."""
    context, own = zmq.Context(), Keys(keys, name)
    run = Master(context, (out / "logs/master.address").read_text().strip(), own).ask_and_wait(60.0)
    sensor = next(publisher for publisher in run.publishers if publisher.name == "alpha")
    reader = FrameEndpoint(context, own, sensor, run.run_id, latest=False)
    reader.ask()
    report, content = wait_until(lambda: reader.take(None), "a frame of alpha")
    file = out / f"alpha/frame-{report.frame:06d}.fits"
    check(report.sensor == "alpha" and content == file.read_bytes(), f"alpha serves {file.name} to who has a key")
    context.destroy(0)


def test(binary, directory):
    scenario = write_scenario(directory, duration_s=60, network=", real_time: 12")
    keys = directory / "keys"
    code, out, _ = says(binary, "keygen", keys, "--scenario", scenario, "--hosts", 2)
    check(code == 0 and len(out.splitlines()) == 12, f"keygen makes {len(out.splitlines())} keys")
    modes = {oct(p.stat().st_mode & 0o777) for p in keys.glob("*.key")}
    check(modes == {"0o600"}, f"their owner alone may read them: {modes}")
    code, _, err = says(binary, "keygen", keys, "alpha")
    check(code == 2 and "already" in err, f"none is replaced unasked: {err}")
    code, _, err = says(binary, "keygen", keys, "guest", "alpha")
    check(code == 2 and not (keys / "guest.key").exists(), f"nor is one of several made: {err}")
    check(says(binary, "keygen", keys, "guest", "guest")[0] == 2, "a name twice is refused")

    reference, out = directory / "reference", directory / "out"
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0, "a run without a network is complete")
    with Run(binary, "launch", scenario, "--out", out, "--keys", keys) as run:
        wait_until(lambda: list(out.glob("*/frames.jsonl")), "a first frame")
        master = (out / "logs/master.address").read_text().strip()
        code, table, err = says(binary, "status", master, "--once", "--keys", keys)
        check(code == 0 and "alpha" in table and "running" in table, f"the operator is told: {err or table.splitlines()[0]}")
        check(says(binary, "status", master, "--healthy", "--keys", keys)[0] == 0, "the run is healthy")
        code, table, err = says(binary, "clock", "pause", master, "--keys", keys)
        check(code == 0 and "paused" in table, f"the operator pauses the run: {err or table.splitlines()[0]}")
        serves_frames(out, keys)
        # Paused, so that it cannot end while strangers wait for an answer.
        code, _, err = says(binary, "status", master, "--once")
        check(code == 1 and "no answer from a time-master" in err, f"nobody else is: {err}")
        code, _, err = says(binary, "clock", "abort", master)
        check(code == 1, f"nor obeyed: {err}")
        check(says(binary, "clock", "pace", master, "5")[0] == 1, "nor are they when they ask for another pace")
        code, table, err = says(binary, "clock", "pace", master, "500", "--keys", keys)
        check(code == 0 and "pace: 500 times real time" in table, f"which the operator sets: {err or 500}")
        check(says(binary, "clock", "go-on", master, "--keys", keys)[0] == 0, "and lets it go on")
        code, _ = run.finish()
        check(code == 0, f"the run ends with code {code} {run.stderr[-300:] if code else ''}")
        run.nothing_left()
    check_same(out, reference, "with keys")

    behind = directory / "behind"
    with Run(binary, "launch", scenario, "--out", behind, "--keys", keys, "--hosts", 2) as run:
        wait_until(lambda: list(behind.glob("alpha/frames.jsonl")), "a first frame")
        serves_frames(behind, keys)
        code, _ = run.finish()
        check(code == 0, f"sensors behind agents with keys end with code {code} {run.stderr[-300:] if code else ''}")
        run.nothing_left()
    check_same(behind, reference, "with keys behind agents")
    code, _, err = says(binary, "launch", scenario, "--out", directory / "moved", "--keys", keys, "--hosts", 1)
    check(code == 2 and "the key of host-1 may not speak for" in err, f"an agent's key is for its own sensors: {err}")

    with Run(binary, "launch", scenario, "--out", directory / "open", "--bind", "tcp://0.0.0.0:0") as run:
        code, waited_s = run.finish()
        last = run.stderr.strip().splitlines()[-1]
        check(code != 0 and "not loopback" in last, f"no keys, no other address than loopback: {last}")
        run.nothing_left()


if __name__ == "__main__":
    main(test)
