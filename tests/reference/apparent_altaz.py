"""Azimuth and elevation of stars from a site by astropy, for tests/sky/test_apparent_stars.cpp.

A line a star: UTC, UT1 - UTC [s], polar motion [arcsec], right ascension, declination [deg], then azimuth and
elevation [deg] without air and with it (800 hPa, 5 C, humidity 0.3, 0.7 um). Usage: apparent_altaz.py [COUNT SEED]:
twelve chosen stars, or COUNT random ones above 20 deg, the pole among them, without C++'s braces.
"""
import sys

import astropy.units as u
import numpy as np
from astropy.coordinates import AltAz, EarthLocation, SkyCoord
from astropy.time import Time
from astropy.utils import iers

iers.conf.auto_download = False
table = iers.IERS_B.open()
iers.earth_orientation_table.set(table)
site = EarthLocation.from_geodetic(lon=-84.398 * u.deg, lat=33.777 * u.deg, height=300 * u.m)

AIR = dict(pressure=800 * u.hPa, temperature=5 * u.deg_C, relative_humidity=0.3, obswl=0.7 * u.micron)


def random_stars(count, seed):
    rng = np.random.default_rng(seed)
    left, i = count, 0
    while left > 0:
        time = Time("2010-01-20T23:40:00", scale="utc") + i * 173.39 * u.day
        i += 1
        x, y = table.pm_xy(time)
        ra, dec = rng.uniform(0, 360, 200), np.degrees(np.arcsin(rng.uniform(-0.5, 1, 200)))
        dec[0] = 90.0
        stars = SkyCoord(ra=ra * u.deg, dec=dec * u.deg)
        plain = stars.transform_to(AltAz(obstime=time, location=site))
        air = stars.transform_to(AltAz(obstime=time, location=site, **AIR))
        for k in np.flatnonzero(air.alt.deg > 20)[:left]:
            left -= 1
            print(time.utc.isot, *(f"{v:.12f}" for v in (
                time.delta_ut1_utc, x.to_value(u.arcsec), y.to_value(u.arcsec), ra[k], dec[k], plain[k].az.deg,
                plain[k].alt.deg, air[k].az.deg, air[k].alt.deg)))


if len(sys.argv) > 2:
    random_stars(int(sys.argv[1]), int(sys.argv[2]))
    sys.exit()

for i in range(12):
    time = Time("2018-01-20T23:40:00", scale="utc") + i * 17.3 * u.day / 24
    x, y = table.pm_xy(time)
    sidereal = time.sidereal_time("mean", longitude=site.lon).deg
    ra, dec = (sidereal - 60 + 11 * i) % 360, -35 + 11 * i
    star = SkyCoord(ra=ra * u.deg, dec=dec * u.deg)
    plain = star.transform_to(AltAz(obstime=time, location=site))
    air = star.transform_to(AltAz(obstime=time, location=site, **AIR))
    print(f'{{"{time.utc.isot}", {time.delta_ut1_utc:.9f}, {x.to_value(u.arcsec):.9f}, '
          f"{y.to_value(u.arcsec):.9f}, {ra:.12f}, {dec}, {plain.az.deg:.12f}, {plain.alt.deg:.12f}, "
          f"{air.az.deg:.12f}, {air.alt.deg:.12f}}},")
