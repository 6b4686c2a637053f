"""Up to which tick every topic is complete, by what publishers say and by when they have nothing to say."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from .message import Message


class Completeness:
    """`last_tick`: of the run. `wanted`: whether a topic counts."""

    def __init__(self, last_tick: int, wanted: Callable[[str], bool]) -> None:
        self._last_tick, self._wanted = last_tick, wanted
        self._schedule: dict[str, tuple[int, int]] = {}  # period, offset
        self._through: dict[str, int] = {}
        self._closed: dict[str, int] = {}  # from this tick on

    def expect(self, publishers: Iterable[Any]) -> None:
        """The topics are those of the publishers of a Topology or of Endpoints."""
        for publisher in publishers:
            own = {s.topic: (s.period_ticks, s.offset_ticks) for s in publisher.schedules}
            for topic in [*publisher.topics, *publisher.direct_topics]:
                if self._wanted(topic):
                    period, offset = own.get(topic, (publisher.period_ticks, publisher.offset_ticks))
                    self._schedule[topic] = max(1, period), offset
                    self._through.setdefault(topic, offset - 1)

    def topics(self) -> list[str]:
        return sorted(self._schedule)

    def heard(self, message: Message) -> None:
        if message.last_of_tick and message.topic in self._schedule:
            # Nothing is said before the next tick at which the publisher works.
            period, _ = self._schedule[message.topic]
            self._raise(message.topic, message.tick + period - 1)

    def close(self, topic: str, from_tick: int) -> None:
        """Nothing is published on the topic from a tick on."""
        self._closed[topic] = from_tick
        self._raise(topic, -1)

    def _raise(self, topic: str, tick: int) -> None:
        if topic in self._schedule:
            tick = max(self._through[topic], tick)
            is_closed = tick + 1 >= self._closed.get(topic, self._last_tick + 1)
            self._through[topic] = self._last_tick if is_closed else tick

    def is_due(self, topic: str, after_tick: int, tick: int) -> bool:
        """Whether something is said on the topic after a tick, at `tick` or before."""
        if topic not in self._schedule or after_tick + 1 >= self._closed.get(topic, self._last_tick + 1):
            return False
        period, offset = self._schedule[topic]
        return offset + (max(after_tick - offset, -1) // period + 1) * period <= tick

    def through(self) -> int:
        """The last tick for which every topic is complete; -1: none, or no topic is known."""
        return min(self._last_tick, min(self._through.values(), default=-1))
