"""Direction and range from a site to satellites by skyfield, for tests/frames/test_site_satellite.cpp.

Usage: site_satellite.py launch/catalogues/demo.tle. Each row: UTC, dUT1 [s], TEME position [m] as skyfield's SGP4 gives
it, then the geometric right ascension, declination [rad], range [m], azimuth and elevation [rad].
"""
import sys

from skyfield.api import EarthSatellite, load, wgs84

ts = load.timescale(builtin=True)
site = wgs84.latlon(33.777, -84.398, elevation_m=300.0)

with open(sys.argv[1]) as catalogue:
    lines = [line.rstrip() for line in catalogue if not line.startswith("#")]
elements = list(zip(lines[::3], lines[1::3], lines[2::3]))

count = 0
for name, one, two in elements[::80]:
    t = ts.utc(2018, 1, 21, 0, 7 * count, 12.5)
    satellite = EarthSatellite(one, two, name, ts)
    teme_km, _, error = satellite._position_and_velocity_TEME_km(t)
    if error:
        continue
    pair = (satellite - site).at(t)
    ra, dec, distance = pair.radec()
    elevation, azimuth, _ = pair.altaz()
    print("{" + f'"{t.utc_iso(places=3)}", {t.dut1:.9f}, {{'
          + ", ".join(f"{1e3 * x:.6f}" for x in teme_km)
          + f"}}, {ra.radians:.12f}, {dec.radians:.12f}, {distance.m:.4f}, {azimuth.radians:.12f}, "
          + f"{elevation.radians:.12f}" + "},")
    count += 1
