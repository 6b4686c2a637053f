"""Frames of any camera: what is in them, and where they point."""
from __future__ import annotations

import json
import os
import types
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .cards import CardValue, values_of
from .engine import core
from .json_lines import record_of_line
from .plain_fits import fits_of
from .records import Detection, FrameReport
from .simulation import SimulatedFrame
from .tables import Table, table_of


class Detections(Table):
    """Rows of `dmise.Detection`. `report`: the frame's; `missing`, `assumed`: what its header leaves unsaid."""

    report: FrameReport
    missing: list[str]
    assumed: list[str]

    def __array_finalize__(self, whole: Any) -> None:
        """Rows that are chosen are of the same frame."""
        if isinstance(whole, Detections):
            vars(self).update(vars(whole))


def detect(image: Any, header: Any = None, *, catalogue: str | os.PathLike[str] = "kstars", blind: bool = False,
           threads: int = 1) -> Detections:
    """What is no star in a frame, as `dmise detect` finds it.

    image      rows x columns of numbers, NaN where a pixel has no value; or a `SimulatedFrame`, without `header`
    header     keywords of the camera's FITS header: a mapping, astropy's Header, or cards (docs/detection.md)
    catalogue  of stars: kstars, tycho2, a file, or none
    blind      finds where the frame points by its stars alone
    """
    lines, report, missing, assumed = core.detect(file_of_frame(image, header), "image", os.fspath(catalogue), blind, threads)
    found = table_of([record_of_line(json.loads(line), Detection, None) for line in lines], Detection).view(Detections)
    found.report = record_of_line(json.loads(report), FrameReport, None)
    found.missing, found.assumed = missing, assumed
    return found


@dataclass
class Solution:
    """Where a frame points. `info`: as of `dmise solve --json`; `header`: the frame's with the solution."""
    info: dict[str, Any]
    header: Mapping[str, CardValue]
    cards: list[str] = field(repr=False)
    missing: list[str]
    assumed: list[str]

    @property
    def wcs(self) -> Any:
        """astropy.wcs.WCS of ICRS; needs astropy."""
        from astropy.io import fits
        from astropy.wcs import WCS

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # astropy warns about headers that it corrects
            return WCS(fits.Header.fromstring("".join(self.cards)))


def solve(image: Any, header: Any = None, *, catalogue: str | os.PathLike[str] = "kstars", blind: bool = False,
          threads: int = 1) -> Solution:
    """Where a frame points, its distortion and zero point by its stars, as `dmise solve` finds it.

    Arguments are as of `detect`. Raises `EngineError` if there is no solution.
    """
    solution, cards, missing, assumed = core.solve(file_of_frame(image, header), "image", os.fspath(catalogue), blind, threads)
    return Solution(json.loads(solution), types.MappingProxyType(values_of(cards)), cards, missing, assumed)


def file_of_frame(image: Any, header: Any) -> bytes:
    """The FITS file of a frame."""
    return image.to_fits() if isinstance(image, SimulatedFrame) and header is None else fits_of(image, header)
