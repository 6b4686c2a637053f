"""UT1 - UTC and polar motion by astropy, for tests/time. Usage: earth_rotation.py finals2000A.all[.gz]

Prints seconds and arcseconds at 2016-12-31T18:00 and 2017-01-01T06:00 UTC, around a leap second.
"""
import gzip
import shutil
import sys
import tempfile

from astropy.time import Time
from astropy.utils import iers

with tempfile.NamedTemporaryFile(suffix=".all") as plain:
    with (gzip.open if sys.argv[1].endswith(".gz") else open)(sys.argv[1], "rb") as packed:
        shutil.copyfileobj(packed, plain)
    plain.flush()
    table = iers.IERS_A.open(plain.name)

for utc in ("2016-12-31T18:00:00", "2017-01-01T06:00:00"):
    time = Time(utc, scale="utc")
    x, y = table.pm_xy(time)
    print(utc, f"{table.ut1_utc(time).value:.9f}", f"{x.value:.9f}", f"{y.value:.9f}")
