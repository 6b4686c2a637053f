"""Recording a run: everything that is on the wire into an MCAP file (docs/clients.md, Record and replay)."""
from __future__ import annotations

import os
import pathlib
import time
from dataclasses import dataclass, field
from typing import Any

from . import keys as keys_
from . import protocol, resend
from .convert import start_of
from .master import OVER
from .message import Message
from .recorded import CLOCK_CHANNEL, RUN_CHANNEL, SCHEMA, descriptors, pack
from .recording import mcap_modules
from .sequences import Gap
from .subscription import Subscription

CHUNK_BYTES, CHUNK_S = 1 << 20, 1.0  # a killed recorder loses at most one chunk
ENDLESS = (1 << 63) - 1


@dataclass
class Recorded:
    """What a recorder has written. `complete`: whether every topic is there from its first message to its last."""
    path: pathlib.Path
    messages: int = 0
    topics: dict[str, int] = field(default_factory=dict)  # messages, probes left out
    gaps: list[Gap] = field(default_factory=list)
    refused: int = 0
    phase: str = ""
    cause: str = ""

    @property
    def complete(self) -> bool:
        return not self.gaps and self.phase == "ended"

    def __str__(self) -> str:
        lost = sum(len(gap) for gap in self.gaps)
        told = f"{self.path}: {self.messages} messages of {len(self.topics)} topics, {lost} lost"
        if self.gaps:
            told += " (" + ", ".join(f"{g.topic} {g.first} to {g.last}" for g in self.gaps[:5]) + \
                (f" and {len(self.gaps) - 5} gaps more)" if len(self.gaps) > 5 else ")")
        return told + (f", {self.refused} refused" if self.refused else "") + \
            (f"; the run has failed: {self.cause}" if self.phase == "failed" else "") + \
            ("; the run was not over" if self.phase not in ("ended", "failed") else "")


class File:
    """The MCAP file while it grows, at `path`.part; `finish` gives it its name."""

    def __init__(self, path: pathlib.Path) -> None:
        self.path, self.part = path, path.with_name(path.name + ".part")
        self._mcap = mcap_modules()
        self._file = self.part.open("wb")
        self._writer = self._mcap.writer.Writer(self._file, chunk_size=CHUNK_BYTES, enable_data_crcs=True)
        # mcap ends a chunk by its size alone: of a slow run a killed recorder would lose hours.
        self._end_chunk = getattr(self._writer, "_Writer__finalize_chunk", lambda: None)
        self._ended_at = time.monotonic()
        self._writer.start(profile="dmise", library="dmise")
        self._descriptors = descriptors()
        self._schemas: dict[str, int] = {}
        self._channels: dict[tuple[str, str], int] = {}

    def add(self, channel: str, schema: str, time_ns: int, data: bytes, sequence: int = 0) -> None:
        """`time_ns`: UTC since 1970, of the simulation."""
        if schema not in self._schemas:
            self._schemas[schema] = self._writer.register_schema(schema, "protobuf", self._descriptors)
        key = channel, schema
        if key not in self._channels:
            self._channels[key] = self._writer.register_channel(channel, "protobuf", self._schemas[schema])
        at = max(0, time_ns)
        self._writer.add_message(self._channels[key], log_time=at, publish_time=at, data=data,
                                 sequence=sequence & 0xFFFFFFFF)

    def flush(self, older_than_s: float = CHUNK_S) -> None:
        """Ends the chunk if it is older, so that the file can be read up to here."""
        if time.monotonic() - self._ended_at >= older_than_s:
            self._end_chunk()
            self._file.flush()
            self._ended_at = time.monotonic()

    def finish(self, told: dict[str, str]) -> None:
        self._end_chunk()
        self._writer.add_metadata("dmise", told)
        self._writer.finish()
        self._file.flush()
        os.fsync(self._file.fileno())
        self._file.close()
        os.replace(self.part, self.path)


