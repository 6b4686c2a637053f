#!/usr/bin/python3
"""Reference for tests/photometry/test_star_spectrum.cpp: photon rate of a black body in the 0.50-0.60 um and
0.80-0.90 um top hats relative to 0.50-0.51 um, by scipy's quadrature of astropy's Planck law."""
from astropy import units as u
from astropy.modeling.models import BlackBody
from scipy.integrate import quad

for kelvin in (3500, 5778, 20000):
    planck = BlackBody(temperature=kelvin * u.K, scale=1 * u.W / (u.m**2 * u.um * u.sr))
    photons = lambda x: planck(x * u.um).value * x
    rate = lambda a, b: quad(photons, a, b, epsrel=1e-10)[0]
    print(kelvin, rate(0.5, 0.6) / rate(0.5, 0.51), rate(0.8, 0.9) / rate(0.5, 0.51))

# Median U-B of the Yale Bright Star Catalogue (BSC5) about colours B-V, for the dwarfs (class V) among it.
import gzip
import os
from pathlib import Path
from statistics import median

data = Path(os.environ.get("DMISE_DATA", Path(__file__).resolve().parents[3] / "shared/data"))
stars = []
for line in gzip.open(data / "stars/bsc5.dat.gz", "rt", encoding="latin-1"):
    try:
        stars.append((float(line[109:114]), float(line[115:120]), line[127:147].strip()))
    except ValueError:
        pass  # its colour is not known
for bv in (-0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.9, 1.0, 1.2):
    near = [ub for b, ub, kind in stars if abs(b - bv) < 0.03 and kind.endswith("V") and not kind.endswith("IV")]
    print(f"{{{bv}, {median(near):.2f}}},  // {len(near)}")
