"""Writes frames as other cameras do, with astropy, and prints what astropy makes of them.

    foreign_frames.py wcs DIR      one file for each form of a WCS; prints FILE X Y RA DEC [deg] for pixels (0 is the first)
    foreign_frames.py pixels DIR   one file for each type of pixel; prints FILE and the sum, least and greatest value
"""

import pathlib
import sys
import warnings

import numpy as np
from astropy.io import fits
from astropy.wcs import WCS

COLUMNS, ROWS = 320, 200
SCALE = 0.01


def matrix(turn_deg, flip):
    c, s = np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))
    return np.array([[-c, s if flip else -s], [s, c if flip else -c]]) * SCALE


def cd_cards(m):
    return {f"CD{i + 1}_{j + 1}": m[i, j] for i in range(2) for j in range(2)}


def form(code="TAN", ra=150.0, dec=40.0, **more):
    cards = {"CTYPE1": f"RA---{code}", "CTYPE2": f"DEC--{code}", "CRPIX1": 170.3, "CRPIX2": 90.8,
             "CRVAL1": ra, "CRVAL2": dec, "CUNIT1": "deg", "CUNIT2": "deg"}
    cards.update(more)
    return cards


def wcs_forms():
    up = cd_cards(matrix(20, True))
    for code in ("TAN", "ARC", "ZEA", "STG"):
        yield code, form(code, **up)
    yield "down", form(**cd_cards(matrix(-70, False)))
    yield "pole", form(dec=90.0, **up)
    yield "south", form(dec=-90.0, **up)
    yield "lonpole", form(LONPOLE=123.0, **up)
    yield "lonpole-arc", form("ARC", LONPOLE=-30.0, **up)
    yield "crota", form(CDELT1=-SCALE, CDELT2=2 * SCALE, CROTA2=33.0)
    yield "pc", form(CDELT1=-SCALE, CDELT2=SCALE, PC1_1=0.8, PC1_2=0.6, PC2_1=-0.6, PC2_2=0.8)
    yield "cdelt", form(CDELT1=-SCALE, CDELT2=SCALE)
    swapped = form(**cd_cards(matrix(20, True)[::-1]))
    swapped.update(CTYPE1="DEC--TAN", CTYPE2="RA---TAN", CRVAL1=40.0, CRVAL2=150.0)
    yield "swapped", swapped
    sip = dict(A_ORDER=2, B_ORDER=3, A_2_0=3e-5, A_1_1=-2e-5, B_0_3=1e-7, B_2_0=1e-5)
    yield "sip", form("TAN-SIP", **up, **sip)


def header_of(cards):
    header = fits.Header()
    for key, value in cards.items():
        header[key] = value
    return header


def write_wcs(directory):
    for name, cards in wcs_forms():
        header = header_of(cards)
        path = directory / f"{name}.fits"
        fits.PrimaryHDU(np.full((ROWS, COLUMNS), 100, np.int16), header).writeto(path, overwrite=True)
        wcs = WCS(header)
        for x, y in ((0, 0), (COLUMNS - 1, 0), (10, ROWS - 1), (200.25, 77.5)):
            ra, dec = (float(v) for v in wcs.all_pix2world(x, y, 0))
            if name == "swapped":
                ra, dec = dec, ra
            print(name, x, y, f"{ra:.12f} {dec:.12f}")


def write_pixels(directory):
    random = np.random.default_rng(1)
    values = np.round(random.normal(1000, 20, (ROWS, COLUMNS)))
    values[50, 60] = 40000
    holes = values.astype(np.float32) / 7
    holes[20:30, 40:45] = np.nan
    images = {"uint8": (values / 200).astype(np.uint8), "int16": np.minimum(values, 30000).astype(np.int16),
              "uint16": values.astype(np.uint16), "int32": values.astype(np.int32) * 50,
              "uint32": values.astype(np.uint32) * 50, "int64": values.astype(np.int64) * 5000,
              "float32": holes, "float64": values / 3e6}
    for name, image in images.items():
        fits.PrimaryHDU(image).writeto(directory / f"{name}.fits", overwrite=True)
        fits.HDUList([fits.PrimaryHDU(), fits.ImageHDU(image)]).writeto(directory / f"{name}-ext.fits", overwrite=True)
        print(name, f"{np.nansum(image, dtype=float):.9g} {np.nanmin(image):.9g} {np.nanmax(image):.9g}")
        print(name + "-ext", f"{np.nansum(image, dtype=float):.9g} {np.nanmin(image):.9g} {np.nanmax(image):.9g}")
        forms = ("RICE_1", "GZIP_1", "GZIP_2")
        if image.dtype.kind == "f":
            forms = forms[1:]  # Rice quantises floats: FitsImage.ReadsQuantisedFloats
        if image.dtype == np.int64:
            forms = ()  # astropy 5.2 does not write them
        for form in forms:
            file = f"{name}-{form}"
            fits.CompImageHDU(image, compression_type=form, quantize_level=0.0).writeto(
                directory / f"{file}.fits", overwrite=True)
            print(file, f"{np.nansum(image, dtype=float):.9g} {np.nanmin(image):.9g} {np.nanmax(image):.9g}")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    {"wcs": write_wcs, "pixels": write_pixels}[sys.argv[1]](pathlib.Path(sys.argv[2]))
