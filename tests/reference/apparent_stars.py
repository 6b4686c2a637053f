"""Apparent places of random stars by astropy, for tests/sky. Usage: apparent_stars.py COUNT SEED

A line a star: TT Julian date in two parts; right ascension, declination [rad], proper motions [rad/yr],
parallax [rad], radial velocity [m/s] at J2000; the observer's geocentric position [m] and velocity [m/s];
then the direction at the observer in GCRS axes (no refraction). Half the observers stand on the ground,
half are in orbit. The first stars are at the poles, on the 24 h line, near the Sun and Barnard's.
"""
import sys

import astropy.units as u
import numpy as np
from astropy.coordinates import GCRS, CartesianRepresentation, Distance, SkyCoord
from astropy.time import Time
from astropy.utils import iers

iers.conf.auto_download = False
iers.conf.iers_degraded_accuracy = "ignore"
count, seed = int(sys.argv[1]), int(sys.argv[2])
rng = np.random.default_rng(seed)

special = [  # degrees, mas/yr, mas/yr, mas, km/s
    (0.0, 90.0, 44.0, -12.0, 7.5, -16.0),
    (123.0, -90.0, 3000.0, 2000.0, 300.0, 30.0),
    (0.0, 0.0, 3000.0, 0.0, 0.0, 0.0),
    (359.9999999, 45.0, 500.0, -500.0, 50.0, 0.0),
    (269.452079, 4.693391, -798.58, 10328.12, 548.31, -110.51),  # Barnard's star
    (219.902066, -60.833976, -3679.25, 473.67, 754.81, -22.4),   # alpha Centauri A
    (302.0, -20.0, 0.0, 0.0, 0.0, 0.0),  # 2 deg from the Sun in late January
]

for i in range(count):
    if i < len(special):
        ra, dec, pm_ra, pm_dec, parallax, rv = special[i]
        day = 2458139 + i
    else:
        ra, dec = rng.uniform(0, 360), np.degrees(np.arcsin(rng.uniform(-1, 1)))
        pm_ra, pm_dec = rng.normal(0, 300, 2)
        parallax, rv = rng.exponential(20), rng.normal(0, 50)
        day = int(rng.integers(2451545, 2466154))  # 2000 to 2040
    fraction = round(rng.uniform(0, 1), 9)
    axis, other = rng.normal(size=(2, 3))
    axis /= np.linalg.norm(axis)
    if i % 2:  # in orbit
        position = 6.9e6 * axis
        velocity = np.cross(axis, other)
        velocity *= 7.6e3 / np.linalg.norm(velocity)
    else:
        position = 6.37e6 * axis
        velocity = np.cross([0, 0, 7.292115e-5], position)

    time = Time(day, fraction, format="jd", scale="tt")
    star = SkyCoord(ra=ra * u.deg, dec=dec * u.deg, pm_ra_cosdec=pm_ra * u.mas / u.yr,
                    pm_dec=pm_dec * u.mas / u.yr, radial_velocity=rv * u.km / u.s,
                    distance=Distance(parallax=max(parallax, 1e-6) * u.mas),
                    obstime=Time("J2000", scale="tt"))
    frame = GCRS(obstime=time, obsgeoloc=CartesianRepresentation(position * u.m),
                 obsgeovel=CartesianRepresentation(velocity * u.m / u.s))
    seen = star.apply_space_motion(new_obstime=time).transform_to(frame)
    direction = seen.cartesian.xyz.value
    direction = direction / np.linalg.norm(direction)
    mas = np.pi / 180 / 3.6e6
    row = [day, fraction, np.radians(ra), np.radians(dec), pm_ra * mas, pm_dec * mas, parallax * mas,
           rv * 1e3, *position, *velocity, *direction]
    print(", ".join(repr(float(v)) for v in row))
