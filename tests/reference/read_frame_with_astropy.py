"""Prints what astropy reads from a frame: shape, corner pixels, a few keywords, the WCS's frame."""

import sys
import warnings

from astropy.io import fits
from astropy.time import Time
from astropy.wcs import WCS, FITSFixedWarning
from astropy.wcs.utils import wcs_to_celestial_frame

# It says so whenever it sets the MJD-* that belong to DATE-*.
warnings.simplefilter("ignore", FITSFixedWarning)
with fits.open(sys.argv[1]) as hdus:
    hdus.verify("exception")
    data, header = hdus[0].data, hdus[0].header
    wcs = WCS(header, hdus)
    print("shape", *data.shape, "dtype", data.dtype, "corners", data[0, 0], data[-1, -1])
    print("gain", header["GAIN"], "seed", header["SEED"], "obs", Time(header["DATE-OBS"]).isot)
    x, y = wcs.all_world2pix([wcs.wcs.crval], 0)[0]
    print("frame", wcs_to_celestial_frame(wcs).name, "ctype", *wcs.wcs.ctype,
          f"reference pixel {x:.6g} {y:.6g}")