class Recorder(Subscription):
    """Records the run at `address` into `path`: call `record`. Options and errors as of `dmise.record`."""

    def __init__(self, address: str, path: str | pathlib.Path, *topics: str, truth: bool = False,
                 keys: str | pathlib.Path | None = None, name: str = "operator", answer_within_s: float = 3.0) -> None:
        mcap_modules()
        self.recorded = Recorded(pathlib.Path(path))
        if not self.recorded.path.absolute().parent.is_dir():
            raise FileNotFoundError(f"{self.recorded.path}: there is no such directory")
        self._file: File | None = None
        self._kept_of: set[tuple[str, int]] = set()  # topics and incarnations whose kept messages have been asked for
        self._waiting: list[tuple[str, str, int, bytes]] = []  # until there is a file
        self._last_run = b""
        self._rosters: dict[str, int] = {}  # sequence numbers by topic
        self._said: dict[tuple[str, int], int] = {}  # last sequence number by the manifests
        wanted = (*(topics or ("",)), *(("truth/",) if truth else ()))
        super().__init__(address, wanted, keys_.Keys(keys, name) if keys else None, False, answer_within_s)

    def record(self) -> Recorded:
        """Records until the run is over, or `close` is called; the file is whole then."""
        self._file = File(self.recorded.path)
        try:
            while not self.over:
                message = self.receive(0.2)
                for entry in self._waiting:
                    self._file.add(*entry)
                self._waiting.clear()
                if message is not None:
                    self._add(message)
                self._file.flush()
        finally:
            self._end(self._file)
        return self.recorded

    def _add(self, message: Message) -> None:
        assert self._file is not None
        self._file.add(message.topic, SCHEMA, self._utc_ns(message.envelope.time_ns), pack(message), message.sequence)
        self.recorded.messages += 1
        self.recorded.topics[message.topic] = self.recorded.topics.get(message.topic, 0) + (message.sequence > 0)

    def _end(self, file: File) -> None:
        for (topic, incarnation), last in self._said.items() if self.run.phase in OVER else ():
            following = self._sequences.following(topic, incarnation)
            if following <= last:
                self._note(topic, following, last)
        phase = protocol.Phase.Name(self.run.phase).removeprefix("PHASE_").lower()
        self.recorded.gaps, self.recorded.refused = self.gaps, self.refused
        self.recorded.phase, self.recorded.cause = phase, self.run.cause
        file.add(RUN_CHANNEL, "dmise.v1.Endpoints", self._utc_ns(max(0, self.run.granted_tick) * self.run.tick_ns),
                 self.run.SerializeToString())
        file.finish({"phase": phase, "lost": str(sum(len(gap) for gap in self.gaps)),
                     "gaps": " ".join(f"{g.topic}:{g.first}-{g.last}" for g in self.gaps)})

    def _utc_ns(self, time_ns: int) -> int:
        start = start_of(self.run.start_utc)
        return time_ns + (int(start.timestamp()) * 10**9 + start.microsecond * 1000 if start else 0)

    def _adopt(self, endpoints: Any) -> None:
        super()._adopt(endpoints)
        same = type(self.run)(run_id=self.run.run_id, phase=self.run.phase, publishers=self.run.publishers,
                              observe_endpoint=self.run.observe_endpoint).SerializeToString()
        if same != self._last_run:
            self._last_run = same
            at = self._utc_ns(max(0, self.run.granted_tick) * self.run.tick_ns)
            self._waiting.append((RUN_CHANNEL, "dmise.v1.Endpoints", at, self.run.SerializeToString()))
        if self.run.phase == protocol.PHASE_RUNNING:
            self._fetch_kept()

    def _fetch_kept(self) -> None:
        """What publishers have said before this recorder was there, as far as they still keep it. Asks once for each."""
        asked = []
        for publisher in self.run.publishers:
            topics = [topic for topic in [*publisher.topics, *publisher.direct_topics]
                      if self._wanted(topic) and (topic, publisher.incarnation) not in self._kept_of
                      and not self._sequences.following(topic, publisher.incarnation)]
            self._kept_of.update((topic, publisher.incarnation) for topic in topics)
            if topics and publisher.resend_endpoint:
                asked.append((publisher, topics))
        for message in resend.kept(self._context, self._keys, asked, self.run.run_id) if asked else ():
            self._accept(message)

    def _accept(self, message: Message) -> None:
        incarnation = message.envelope.incarnation
        if message.sequence > 1 and not self._sequences.following(message.topic, incarnation):
            self._fetch_kept()
            if incarnation == 1 and not self._sequences.following(message.topic, incarnation):
                self._note(message.topic, self._rosters.get(message.topic, 0) + 1, message.sequence - 1)
        super()._accept(message)

    def _deliver(self, message: Message) -> None:
        if message.envelope.kind == protocol.KIND_OBJECT_ROSTER:  # it comes out of turn to who is late
            self._rosters[message.topic] = message.sequence
        super()._deliver(message)

    def _hear_grant(self, grant: Any, frame: bytes) -> None:
        super()._hear_grant(grant, frame)
        for tally in grant.published:
            if self._wanted(tally.topic):
                self._said[tally.topic, tally.incarnation] = tally.last_sequence
        self._waiting.append((CLOCK_CHANNEL, "dmise.v1.Grant", self._utc_ns(max(0, grant.tick) * self.run.tick_ns), frame))


def record(address: str, path: str | pathlib.Path, *topics: str, truth: bool = False,
           keys: str | pathlib.Path | None = None, name: str = "operator", answer_within_s: float = 3.0) -> Recorded:
    """Records the run whose time-master is at `address` into an MCAP file until the run is over; needs mcap.

    path      of the file; while it grows it is `path`.part
    topics    as of `subscribe`; none: all but truth
    truth     truth as well
    keys, name, answer_within_s   as of `subscribe`

    Raises NoAnswer without a time-master, ValueError for an address or key that is none, OSError for a file that cannot
    be written. A run that fails is recorded, too; `gaps` of the result are messages that were lost.
    """
    return Recorder(address, path, *topics, truth=truth, keys=keys, name=name, answer_within_s=answer_within_s).record()
