"""One published message: the frames as they came, what its envelope says, and its records."""
from __future__ import annotations

import datetime
import functools
from collections.abc import Sequence
from typing import Any

from . import protocol
from .convert import record_of, with_arrays

_READ_ERRORS = (ValueError, TypeError, KeyError, OverflowError)  # what wrong bytes may raise
try:
    from google.protobuf.message import DecodeError

    _READ_ERRORS += (DecodeError,)  # type: ignore[assignment]
except ImportError:
    pass


class Message:
    """`frames`: topic, envelope, payload and perhaps arrays, as received. Raises ValueError if they are no message."""

    def __init__(self, frames: Sequence[bytes], start_utc: datetime.datetime | None = None) -> None:
        if not 3 <= len(frames) <= 4:
            raise ValueError(f"a message has 3 or 4 frames, this one {len(frames)}")
        self.frames = list(frames)
        try:
            self.topic = frames[0].decode()
            self.envelope: Any = protocol.Envelope.FromString(frames[1])
        except _READ_ERRORS as error:
            raise ValueError(f"not a message of a run: {error}") from None
        if self.envelope.schema_version != protocol.SCHEMA_VERSION:
            raise ValueError(f"{self.topic}: schema version {self.envelope.schema_version}")
        self.start_utc_of_run = start_utc

    @property
    def tick(self) -> int:
        return int(self.envelope.tick)

    @property
    def sequence(self) -> int:
        """The publisher's count of its messages on this topic, from 1; 0 of a probe."""
        return int(self.envelope.sequence)

    @property
    def last_of_tick(self) -> bool:
        """Whether the topic is complete for this tick and all before."""
        return bool(self.envelope.last_of_tick)

    @property
    def has_content(self) -> bool:
        """False of a probe or a watermark."""
        return protocol.class_of_kind(self.envelope.kind) is not None

    @functools.cached_property
    def body(self) -> Any:
        """The payload as its message of Protocol Buffers, None of one without. Raises ValueError for wrong bytes."""
        cls = protocol.class_of_kind(self.envelope.kind)
        if cls is None:
            return None
        try:
            return cls.FromString(self.frames[2])
        except _READ_ERRORS as error:
            raise ValueError(f"{self.topic}: not a {cls.DESCRIPTOR.name}: {error}") from None

    @functools.cached_property
    def records(self) -> list[Any]:
        """The records of the message: each detection, truth or track of a set, else one or none."""
        if self.body is None:
            return []
        try:
            return records_in(self.body, self.frames[3] if len(self.frames) == 4 else b"", self.start_utc_of_run)
        except _READ_ERRORS as error:
            raise ValueError(f"{self.topic}: wrong arrays: {error}") from None


def records_in(body: Any, arrays: bytes, start_utc: datetime.datetime | None) -> list[Any]:
    """The records of a payload: each member of a set, else one. Raises ValueError or TypeError for wrong arrays."""
    if body.DESCRIPTOR.name.endswith("Set"):
        members = next(f.name for f in body.DESCRIPTOR.fields if f.message_type is not None)
        return [record_of(member, start_utc) for member in getattr(body, members)]
    record = record_of(body, start_utc)
    if arrays and hasattr(body, "arrays") and record is not body:
        with_arrays(record, body.arrays, arrays)
    return [record]
