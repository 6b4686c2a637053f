"""The numbers of objects in a field, and of those that are sunlit, by skyfield, in ten exposures of each of two sites.

    survey_counts.py DMISE

`dmise survey` writes them into exposures.csv. Here every object of the catalogue is propagated by skyfield's SGP4 and
turned into the site's horizon at mid exposure. In the field: its gnomonic image, north up, is within the frame. Sunlit:
its line to the Sun (of ERFA) passes the Earth. Objects within 0.03 deg of the frame's edge (refraction and light
time) or whose line passes within 40 km of the round Earth (flattening, the Sun's disc) are in doubt: the numbers must
agree but for those.
"""
import csv
import subprocess
import sys
import tempfile

import erfa
import numpy as np
from skyfield.api import EarthSatellite, load, wgs84
from skyfield.constants import AU_M

import referee
from skyfield_directions import read_elements

SITES = {"atlanta": (33.777, -84.398, 300.0), "cerro-tololo": (-30.165278, -70.815, 2215.0)}
ELEMENTS = referee.CATALOGUES / "demo.tle"
EDGE_DEG, LIMB_M, EARTH_M = 0.03, 40e3, 6371e3
HALF_WIDE, HALF_HIGH = 1.0, 2504 / 3326  # half sides of the frame in the tangent plane: 90 deg across its width

SCENARIO = """simulation: {start: 2018-01-21T00:15:00Z, duration_s: 27100, tick_s: 10}
objects: [{catalogue: demo}]
sensors:
"""


def counts(satellites, site, t):
    """(in field, in doubt, sunlit in field, of those in doubt) at one time."""
    sun_m = -np.asarray(erfa.epv00(t.whole, t.tt_fraction)[0]["p"]) * AU_M
    field = doubt = sunlit = lit_doubt = 0
    for satellite in satellites:
        if np.any(np.isnan(satellite.at(t).position.m)):
            continue
        up, around = (angle.radians for angle in (satellite - site).at(t).altaz()[:2])
        if up <= 0:
            continue
        x, y = np.sin(around) / np.tan(up), np.cos(around) / np.tan(up)
        # Angle by which the image is inside the nearest edge.
        inside = min(np.arctan(HALF_WIDE) - np.arctan(abs(x)), np.arctan(HALF_HIGH) - np.arctan(abs(y)))
        unsure = abs(np.degrees(inside)) < EDGE_DEG
        if inside < 0 and not unsure:
            continue
        here = satellite.at(t).position.m
        line = (sun_m - here) / np.linalg.norm(sun_m - here)
        along = here @ line
        miss = np.linalg.norm(here - along * line) if along < 0 else np.inf
        lit, unsure_lit = miss > EARTH_M, abs(miss - EARTH_M) < LIMB_M
        field += inside > 0
        doubt += unsure
        sunlit += inside > 0 and lit
        lit_doubt += unsure or unsure_lit
    return field, doubt, sunlit, lit_doubt


def judge(binary):
    timescale = load.timescale(delta_t=69.184, builtin=True)  # UT1 is UTC, as without an Earth orientation file
    satellites = [EarthSatellite(one, two, str(number), timescale)
                  for number, (one, two) in read_elements(ELEMENTS).items()]
    start = timescale.utc(2018, 1, 21, 0, 15)
    compared = 0
    with tempfile.TemporaryDirectory(prefix="dmise-referee-") as directory:
        scenario = f"{directory}/scenario.yaml"
        with open(scenario, "w") as file:
            file.write(SCENARIO)
            for name, (latitude, longitude, height) in SITES.items():
                file.write(f"  - {{name: {name}, site: {{latitude_deg: {latitude}, longitude_deg: {longitude}, height_m: "
                           f"{height}}}, camera: omnissa, pointing: zenith, exposure_s: 20, cadence_s: 3000}}\n")
        subprocess.run([binary, "survey", scenario, "--out", f"{directory}/out"], check=True, capture_output=True)
        for name, (latitude, longitude, height) in SITES.items():
            site = wgs84.latlon(latitude, longitude, elevation_m=height)
            with open(f"{directory}/out/{name}/exposures.csv", newline="") as file:
                rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
            for row in rows:
                t = timescale.tt_jd(start.whole, start.tt_fraction + int(row["middle_ns"]) * 1e-9 / 86400)
                field, doubt, sunlit, lit_doubt = counts(satellites, site, t)
                said = f"{name}, frame {row['frame']}: {row['in_field']} in the field, {row['sunlit']} sunlit"
                if abs(int(row["in_field"]) - field) > doubt or abs(int(row["sunlit"]) - sunlit) > lit_doubt:
                    raise referee.Failure(f"{said}; skyfield: {field} ({doubt} in doubt), {sunlit} ({lit_doubt})")
                print(f"{said}: agrees with skyfield, {doubt} and {lit_doubt} in doubt")
                compared += 1
    if compared < 15:
        raise referee.Failure(f"only {compared} exposures were compared")


if __name__ == "__main__":
    referee.main(judge, sys.argv[1])
