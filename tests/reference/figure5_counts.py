"""Figure 5 of the paper at ten times: how many objects are in the field over Atlanta, and how many of them sunlit, by skyfield
and by astropy.

    figure5_counts.py DMISE [--json] [--counts counts.csv]

`dmise visible launch/scenarios/figure5.yaml` writes them into counts.csv. Here every object is propagated by Python's sgp4
and turned to the Earth by skyfield and by astropy. In the field: its gnomonic image is within the frame of 90 deg north to
south by 74 deg. Sunlit: the middle of the Sun (ERFA's) stands above the limb of WGS 84, as seen from it; half a disc is seen
then, to 0.002 deg. Objects within 0.01 deg of an edge of the frame or of the limb are in doubt: the numbers agree but for those.
The catalogue is that of 2019-12-19 with 18,470 objects where it is there ($DMISE_DATA, else ../shared/data),
else the one that is shipped.
"""
import argparse
import csv
import datetime
import gzip
import json
import os
import pathlib
import subprocess
import tempfile

import astropy.units as u
import erfa
import numpy as np
from astropy.coordinates import ITRS, TEME, CartesianRepresentation, EarthLocation
from astropy.time import Time
from astropy.utils import iers
from sgp4.api import Satrec, SatrecArray
from skyfield.api import load, wgs84
from skyfield.framelib import itrs
from skyfield.sgp4lib import TEME as SkyfieldTeme

import referee
from skyfield_directions import read_elements

LATITUDE, LONGITUDE, HEIGHT_M = 33.777, -84.398, 300.0
DATA = pathlib.Path(os.environ.get("DMISE_DATA", referee.SOURCE / "../shared/data")) / "tle/catalog_3le_2019-12-19_18470.txt.gz"
EDGE_DEG = 0.01
HALF_NORTH, HALF_EAST = 1.0, 2504 / 3326  # half sides of the frame in the tangent plane: 90 deg along its width
A_M, F = 6378137.0, 1 / 298.257223563
TIMES = [round(86400 * (k + 0.5) / 10 / 10) * 10 for k in range(10)]  # s, on the grid of 10 s

iers.conf.auto_download = False
iers.conf.iers_degraded_accuracy = "ignore"


def catalogue():
    """([(line 1, line 2)], start, what it is called)"""
    if not DATA.exists():
        return list(read_elements(referee.CATALOGUES / "demo.tle").values()), "2018-01-20T00:00:00Z", "the shipped one"
    lines = [line.rstrip() for line in gzip.open(DATA, "rt")]
    pairs = [(one, two) for one, two in zip(lines, lines[1:]) if one.startswith("1 ") and two.startswith("2 ")]
    return pairs, "2019-12-19T00:00:00Z", "2019-12-19"


def earth_by_skyfield(position_km, start, second):
    """Positions and the site in ITRS [m]."""
    timescale = load.timescale(delta_t=69.184, builtin=True)  # UT1 is UTC, as without an Earth orientation file
    t = timescale.utc(start.year, start.month, start.day, start.hour, start.minute, start.second + second)
    itrs_from_teme = itrs.rotation_at(t) @ SkyfieldTeme.rotation_at(t).T
    return position_km @ itrs_from_teme.T * 1e3, wgs84.latlon(LATITUDE, LONGITUDE, HEIGHT_M).itrs_xyz.m


def earth_by_astropy(position_km, start, second):
    t = Time(start.replace(tzinfo=None), scale="utc") + second * u.s
    t.delta_ut1_utc = 0.0
    teme = TEME(CartesianRepresentation(*(position_km.T * u.km)), obstime=t)
    site = EarthLocation.from_geodetic(LONGITUDE * u.deg, LATITUDE * u.deg, HEIGHT_M * u.m)
    return teme.transform_to(ITRS(obstime=t)).cartesian.xyz.to_value(u.m).T, np.array([x.to_value(u.m) for x in site.geocentric])


def sun_itrs_m(start, second):
    """The Sun from the Earth's centre, by ERFA's ephemeris and rotation."""
    t = Time(start.replace(tzinfo=None), scale="utc") + second * u.s
    gcrs = -np.asarray(erfa.epv00(t.tt.jd1, t.tt.jd2)[0]["p"]) * erfa.DAU
    return erfa.c2t06a(t.tt.jd1, t.tt.jd2, t.utc.jd1, t.utc.jd2, 0.0, 0.0) @ gcrs


