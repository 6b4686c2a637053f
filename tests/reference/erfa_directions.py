"""The truth's apparent directions of satellites, from the ground and from orbit, are ERFA's.

    erfa_directions.py RUN [--elements FILE] [--platform SENSOR=NUMBER]..

Every line of truth.jsonl of every sensor, at mid exposure: SGP4 of Debian's python3-sgp4, TEME to GCRS by
way of ITRS (GMST-82; IAU 2006/2000A), light time iterated on the propagated orbit, aberration by eraAb with
the observer's geocentric velocity. UT1 is UTC and the pole lies at 0, as in a run without an Earth
orientation file. A sensor on the ground stands where launch/sites says, one in orbit is the object that
--platform names. Tolerance: 5 mas and 10 mm.
"""

import argparse
import re

import erfa
import numpy as np
from sgp4.api import WGS72, Satrec

import referee
from skyfield_directions import read_elements

TOLERANCE_MAS = 5.0
TOLERANCE_M = 0.01
LIGHT_M_PER_S = 299792458.0
DAY_S = 86400.0
HALF_STEP_S = 0.5  # half the step of the differences that give velocities


class Instant:
    """UTC of a truth's line plus some seconds, and the Earth's orientation then."""

    def __init__(self, utc, seconds=0.0):
        date, time = utc.rstrip("Z").split("T")
        hour, minute, second = time.split(":")
        self.utc = erfa.dtf2d("UTC", *map(int, date.split("-")), int(hour), int(minute), float(second))
        self.utc = self.utc[0], self.utc[1] + seconds / DAY_S
        tt = erfa.taitt(*erfa.utctai(*self.utc))
        ut1 = erfa.utcut1(*self.utc, 0.0)
        self.itrs_from_gcrs = erfa.c2t06a(*tt, *ut1, 0.0, 0.0)
        turn = erfa.rz(erfa.gmst82(*ut1), np.eye(3))
        self.gcrs_from_teme = self.itrs_from_gcrs.T @ erfa.pom00(0.0, 0.0, erfa.sp00(*tt)) @ turn


class Satellite:
    def __init__(self, two_lines):
        self.record = Satrec.twoline2rv(*two_lines, WGS72)

    def at(self, instant):
        code, position_km, _ = self.record.sgp4(*instant.utc)
        referee.check_silently(code == 0, f"SGP4 has a state, code {code}")
        return instant.gcrs_from_teme @ np.array(position_km) * 1e3


class Site:
    def __init__(self, path):
        text = referee.need_file(path).read_text()
        value = {key: float(number) for key, number in re.findall(r"(\w+_deg|height_m): *(-?[0-9.]+)", text)}
        self.itrs_m = erfa.gd2gc(1, np.radians(value["longitude_deg"]), np.radians(value["latitude_deg"]),
                                 value["height_m"])

    def at(self, instant):
        return instant.itrs_from_gcrs.T @ self.itrs_m


def apparent(satellite, observer, utc):
    """(unit vector, geometric range [m]) in GCRS."""
    here = observer.at(Instant(utc))
    velocity = (observer.at(Instant(utc, HALF_STEP_S)) - observer.at(Instant(utc, -HALF_STEP_S))) / (2 * HALF_STEP_S)
    line = satellite.at(Instant(utc)) - here
    range_m = np.linalg.norm(line)
    for _ in range(3):
        line = satellite.at(Instant(utc, -np.linalg.norm(line) / LIGHT_M_PER_S)) - here
    beta = velocity / LIGHT_M_PER_S
    return erfa.ab(line / np.linalg.norm(line), beta, 1.0, np.sqrt(1 - beta @ beta)), range_m


def judge(run, elements_path, platforms):
    elements = read_elements(elements_path)
    for first in referee.first_frames(referee.need_file(run)):
        sensor = first.path.parent.name
        if sensor in platforms:
            observer = Satellite(elements[platforms[sensor]])
        else:
            observer = Site(referee.SOURCE / f"launch/sites/{sensor}.yaml")
        worst_mas = worst_m = compared = 0
        for truth in referee.lines(first.path.parent / "truth.jsonl"):
            satellite = Satellite(elements[truth["catalogue_number"]])
            direction, range_m = apparent(satellite, observer, truth["middle_utc"])
            ra, dec = np.radians([truth["apparent_ra_deg"], truth["apparent_dec_deg"]])
            ours = np.array([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])
            error_mas = np.degrees(np.linalg.norm(np.cross(ours, direction))) * 3.6e6
            error_m = abs(truth["true_range_m"] - range_m)
            compared += 1
            worst_mas, worst_m = max(worst_mas, error_mas), max(worst_m, error_m)
            what = f"{sensor} frame {truth['frame']}, {truth['catalogue_number']}"
            referee.check_silently(error_mas < TOLERANCE_MAS, f"{what}: direction {error_mas:.2f} mas from ERFA's")
            referee.check_silently(error_m < TOLERANCE_M, f"{what}: range {error_m * 1e3:.2f} mm from ERFA's")
        referee.check(compared > 0, f"{sensor}: {compared} directions, worst {worst_mas:.3f} mas "
                                    f"(< {TOLERANCE_MAS}), ranges {worst_m * 1e3:.2f} mm (< {TOLERANCE_M * 1e3})")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run")
    parser.add_argument("--elements", default=referee.CATALOGUES / "demo.tle")
    parser.add_argument("--platform", action="append", default=[])
    options = parser.parse_args()
    named = (each.split("=") for each in options.platform)
    referee.main(judge, options.run, options.elements, {sensor: int(number) for sensor, number in named})
