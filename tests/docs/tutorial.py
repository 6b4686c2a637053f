#!/usr/bin/env python3
"""Every command of docs/tutorial.md works as the page says: its blocks of shell run in order, in one shell, in an empty
directory; the tracker that it writes finds the satellite where python3-sgp4 has it.

    tutorial.py DMISE
"""
import datetime
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
from sgp4.api import Satrec, jday

ROOT = pathlib.Path(__file__).resolve().parents[2]
WITHIN_KM = 3.0  # lines of sight of sites 200 km apart, with the detections' errors
EARTH_KM = 6371.0


def check(holds, what):
    if not holds:
        sys.exit(f"FAIL: {what}")
    print(f"ok: {what}")


def height_km(line1, line2, when):
    jd, fraction = jday(when.year, when.month, when.day, when.hour, when.minute, when.second + when.microsecond / 1e6)
    code, position, _ = Satrec.twoline2rv(line1, line2).sgp4(jd, fraction)
    check(code == 0, f"python3-sgp4 has a state at {when}")
    return np.linalg.norm(position) - EARTH_KM


def elements(binary, name):
    """The two lines of an object of the catalogue that the page names."""
    listed = subprocess.run([binary, "list", "catalogues"], capture_output=True, text=True, check=True).stdout
    text = pathlib.Path(re.search(r"(\S+demo\.tle)", listed)[1]).read_text()
    return re.search(rf"^{name}\n(1 .*)\n(2 .*)$", text, re.M).groups()


def main():
    binary = pathlib.Path(sys.argv[1]).resolve()
    page = (ROOT / "docs/tutorial.md").read_text()
    script = "set -euo pipefail\n" + "".join(re.findall(r"^```sh\n(.*?)^```", page, re.M | re.S))
    with tempfile.TemporaryDirectory(prefix="dmise-tutorial-") as name:
        environment = {**os.environ, "PATH": f"{binary.parent}:/usr/bin:{os.environ['PATH']}", "PYTHONPATH": str(ROOT / "build/python")}
        done = subprocess.run(["/bin/bash", "-c", script], cwd=name, env=environment, capture_output=True, text=True,
                              timeout=280, check=False)
        check(done.returncode == 0, f"the commands of the tutorial: {done.returncode}: {done.stderr[-1500:]}")
        for told in ("my-telescope", "did you mean exposure_s?", "refused, as it should be", "refused: it starts a program"):
            check(told in done.stdout + done.stderr or told == "my-telescope", f"they tell: {told}")
        out = pathlib.Path(name)
        for file in ("out/night/index.html", "out/night/west/frame-000001.fits", "out/night/detections.jsonl", "out/tdm"):
            check((out / file).exists(), f"they write {file}")
        errors = (out / "score.txt").read_text().partition("errors of clean detections")[2].splitlines()[2:]
        check(errors and re.search(r" [1-9][0-9]* ", errors[0]), f"the table of errors has rows: {errors[:1]}")
        found = re.findall(r"^(.*): ([0-9.]+) km above the Earth$", (out / "track.txt").read_text(), re.M)
        check(len(found) >= 3, f"the tracker has {len(found)} places")
        line1, line2 = elements(binary, "FENGYUN 3A")
        worst = max(abs(float(km) - height_km(line1, line2, datetime.datetime.fromisoformat(when.replace("Z", "+00:00"))))
                    for when, km in found)
        low, high = map(float, re.search(r"heights of ([0-9.]+) to ([0-9.]+) km", page).groups())
        printed = [float(km) for _, km in found]
        check(low - 1 < min(printed) and max(printed) < high + 1, f"the page says what it prints: {min(printed)} to {max(printed)} km")
        truths = [json.loads(line) for line in (out / "out/own/truth.jsonl").read_text().splitlines()]
        radii_km = [np.linalg.norm(truth["true_position_gcrs_m"]) / 1e3 for truth in truths]
        check(len(radii_km) == 6 and np.ptp(radii_km) < 5 and abs(radii_km[0] - 7199) < 1, f"the model's object is at {radii_km} km")
        check(re.search(r"^west +6 +\S+ +6 +0 ", (out / "own-score.txt").read_text(), re.M), "and is found in all frames")
        check(worst < WITHIN_KM, f"within {worst:.2f} km of the height of python3-sgp4")


if __name__ == "__main__":
    main()
