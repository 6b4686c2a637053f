"""Records as a table of pandas."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from .records import Record

if TYPE_CHECKING:
    import pandas

_AXES = {"sensor_position_m", "sensor_velocity_m_per_s", "refraction_offset_m", "position_m",
         "velocity_m_per_s"}


def to_pandas(records: Iterable[Record]) -> "pandas.DataFrame":
    """A DataFrame with a row per record and a column per number or text; needs pandas.

    Columns are named as fields: vectors `sensor_position_m_x`, `_y`, `_z`, other lists `covariance_rad2_0` and so on,
    parts of parts `wcs.rms_px`. Each time `X_ns` has `X_utc` beside it, if the run tells its start.
    """
    import pandas

    return pandas.DataFrame([_row(record) for record in records])


def _row(record: Any, prefix: str = "") -> dict[str, Any]:
    row: dict[str, Any] = {}
    for field in dataclasses.fields(record):
        name, value = prefix + field.name, getattr(record, field.name)
        if dataclasses.is_dataclass(value):
            row.update(_row(value, name + "."))
        elif isinstance(value, np.ndarray):
            names = "xyz" if field.name in _AXES else map(str, range(value.size))
            row.update({f"{name}_{part}": number for part, number in zip(names, value.ravel().tolist())})
        elif not isinstance(value, list):
            row[name] = value
            if name.endswith("_ns") and record.start_utc_of_run is not None:
                row[name.removesuffix("ns") + "utc"] = record.utc(value)
    return row
