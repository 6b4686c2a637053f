#!/usr/bin/env python3
"""GalSim's point spread functions, which tests/optics/test_galsim.cpp holds frames against.

    galsim_psf.py            GalSim, run now, gives the table of galsim_psf.inc (1e-6 of each peak)
    galsim_psf.py --write    prints that table

Pixel-integrated images by GalSim (launch/setup/python-packages.txt): cells of half lambda/D (Airy) and of a third of the
seeing's FWHM (Kolmogorov), 21 x 21, fluxes before any scaling. Without GalSim
it says so and exits 77, with DMISE_DATA set 1.
"""
import os
import pathlib
import re
import sys

try:
    import galsim
except ImportError:
    print("galsim is not there (./dmise setup --tests): its table galsim_psf.inc was not made again")
    sys.exit(1 if os.environ.get("DMISE_DATA") else 77)

LAMBDA_M, DIAMETER_M, R0_M = 0.55e-6, 0.3, 0.1
SIDE = 21
TABLE = pathlib.Path(__file__).with_name("galsim_psf.inc")
PRECISE = galsim.GSParams(folding_threshold=1e-4, maxk_threshold=1e-5, maximum_fft_size=16384)
UNIT = LAMBDA_M / DIAMETER_M  # radians: GalSim's lengths carry the unit that we give them


def images():
    """(name, 441 values) of each profile."""
    for name, profile, cell_rad in (
        ("galsim_airy", galsim.Airy(lam_over_diam=UNIT, gsparams=PRECISE), 0.5 * UNIT),
        ("galsim_obscured_airy", galsim.Airy(lam_over_diam=UNIT, obscuration=0.4, gsparams=PRECISE), 0.5 * UNIT),
        ("galsim_kolmogorov", galsim.Kolmogorov(lam_over_r0=LAMBDA_M / R0_M, gsparams=PRECISE),
         0.325 * LAMBDA_M / R0_M),
    ):
        image = profile.drawImage(nx=SIDE, ny=SIDE, scale=cell_rad, method="auto", dtype=float)
        yield name, [float(v) for v in image.array.ravel()]


def main():
    if sys.argv[1:] == ["--write"]:
        print(f"// Made by tests/reference/galsim_psf.py --write with GalSim {galsim.__version__}.")
        for name, values in images():
            print(f"constexpr double {name}[] = {{{', '.join(f'{v:.9e}' for v in values)}}};")
        return 0
    text = TABLE.read_text()
    for name, values in images():
        table = [float(v) for v in re.search(name + r"\[\] = \{(.*?)\}", text, re.S)[1].split(",")]
        worst = max(abs(a - b) for a, b in zip(values, table, strict=True)) / max(values)
        print(f"{name}: galsim {galsim.__version__} and the table differ by {worst:.1e} of the peak")
        if worst > 1e-6:
            return 1
    return 0


sys.exit(main())
