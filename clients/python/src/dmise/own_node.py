"""Models of one's own in a run: `actor` marks what moves objects; `dmise.serve` runs it, `dmise.Simulation` calls it in its process
(docs/howto/plug-in-a-model.md).

    @dmise.actor("inspector")
    def orbit(t_s, world, options):
        return dmise.State(position_m=.., velocity_m_per_s=..)
    dmise.serve(orbit)
"""
from __future__ import annotations

import datetime
import functools
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from . import protocol
from .convert import record_of
from .message import records_in
from .own_served import Served
from .own_tracker import Known
from .topics import is_wanted
from .world import EnvironmentState, ObjectStates


@dataclass
class World:
    """What a model is told with a tick."""
    tick: int
    time_ns: int
    environment_bytes: bytes = field(repr=False)
    start_utc: datetime.datetime | None = field(repr=False)
    node: str = ""
    objects: list[str] = field(default_factory=list)  # those that it moves or turns, in the order of arrays
    seed: int = 0  # seed of the scenario
    known: Known = field(default_factory=Known)  # to a tracker
    messages: tuple[Any, ...] = field(default=(), repr=False)  # that came since the last tick, OwnNodeHeard each
    truth: ObjectStates | None = field(default=None, repr=False)  # all objects at mid exposure, to a sensor with `truth: on`

    @functools.cached_property
    def topics(self) -> dict[str, list[Any]]:
        """What came since the last tick by its topic, as the records of `dmise.subscribe`; read when it is asked for."""
        topics: dict[str, list[Any]] = {}
        for one in self.messages:
            body = protocol.class_of_kind(one.kind).FromString(one.payload)
            topics.setdefault(one.topic, []).extend(records_in(body, one.arrays, self.start_utc))
        return topics

    def heard(self, topic: str) -> list[Any]:
        """The records of a topic, or of all that begin so: "detection/"."""
        return [record for name, records in self.topics.items() if is_wanted([topic], name) for record in records]

    @functools.cached_property
    def environment(self) -> EnvironmentState:
        """Sun, Moon and Earth at the tick; read when it is asked for."""
        state: EnvironmentState = record_of(protocol.EnvironmentState.FromString(self.environment_bytes), self.start_utc)
        return state

    @property
    def time_utc(self) -> datetime.datetime:
        return self.environment.time_utc


class Actor(Served):
    """A model that says where objects are: a function `f(t_s, world, options)`, or a class whose instances are called so.

    A class may have `checkpoint() -> bytes` and `restore(bytes)`; else what it remembers is made again from the first tick.
    """

    mark = "actor"

    def __init__(self, model: Callable[..., Any], names: tuple[str, ...]) -> None:
        super().__init__(model)
        self.names = list(names)


def actor(*names: str) -> Callable[[Callable[..., Any]], Actor]:
    """Marks a function or class that moves or turns the objects of these names; without names, whatever the scenario gives it."""
    return lambda model: Actor(model, names)
