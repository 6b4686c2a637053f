"""Who has published how much on each topic: what is new, what comes twice, what is missing."""
from __future__ import annotations

from dataclasses import dataclass

from .message import Message


@dataclass(frozen=True)
class Gap:
    """Messages of a topic that have not come: sequence numbers `first` to `last` of its publisher."""
    topic: str
    first: int
    last: int

    def __len__(self) -> int:
        return self.last - self.first + 1


class Sequences:
    """The next sequence number of each topic. A process that replaces its publisher begins again at 1."""

    def __init__(self) -> None:
        self._next: dict[str, tuple[int, int]] = {}  # incarnation, sequence

    def following(self, topic: str, incarnation: int) -> int:
        """The number after the last that came of a publisher's process; 0: none came."""
        known, following = self._next.get(topic, (0, 0))
        return following if known == incarnation else 0

    def gap_before(self, message: Message) -> Gap | None:
        """What is missing before a message; nothing before the first of a topic, nor of another incarnation."""
        incarnation, following = self._next.get(message.topic, (0, 0))
        if incarnation != message.envelope.incarnation or message.sequence <= following:
            return None
        return Gap(message.topic, following, message.sequence - 1)

    def is_new(self, message: Message) -> bool:
        """Whether the message comes for the first time. Counts it."""
        incarnation, following = self._next.get(message.topic, (0, 0))
        envelope = message.envelope
        if envelope.incarnation < incarnation or \
                envelope.incarnation == incarnation and message.sequence < following:
            return False
        self._next[message.topic] = (envelope.incarnation, message.sequence + 1)
        return True
