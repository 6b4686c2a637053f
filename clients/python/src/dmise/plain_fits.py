"""Images and headers in memory as FITS files, which the engine reads as those of any camera."""
from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from .errors import InputError

BLOCK = 2880
MOST_PIXELS = 2**32 - 1
# What the file says of its pixels, which is not the header's to say.
_STRUCTURE = {"SIMPLE", "BITPIX", "NAXIS", "NAXIS1", "NAXIS2", "NAXIS3", "BZERO", "BSCALE", "EXTEND", "XTENSION", "PCOUNT",
              "GCOUNT", "GROUPS", "END", "CHECKSUM", "DATASUM", "BLANK", "ZIMAGE", "EXTNAME"}
# Numbers that FITS has not, as some that it has.
_AS = {"i1": "i2", "u8": "f8", "f2": "f4", "f16": "f8"}
_STORED = {"u1": (8, ">u1", 0), "i2": (16, ">i2", 0), "u2": (16, ">i2", 2**15), "i4": (32, ">i4", 0), "u4": (32, ">i4", 2**31),
           "i8": (64, ">i8", 0), "f4": (-32, ">f4", 0), "f8": (-64, ">f8", 0)}


def fits_of(image: Any, header: Any) -> bytes:
    """A FITS file of an image, rows x columns, and a header: a mapping of keywords, astropy's Header or cards.

    A masked pixel has no value, as one that is NaN.
    """
    pixels = np.asarray(np.ma.filled(image.astype(np.float64), np.nan) if isinstance(image, np.ma.MaskedArray) else image)
    if pixels.ndim != 2 or pixels.size == 0 or pixels.size > MOST_PIXELS:
        raise InputError(f"image: must have rows and columns, and at most 2^32 pixels, got shape {pixels.shape}")
    kind = pixels.dtype.str[1:]
    kind = _AS.get(kind, kind)
    if kind not in _STORED:
        raise InputError(f"image: must be of real numbers, got {pixels.dtype}")
    bits, stored, zero = _STORED[kind]
    rows, columns = pixels.shape
    begin = [_card("SIMPLE", True), _card("BITPIX", bits), _card("NAXIS", 2), _card("NAXIS1", columns), _card("NAXIS2", rows)]
    begin += [_card("BZERO", zero), _card("BSCALE", 1)] if zero else []
    text = "".join([*begin, *cards_of(header), f"{'END':80}"])
    data = (pixels.astype(np.int64) - zero if zero else pixels).astype(stored).tobytes()
    return _padded(text.encode("ascii", "replace"), b" ") + _padded(data, b"\0")


def cards_of(header: Any) -> list[str]:
    """Cards of 80 characters of a header, but those that describe pixels."""
    if header is None:
        return []
    if hasattr(header, "cards"):  # a header of astropy; a long text is several cards
        images = "".join(card.image for card in header.cards)
        cards = [images[i:i + 80] for i in range(0, len(images), 80)]
    elif isinstance(header, Mapping):
        cards = [_card(str(key), value) for key, value in header.items() if value is not None]
    elif isinstance(header, Iterable) and not isinstance(header, (str, bytes)):
        cards = [f"{card:80}" for card in header]
    else:
        raise InputError(f"header: must be a mapping of keywords, a header of astropy or cards, got {type(header).__name__}")
    return [card for card in cards if card[:8].strip() not in _STRUCTURE]


def _card(key: str, value: Any) -> str:
    key = key.upper()
    if not 0 < len(key) <= 8 or not key.replace("-", "").replace("_", "").isalnum() or not key.isascii():
        raise InputError(f"header: {key}: is no keyword of FITS")
    if isinstance(value, (bool, np.bool_)):
        return f"{key:8}= {'T' if value else 'F':>20}".ljust(80)
    if isinstance(value, (int, np.integer)):
        return f"{key:8}= {int(value):20d}".ljust(80)
    if isinstance(value, (float, np.floating)):
        if not math.isfinite(value):
            raise InputError(f"header: {key}: must be finite, got {value}")
        number = repr(float(value)).upper()
        return f"{key:8}= {number:>20}".ljust(80)
    text = str(value).replace("'", "''")
    if not text.isascii() or not text.isprintable() or len(text) > 68:
        raise InputError(f"header: {key}: must be at most 68 printable characters of ASCII, got {value!r}")
    return f"{key:8}= '{text:8}'".ljust(80)


def _padded(content: bytes, by: bytes) -> bytes:
    return content + by * (-len(content) % BLOCK)