def above_limb_deg(here_m, sun_m):
    """Angle of the Sun's middle above the limb of WGS 84; negative behind it. In space that is stretched along the axis the
    limb is that of a sphere; the limb's point nearest to the Sun is turned back before the angle is taken."""
    stretch = np.array([1, 1, 1 / (1 - F)])
    to_sun = sun_m - here_m
    here, line = here_m * stretch, to_sun * stretch
    distance = np.linalg.norm(here, axis=1, keepdims=True)
    down = -here / distance
    aside = line - down * (down * line).sum(axis=1, keepdims=True)
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    sine = np.minimum(1.0, A_M / distance)
    limb = (down * np.sqrt(1 - sine**2) + aside * sine) / stretch

    def angle(a, b):
        return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))

    behind = angle(-here, line) < np.degrees(np.arcsin(sine[:, 0]))
    return np.where(behind, -1, 1) * angle(to_sun, limb)


def counts(itrs_m, site_m, sun_m):
    """(in the field, of those in doubt, sunlit, of those in doubt)"""
    latitude, longitude = np.radians([LATITUDE, LONGITUDE])
    east = np.array([-np.sin(longitude), np.cos(longitude), 0])
    up = np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)])
    line = itrs_m - site_m
    e, n, h = line @ east, line @ np.cross(up, east), line @ up
    inside = np.degrees(np.minimum(np.arctan(HALF_NORTH) - np.arctan2(abs(n), h), np.arctan(HALF_EAST) - np.arctan2(abs(e), h)))
    unsure = abs(inside) < EDGE_DEG
    sun_deg = above_limb_deg(itrs_m, sun_m)
    field, lit = inside > 0, sun_deg > 0
    return (int(field.sum()), int(unsure.sum()), int((field & lit).sum()),
            int((unsure | (field & (abs(sun_deg) < EDGE_DEG))).sum()))


def compare(binary, counts_file):
    pairs, start_text, named = catalogue()
    start = datetime.datetime.fromisoformat(start_text.replace("Z", "+00:00"))
    if counts_file:
        text = pathlib.Path(counts_file).read_text()
    else:
        with tempfile.TemporaryDirectory(prefix="dmise-referee-") as directory:
            (pathlib.Path(directory) / "objects.tle").write_text("".join(f"{one}\n{two}\n" for one, two in pairs))
            scenario = (referee.SOURCE / "launch/scenarios/figure5.yaml").read_text()
            scenario = scenario.replace("catalogue: demo", "catalogue: objects.tle").replace("2018-01-21T00:00:00Z", start_text)
            (pathlib.Path(directory) / "s.yaml").write_text(scenario)
            subprocess.run([binary, "visible", f"{directory}/s.yaml", "--out", f"{directory}/out", "--rows", "1", "--threads", "2"],
                           check=True, capture_output=True)
            text = (pathlib.Path(directory) / "out/atlanta/counts.csv").read_text()
    ours = {row["time_utc"]: (int(row["in_sight"]), int(row["sunlit"])) for row in csv.DictReader(text.splitlines())}
    satellites = SatrecArray([Satrec.twoline2rv(*pair) for pair in pairs])
    rows = []
    for second in TIMES:
        at = start + datetime.timedelta(seconds=second)
        day = np.array([(start - datetime.datetime(2000, 1, 1, 12, tzinfo=datetime.timezone.utc)).total_seconds() / 86400 + 2451545.0])
        errors, position, _ = satellites.sgp4(day, np.array([second / 86400]))
        position = position[errors[:, 0] == 0, 0]
        sun_m = sun_itrs_m(start, second)
        row = {"time_utc": at.strftime("%Y-%m-%dT%H:%M:%S.000Z"), "objects": len(position)}
        row["dmise"] = ours[row["time_utc"]]
        row["skyfield"] = counts(*earth_by_skyfield(position, start, second), sun_m)
        row["astropy"] = counts(*earth_by_astropy(position, start, second), sun_m)
        rows.append(row)
    return {"catalogue": named, "objects": len(pairs), "rows": rows}


def judge(binary, options):
    found = compare(binary, options.counts)
    if options.json:
        print(json.dumps(found))
        return
    lit = 0
    for row in found["rows"]:
        field, sunlit = row["dmise"]
        lit += sunlit
        said = f"{row['time_utc']}: {field} in the field, {sunlit} sunlit"
        for who in ("skyfield", "astropy"):
            theirs = row[who]
            if abs(field - theirs[0]) > theirs[1] or abs(sunlit - theirs[2]) > theirs[3]:
                raise referee.Failure(f"{said}; {who}: {theirs[0]} ({theirs[1]} in doubt), {theirs[2]} ({theirs[3]})")
        print(f"{said}: agrees with skyfield and astropy, {row['skyfield'][1]} and {row['skyfield'][3]} in doubt")
    if lit < 100:
        raise referee.Failure(f"only {lit} sunlit objects were compared")


if __name__ == "__main__":
    arguments = argparse.ArgumentParser()
    arguments.add_argument("dmise")
    arguments.add_argument("--json", action="store_true")
    arguments.add_argument("--counts", help="counts.csv of that catalogue and day, instead of running dmise visible")
    given = arguments.parse_args()
    referee.main(judge, given.dmise, given)
