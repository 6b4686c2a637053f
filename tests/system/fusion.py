"""Two sensors see one object that is in no catalogue: the fusion node finds it, the same for `run` and `launch`.

    fusion.py DMISE
"""

import json
import math
import re
import subprocess

import sgp4.omm
from astropy import units
from astropy.coordinates import GCRS, TEME, CartesianRepresentation
from astropy.time import Time
from astropy.utils import iers
from sgp4.api import Satrec

from harness import check, main, truth_at

SCENARIO = """\
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 100, tick_s: 5, seed: 1}
objects: [{catalogue: newcomer.tle, radius_m: 4}]
stars: {catalogue: kstars}
fusion: {not_in_catalogue: [NEWCOMER]}
sensors:
"""
# 900 km above the two sites after a minute.
ELEMENTS = ("1 99999U 18001A   18021.01041667  .00000000  00000-0  00000-0 0  999",
            "2 99999  66.0000  22.9510 0000001   0.0000  33.5590 13.9820000000001")
SENSOR = """\
  - name: {name}
    site: {name}
    camera: omnissa
    pointing: zenith
    exposure_s: 1
    cadence_s: 10
    sky: dark
"""


def lines_of(file):
    return [json.loads(line) for line in file.read_text().splitlines()]


def with_checksum(line):
    return line + str(sum(int(c) if c.isdigit() else c == "-" for c in line) % 10)


def judge_elements(file, track):
    """Python's SGP4 and astropy's TEME put the elements where the track is, as near as the message says."""
    with open(file, encoding="utf-8") as text:
        fields = list(sgp4.omm.parse_xml(text))
    check(len(fields) == 1, "an OMM for each track")
    worst_m = float(re.search(r"at worst (\d+) m", file.read_text())[1])
    satellite = Satrec()
    sgp4.omm.initialize(satellite, fields[0])
    code, place_km, _ = satellite.sgp4(satellite.jdsatepoch, satellite.jdsatepochF)
    with iers.conf.set_temp("auto_download", False):
        time = Time(satellite.jdsatepoch, satellite.jdsatepochF, format="jd", scale="utc")
        gcrs = TEME(CartesianRepresentation(place_km * units.km), obstime=time).transform_to(GCRS(obstime=time))
    off_m = math.dist(gcrs.cartesian.xyz.to_value(units.m), track["position_gcrs_m"])
    check(code == 0 and off_m < 1.5 * worst_m + 50 and worst_m < 2000, f"SGP4 has the track {off_m:.0f} m off, {worst_m:.0f} m said")


def test(binary, work):
    def dmise(*arguments):
        done = subprocess.run([binary, *arguments], capture_output=True, text=True)
        check(done.returncode == 0, f"{arguments[0]} exits with 0: {done.stderr[-300:]}")

    scenario = work / "two.yaml"
    (work / "newcomer.tle").write_text("\n".join(["NEWCOMER", *map(with_checksum, ELEMENTS)]) + "\n")
    scenario.write_text(SCENARIO + "".join(SENSOR.format(name=name) for name in ("atlanta", "huntsville")))
    dmise("run", scenario, "--out", work / "run")
    dmise("launch", scenario, "--out", work / "launch")
    for name in ("tracks.jsonl", "detections.jsonl"):
        check((work / "run" / name).read_bytes() == (work / "launch" / name).read_bytes(), f"{name}: the same of run and launch")

    tracks = lines_of(work / "run" / "tracks.jsonl")
    confirmed = [t for t in tracks if t["status"] == "confirmed"]
    check(len({t["id"] for t in confirmed}) == 1, "one track is confirmed")
    last = confirmed[-1]
    check(last["catalogue_number"] == 0 and last["detections"] >= 8, "it is in no catalogue and has detections of both")
    check({i.split("/")[0] for t in confirmed for i in t["associated"]} == {"atlanta", "huntsville"}, "of both sites")

    truth = truth_at(last["time_ns"], lines_of(work / "run" / "truth.jsonl"))
    error = math.dist(truth, last["position_gcrs_m"])
    sigma = math.sqrt(sum(last["covariance_gcrs"][k] for k in (0, 2, 5)))
    check(error < 5 * sigma and error < 5000, f"its place: {error:.0f} m of {sigma:.0f} m")

    dmise("export", work / "run", "--to", "oem", "--tracks")
    check("COVARIANCE_START" in (work / "run" / "export" / "tracks.oem").read_text(), "an OEM with covariances")
    dmise("export", work / "run", "--to", "tdm", "--tracks")
    tdm = (work / "run" / "export" / "tracks.tdm").read_text()
    taken = [d for t in tracks if t["id"] == last["id"] for d in t["associated"]]
    check(tdm.count(f"TRACK_ID = TRACK {last['id']}\n") == tdm.count("META_START") == len(taken)
          and all(f"COMMENT detection {d}\n" in tdm for d in taken), f"a TDM of the {len(taken)} detections that it took")
    dmise("export", work / "run", "--to", "omm", "--tracks")
    judge_elements(work / "run" / "export" / "tracks.omm.xml", last)


main(test)
