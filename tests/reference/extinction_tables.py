#!/usr/bin/python3
"""Prints core/sky/air/extinction_tables.inc from observatories' curves (the argument: their folder), each
sampled at the same wavelengths; beyond a curve's red end its last slope-free value."""
import sys

import numpy as np

nodes = np.concatenate([np.arange(3200, 4000, 100), np.arange(4000, 7000, 250), np.arange(7000, 11001, 500)])
sources = {
    "lick": ("mthamextinct", "Lick Observatory, Mount Hamilton, mean extinction table"),
    "ctio": ("ctioextinct", "Stone & Baldwin 1983, MNRAS 204, 347; Baldwin & Stone 1984, MNRAS 206, 241"),
    "kitt_peak": ("kpnoextinct", "Kitt Peak National Observatory, standard curve of IRAF onedspec"),
    "la_palma": ("lapalmaextinct", "King 1985, RGO/La Palma technical note 31"),
    "mauna_kea": ("mkoextinct", "Buton et al. 2013, A&A 549, A8"),
    "paranal": ("paranalextinct", "Patat et al. 2011, A&A 527, A91"),
}
print("// Made by tests/reference/extinction_tables.py. {wavelength [nm], extinction [mag/airmass]}")
for name, (file, source) in sources.items():
    data = np.array([line.split()[:2] for line in open(f"{sys.argv[1]}/{file}.dat") if not line.startswith("#") and line.strip()], float)
    data = data[np.argsort(data[:, 0])]
    cells = [f"{{{w / 10:g}, {k:.3f}}}," for w, k in zip(nodes, np.interp(nodes, data[:, 0], data[:, 1]))]
    print(f"// {source}.\nconstexpr Sample {name}[] = {{")
    for i in range(0, len(cells), 6):
        print("    " + " ".join(cells[i : i + 6]))
    print("};")
