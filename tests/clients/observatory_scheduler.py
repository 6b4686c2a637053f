"""A program of somebody's own closes the loop: a run's fusion finds what is in no catalogue, and an observatory's telescope that knows
nothing of it is sent there by Alpaca, follows and images it within a minute of the first detection.

    observatory_scheduler.py DMISE

Both have one clock, that of the run, which is paced. clients/python/examples/scheduler.py is the program: alpyca, astropy and the
Python client.
"""

import datetime
import json
import math
import os
import subprocess
import sys

try:
    import alpaca.telescope  # noqa: F401
    import astropy  # noqa: F401
    import zmq  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)

from served_observatory import ROOT, Served, check, journal, main, same_again, wait_until

sys.path.insert(0, str(ROOT / "tests/system"))
from cue import CAMERAS  # noqa: E402
from harness import Run  # noqa: E402

IMAGES, EXPOSURE_S = 2, 0.5
NETWORK = """\
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 100, tick_s: 5, seed: 1}
objects: [{catalogue: newcomer.tle, radius_m: 4}]
stars: {catalogue: kstars}
fusion: {not_in_catalogue: [NEWCOMER]}
network: {real_time: 1}
sensors:
  - {name: atlanta, site: atlanta, camera: wide.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark}
  - {name: huntsville, site: huntsville, camera: wide.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark}
output: {png: false}
"""
OBSERVATORY = """\
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 600, tick_s: 5, seed: 1}
objects: [{catalogue: newcomer.tle, radius_m: 4}]
stars: {catalogue: kstars}
sensors:
  - {name: telescope, site: atlanta, camera: narrow.yaml, pointing: zenith, exposure_s: 0.5, cadence_s: 3600, sky: dark, mask_deg: 10}
output: {png: false}
"""
START = datetime.datetime.fromisoformat("2018-01-21T00:15:00+00:00")


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def seconds(utc):
    return (datetime.datetime.fromisoformat(utc.replace("Z", "") + ("" if "+" in utc else "+00:00")) - START).total_seconds()


def check_images(run, night, said):
    """Each image has the object in the middle, as a point among trails, and the first is there in time."""
    first_s = min(d["end_ns"] if "end_ns" in d else d["time_ns"] for s in ("atlanta", "huntsville")
                  for d in lines_of(run / s / "detections.jsonl")) / 1e9
    ready_s = seconds(said[0]["start_utc"]) + EXPOSURE_S
    check(ready_s - first_s <= 60, f"from the first detection, {first_s:.1f} s, to the end of the exposure, {ready_s:.1f} s: "
          f"{ready_s - first_s:.1f} s; its track was of {seconds(said[0]['given_utc']):.1f} s")
    truth = {t["frame"]: t for t in lines_of(night / "telescope/truth.jsonl")}
    for number, image in enumerate(said, 1):
        off = math.dist(truth[number]["middle_px"], (511.5, 511.5))
        found = [d for d in lines_of(night / "telescope/detections.jsonl") if d["frame"] == number]
        near = min((math.dist(d["middle_px"] if "middle_px" in d else (d["x_px"], d["y_px"]), truth[number]["middle_px"]) for d in found),
                   default=math.inf)
        check(off < 400 and near < 2, f"image {number}, {image['shape']}, has it {off:.0f} px from the middle, and its detection "
              f"{near:.2f} px from the truth")


def test(binary, work):
    for name, text in CAMERAS.items():
        (work / name).write_text(text)
    (work / "network.yaml").write_text(NETWORK)
    scenario, run_out, night = work / "observatory.yaml", work / "run", work / "night"
    scenario.write_text(OBSERVATORY)
    with Run(binary, "launch", work / "network.yaml", "--out", run_out) as run:
        announced = run_out / "logs/master.address"
        master = wait_until(lambda: announced.exists() and announced.read_text().strip(), "the time-master's address")
        with Served(binary, night, "--no-discovery", "--slew-rate", "5", "--run", master, scenario=scenario) as observatory:
            program = subprocess.run(
                [sys.executable, ROOT / "clients/python/examples/scheduler.py", master, observatory.address, str(IMAGES), str(EXPOSURE_S)],
                stdout=subprocess.PIPE, text=True, timeout=150, check=False,
                env={**os.environ, "PYTHONPATH": str(ROOT / "build/python")})
            check(program.returncode == 0, f"the scheduler has its images: code {program.returncode}")
            check(len(journal(night)) == IMAGES, "they are in the journal")
            run.interrupt()
            run.finish()
            wait_until(lambda: observatory.process.poll() is not None, "the night's end")
            check(observatory.process.returncode == 0, "the night ends with the run")
    check_images(run_out, night, [json.loads(line) for line in program.stdout.splitlines()])
    same_again(binary, night, work, scenario)


if __name__ == "__main__":
    main(test)
