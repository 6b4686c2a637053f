"""Prints how far the times of an OEM in TDB are from TAI, by astropy: the values of `Oem.TdbDiffers..` in tests/orbit."""

from astropy.time import Time

for text in ("2026-01-01T00:00:00", "2026-04-01T00:00:00"):
    tdb = Time(text, scale="tdb")
    print(text, f"{(tdb.tai - Time(text, scale='tai')).sec:.7f} s")
