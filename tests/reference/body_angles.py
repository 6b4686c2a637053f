#!/usr/bin/env python3
"""Where astropy sees Sun and Moon, in GCRS axes and with the observer's aberration, from a site
and from a place that stands still in space, with the altitudes at the site: the rows of tests/pipeline/test_exclusion.cpp."""
import astropy.units as u
from astropy.coordinates import (GCRS, AltAz, CartesianRepresentation, EarthLocation, get_body,
                                 solar_system_ephemeris)
from astropy.time import Time
from astropy.utils import iers

iers.conf.auto_download = False

SITE = EarthLocation.from_geodetic(-86.58 * u.deg, 34.73 * u.deg, 190 * u.m)
IN_SPACE_M = [42e6, 1e6, 2e6]
# The exposures of 10 ms begin at the epochs.
EPOCHS = ["2018-01-02T06:00:00", "2018-04-11T15:00:00", "2018-07-19T18:30:00", "2018-10-30T12:00:00"]


def direction(body, time, place):
    if place == "site":
        seen = get_body(body, time, SITE, ephemeris="builtin")
    else:
        here = CartesianRepresentation(*IN_SPACE_M, unit=u.m)
        still = CartesianRepresentation(0, 0, 0, unit=u.m / u.s)
        frame = GCRS(obstime=time, obsgeoloc=here, obsgeovel=still)
        with solar_system_ephemeris.set("builtin"):
            geocentric = get_body(body, time, ephemeris="builtin")
            seen = geocentric.transform_to(frame)
    altitude = seen.transform_to(AltAz(obstime=time, location=SITE)).alt.deg if place == "site" else 90
    return seen.ra.deg, seen.dec.deg, altitude


for epoch in EPOCHS:
    time = Time(epoch, scale="utc") + 0.005 * u.s
    for place in ("site", "space"):
        row = [f"{value:.7f}" for body in ("sun", "moon") for value in direction(body, time, place)]
        print(f'{{"{epoch}Z", {str(place == "site").lower()}, {", ".join(row)}}},')
