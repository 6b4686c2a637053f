#!/usr/bin/env python3
"""Prints tests/sky/planets_reference.inc: apparent places and magnitudes of the planets by skyfield with JPL's DE421, as PyPI's
skyfield-data has it: planets_with_skyfield.py DE421.BSP. Times are TT, from 1950 to 2053, where DE421 ends; geocentric directions in
GCRS axes with light time, deflection by the Sun and aberration, both by ERFA; V for an observer in the Earth's centre."""
import sys
from types import SimpleNamespace as Namespace

import erfa
import numpy as np
from skyfield.api import load, load_file
from skyfield.magnitudelib import planetary_magnitude

NAMES = ["mercury", "venus", "mars", "jupiter barycenter", "saturn barycenter", "uranus barycenter", "neptune barycenter"]
C_AU_PER_DAY = 86400.0 / erfa.AULT


def seen(planet_au, bodies):
    """The proper direction of a planet for an observer in the Earth's centre, by ERFA."""
    sun_au, earth_au, velocity_au_per_day, line_au = bodies
    from_sun = earth_au - sun_au
    distance = np.linalg.norm(from_sun)
    direction = line_au / np.linalg.norm(line_au)
    q = planet_au - sun_au
    bent = erfa.ld(1.0, direction, q / np.linalg.norm(q), from_sun / distance, distance, 1e-6)
    velocity = velocity_au_per_day / C_AU_PER_DAY
    return erfa.ab(bent, velocity, distance, np.sqrt(1.0 - velocity @ velocity))


def main():
    timescale = load.timescale(builtin=True)
    bodies = load_file(sys.argv[1])
    earth, sun = bodies["earth"], bodies["sun"]
    print("// Made by tests/reference/planets_with_skyfield.py. {planet, TT [JD], direction x, y, z, V}")
    rng = np.random.default_rng(3)
    for i, name in enumerate(NAMES):
        for jd in np.sort(rng.uniform(2433282.5, 2471100.0, 12)).round(3):
            t = timescale.tt_jd(jd)
            observed = earth.at(t).observe(bodies[name])
            line = observed.xyz.au
            at = earth.at(t)
            x = seen(at.xyz.au + line, (sun.at(t).xyz.au, at.xyz.au, at.velocity.au_per_d, line))
            # skyfield takes the barycentre for the Sun: 0.02 mag of Mercury and Venus. Here it gets the Sun's place.
            centre = Namespace(xyz=Namespace(au=at.xyz.au - sun.at(t).xyz.au))
            v_mag = planetary_magnitude(Namespace(target=observed.target, t=t, xyz=observed.xyz, center_barycentric=centre))
            print("{%d, %.3f, {%.9f, %.9f, %.9f}, %.3f}," % (i, jd, *x, v_mag))


if __name__ == "__main__":
    main()
