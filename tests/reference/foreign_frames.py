"""Writes frames as other cameras do, with astropy, and prints what astropy makes of them.

    foreign_frames.py wcs DIR      one file for each form of a WCS; prints FILE X Y RA DEC [deg] for pixels (0 is the first)
    foreign_frames.py pixels DIR   one file for each type of pixel; prints FILE and the sum, least and greatest value
    foreign_frames.py mangled DIR  files with headers as careless programs write them; prints FILE and the sum of those it reads
"""

import io
import pathlib
import sys
import warnings

import numpy as np
from astropy.io import fits
from astropy.wcs import WCS
from astropy.wcs.utils import pixel_to_skycoord

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
    tpv = dict(PV1_0=0.02, PV1_1=1.01, PV1_2=-0.01, PV1_4=3e-3, PV1_8=-2e-3, PV1_20=1e-4, PV1_35=2e-5,
               PV2_1=0.99, PV2_2=0.02, PV2_5=2e-3, PV2_7=4e-3, PV2_16=-1e-4, PV2_31=1e-5)
    yield "tpv", form("TPV", **up, **tpv)
    yield "tpv-lonpole", form("TPV", **up, **tpv, LONPOLE=123.0)
    yield "other-epoch", form(**up, EPOCH=1950.0)
    yield "other-fk4", form(**up, RADESYS="FK4", EQUINOX=1960.0)
    yield "other-equinox", form(**up, EQUINOX=2018.05)
    yield "other-fk5", form("TAN-SIP", dec=-88.0, RADECSYS="FK5", EQUINOX=1990.0, **up, **sip)
    galactic = form(ra=33.0, dec=-60.0, **up)
    galactic.update(CTYPE1="GLON-TAN", CTYPE2="GLAT-TAN")
    yield "other-galactic", galactic


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
            if name.startswith("other-"):
                seen = pixel_to_skycoord(x, y, wcs).icrs
                ra, dec = seen.ra.deg, seen.dec.deg
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


def odd_card(random):
    """A card that no writer should write, or that readers stumble over."""
    key = bytes(random.choice(list(b"ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-"), random.integers(1, 9))).ljust(8)
    text = bytes(random.integers(32, 127, random.integers(0, 50)).astype(np.uint8)).replace(b"'", b" ")
    any_bytes = bytes(random.integers(0, 256, random.integers(1, 50)).astype(np.uint8)).replace(b"'", b" ")
    digits = bytes(random.choice(list(b"0123456789"), random.integers(20, 65)))
    return [
        lambda: b"COMMENT " + text,
        lambda: b"HISTORY " + any_bytes,
        lambda: b"COMMENT " + b"=" * random.integers(1, 70),
        lambda: b"        " + any_bytes,
        lambda: key + b"= '" + any_bytes[:40] + b"'",
        lambda: key + b"= '" + text,  # a text without an end
        lambda: key + b"= " + digits,
        lambda: key + b"= " + digits[:1] + b"." + digits + b" / " + text,
        lambda: key + b"=                  1.0 / " + any_bytes,
        lambda: key + b"= (1.0, 2.0) / complex",
        lambda: key + b"= " + text,
        lambda: key + b"=" + digits[:20],
        lambda: key.lower() + b"=                    5",
        lambda: b"HIERARCH ESO " + key + b" = " + digits,
        lambda: b"CONTINUE  '" + text + b"'",
        lambda: b"\0" * 80,
        lambda: b" " * 80,
        lambda: b"\t" + text,
        lambda: any_bytes,
        lambda: b"NAXIS9  = " + digits[:25],
        lambda: b"EXTNAME = '" + text[:20] + b"'",
        lambda: b"BLANKS  = " + digits,
    ][random.integers(22)]().ljust(80)[:80]


def write_mangled(directory, count=400):
    random = np.random.default_rng(2)
    for i in range(count):
        image = random.integers(0, 30000, (12, 20)).astype((np.int16, np.int32, np.float32)[i % 3])
        held = io.BytesIO()
        hdus = [fits.PrimaryHDU(), fits.ImageHDU(image)] if i % 4 == 3 else [fits.PrimaryHDU(image)]
        fits.HDUList(hdus).writeto(held)
        raw = held.getvalue()
        at = 2880 * (len(hdus) - 1)  # begin of the image's header; its data fill one block at most
        data = raw[at + 2880:][:image.nbytes]
        cards = [raw[at + k:at + k + 80] for k in range(0, 2880, 80)]
        cards = cards[:cards.index(b"END".ljust(80))]
        if random.random() < 0.2:
            cards += [b"BSCALE  = 2." + b"0" * 40, b"BZERO   = -10." + b"0" * 35]
        fixed = next(k for k, card in enumerate(cards) if card.startswith(b"NAXIS2")) + 1
        if len(hdus) > 1:
            fixed = next(k for k, card in enumerate(cards) if card.startswith(b"GCOUNT")) + 1
        for _ in range(random.integers(1, 8)):
            cards.insert(random.integers(fixed, len(cards) + 1), odd_card(random))
        end = b"END".ljust(80) if random.random() < 0.8 else b"END".ljust(80, b"\0")
        head = b"".join(card.ljust(80) for card in cards) + end
        head += (b" " if random.random() < 0.8 else b"\0") * (-len(head) % 2880)
        body = data + b"\0" * (-len(data) % 2880 if random.random() < 0.7 else random.integers(0, 400))
        if random.random() < 0.3 and len(body) % 2880 == 0:
            body += bytes(random.integers(0, 256, random.integers(1, 9000)).astype(np.uint8) * (i % 2))
        path = directory / f"mangled-{i}.fits"
        path.write_bytes(raw[:at] + head + body)
        try:
            with fits.open(path) as file:
                print(path.stem, repr(float(file[len(hdus) - 1].data.sum(dtype=float))))
        except Exception:
            continue  # astropy refuses it, too


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    {"wcs": write_wcs, "pixels": write_pixels, "mangled": write_mangled}[sys.argv[1]](pathlib.Path(sys.argv[2]))
