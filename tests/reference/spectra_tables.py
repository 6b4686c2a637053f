#!/usr/bin/python3
"""Prints core/photometry/reference_spectra_tables.inc: short tables of the Sun (ASTM E490) and Vega (CALSPEC).

Run with the folder of the originals (e490_00a.dat, vega_galsim.txt) as the argument. Each value is the
mean under the hat function of linear interpolation, so integrals over bands survive the coarser steps.
"""
import sys

import numpy as np


def hat_means(nodes, x, y):
    fine = np.arange(nodes[0], nodes[-1] + 0.025, 0.05)
    value = np.interp(fine, x, y)
    out = []
    for i, centre in enumerate(nodes):
        left = nodes[i - 1] if i else centre
        right = nodes[i + 1] if i + 1 < len(nodes) else centre
        weight = np.interp(fine, [left - 1e-9, centre, right + 1e-9], [0, 1, 0], left=0, right=0)
        out.append((weight * value).sum() / weight.sum())
    return np.array(out)


def table(name, nodes, values):
    cells = [f"{{{n:g}, {v:.4g}}}," for n, v in zip(nodes, values)]
    print(f"constexpr SpectrumSample {name}[] = {{")
    for i in range(0, len(cells), 6):
        print("    " + " ".join(cells[i : i + 6]))
    print("};")


folder = sys.argv[1]
sun = np.loadtxt(folder + "/e490_00a.dat")
vega = np.loadtxt(folder + "/vega_galsim.txt")
common = np.concatenate([np.arange(200, 300, 10), np.arange(300, 1100, 5), np.arange(1100, 2200, 25)])
nodes = np.concatenate([common, np.arange(2200, 2500, 25), np.arange(2500, 5001, 250)]).astype(float)
print("// Made by tests/reference/spectra_tables.py. {wavelength [nm], spectral irradiance}")
print("// Sun at 1 au, above the atmosphere [W/m2/um]. Source: ASTM E490-00a.")
table("sun_samples", nodes, hat_means(nodes, sun[:, 0] * 1e3, sun[:, 1]))
nodes = np.concatenate([common, [2195]]).astype(float)
print("// Vega [1e-9 W/m2/um]. Source: CALSPEC alpha_lyr_mod_001 (STScI).")
table("vega_samples", nodes, hat_means(nodes, vega[:, 0], vega[:, 1] * 1e9))  # erg/s/cm2/nm = W/m2/um
