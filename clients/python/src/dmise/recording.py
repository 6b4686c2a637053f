"""A recording of a run: an MCAP file of everything that was on the wire (docs/clients.md, Record and replay)."""
from __future__ import annotations

import logging
import pathlib
from collections.abc import Iterator
from typing import Any

from . import protocol
from .convert import start_of
from .message import Message
from .recorded import CLOCK_CHANNEL, RUN_CHANNEL, SCHEMA, unpack
from .topics import is_wanted
from .world import ObjectRoster

log = logging.getLogger("dmise")
LONGEST_RECORD_BYTES = 1 << 30


def mcap_modules() -> Any:
    """The package mcap. Raises ImportError that says how to get it."""
    try:
        import mcap.exceptions
        import mcap.records
        import mcap.stream_reader
        import mcap.writer
    except ImportError as missing:
        raise ImportError(f"{missing.name}: not installed; recordings need mcap: pip install mcap",
                          name=missing.name) from None
    return mcap


class Recording:
    """What was recorded; iterate for records, in order of arrival. It may be read several times.

    run       what the time-master said last, an `Endpoints`; as of the beginning until the file has been read
    finished  whether its recorder has ended the file; known when it has been read, and False of one that was killed
    roster    the last ObjectRoster that was read
    """

    def __init__(self, path: str | pathlib.Path) -> None:
        self.path = pathlib.Path(path)
        self.finished = False
        self.roster: ObjectRoster | None = None
        self.run: Any = None
        self._cut_at = -1
        beginning = self.everything()
        while self.run is None and next(beginning, None) is not None:
            pass
        beginning.close()  # type: ignore[attr-defined]
        if self.run is None:
            raise ValueError(f"{self.path}: not a recording of a run: it does not say of which")

    def __iter__(self) -> Iterator[Any]:
        for message in self.messages():
            records = message.records if message.has_content else []
            for record in records:
                if isinstance(record, ObjectRoster):
                    self.roster = record
                elif hasattr(record, "roster"):
                    record.roster = self.roster
                yield record

    def messages(self, *topics: str) -> Iterator[Message]:
        """Messages with probes and watermarks, of topics as in `subscribe`; none: of all. Errors as of `everything`."""
        for channel, item in self.everything():
            if isinstance(item, Message) and (not topics or is_wanted(topics, channel)):
                yield item

    def everything(self) -> Iterator[tuple[str, Any]]:
        """(channel, Message, Endpoints or Grant) in order of arrival. Raises ValueError with the file for a damaged one."""
        modules = mcap_modules()
        start = None
        for channel, schema, data in self._raw(modules):
            try:
                if channel == RUN_CHANNEL and schema == "dmise.v1.Endpoints":
                    item = self.run = protocol.Endpoints.FromString(data)
                    start = start_of(self.run.start_utc)
                elif channel == CLOCK_CHANNEL and schema == "dmise.v1.Grant":
                    item = protocol.Grant.FromString(data)
                elif schema == SCHEMA:
                    item = Message(unpack(channel, data), start)
                else:
                    continue  # somebody else's
            except Exception as error:  # whatever a library makes of wrong bytes
                raise ValueError(f"{self.path}: damaged: {channel}: {error}") from None
            yield channel, item

    def _raw(self, modules: Any) -> Iterator[tuple[str, str, bytes]]:
        """(channel, schema, data) of messages. The index at the end is not used: a file whose recorder was killed has none."""
        schemas: dict[int, str] = {}
        channels: dict[int, tuple[str, str]] = {}
        records = modules.records
        self.finished = False
        read = 0
        with self.path.open("rb") as file:
            stream = modules.stream_reader.StreamReader(file, validate_crcs=True, record_size_limit=LONGEST_RECORD_BYTES)
            source = iter(stream.records)
            while True:
                at = file.tell()
                try:
                    record = next(source)
                    if isinstance(record, records.Schema):
                        schemas[record.id] = record.name
                    elif isinstance(record, records.Channel):
                        channels[record.id] = record.topic, schemas.get(record.schema_id, "")
                    elif isinstance(record, records.Message):
                        channel, schema = channels[record.channel_id]
                except StopIteration:
                    self.finished = True
                    return
                except Exception as error:  # whatever a library makes of wrong bytes
                    if self._is_cut(at):
                        if self._cut_at != at:
                            self._cut_at = at
                            log.warning("%s: not finished: it ends after message %d", self.path, read)
                        return
                    reason = str(error) or "it ends early"
                    raise ValueError(f"{self.path}: not an MCAP file: {reason}" if not at else
                                     f"{self.path}: damaged after byte {at}: {reason}") from None
                if isinstance(record, records.Message):
                    read += 1
                    yield channel, schema, record.data

    def _is_cut(self, at: int) -> bool:
        """Whether the file was not finished, and its last record is the one at a place."""
        with self.path.open("rb") as file:
            magic = file.read(8)
            size = file.seek(0, 2)
            file.seek(max(0, size - 8))
            if file.read() == magic:
                return False
            file.seek(at)
            head = file.read(9)  # opcode, length
        return at > 0 and (len(head) < 9 or at + 9 + int.from_bytes(head[1:], "little") > size)


def open_recording(path: str | pathlib.Path) -> Recording:
    """Opens a file of `dmise.record`. Raises FileNotFoundError, or ValueError if it is none or damaged."""
    return Recording(path)
