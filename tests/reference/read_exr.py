"""Prints what OpenEXR reads from a radiance map, of each channel: shape, type, corners, sum, unit, compression."""

import sys

import numpy
import OpenEXR

with OpenEXR.File(sys.argv[1], separate_channels=True) as exr:
    header = exr.header()
    for name, channel in sorted(exr.channels().items()):
        pixels = channel.pixels
        print("channel", name, "shape", *pixels.shape, pixels.dtype, "corners",
              *(f"{pixels[y, x]:.9g}" for y in (0, -1) for x in (0, -1)))
        print(f"sum {pixels.sum(dtype=numpy.float64):.17g} unit", header["unit"], "frame",
              f"{header['frame'][0]:g}", header["compression"])
