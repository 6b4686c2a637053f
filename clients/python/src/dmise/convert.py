"""Messages to records, field by field by their names; a message without a record stays itself."""
from __future__ import annotations

import datetime
import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from . import records, world

RECORDS: dict[str, Any] = {cls.__name__: cls for module in (records, world) for cls in vars(module).values()
                           if isinstance(cls, type) and issubclass(cls, records.Record)}


def numbers_of(values: Any) -> records.Floats:
    return np.array(values, dtype=np.float64)


def start_of(start_utc: str) -> datetime.datetime | None:
    """The start of a run as time-masters and run.json tell it (ISO 8601); None if they do not."""
    if not start_utc:
        return None
    leap = ":60" in start_utc
    start = datetime.datetime.fromisoformat(start_utc.replace("Z", "+00:00").replace(":60", ":59"))
    return start.replace(fold=int(leap))


@functools.cache
def _converter(field: Any) -> Callable[[Any, datetime.datetime | None], Any] | None:
    """What turns the value of a message's field into that of a record's; None: nothing to do."""
    # Protocol Buffers 7 has no label, 4 has no is_repeated.
    repeated = field.is_repeated if hasattr(field, "is_repeated") else field.label == field.LABEL_REPEATED
    if field.message_type is not None:
        if repeated:
            return lambda values, start: [record_of(value, start) for value in values]
        return record_of
    if repeated and field.cpp_type == field.CPPTYPE_STRING:
        return lambda values, start: list(values)
    if repeated:
        return lambda values, start: numbers_of(values)
    if field.enum_type is not None:
        prefix = "".join("_" * c.isupper() + c.upper() for c in field.enum_type.name)[1:] + "_"
        names = {value.number: value.name.removeprefix(prefix).lower() for value in field.enum_type.values}
        return lambda value, start: names.get(value, str(value))
    return None


@functools.cache
def _plan(descriptor: Any) -> tuple[Any, list[Any]]:
    """The record of a kind of message, and its fields: (name, converter, whether it may be absent)."""
    cls = RECORDS[descriptor.name]
    return cls, [(field.name, _converter(field), field.has_presence)
                 for field in descriptor.fields if field.name in cls.__dataclass_fields__]


def record_of(message: Any, start: datetime.datetime | None = None) -> Any:
    """The record of a message of proto/dmise/v1, or the message itself if there is none."""
    if message.DESCRIPTOR.name not in RECORDS:
        return message
    cls, fields = _plan(message.DESCRIPTOR)
    values = {}
    for name, convert, optional in fields:
        if optional and not message.HasField(name):
            continue
        value = getattr(message, name)
        values[name] = value if convert is None else convert(value, start)
    record = cls(**values)
    record.start_utc_of_run = start
    return record


def arrays_of(layouts: Any, frame: bytes) -> dict[str, records.ArrayLike]:
    """The arrays of a message's fourth frame by name, without a copy. Raises ValueError if one does not fit."""
    return {layout.name: np.frombuffer(frame, dtype=np.dtype(layout.type).newbyteorder("<"),
                                       count=math.prod(layout.shape),
                                       offset=layout.offset_bytes).reshape(tuple(layout.shape))
            for layout in layouts}


def with_arrays(record: Any, layouts: Any, frame: bytes) -> Any:
    for name, array in arrays_of(layouts, frame).items():
        setattr(record, name, array)
    return record
