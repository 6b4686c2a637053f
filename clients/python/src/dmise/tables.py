"""Records as tables, of numpy and of pandas."""
from __future__ import annotations

import dataclasses
import html
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .display import MOST_ROWS, table_html
from .records import Record

if TYPE_CHECKING:
    import pandas

_AXES = {"sensor_position_m", "sensor_velocity_m_per_s", "refraction_offset_m", "position_m",
         "velocity_m_per_s"}
# Lists of numbers have three: vectors, and covariances of two quantities.
_LENGTHS = {"camera_from_gcrs": 4}
_VECTORS = ("_m", "_m_per_s", "_rad2", "_px2")


def to_pandas(records: Iterable[Record]) -> "pandas.DataFrame":
    """A DataFrame with a row per record and a column per number or text; needs pandas.

    Columns are named as fields: vectors `sensor_position_m_x`, `_y`, `_z`, other lists `covariance_rad2_0` and so on,
    parts of parts `wcs.rms_px`. Each time `X_ns` has `X_utc` beside it, if the run tells its start.
    """
    import pandas

    return pandas.DataFrame([_row(record) for record in records])


class Table(np.ndarray[Any, Any]):
    """A structured array: a row per record, a field per number or text of it, a vector per list of numbers."""

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)
        return found.view(np.ndarray) if isinstance(found, Table) and found.dtype.names is None else found

    def _repr_html_(self) -> str:
        """The first rows, in notebooks."""
        if self.dtype.names is None or self.ndim != 1:
            return f"<pre>{html.escape(repr(self))}</pre>"
        shown = np.asarray(self[:MOST_ROWS])
        columns = [name for name in self.dtype.names if self.dtype[name].shape != (0,)]
        return table_html(columns, ([row[name] for name in columns] for row in shown), f"{len(self)} rows")

    def to_pandas(self) -> "pandas.DataFrame":
        """A DataFrame with columns as those of `dmise.to_pandas`; needs pandas."""
        import pandas

        columns: dict[str, Any] = {}
        for name in self.dtype.names or ():
            values = np.asarray(self[name])
            if values.ndim == 1:
                columns[name] = values
            else:
                columns.update({f"{name}_{part}": values[:, i] for i, part in enumerate(_parts(name, values.shape[1]))})
        return pandas.DataFrame(columns)


def table_of(records: Sequence[Record], cls: type[Record]) -> Table:
    """A table of records of a class, which may be none.

    A list of numbers that a record lacks is zeros, a number that it lacks is NaN.
    """
    fields = [_field(name, records, cls()) for name in vars(cls())]
    table = np.zeros(len(records), dtype=fields)
    for name, *_ in fields:
        for i, record in enumerate(records):
            value = getattr(record, name)
            if np.size(value):
                table[name][i] = np.nan if value is None else value
    return table.view(Table)


def _field(name: str, records: Sequence[Record], usual: Record) -> tuple[Any, ...]:
    """A field of a table: its name, type and, of a list of numbers, length."""
    value = getattr(usual, name)
    if isinstance(value, np.ndarray):
        return name, np.float64, (_LENGTHS.get(name) or (3 if name.endswith(_VECTORS) else 0),)
    if isinstance(value, str):
        return name, f"U{max([1, *(len(getattr(record, name)) for record in records)])}"
    return name, {bool: np.bool_, int: np.int64, float: np.float64, type(None): np.float64}[type(value)]


def _parts(name: str, size: int) -> Iterable[str]:
    """What the columns of a list of numbers are called."""
    return "xyz" if name in _AXES else map(str, range(size))


def _row(record: Any, prefix: str = "") -> dict[str, Any]:
    row: dict[str, Any] = {}
    for field in dataclasses.fields(record):
        name, value = prefix + field.name, getattr(record, field.name)
        if dataclasses.is_dataclass(value):
            row.update(_row(value, name + "."))
        elif isinstance(value, np.ndarray):
            row.update({f"{name}_{part}": number
                        for part, number in zip(_parts(field.name, value.size), value.ravel().tolist())})
        elif not isinstance(value, list):
            row[name] = value
            if name.endswith("_ns") and record.start_utc_of_run is not None:
                row[name.removesuffix("ns") + "utc"] = record.utc(value)
    return row
