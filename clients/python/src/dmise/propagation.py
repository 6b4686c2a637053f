"""States of objects at other times: of catalogues by SGP4, of states by two bodies and J2."""
from __future__ import annotations

import datetime
import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from . import dynamics
from .errors import InputError
from .late_imports import importing
from .records import Floats


@dataclass
class CatalogueStates:
    """States of n objects at m times; where `codes` is not 0, SGP4 has none and numbers are 0 (docs/models/objects.md).

    positions_m, velocities_m_per_s   n x m x 3
    codes                             n x m
    numbers, names                    n, of the catalogue
    refused                           records of the catalogue that were left out, and why
    """
    positions_m: Floats
    velocities_m_per_s: Floats
    codes: npt.NDArray[np.uint8]
    numbers: npt.NDArray[np.uint32]
    names: list[str]
    refused: list[str] = field(repr=False)


@overload
def propagate(what: str | os.PathLike[str], times: Any, *, axes: str = ...,
              earth_orientation: str | os.PathLike[str] = ..., threads: int = ...) -> CatalogueStates: ...


@overload
def propagate(what: Floats, times: float, pole: Floats) -> Floats: ...


def propagate(what: Any, times: Any, pole: Any = None, *, axes: str = "gcrs",
              earth_orientation: str | os.PathLike[str] = "", threads: int = 1) -> Any:
    """States of the objects of a catalogue at times, in UTC, by SGP4.

    what               path or text of element sets: TLE, OMM, gpredict
    times              datetimes, datetime64, or texts of ISO 8601, in UTC; one or many
    axes               gcrs, itrs (velocities relative to the turning Earth) or teme
    earth_orientation  an IERS finals file; without it UT1 equals UTC and there is no polar motion

    Of states, 6 x n, an interval [s] and the Earth's pole it gives the states after the interval:
    `dmise.dynamics.propagate`.
    """
    if not isinstance(what, (str, os.PathLike)):
        return dynamics.propagate(what, times, pole)
    with importing:
        from .engine import core

    if isinstance(what, str) and "\n" in what:
        catalogue = core.Catalogue.of_text(what, "catalogue")
    else:
        catalogue = core.Catalogue.of_file(os.fspath(what))
    positions, velocities, codes = catalogue.states(_texts_of(times), axes, os.fspath(earth_orientation), threads)
    return CatalogueStates(positions, velocities, codes, np.array(catalogue.numbers, dtype=np.uint32), catalogue.names,
                           catalogue.refused)


def _texts_of(times: Any) -> list[str]:
    """Times as ISO 8601 in UTC."""
    if isinstance(times, (str, datetime.datetime, np.datetime64)):
        times = [times]
    if isinstance(times, np.ndarray) and times.dtype.kind == "M":
        if np.isnat(times).any():
            raise InputError("times: must be times, got NaT")
        native = times.ravel().astype(times.dtype.newbyteorder("="))  # which datetime_as_string needs
        return [str(text) for text in np.datetime_as_string(native, unit="ns", casting="unsafe")]
    if not isinstance(times, Iterable):
        raise InputError(f"times: must be datetimes, datetime64 or texts, got {type(times).__name__}")
    return [_text_of(time) for time in times]


def _text_of(time: Any) -> str:
    if isinstance(time, str):
        return time
    if isinstance(time, np.datetime64):
        return _texts_of(np.array([time]))[0]
    if isinstance(time, datetime.datetime):
        utc = time.astimezone(datetime.timezone.utc) if time.tzinfo else time
        return utc.replace(tzinfo=None).isoformat()
    raise InputError(f"times: must be datetimes, datetime64 or texts, got {type(time).__name__}")
