"""Apparent places of random stars by astropy, for tests/sky. Usage: apparent_stars.py COUNT SEED

A line a star: TT Julian date in two parts; right ascension, declination [rad], proper motions [rad/yr],
parallax [rad], radial velocity [m/s] at J2000; the observer's geocentric position [m] and velocity [m/s];
then the direction at the observer in GCRS axes (no refraction). Half the observers stand on the ground,
half are in orbit.
About COUNT stars; the first are at the poles, on the 24 h line, near the Sun and Barnard's.
"""
import sys

import astropy.units as u
import numpy as np
from astropy.coordinates import GCRS, CartesianRepresentation, Distance, SkyCoord
from astropy.time import Time
from astropy.utils import iers

iers.conf.auto_download = False
iers.conf.iers_degraded_accuracy = "ignore"
MAS = np.pi / 180 / 3.6e6
count, seed = int(sys.argv[1]), int(sys.argv[2])
rng = np.random.default_rng(seed)

# Degrees, mas/yr, mas/yr, mas, km/s. Astropy takes a fast star without parallax to be near: none here.
special = np.array([
    (0.0, 90.0, 44.0, -12.0, 7.5, -16.0),
    (123.0, -90.0, 3000.0, 2000.0, 300.0, 30.0),
    (0.0, 0.0, 3000.0, 0.0, 30.0, 0.0),
    (359.9999999, 45.0, 500.0, -500.0, 50.0, 0.0),
    (269.452079, 4.693391, -798.58, 10328.12, 548.31, -110.51),  # Barnard's star
    (219.902066, -60.833976, -3679.25, 473.67, 754.81, -22.4),   # alpha Centauri A
    (302.0, -20.0, 0.0, 0.0, 0.0, 0.0),  # 2 deg from the Sun in late January
])


def random_stars(n):
    pm = rng.normal(0, 300, (2, n))
    return np.column_stack([rng.uniform(0, 360, n), np.degrees(np.arcsin(rng.uniform(-1, 1, n))), *pm,
                            0.01 * np.hypot(*pm) + rng.exponential(20, n), rng.normal(0, 50, n)])


def observer(in_orbit):
    axis, other = rng.normal(size=(2, 3))
    axis /= np.linalg.norm(axis)
    if not in_orbit:
        return 6.37e6 * axis, np.cross([0, 0, 7.292115e-5], 6.37e6 * axis)
    velocity = np.cross(axis, other)
    return 6.9e6 * axis, velocity * 7.6e3 / np.linalg.norm(velocity)


groups = 20  # each with an instant and an observer of its own
for group in range(groups):
    stars = special if group == 0 else random_stars((count - len(special)) // (groups - 1))
    day = 2458139 if group == 0 else int(rng.integers(2451545, 2466154))  # 2000 to 2040
    fraction = round(rng.uniform(0, 1), 9)
    position, velocity = observer(in_orbit=group % 2)
    time = Time(day, fraction, format="jd", scale="tt")
    ra, dec, pm_ra, pm_dec, parallax, rv = stars.T
    place = SkyCoord(ra=ra * u.deg, dec=dec * u.deg, pm_ra_cosdec=pm_ra * u.mas / u.yr,
                     pm_dec=pm_dec * u.mas / u.yr, radial_velocity=rv * u.km / u.s,
                     distance=Distance(parallax=np.maximum(parallax, 1e-6) * u.mas),
                     obstime=Time("J2000", scale="tt"))
    frame = GCRS(obstime=time, obsgeoloc=CartesianRepresentation(position * u.m),
                 obsgeovel=CartesianRepresentation(velocity * u.m / u.s))
    seen = place.apply_space_motion(new_obstime=time).transform_to(frame).cartesian.xyz.value
    seen = seen / np.linalg.norm(seen, axis=0)
    for star, direction in zip(stars, seen.T):
        row = [day, fraction, *np.radians(star[:2]), *(star[2:5] * MAS), star[5] * 1e3,
               *position, *velocity, *direction]
        print(", ".join(repr(float(v)) for v in row))
