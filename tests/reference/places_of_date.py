"""Apparent places of the true equator and equinox of date, geocentric, by astropy's TETE: for Observatory.PlacesOfDateAreAstropys."""

import astropy.utils.iers
from astropy.coordinates import TETE, SkyCoord
from astropy.time import Time

astropy.utils.iers.conf.auto_download = False
when = TETE(obstime=Time("2018-01-21T00:30:00", scale="utc"))
for ra_deg, dec_deg in ((69.0, 16.5), (359.999, -60.0), (10.0, 89.9)):
    place = SkyCoord(ra_deg, dec_deg, unit="deg").transform_to(when)
    print(f"{{{{{ra_deg}, {dec_deg}}}, {{{place.ra.deg:.10f}, {place.dec.deg:.10f}}}}},")
