#!/usr/bin/env python3
"""Prints core/sky/air/gas_tables.inc: absorption coefficients of water vapour and of the well-mixed gases of Bird & Riordan
1986, J. Climate Appl. Meteor. 25, 87, table 1 (SPECTRL2), as pvlib has them.
"""
from pvlib.spectrum.spectrl2 import _SPECTRL2_COEFFS as table

print("// Made by tests/reference/gas_tables.py. {wavelength [nm], water vapour, mixed gases}")
print("// Bird & Riordan 1986, J. Climate Appl. Meteor. 25, 87, table 1.")
print("constexpr Gas gases[] = {")
cells = [f"{{{row['wavelength']:g}, {row['water_vapor_absorption']:g}, {row['mixed_absorption']:g}}}," for row in table]
for i in range(0, len(cells), 4):
    print("    " + " ".join(cells[i : i + 4]))
print("};")
