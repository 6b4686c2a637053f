#!/usr/bin/env python3
"""GalSim's image of a point at a finite range, which tests/optics holds objects out of focus against.

    range_defocus.py            run now, gives the tables of range_defocus.inc
    range_defocus.py --write    prints them

A telescope of 3 m that is focused at infinity sees a point at a range R with a wavefront of D^2 / (8 R) at its edge. OpticalPSF
at 550 nm, clear and with an obscuration of 0.4, on pixels of lambda / (2 D): 65 of them are the disc D / R of 500 km. Each table has
the pixels of the row through the middle, from the middle to the right, then the share of the light within 10, 20, 30 and 40 px of
it (pixels by their middles); all in units of the whole light. Without GalSim it says so and exits 77, with DMISE_DATA set 1.
"""
import os
import pathlib
import re
import sys

try:
    import galsim
    import numpy as np
except ImportError:
    print("galsim is not there (./dmise setup --tests): the tables were not made again")
    sys.exit(1 if os.environ.get("DMISE_DATA") else 77)

TABLE = pathlib.Path(__file__).with_name("range_defocus.inc")
LAMBDA_M, APERTURE_M, SIDE = 550e-9, 3.0, 121
RANGES_KM, OBSCURATIONS, RADII_PX = [500, 1000, 2000], [0.0, 0.4], [10, 20, 30, 40]


def table(range_km, obscuration):
    edge_waves = APERTURE_M**2 / (8 * range_km * 1e3) / LAMBDA_M
    psf = galsim.OpticalPSF(lam_over_diam=2.0, defocus=edge_waves / (2 * np.sqrt(3)), obscuration=obscuration,
                            oversampling=2, pad_factor=4)
    image = psf.drawImage(nx=SIDE, ny=SIDE, scale=1.0, dtype=float).array
    y, x = np.mgrid[:SIDE, :SIDE] - SIDE // 2
    within = [image[np.hypot(x, y) <= r].sum() for r in RADII_PX]
    return list(image[SIDE // 2, SIDE // 2:]) + within


def tables():
    for obscuration in OBSCURATIONS:
        for range_km in RANGES_KM:
            yield f"galsim_{'ring' if obscuration else 'disc'}_{range_km}_km", table(range_km, obscuration)


def main():
    if sys.argv[1:] == ["--write"]:
        print(f"// Made by tests/reference/range_defocus.py --write with GalSim {galsim.__version__}.")
        for name, values in tables():
            print(f"constexpr double {name}[] = {{{', '.join(f'{v:.9e}' for v in values)}}};")
        return 0
    text = TABLE.read_text()
    for name, values in tables():
        known = [float(v) for v in re.search(name + r"\[\] = \{(.*?)\}", text, re.S)[1].split(",")]
        worst = max(abs(a - b) for a, b in zip(values, known, strict=True))
        print(f"{name}: run now and the table differ by {worst:.1e}")
        if worst > 1e-6:
            return 1
    return 0


sys.exit(main())
