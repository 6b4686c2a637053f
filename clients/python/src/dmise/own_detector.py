"""A detector of one's own in a run: `detector` marks it, `serve` runs it (docs/howto/plug-in-a-model.md).

    @dmise.detector
    def find(frame, options):
        return [dmise.Found(x_px=.., y_px=.., sigma_px=.., flux_e=.., snr=..)]
    dmise.serve(find)
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import protocol
from .cards import CardValue, values_of
from .dynamics import rotation_matrix
from .own_served import Served, list_of, number_of, numbers_in, one_by_one, variance_of


@dataclass
class Found:
    """One source in a frame; or n, if `x_px` and others are arrays. (0, 0) is the centre of the first pixel.

    x_px, y_px      centroid of light
    sigma_px        its standard error in x and y; or
    covariance_px2  var x, cov xy, var y (3, or 3 x n)
    flux_e          light above the background [e-]
    snr             flux_e over its standard error
    end1_px         x, y (2, or 2 x n) of one end of a streak, end2_px of the other
    end_sigma_px    their standard error, that of the centroid if it is left out; or
    end1_covariance_px2, end2_covariance_px2
    """
    x_px: Any
    y_px: Any
    flux_e: Any
    snr: Any
    sigma_px: Any = None
    covariance_px2: Any = None
    end1_px: Any = None
    end2_px: Any = None
    end_sigma_px: Any = None
    end1_covariance_px2: Any = None
    end2_covariance_px2: Any = None


@dataclass
class SensorFrame:
    """What a detector is told: a frame, as it is in its file. `counts`: rows x columns [DN]."""
    sensor: str
    number: int  # from 1
    tick: int
    counts: npt.NDArray[np.uint16]
    header: dict[str, CardValue]  # cards of the FITS file
    node: str = ""

    @property
    def gain_e_per_dn(self) -> float:
        return float(self.header["GAIN"])

    @property
    def exposure_s(self) -> float:
        return float(self.header["EXPTIME"])

    @property
    def star_trail_px(self) -> npt.NDArray[np.float64]:
        """x, y [px] by which the camera's turning moves a star in the middle of the frame, from start to end of the exposure.

        Of a turn of less than 90 degrees; not a number of a larger one.
        """
        start, end = (rotation_matrix([float(self.header[f"Q{at}{k}"]) for k in range(4)]) for at in ("BEG", "END"))
        x, y, z = end @ start[2]  # the boresight at the start
        return float(self.header["FOCALPX"]) * np.array([x, y]) / (z if z > 0 else np.nan)


class Detector(Served):
    """A function `f(frame, options)` that returns what is in a frame, or a class whose instances are called so."""

    mark = "detector"


def detector(model: Callable[..., Any]) -> Detector:
    """Marks a function or class that detects in the frames of a sensor."""
    return Detector(model)


def frame_of(frame: Any, counts: bytes, node: str) -> SensorFrame:
    """The frame of a request."""
    pixels = np.frombuffer(counts, "<u2").reshape(frame.rows, frame.columns)
    return SensorFrame(frame.sensor, frame.frame, frame.tick, pixels.astype(np.uint16, copy=False),
                       values_of(frame.cards), node)


def packed(said: Any) -> Any:
    """What a detector says, as OwnNodeFound."""
    found = protocol.OwnNodeFound()
    for one in list_of([said] if isinstance(said, Found) else said, Found, "a detector returns dmise.Found, or a list of them"):
        for source in one_by_one(one, len(one.x_px) if np.ndim(one.x_px) else None):
            _add(found, source)
    return found


def _add(found: Any, source: Found) -> None:
    added = found.sources.add(flux_e=number_of(source, "flux_e"), snr=number_of(source, "snr"))
    covariance = _covariance(source, "covariance_px2", "sigma_px")
    if covariance is None:
        raise ValueError("sigma_px or covariance_px2: is needed")
    _set(added.centroid, [number_of(source, "x_px"), number_of(source, "y_px")], covariance)
    if (source.end1_px is None) != (source.end2_px is None):
        raise ValueError("end1_px and end2_px: a streak has both")
    for name, end in (("end1", added.end1), ("end2", added.end2)):
        if getattr(source, f"{name}_px") is None:
            continue
        of_end = _covariance(source, f"{name}_covariance_px2", "end_sigma_px")
        _set(end, numbers_in(source, f"{name}_px", 2), covariance if of_end is None else of_end)


def _set(place: Any, at: list[float], covariance_px2: list[float]) -> None:
    place.x_px, place.y_px = at
    place.var_x_px2, place.cov_xy_px2, place.var_y_px2 = covariance_px2


def _covariance(source: Found, name: str, sigma_name: str) -> list[float] | None:
    if getattr(source, name) is not None:
        return numbers_in(source, name, 3)
    if getattr(source, sigma_name) is None:
        return None
    variance = variance_of(source, sigma_name)
    return [variance, 0.0, variance]
