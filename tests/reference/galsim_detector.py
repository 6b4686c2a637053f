#!/usr/bin/python3
"""Reference for tests/detector/test_expected_signal.cpp: GalSim's non-linearity and then its interpixel
coupling, in the order of its Roman chain, on a frame of 5 x 5 electrons; the middle 3 x 3."""
import galsim
import numpy

electrons = numpy.array([[100 * x * x + 900 * y + (20000 if (x, y) == (2, 2) else 0) for x in range(5)] for y in range(5)])
image = galsim.Image(electrons.astype(float))
image.applyNonlinearity(lambda e: e * (1 - 0.05 * e / 30000))
coupling = 0.02
image.applyIPC(galsim.Image(numpy.array([[0, coupling, 0], [coupling, 1 - 4 * coupling, coupling], [0, coupling, 0]])))
for row in image.array[1:4, 1:4]:
    print("{" + ", ".join(f"{e:.6f}" for e in row) + "},")
