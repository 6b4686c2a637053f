#!/usr/bin/env python3
"""SciPy's monotone interpolation and GalSim's optical point spreads, which tests/optics holds cameras against.

    field_optics.py            both, run now, give the tables of field_optics.inc
    field_optics.py --write    prints them

A table of aberrations by the distance from the axis is interpolated by scipy's PchipInterpolator and turned with the azimuth here,
in numpy; GalSim's OpticalPSF makes the image (pixels of lambda N, 61 x 61). Of each image: the centroid of the pixels, and
standard deviations along x and y and the covariance under a Gaussian window of 4 px. Without GalSim or SciPy it says so and exits
77, with DMISE_DATA set 1.
"""
import os
import pathlib
import re
import sys

try:
    import galsim
    import numpy as np
    from scipy.interpolate import PchipInterpolator
except ImportError:
    print("galsim or scipy is not there (./dmise setup --tests): the tables were not made again")
    sys.exit(1 if os.environ.get("DMISE_DATA") else 77)

TABLE = pathlib.Path(__file__).with_name("field_optics.inc")
LAMBDA_NM, F_NUMBER = 550.0, 5.0
SIDE = 61
ILLUMINATION = ([0, 4, 9, 15, 22, 30, 41], [1.0, 0.995, 0.96, 0.97, 0.8, 0.35, 0.1])
AT = np.linspace(0, 41, 83)
RADIUS_PX = [0, 35, 70]
TERMS_NM = {4: [-20, 10, 60], 6: [0, 30, 90], 8: [0, 40, 100], 11: [15, 15, 15]}
PLACES = [(0.0, 0.0), (35.0, 0.0), (50.0, 90.0), (70.0, 0.0), (70.0, 225.0)]  # px, deg
DEFOCUS_UM = [0.0, 40.0, 120.0]
UNIT = 1.0  # a pixel, lambda / D


def moments(aberrations):
    profile = galsim.OpticalPSF(lam_over_diam=UNIT, aberrations=aberrations, oversampling=2, pad_factor=2)
    image = profile.drawImage(nx=SIDE, ny=SIDE, scale=UNIT, dtype=float).array
    y, x = np.mgrid[:SIDE, :SIDE] - SIDE // 2
    mx, my = (image * x).sum() / image.sum(), (image * y).sum() / image.sum()
    seen = image * np.exp(-0.5 * (x**2 + y**2) / 16.0)
    total = seen.sum()
    cx, cy = (seen * x).sum() / total, (seen * y).sum() / total
    xx, yy = (seen * (x - cx) ** 2).sum() / total, (seen * (y - cy) ** 2).sum() / total
    xy = (seen * (x - cx) * (y - cy)).sum() / total
    return [mx, my, np.sqrt(xx), np.sqrt(yy), xy, image.max() / image.sum()]


def at_place(radius_px, azimuth_deg):
    aberrations = np.zeros(12)
    a = np.radians(azimuth_deg)
    for noll, nm in TERMS_NM.items():
        rms = float(PchipInterpolator(RADIUS_PX, nm)(radius_px)) / LAMBDA_NM
        frequency, other = {4: (0, 0), 11: (0, 0), 6: (2, 5), 8: (1, 7)}[noll]
        aberrations[noll] += rms * np.cos(frequency * a)
        if other:
            aberrations[other] += rms * np.sin(frequency * a)
    return list(aberrations)


def tables():
    yield "scipy_pchip", [float(v) for v in PchipInterpolator(*ILLUMINATION)(AT)]
    for i, place in enumerate(PLACES):
        yield f"galsim_place_{i}", moments(at_place(*place))
    for i, um in enumerate(DEFOCUS_UM):
        waves = um * 1000 / (16 * np.sqrt(3) * F_NUMBER**2) / LAMBDA_NM
        yield f"galsim_defocus_{i}", moments([0, 0, 0, 0, waves])


def main():
    if sys.argv[1:] == ["--write"]:
        print(f"// Made by tests/reference/field_optics.py --write with GalSim {galsim.__version__}.")
        for name, values in tables():
            print(f"constexpr double {name}[] = {{{', '.join(f'{v:.9e}' for v in values)}}};")
        return 0
    text = TABLE.read_text()
    for name, values in tables():
        table = [float(v) for v in re.search(name + r"\[\] = \{(.*?)\}", text, re.S)[1].split(",")]
        worst = max(abs(a - b) for a, b in zip(values, table, strict=True))
        print(f"{name}: run now and the table differ by {worst:.1e}")
        if worst > 1e-5:
            return 1
    return 0


sys.exit(main())
