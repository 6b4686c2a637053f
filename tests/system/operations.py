"""A run as an operator sees it: figures of every process for Prometheus, logs in JSON, health.

    operations.py DMISE
"""

import json
import os
import pathlib
import re
import subprocess
import urllib.request

from harness import Run, check, main, wait_until, write_scenario

PROMTOOL = pathlib.Path(__file__).resolve().parents[2] / "build/tools/promtool"
PROCESSES = ["time-master", "broker", "orbit-node", "environment-node", "alpha", "beta"]


def events(out, name):
    """A process's log; a last line that is not whole yet is left out."""
    path = out / f"logs/{name}.log"
    lines = path.read_text().splitlines(keepends=True) if path.exists() else []
    return [json.loads(line) for line in lines if line.endswith("\n")]


def url_of(out, name):
    return next((e["fields"]["url"] for e in events(out, name) if e["event"] == "metrics_served"), None)


def page_of(out, name):
    with urllib.request.urlopen(wait_until(lambda: url_of(out, name), f"metrics of {name}"), timeout=20) as answer:
        return answer.read().decode()


def value(page, sample):
    found = re.search(rf"^{re.escape(sample)} (\S+)$", page, re.MULTILINE)
    return float(found[1]) if found else None


def says(*command, **environment):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=60,
                          env=os.environ | environment)
    return done.returncode, (done.stdout + done.stderr).strip()


def test(binary, directory):
    scenario, out = write_scenario(directory, network=", real_time: 12"), directory / "out"
    with Run(binary, "launch", scenario, "--out", out, "--metrics", "auto", "--log-format", "json") as run:
        wait_until(lambda: list(out.glob("*/frame-000002.fits")), "a second frame")
        pages = {name: page_of(out, name) for name in PROCESSES}
        for name, page in pages.items():
            if PROMTOOL.exists() or "DMISE_DATA" in os.environ:
                lint = subprocess.run([PROMTOOL, "check", "metrics"], input=page, capture_output=True, text=True, timeout=60)
                check(lint.returncode == 0 and not lint.stderr, f"promtool accepts {name}: {lint.stderr or 'no complaint'}")
        check(value(pages["time-master"], 'dmise_clock_phase{phase="running"}') == 1, "the clock says that the run goes on")
        frames = wait_until(lambda: value(page_of(out, "alpha"), 'dmise_node_frames_total{node="alpha"}'), "a frame counted")
        check(frames >= 1, f"a sensor counts its frames: {frames:g}")
        told = wait_until(lambda: value(page_of(out, "time-master"), 'dmise_clock_node_frames_total{node="alpha"}'), "the same")
        check(told >= 1, f"and the clock knows of them: {told:g}")
        compute = value(page_of(out, "alpha"), 'dmise_node_seconds_total{node="alpha",part="compute"}')
        check(compute > 0, f"time is split: {compute:.2f} s in steps")
        page = page_of(out, "alpha")
        for kind in ("", "predicted_"):
            spent = value(page, f'dmise_sensor_stage_{kind}seconds_total{{node="alpha",stage="photon_noise"}}')
            check(spent > 0, f"stages of frames have their {kind.replace('_', ' ')}time: {spent:.3g} s of photon noise")

        master = (out / "logs/master.address").read_text().strip()
        for name in [*PROCESSES]:
            code, text = says(binary, "health", name, DMISE_MASTER=master)
            check(code == 0 and text.startswith("healthy"), f"{name} is {text}")
        code, text = says(binary, "health", "gamma", "--master", master)
        check(code == 1 and "gamma is not a node of this run" in text, f"no other is: {text}")
        run.interrupt()
        run.finish()
        code, text = says(binary, "health", "alpha", "--master", master)
        check(code == 1 and "no answer from a time-master" in text, f"nor after the end: {text}")
        for name in PROCESSES:
            check(all(list(e) == ["time", "level", "node", "event", "text", "fields"] for e in events(out, name)),
                  f"{name}: {len(events(out, name))} lines of JSON")
        run.nothing_left()


if __name__ == "__main__":
    main(test)
