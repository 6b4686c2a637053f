#!/usr/bin/python3
"""Prints colours of the spectra of Pickles 1998, PASP 110, 863, for tests/photometry/test_star_spectrum.cpp: rates of
photons by synphot, beside CALSPEC's Vega of 0.03 mag (U 0.024).

    pickles_colours.py SPECTRA FILTERS VEGA

SPECTRA: dat_uvk of EXOSIMS (PyPI: EXOSIMS/TargetList/dat_uvk of its wheel); FILTERS: filter curves in ECSV (speclite);
VEGA: a table of nm and erg/s/cm2/nm (share/SEDs/vega.txt of GalSim). Needs synphot and astropy.
"""
import sys

import numpy as np
from astropy import units as u
from astropy.io import fits
from synphot import Empirical1D, Observation, SourceSpectrum, SpectralElement

VEGA_MAG = {"U": 0.024, "B": 0.03, "V": 0.03, "R": 0.03, "I": 0.03}


def band(folder, name):
    rows = np.array([line.split() for line in open(f"{folder}/bessell-{name}.ecsv") if line[0].isdigit()], float)
    response = rows[:, 1] / rows[:, 0]  # response to photons
    return SpectralElement(Empirical1D, points=rows[:, 0] * u.AA, lookup_table=response / response.max())


def spectrum(angstrom, flam):
    return SourceSpectrum(Empirical1D, points=angstrom * u.AA, lookup_table=flam * u.erg / u.s / u.cm**2 / u.AA,
                          keep_neg=False)


def main():
    folder, filters, vega = sys.argv[1:4]
    bands = {name: band(filters, name) for name in "UBVRI"}
    rows = np.array([line.split()[:2] for line in open(vega) if line.strip() and line[0] != "#"], float)
    area = 1 * u.cm**2

    def magnitudes(source):
        return {name: -2.5 * np.log10(Observation(source, b, force="taper").countrate(area).value)
                for name, b in bands.items()}

    zero = magnitudes(spectrum(rows[:, 0] * 10, rows[:, 1] / 10))
    index = fits.getdata(f"{folder}/pickles_uk.fits")
    for name, kind in zip(index["FILENAME"], index["SPTYPE"]):
        try:
            table = fits.getdata(f"{folder}/{name.strip()}.fits")
        except FileNotFoundError:
            continue
        m = magnitudes(spectrum(table["WAVELENGTH"].astype(float), table["FLUX"].astype(float)))
        m = {k: m[k] - zero[k] + VEGA_MAG[k] for k in m}
        print(f'    {{"{kind.strip()}", {m["B"] - m["V"]:.3f}, {m["U"] - m["B"]:.3f}, {m["V"] - m["R"]:.3f}, '
              f'{m["V"] - m["I"]:.3f}}},')


main()
