#!/usr/bin/python3
"""Writes wcs_values.inc: sky positions of pixels by astropy's WCS (wcslib, SIP), for tests/wcs/test_wcs.cpp."""
from astropy.wcs import WCS
from astropy.io import fits

for ra, dec in ((83.6, 22.0), (0.01, -5.0), (359.9, 60.0), (120.0, 90.0), (45.0, -90.0), (200.0, 88.0)):
    header = fits.Header()
    header["CTYPE1"], header["CTYPE2"] = "RA---TAN-SIP", "DEC--TAN-SIP"
    header["CRPIX1"], header["CRPIX2"] = 256.5, 200.5
    header["CRVAL1"], header["CRVAL2"] = ra, dec
    header["CD1_1"], header["CD1_2"], header["CD2_1"], header["CD2_2"] = -0.02, 0.003, 0.004, 0.021
    header["LONPOLE"] = 180.0
    header["A_ORDER"], header["B_ORDER"] = 3, 3
    header["A_0_2"], header["A_1_1"], header["A_3_0"] = 1e-5, -2e-5, 3e-8
    header["B_2_0"], header["B_0_3"] = 1.5e-5, -2e-8
    wcs = WCS(header)
    for x, y in ((255.5, 199.5), (0.0, 0.0), (511.0, 0.0), (13.25, 398.75), (511.0, 399.0)):
        sky = wcs.all_pix2world(x, y, 0)
        print(f"{{{ra}, {dec}, {x}, {y}, {float(sky[0])!r}, {float(sky[1])!r}}},")
