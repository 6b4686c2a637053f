#!/usr/bin/env python3
"""What tests/observatory/test_scenario_sky.cpp compares with: where ERFA sees stars over Huntsville, and its sidereal time.

UT1 is UTC and there is no polar motion, as in a scenario without a file of the Earth's orientation.
"""
import erfa

SITE = (-86.640 * erfa.DD2R, 34.725 * erfa.DD2R, 200.0)


def main():
    for second in (0, 14400):
        utc = erfa.dtf2d("UTC", 2018, 1, 21, 0, 30, 0.0)
        utc1, utc2 = utc[0], utc[1] + second / 86400
        tt = erfa.taitt(*erfa.utctai(utc1, utc2))
        last = erfa.anp(erfa.gst06a(utc1, utc2, *tt) + SITE[0])
        print(f"{second} s: LAST {last:.12f} rad")
        for ra, dec in ((80.0, 20.0), (130.0, -5.0), (37.95456067, 89.26410897)):
            for pressure in (0.0, 989.0):
                azimuth, zenith, *_ = erfa.atco13(ra * erfa.DD2R, dec * erfa.DD2R, 0, 0, 0, 0, utc1, utc2, 0.0, *SITE, 0, 0,
                                                  pressure, 13.7, 0.5, 0.55)
                print(f"  {ra} {dec}, {pressure} hPa: azimuth {azimuth:.10f}, elevation {erfa.DPI / 2 - zenith:.10f} rad")


main()
