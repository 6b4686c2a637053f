"""Reads lines "x y ra_deg dec_deg" (0-based pixels) and prints the largest distance [px] between each
pixel and where astropy's WCS of the FITS file puts that direction, SIP included."""

import sys
import warnings

import numpy as np
from astropy.io import fits
from astropy.wcs import WCS, FITSFixedWarning

warnings.simplefilter("ignore", FITSFixedWarning)
wcs = WCS(fits.getheader(sys.argv[1]))
x, y, ra, dec = np.loadtxt(sys.argv[2], unpack=True)
found = wcs.all_world2pix(np.column_stack([ra, dec]), 0, tolerance=1e-8)
print(f"{np.hypot(found[:, 0] - x, found[:, 1] - y).max():.3e}")
