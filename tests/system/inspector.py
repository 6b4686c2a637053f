"""Objects of a scenario's own move as their closed forms say, and are drawn where the truth is.

    inspector.py DMISE

Runs launch/scenarios/inspector.yaml. `inspector` and `probe` are on one circular orbit, `slot` turns
with the Earth: their ranges (geometric) and directions (with light time) are computed here anew and
compared with what the sensor aboard `inspector` and the one in Atlanta tell.
"""

import json
import math
import pathlib
import subprocess

import numpy as np
from harness import check, main

ROOT = pathlib.Path(__file__).resolve().parents[2]
C = 299_792_458.0  # m/s
GM = 3.986004415e14  # m^3/s^2
A = 7_178_137.0  # m
INCLINATION = math.radians(98.6)
AHEAD = math.radians(0.15)


def on_orbit(t_s, ahead_rad):
    u = ahead_rad + math.sqrt(GM / A**3) * t_s
    return A * np.array([math.cos(u), math.sin(u) * math.cos(INCLINATION),
                         math.sin(u) * math.sin(INCLINATION)])


def wgs84(latitude_deg, longitude_deg, height_m):
    a, f = 6378137.0, 1 / 298.257223563
    lat, lon = math.radians(latitude_deg), math.radians(longitude_deg)
    e2 = f * (2 - f)
    n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
    return np.array([(n + height_m) * math.cos(lat) * math.cos(lon),
                     (n + height_m) * math.cos(lat) * math.sin(lon),
                     (n * (1 - e2) + height_m) * math.sin(lat)])


def seen(place, observer):
    """Vector from the observer to `place(-light time)`."""
    line = place(0.0) - observer
    for _ in range(4):
        line = place(-np.linalg.norm(line) / C) - observer
    return line


def test(binary, directory):
    out = directory / "out"
    run = subprocess.run([binary, "run", ROOT / "launch/scenarios/inspector.yaml", "--out", out],
                         capture_output=True, text=True)
    check(run.returncode == 0, f"the scenario runs{run.stderr if run.returncode else ''}")
    truths = [json.loads(line) for line in (out / "truth.jsonl").read_text().splitlines()]

    probes = [t for t in truths if t["sensor"] == "watcher" and t["name"] == "probe"]
    check(len(probes) == 3, "the sensor aboard `inspector` sees `probe` in all three frames")
    check(not any(t["name"] == "inspector" and t["sensor"] == "watcher" for t in truths),
          "and not the object that carries it")
    worst_m = worst_rad = 0.0
    for t in probes:
        time_s = t["middle_ns"] * 1e-9
        line = seen(lambda dt: on_orbit(time_s + dt, AHEAD), on_orbit(time_s, 0.0))
        distance_m = np.linalg.norm(on_orbit(time_s, AHEAD) - on_orbit(time_s, 0.0))
        worst_m = max(worst_m, abs(distance_m - t["true_range_m"]))
        ra, dec = math.radians(t["true_ra_deg"]), math.radians(t["true_dec_deg"])
        told = np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])
        worst_rad = max(worst_rad, np.linalg.norm(np.cross(told, line / np.linalg.norm(line))))
    check(worst_m < 0.005, f"its range is that of the closed form to {worst_m * 1e3:.2f} mm")
    check(worst_rad * 18.8e3 < 0.005, f"its direction too, {worst_rad * 206264806:.1f} mas")
    check(all(abs(t["rendered_px"][k] - t["middle_px"][k]) < 0.01 for t in probes for k in (0, 1)),
          "its light falls where the truth says, to 0.01 px")

    slots = [t for t in truths if t["sensor"] == "atlanta" and t["name"] == "slot"]
    check(len(slots) == 2, "the sensor in Atlanta sees `slot` in both frames")
    site, slot = wgs84(33.777, -84.398, 300), wgs84(0, -75.3, 35786000)
    worst_m = max(abs(np.linalg.norm(slot - site) - t["true_range_m"]) for t in slots)
    check(worst_m < 0.01, f"its range is that of the geodetic places to {worst_m * 1e3:.2f} mm")
    check(len({t["true_range_m"] // 1 for t in slots}) == 1, "and does not change with time")
    numbers = {t["name"]: t["catalogue_number"] for t in truths}
    check(numbers["probe"] == 990000002 and numbers["slot"] == 990000003,
          "objects without a number have one of their own in the truth")


main(test)
