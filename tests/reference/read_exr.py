"""Prints what OpenEXR reads from a radiance map: shape, type, corners, sum, unit, compression."""

import sys

import numpy
import OpenEXR

with OpenEXR.File(sys.argv[1]) as exr:
    (name, channel), = exr.channels().items()
    pixels, header = channel.pixels, exr.header()
    print("channel", name, "shape", *pixels.shape, pixels.dtype, "corners",
          *(f"{pixels[y, x]:.9g}" for y in (0, -1) for x in (0, -1)))
    print(f"sum {pixels.sum(dtype=numpy.float64):.17g} unit", header["unit"], "frame",
          f"{header['frame'][0]:g}", header["compression"])
