"""The lines of detections.jsonl, frames.jsonl, truth.jsonl, tracks.jsonl and tasks.jsonl as the records of the same messages.

Their names say degrees and arcseconds, for people; records have the names and units of the messages.
"""
from __future__ import annotations

import datetime
import json
import math
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from .convert import numbers_of
from .records import LightCurve, LightPeriod, Record, Wcs, WcsRefraction

_ARCSEC = math.pi / 648000.0
# What the end of a name becomes, and the factor of the value.
_UNITS = (("_arcsec_per_s", "_rad_per_s", _ARCSEC), ("_arcsec2", "_rad2", _ARCSEC ** 2),
          ("_arcsec", "_rad", _ARCSEC), ("_deg", "_rad", math.pi / 180.0),
          ("_gcrs_m_per_s", "_m_per_s", 1.0), ("_gcrs_m", "_m", 1.0), ("_gcrs", "", 1.0))
_PARTS: dict[str, type[Record]] = {"light_curve": LightCurve, "period": LightPeriod}
_PLANES = ("TAN", "ARC", "ZEA", "STG", "ZPN")
_LENSES = ("gnomonic", "equidistant", "equisolid", "stereographic", "kannala_brandt", "brown_conrady")


def read_lines(path: pathlib.Path, cls: type[Record], start: datetime.datetime | None) -> Iterator[Any]:
    """The records of a file of lines. Raises ValueError with file and line for one that is none."""
    with path.open(encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            try:
                yield record_of_line(json.loads(line), cls, start)
            except (ValueError, TypeError, KeyError, AttributeError) as error:
                raise ValueError(f"{path}:{number}: not a {cls.__name__}: {error}") from None


def record_of_line(values: dict[str, Any], cls: type[Record], start: datetime.datetime | None) -> Any:
    """A record; what the line does not know (null) is 0, as in messages."""
    fields: dict[str, Any] = cls.__dataclass_fields__  # type: ignore[attr-defined]
    known: dict[str, Any] = {}
    for key, value in values.items():
        if key == "wcs":
            known[key] = _wcs(value) if value else None
        elif key in _PARTS and value is not None:
            known[key] = record_of_line(value, _PARTS[key], start)
        elif value is not None:
            for name, part in _named(key, value, fields):
                known[name] = part
    record = cls(**known)
    record.start_utc_of_run = start
    return record


def _named(key: str, value: Any, fields: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """The fields of a record that a key of a line stands for, none for what only people read."""
    if key in fields and key == "magnitude_system":
        yield key, value.lower().replace("-", "_")
    elif key in fields:
        texts = fields[key].default_factory is list
        yield key, numbers_of(value) if isinstance(value, list) and not texts else value
    elif key.endswith("_px") and isinstance(value, list):
        yield from zip((key[:-2] + "x_px", key[:-2] + "y_px"), value)
    for ending, name, factor in _UNITS:
        if key.endswith(ending) and (field := key.removesuffix(ending) + name) in fields:
            yield field, numbers_of(value) * factor if isinstance(value, list) else value * factor
            return


def _coefficients(values: dict[str, Any], others: set[str]) -> Any:
    return np.array([value for key, value in values.items() if key not in others and isinstance(value, float | int)],
                    dtype=np.float64)


def _wcs(values: dict[str, Any]) -> Wcs:
    lists = {name: numbers_of(values.get(name, [])) for name in ("a", "b", "ap", "bp")}
    return Wcs(
        crpix_x_px=values["crpix_px"][0], crpix_y_px=values["crpix_px"][1],
        ra_rad=math.radians(values["crval_deg"][0]), dec_rad=math.radians(values["crval_deg"][1]),
        cd_deg=numbers_of(values["cd_deg_per_px"]), order=values["order"],
        projection=_PLANES.index(values["projection"].removesuffix("-SIP")),
        coefficients=_coefficients(values, {"order", "rms_px", "max_px"}),
        rms_px=values["rms_px"], max_px=values["max_px"],
        refraction=_air(values["refraction"]) if "refraction" in values else None, **lists)


def _air(values: dict[str, Any]) -> WcsRefraction:
    numbers = ("focal_length_px", "pressure_hpa", "temperature_c", "humidity", "wavelength_um", "cell_px")
    return WcsRefraction(
        zenith=numbers_of(values["zenith"]),
        offset_x_px=values["offset_px"][0], offset_y_px=values["offset_px"][1],
        lens=_LENSES.index(values["lens"]) if "lens" in values else None,
        lens_coefficients=_coefficients(values, set(numbers)), **{name: values[name] for name in numbers})
