#!/usr/bin/python3
"""Prints core/photometry/filter_tables.inc from filter curves in ECSV (the argument: their folder).

Bessell's are given every 5 or 10 nm and are responses to energy: divided by the wavelength, scaled to
a peak of 1, they are responses to photons. SDSS's are responses to photons, given every 2 nm and
printed every 10 nm as means under the hat function, scaled to a peak of 1.
"""
import sys

import numpy as np


def curve(name):
    rows = [line.split() for line in open(f"{sys.argv[1]}/{name}.ecsv") if line[0].isdigit()]
    data = np.array(rows, float)
    return data[:, 0] / 10, data[:, 1]


def of_photons(x, y):
    return x, y / x / (y / x).max()


def coarse(x, y):
    nodes = np.arange(np.floor(x[0] / 10) * 10, x[-1] + 10, 10)
    fine = np.arange(nodes[0], nodes[-1] + 0.05, 0.1)
    value = np.interp(fine, x, y, left=0, right=0)
    hats = np.maximum(0, 1 - np.abs(fine[None, :] - nodes[:, None]) / 10)
    mean = (hats * value).sum(axis=1) / hats.sum(axis=1)
    mean[0] = mean[-1] = 0
    return nodes, mean / mean.max()


def table(name, x, y):
    cells = [f"{{{n:g}, {v:.4g}}}," for n, v in zip(x, y)]
    print(f"constexpr Sample {name}[] = {{")
    for i in range(0, len(cells), 7):
        print("    " + " ".join(cells[i : i + 7]))
    print("};")


print("// Made by tests/reference/filter_tables.py. {wavelength [nm], response}")
print("// Bessell 1990, PASP 102, 1181, divided by wavelength; airmass 0.")
for band in "UBVRI":
    table(f"bessell_{band.lower()}", *of_photons(*curve(f"bessell-{band}")))
print("// Doi et al. 2010, AJ 139, 1628; with the camera, the telescope and 1.3 airmasses.")
for band in "ugriz":
    table(f"sdss_{band}", *coarse(*curve(f"sdss2010-{band}")))
