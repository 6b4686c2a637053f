"""Four stations watch an object that is in no catalogue for half a day: the fusion node keeps its orbit from pass to pass and finds
its manoeuvre, the same for `run`, `launch` and a run that is stopped and continued.

    kept_orbits.py DMISE
"""

import bisect
import csv
import json
import math
import os
import pathlib
import signal
import subprocess
import sys

from harness import PATIENCE_S, Run, check, check_same, main, wait_until

ROOT = pathlib.Path(__file__).resolve().parents[2]
BURN_S = 36000
SITES = {"svalbard": (78.15, 16.04), "alaska": (65.13, -147.49), "mcmurdo": (-77.85, 166.67), "sutherland": (-32.38, 20.81)}
SCENARIO = """\
simulation: {start: 2018-12-24T22:00:00Z, duration_s: 46000, tick_s: 20, seed: 1}
nodes:
NODES
objects:
  - name: polar
    radius_m: 2
    motion:
      numerical: {semi_major_axis_m: 7192137, eccentricity: 0.001, inclination_deg: 98.6, raan_deg: 65, true_anomaly_deg: 100}
      forces: {area_to_mass_m2_per_kg: 0.01}
      manoeuvres: [{at_s: 36000, delta_v_rtn_m_per_s: [0, 0.3, 0]}]
fusion: {keep_orbits: on}
sensors:
SENSORS
output: {png: false, positions: [csv]}
"""
RANGING = {"sigma_arcsec": 5, "sigma_m": 2, "sigma_m_per_s": 0.1, "least_elevation_deg": 15, "farthest_m": 3.0e6}


def write(directory):
    (directory / "ranging.py").write_bytes((ROOT / "clients/python/examples/ranging.py").read_bytes())
    told = ", ".join(f"{key}: {value}" for key, value in RANGING.items())
    nodes = "".join(f"  - {{name: laser-{name}, run: [{sys.executable}, ranging.py], options: {{{told}}}}}\n" for name in SITES)
    sensors = "".join(f"  - {{name: {name}, node: laser-{name}, truth: on, site: {{latitude_deg: {north}, longitude_deg: {east}, "
                      "height_m: 200}, exposure_s: 1, cadence_s: 20}\n" for name, (north, east) in SITES.items())
    path = directory / "kept.yaml"
    path.write_text(SCENARIO.replace("NODES\n", nodes).replace("SENSORS\n", sensors))
    return path


def lines_of(file):
    return [json.loads(line) for line in file.read_text().splitlines()]


def path_of(file):
    """Times [s] and states [m, m/s] of the object, at each tick."""
    with open(file, encoding="utf-8") as text:
        rows = [row for row in csv.DictReader(text) if row["name"] == "polar"]
    times = [20.0 * int(row["tick"]) for row in rows]
    return times, [[1e3 * float(row[key]) for key in ("x_km", "y_km", "z_km", "vx_km_per_s", "vy_km_per_s", "vz_km_per_s")] for row in rows]


def place_at(path, time_s):
    """By the cubic through states 20 s apart: within 0.1 m."""
    times, states = path
    k = min(bisect.bisect_right(times, time_s) - 1, len(times) - 2)
    h, s = times[k + 1] - times[k], (time_s - times[k]) / (times[k + 1] - times[k])
    a, b = states[k], states[k + 1]
    return [(1 + 2 * s) * (1 - s)**2 * a[i] + s * (1 - s)**2 * h * a[i + 3] + s * s * (3 - 2 * s) * b[i] + s * s * (s - 1) * h * b[i + 3]
            for i in range(3)]


def judge(out):
    orbits, path = lines_of(out / "orbits.jsonl"), path_of(out / "positions.csv")
    check(len(orbits) >= 10 and {orbit["object"] for orbit in orbits} == {orbits[0]["object"]} and
          [orbit["arcs"] for orbit in orbits] == list(range(1, len(orbits) + 1)),
          f"{len(orbits)} arcs of one object, {orbits[0]['object']}")
    for orbit in orbits:
        off_m = math.dist(orbit["position_gcrs_m"], place_at(path, 1e-9 * orbit["time_ns"]))
        sigma_m = math.sqrt(sum(orbit["covariance_gcrs"][k] for k in (0, 2, 5)))
        check(off_m < 4 * sigma_m and (orbit["arcs"] < 3 or off_m < 100),
              f"arc {orbit['arcs']} at {1e-9 * orbit['time_ns']:.0f} s: {off_m:.0f} m off, {sigma_m:.0f} m by its covariance")
    burns = [orbit["manoeuvre"] for orbit in orbits if "manoeuvre" in orbit]
    check(len(burns) == 1 and burns[0]["found_ns"] > BURN_S * 1e9, f"{len(burns)} manoeuvre is found, after it was made")
    check(not lines_of(out / "breakups.jsonl"), "and no breakup")
    off_s = 1e-9 * burns[0]["time_ns"] - BURN_S
    check(abs(off_s) < 4 * burns[0]["time_sigma_s"] and burns[0]["confidence"] > 0.99,
          f"at its time but for {off_s:.0f} s, {burns[0]['time_sigma_s']:.0f} s by its deviation")


def dmise(binary, *arguments):
    done = subprocess.run([binary, *map(str, arguments), "--allow-programs"], capture_output=True, text=True, timeout=10 * PATIENCE_S)
    check(done.returncode == 0, f"dmise {arguments[0]} {done.stderr[-500:] if done.returncode else ''}")


def call(binary, directory):
    scenario = write(directory)
    dmise(binary, "run", scenario, "--out", directory / "run")
    judge(directory / "run")
    dmise(binary, "launch", scenario, "--out", directory / "launch")
    check_same(directory / "launch", directory / "run", "launch keeps the same orbits")
    half = directory / "part/orbits.jsonl"
    with Run(binary, "run", scenario, "--out", directory / "part", "--allow-programs") as run:
        wait_until(lambda: half.exists() and half.read_text().count("\n") >= 4, "four arcs")
        run.process.send_signal(signal.SIGINT)
        run.process.wait()
    dmise(binary, "run", scenario, "--out", directory / "part")
    check_same(directory / "part", directory / "run", "and a run that was stopped and continued")


if __name__ == "__main__":
    os.environ["PYTHONPATH"] = str(ROOT / "build/python")
    main(call)
