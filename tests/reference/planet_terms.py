#!/usr/bin/env python3
"""Writes core/sky/bodies/planet_terms.inc: what is to be added to ERFA's eraPlan94 for the heliocentric places of the planets by JPL's
DE423 (Folkner 2010, IOM 343R-10-001; public domain), 1900 to 2100. planet_terms.py [--check]; it needs numpy, pyerfa and PyPI's
de423 2010.1 and jplephem 2.24, with which the project is neither built nor tested.

The differences are a sum of sinusoids, each with a vector for its cosine and one for its sine. Their frequencies are whole
multiples of one in 16 times the two centuries: they have no meaning of their own. The strongest of the spectrum of what is left is
taken next, and all vectors are solved for anew, until no direction seen from the Earth is off by more than MOST_ARCSEC."""
import pathlib
import sys
import warnings

import erfa
import numpy as np

import de423
from jplephem.ephem import Ephemeris

MOST_ARCSEC = 0.35
FIRST_JD, SPAN_DAYS, FINER = 2415020.5, 73049.0, 16  # 1900 to 2100
UNIT_AU = 1e-9
# Number of ERFA and days between the samples that are fitted.
PLANETS = {"mercury": (1, 7.0), "venus": (2, 10.0), "mars": (4, 14.0), "jupiter": (5, 40.0), "saturn": (6, 50.0),
           "uranus": (7, 80.0), "neptune": (8, 100.0)}
TARGET = pathlib.Path(__file__).resolve().parents[2] / "core/sky/bodies/planet_terms.inc"

ephemeris = Ephemeris(de423)
warnings.simplefilter("ignore", erfa.ErfaWarning)


def differences_au(name, jd):
    """DE423 less eraPlan94, and distances from the Earth."""
    heliocentric, barycentric = erfa.epv00(jd, 0.0)
    earth, sun = barycentric["p"], barycentric["p"] - heliocentric["p"]
    at = np.concatenate([ephemeris.position(name, jd[i:i + 4096]).T for i in range(0, len(jd), 4096)]) / ephemeris.AU
    return at - sun - erfa.plan94(jd, 0.0, PLANETS[name][0])["p"], np.linalg.norm(at - earth, axis=1)


def phases_rad(numbers, jd):
    return 2.0 * np.pi * np.outer((jd - FIRST_JD) / (FINER * SPAN_DAYS), numbers)


def fitted(name):
    count = int(SPAN_DAYS / PLANETS[name][1])
    jd = FIRST_JD + SPAN_DAYS * np.arange(count) / count
    difference, distance = differences_au(name, jd)
    weight = 1.0 / distance
    numbers = []
    left = difference
    while True:
        power = (np.abs(np.fft.rfft(left * weight[:, None]**2, FINER * count, axis=0))**2).sum(axis=1)
        for j in numbers:
            power[max(0, j - 3):j + 4] = 0.0
        for _ in range(1 + len(numbers) // 8):
            j = int(np.argmax(power))
            numbers.append(j)
            power[max(0, j - FINER):j + FINER + 1] = 0.0
        phases = phases_rad(numbers, jd)
        columns = np.hstack([np.cos(phases), np.sin(phases)])
        weighted = columns * weight[:, None]
        normal = weighted.T @ weighted + 1e-9 * count * np.eye(2 * len(numbers))
        vectors = np.linalg.solve(normal, weighted.T @ (difference * weight[:, None]))
        left = difference - columns @ vectors
        if np.degrees((np.linalg.norm(left, axis=1) / distance).max()) * 3600.0 < MOST_ARCSEC:
            break
    cosine, sine = np.rint(vectors / UNIT_AU).astype(int).reshape(2, -1, 3)
    return sorted(zip(numbers, cosine.tolist(), sine.tolist()))


def checked(name, rows):
    """The largest error of a direction from the Earth [arcsec], at other times than those of the fit."""
    jd = np.sort(np.random.default_rng(7).uniform(FIRST_JD, FIRST_JD + SPAN_DAYS, 100_000))
    difference, distance = differences_au(name, jd)
    phases = phases_rad([row[0] for row in rows], jd)
    sum_au = UNIT_AU * (np.cos(phases) @ np.array([row[1] for row in rows]) + np.sin(phases) @ np.array([row[2] for row in rows]))
    return np.degrees((np.linalg.norm(difference - sum_au, axis=1) / distance).max()) * 3600.0


def main():
    text = "// Made by tests/reference/planet_terms.py. {frequency, cosine x, y, z, sine x, y, z [1e-9 au]}\n"
    for name in PLANETS:
        rows = fitted(name)
        print(f"{name}: {len(rows)} terms, within {checked(name, rows):.2f} arcsec", file=sys.stderr)
        text += f"constexpr Term {name}_terms[] = {{\n"
        for number, cosine, sine in rows:
            text += "{%d, {%d, %d, %d}, {%d, %d, %d}},\n" % (number, *cosine, *sine)
        text += "};\n"
    if "--check" in sys.argv[1:]:
        sys.exit(text != TARGET.read_text())
    TARGET.write_text(text)


if __name__ == "__main__":
    main()
