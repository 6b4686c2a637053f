"""Magnitudes of variable stars over time, for tests/sky/test_variable_stars.cpp.

    variable_stars.py            heliocentric dates and V of the stars of tests/sky/gcvs_rows.h
    variable_stars.py --phoebe   light curves of eclipsing binaries by PHOEBE (PyPI: phoebe 2.5.4)

Elements: General Catalogue of Variable Stars, version 5.1. Dates by astropy (its built-in ephemeris of Sun and Earth). Curves by their published
forms: arXiv:2606.29543 (delta Cephei), Stringer et al. 2019, AJ 158, 16 (RRab, the means in g and r at 100 phases, as harmonics),
Andronov 2012, Astrophysics 55, 536 (eclipses).
"""

import sys

import numpy as np

# Place [deg], type, V at maximum and at both minima, epoch (JD - 2400000), period [d], share of the rise or of an eclipse.
STARS = {
    "bet Per": ("03h08m10.13s +40d57m20.2s", "EA", 2.12, 3.39, 2.12, 45641.5135, 2.8673043, 0.14),
    "W UMa": ("09h43m45.48s +55d57m09.0s", "EW", 7.75, 8.48, 8.43, 45765.7385, 0.33363749, None),
    "bet Lyr": ("18h50m04.80s +33d21m45.7s", "EB", 3.25, 4.36, 3.85, 8247.950, 12.913834, None),
    "del Cep": ("22h29m10.27s +58d24m54.7s", "DCEP", 3.48, 4.37, None, 55479.905, 5.366208, 0.25),
    "RR Lyr": ("19h25m27.91s +42d47m03.8s", "RRAB", 7.06, 8.12, None, 42923.4193, 0.56686776, 0.19),
    "ST CVn": ("13h57m34.06s +29d51m28.8s", "even", 11.04, 11.60, None, 51334.7466, 0.3290568, 0.43),
    "omi Cet": ("02h19m20.78s -02d58m39.4s", "even", 2.0, 10.1, None, 44839.0, 331.96, 0.38),
    "T Cen": ("13h41m45.55s -33d35m50.6s", "even", 5.5, 9.0, None, 48575.3, 90.43, 0.47),
}
TIMES = ["2018-01-21T03:00:30", "2018-04-02T09:17:00", "2018-08-15T21:44:10", "2018-11-30T16:05:00"]
SERIES = {
    "DCEP": ([0.3434, 0.1428, 0.0531], [0.0, 4.36, 2.50]),
    "RRAB": ([0.3246, 0.1428, 0.0960, 0.0568, 0.0323, 0.0184, 0.0111, 0.0064], [2.478, 2.598, 3.003, 3.505, 3.991, 4.523, 5.039, 5.332]),
}


def pulsation(kind):
    """Phases from maximum [0, 1) and how faint, 0 to 1, on a fine grid, with the share of the rise."""
    x = np.arange(200000) / 200000
    if kind == "even":
        return x, 0.5 - 0.5 * np.cos(2 * np.pi * x), 0.5
    m = sum(a * np.cos(2 * np.pi * (k + 1) * x + p) for k, (a, p) in enumerate(zip(*SERIES[kind])))
    m = np.roll(m, -np.argmin(m))
    return x, (m - m.min()) / np.ptp(m), 1 - x[np.argmax(m)]


def eclipse(z):
    return (1 - np.minimum(np.abs(z), 1) ** 1.2) ** 1.5


def fainter(kind, phase, first, second, share):
    if kind == "EA":
        return first * eclipse(min(phase, 1 - phase) / (share / 2)) + second * eclipse((phase - 0.5) / (share / 2))
    if kind in ("EB", "EW"):
        forms = min(first, second) / 2
        return (forms * (1 + np.cos(4 * np.pi * phase)) / 2 + (first - forms) * eclipse(min(phase, 1 - phase) / 0.11) +
                (second - forms) * eclipse((phase - 0.5) / 0.11))
    x, m, rise = pulsation(kind)
    moved = np.where(x <= 1 - rise, x * (1 - share) / (1 - rise), 1 - (1 - x) * share / rise)
    return first * np.interp(phase, moved, m)


def table():
    import astropy.units as u
    from astropy.coordinates import EarthLocation, SkyCoord
    from astropy.time import Time
    from astropy.utils import iers

    iers.conf.auto_download, iers.conf.iers_degraded_accuracy = False, "warn"
    centre = EarthLocation.from_geocentric(0, 0, 0, unit=u.m)
    for name, (place, kind, brightest, minimum, second, epoch, period, share) in STARS.items():
        for text in TIMES:
            time = Time(text)
            to_sun = time.light_travel_time(SkyCoord(place), "heliocentric", location=centre, ephemeris="builtin")
            hjd = time.utc.jd + to_sun.to_value(u.d)
            phase = (hjd - 2400000 - epoch) / period % 1
            v = brightest + fainter(kind, phase, minimum - brightest, (second or brightest) - brightest, share)
            print(f'{{"{name}", "{text}Z", {hjd:.6f}, {v:.4f}}},')


def phoebe_curves():
    import os

    os.environ["PHOEBE_ENABLE_ONLINE_PASSBANDS"] = "FALSE"
    import phoebe

    phoebe.logger("CRITICAL")

    def magnitudes(binary):
        binary.add_dataset("lc", compute_phases=np.linspace(0, 0.5, 26), passband="Johnson:V")
        for star in ("primary", "secondary"):
            for key, value in (("atm", "blackbody"), ("ld_mode", "manual"), ("ld_func", "linear"), ("ld_coeffs", [0.6])):
                binary.set_value(key, component=star, value=value)
        binary.set_value_all("ntriangles", 2500)
        binary.run_compute(irrad_method="none", progressbar=False)
        flux = binary.get_value("fluxes@model")
        return -2.5 * np.log10(flux / flux.max())

    def contact(inclination, hotter, cooler):
        binary = phoebe.default_binary(contact_binary=True)
        binary.set_value("q", value=0.5)
        binary.set_value("incl", component="binary", value=inclination)
        binary.set_value("teff", component="primary", value=hotter)
        binary.set_value("teff", component="secondary", value=cooler)
        return binary

    def semi_detached(q, inclination, hotter, cooler, radius):
        binary = phoebe.default_binary()
        binary.set_value("q", value=q)
        binary.set_value("sma", component="binary", value=10.0)
        binary.set_value("incl", component="binary", value=inclination)
        binary.set_value("period", component="binary", value=2.0)
        binary.set_value("teff", component="primary", value=hotter)
        binary.set_value("teff", component="secondary", value=cooler)
        binary.add_constraint("semidetached", "secondary")
        binary.set_value("requiv", component="primary", value=10.0 * radius)
        for star, kelvin in (("primary", hotter), ("secondary", cooler)):
            binary.set_value("gravb_bol", component=star, value=0.9 if kelvin > 8000 else 0.32)
        return binary

    for name, binary in {
        "contact, 85 deg": contact(85, 6300, 6200),
        "contact, 66 deg": contact(66, 6000, 5800),
        "semi-detached, hot": semi_detached(0.6, 80, 12000, 8500, 0.36),
        "semi-detached": semi_detached(0.4, 76, 9000, 5500, 0.33),
        "Algol": semi_detached(0.217, 81.4, 12550, 4900, 0.2047),  # Baron et al. 2012, ApJ 752, 20
    }.items():
        print(name, ", ".join(f"{m:.3f}" for m in magnitudes(binary)))


if __name__ == "__main__":
    phoebe_curves() if "--phoebe" in sys.argv[1:] else table()
