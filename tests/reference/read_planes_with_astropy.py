"""Prints what astropy reads from a compressed frame with flags and from a plane beside it."""

import sys
import warnings

import numpy
from astropy.io import fits
from astropy.units import Unit
from astropy.wcs import WCS, FITSFixedWarning

warnings.simplefilter("ignore", FITSFixedWarning)
with fits.open(sys.argv[1]) as hdus:
    hdus.verify("exception")
    counts, flags = hdus[1], hdus["FLAGS"]
    print("counts", *counts.data.shape, counts.data.dtype, "sum", counts.data.sum(dtype=int),
          "by", counts._header["ZCMPTYPE"])
    print("flags", *flags.data.shape, flags.data.dtype, "sum", flags.data.sum(dtype=int),
          flags.header["FLAG0"], "/", flags.header["FLAG4"])
    print("prnu", counts.header["PRNU"], "blooming", counts.header["BLOOMING"], "bits",
          counts.header["ADCBITS"])
with fits.open(sys.argv[2]) as hdus:
    hdus.verify("exception")
    data, header = hdus[0].data, hdus[0].header
    print("plane", header["EXTNAME"], *data.shape, data.dtype.name, "sum",
          f"{data.sum(dtype=numpy.float64):.17g}", Unit(header["BUNIT"]),
          WCS(header).wcs.ctype[0])
