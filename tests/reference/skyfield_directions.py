"""The truth's directions and ranges of satellites from the ground are skyfield's.

    skyfield_directions.py RUN [--elements FILE] [--dut1-s SECONDS]

Every line of truth.jsonl of every sensor on the ground, at mid exposure: GCRS direction of the satellite
one light time ago from the site now, and its geometric range. skyfield runs SGP4 and the Earth's rotation
by itself; it is given the UT1 - UTC of the run (0 unless the scenario names an Earth orientation file).
Tolerance: 1 arcsec and 10 m.
"""

import argparse
import re

import numpy as np
from skyfield.api import Distance, EarthSatellite, load
from skyfield.toposlib import ITRSPosition

import referee

TOLERANCE_ARCSEC = 1.0
TOLERANCE_M = 10.0
LIGHT_M_PER_S = 299792458.0
TAI_MINUS_UTC_S = 37.0  # since 2017


def read_elements(path):
    """{catalogue number: (line 1, line 2)} of a TLE file; the newest of each."""
    newest = {}
    text = referee.need_file(path).read_text()
    for first, second in re.findall(r"^(1 .*)\n(2 .*)$", text, re.MULTILINE):
        year = int(first[18:20])
        epoch = (year + (1900 if year >= 57 else 2000), float(first[20:32]))
        number = int(first[2:7])
        if number not in newest or epoch > newest[number][0]:
            newest[number] = (epoch, (first, second))
    return {number: two_lines for number, (_, two_lines) in newest.items()}


def seen_from(site, satellite, t, timescale):
    """(direction, range [m]): astrometric unit vector and geometric distance in GCRS."""
    here = site.at(t).position.m
    range_m = np.linalg.norm(satellite.at(t).position.m - here)
    delay_s = range_m / LIGHT_M_PER_S
    for _ in range(3):
        there = satellite.at(timescale.tt_jd(t.whole, t.tt_fraction - delay_s / 86400)).position.m
        delay_s = np.linalg.norm(there - here) / LIGHT_M_PER_S
    return (there - here) / np.linalg.norm(there - here), range_m


def judge(run, elements_path, dut1_s):
    # A constant TT - UT1, as in the run; skyfield's own table would turn the site by up to 13 arcsec.
    timescale = load.timescale(delta_t=32.184 + TAI_MINUS_UTC_S - dut1_s)
    elements = read_elements(elements_path)
    satellites, worst, compared = {}, (0.0, 0.0), 0
    run = referee.need_file(run)
    for first in referee.first_frames(run):
        if "OBSGEO-X" not in first.header:
            continue
        site = ITRSPosition(Distance(m=[first.header[f"OBSGEO-{axis}"] for axis in "XYZ"]))
        times = {}
        for truth in referee.lines(run / first.path.parent.name / "truth.jsonl"):
            number, frame = truth["catalogue_number"], truth["frame"]
            if frame not in times:
                path = first.path.parent / f"frame-{frame:06d}.fits"
                middle = referee.read_frame(path).middle.utc.ymdhms
                times[frame] = timescale.utc(*(middle[k] for k in middle.dtype.names))
            if number not in satellites:
                referee.check_silently(number in elements, f"{number} is in {elements_path}")
                satellites[number] = EarthSatellite(*elements[number], ts=timescale)
            direction, range_m = seen_from(site, satellites[number], times[frame], timescale)
            ra, dec = np.radians([truth["true_ra_deg"], truth["true_dec_deg"]])
            ours = np.array([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])
            error_arcsec = np.degrees(np.arcsin(np.linalg.norm(np.cross(ours, direction)))) * 3600
            error_m = abs(truth["true_range_m"] - range_m)
            compared += 1
            worst = max(worst[0], error_arcsec), max(worst[1], error_m)
            what = f"{first.path.parent.name} frame {frame}, {number}"
            referee.check_silently(error_arcsec < TOLERANCE_ARCSEC,
                                   f"{what}: direction {error_arcsec:.3f} arcsec from skyfield's")
            referee.check_silently(error_m < TOLERANCE_M, f"{what}: range {error_m:.2f} m from skyfield's")
    referee.check(compared > 0, f"{compared} directions compared with skyfield")
    print(f"ok: worst {worst[0]:.4f} arcsec (< {TOLERANCE_ARCSEC}), {worst[1]:.3f} m (< {TOLERANCE_M})")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run")
    parser.add_argument("--elements", default=referee.CATALOGUES / "demo.tle")
    parser.add_argument("--dut1-s", type=float, default=0.0)
    options = parser.parse_args()
    referee.main(judge, options.run, options.elements, options.dut1_s)
