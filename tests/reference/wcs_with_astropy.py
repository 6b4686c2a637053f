"""Takes pairs of a FITS file and a list of lines "x y ra_deg dec_deg" (0-based pixels); prints for each pair
the largest distance [px] between each pixel and where astropy's WCS of the file (projection, SIP and lookup
tables) puts that direction."""

import sys
import warnings

import numpy as np
from astropy.io import fits
from astropy.wcs import WCS, FITSFixedWarning

warnings.simplefilter("ignore", FITSFixedWarning)
for frame, places in zip(sys.argv[1::2], sys.argv[2::2]):
    with fits.open(frame) as file:
        image = next(hdu for hdu in file if hdu.header.get("NAXIS") == 2)
        wcs = WCS(image.header, file)
    x, y, ra, dec = np.loadtxt(places, unpack=True, ndmin=2)
    found = wcs.all_world2pix(np.column_stack([ra, dec]), 0, tolerance=1e-8, maxiter=100)
    print(f"{np.hypot(found[:, 0] - x, found[:, 1] - y).max():.3e}", flush=True)
