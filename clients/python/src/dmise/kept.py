"""What the publishers of a replay keep for observers that have missed messages (docs/wire.md, Missing messages)."""
from __future__ import annotations

import collections
from collections.abc import Iterator
from typing import Any

from . import protocol
from .message import Message
from .seal import sealed

KEEP_BYTES = 64 << 20


class Kept:
    """The newest messages of each topic, KEEP_BYTES in all, and rosters, which hold for the whole run.

    closed: topics that nothing more is said on, `ClosedTopic`
    """

    def __init__(self, run: Any) -> None:
        self.closed: list[Any] = []
        self._run = run
        self._retained: dict[str, list[Message]] = {}
        self._topics: dict[str, collections.deque[Message]] = collections.defaultdict(collections.deque)
        self._order: collections.deque[str] = collections.deque()
        self._bytes = 0

    def add(self, message: Message) -> None:
        if message.sequence == 0:
            return
        if message.envelope.kind == protocol.KIND_OBJECT_ROSTER:
            self._retained.setdefault(message.topic, []).append(message)
        self._topics[message.topic].append(message)
        self._order.append(message.topic)
        self._bytes += sum(map(len, message.frames))
        while self._bytes > KEEP_BYTES:
            oldest = self._topics[self._order.popleft()].popleft()
            self._bytes -= sum(map(len, oldest.frames))

    def answer(self, peer: bytes, request: bytes = b"") -> Iterator[list[bytes]]:
        """Replies to a ResendRequest."""
        try:
            asked = protocol.ResendRequest.FromString(request)
        except Exception:  # whatever a library makes of wrong bytes
            return
        if asked.run_id != self._run.run_id or asked.topic not in self._topics:
            return
        messages = list(self._topics[asked.topic])
        if asked.catch_up:
            messages = [m for m in messages if m.tick >= asked.from_tick
                        and m.envelope.kind != protocol.KIND_OBJECT_ROSTER]
            for message in self._retained.get(asked.topic, []):
                yield [peer, *message.frames]
            yield [peer, *self._position(asked, messages)]
        for message in messages:
            if asked.catch_up or message.sequence >= asked.from_sequence:
                yield [peer, *message.frames]

    def _position(self, asked: Any, messages: list[Message]) -> list[bytes]:
        newest = self._topics[asked.topic][-1].envelope if self._topics[asked.topic] else protocol.Envelope()
        first = messages[0] if messages else None
        tick = first.tick if first else max(newest.tick + 1, asked.from_tick)
        return sealed(asked.topic, protocol.Envelope(
            schema_version=protocol.SCHEMA_VERSION, run_id=self._run.run_id, publisher=newest.publisher,
            incarnation=newest.incarnation, kind=protocol.KIND_POSITION, tick=tick, time_ns=tick * self._run.tick_ns,
            sequence=first.sequence if first else newest.sequence + 1))
