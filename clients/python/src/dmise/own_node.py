"""Models of one's own in a run: `actor` marks what moves objects, `serve` runs it, a detector, a sensor or a tracker
(docs/howto/plug-in-a-model.md).

    @dmise.actor("inspector")
    def orbit(t_s, world, options):
        return dmise.State(position_m=.., velocity_m_per_s=..)
    dmise.serve(orbit)
"""
from __future__ import annotations

import asyncio
import datetime
import functools
import inspect
import json
import os
import sys
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import zmq

from . import own_detector, own_sensor, own_tracker, protocol
from .convert import record_of, start_of
from .message import records_in
from .own_detector import Detector
from .own_sensor import Observer
from .own_served import Served
from .own_states import StatesWriter
from .own_tracker import Known, Tracker
from .topics import is_wanted
from .world import EnvironmentState, ObjectRoster, ObjectStates

ADDRESS_VARIABLE = "DMISE_OWN_NODE"
LONGEST_REQUEST_BYTES = 1 << 30  # frames of 500 Mpx
LINGER_MS = 1000  # for the last answer
HELD_ANSWERS, HELD_S = 32, 0.001  # answers of quick steps go together: each message that goes alone wakes three threads


@dataclass
class World:
    """What a model is told with a tick."""
    tick: int
    time_ns: int
    environment_bytes: bytes = field(repr=False)
    start_utc: datetime.datetime | None = field(repr=False)
    node: str = ""
    objects: list[str] = field(default_factory=list)  # those that it moves or turns, in the order of arrays
    seed: int = 0  # of the scenario
    known: Known = field(default_factory=Known)  # to a tracker
    messages: tuple[Any, ...] = field(default=(), repr=False)  # that came since the last tick, OwnNodeHeard each
    truth: ObjectStates | None = field(default=None, repr=False)  # of all objects at mid exposure, to a sensor with `truth: on`

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

    def __init__(self, model: Callable[..., Any], names: tuple[str, ...]) -> None:
        super().__init__(model)
        self.names = list(names)


def actor(*names: str) -> Callable[[Callable[..., Any]], Actor]:
    """Marks a function or class that moves or turns the objects of these names; without names, whatever the scenario gives it."""
    return lambda model: Actor(model, names)


def serve(model: Actor | Detector | Observer | Tracker) -> None:
    """Says what `model` says, tick by tick or frame by frame, to the run that has started this program, until the run ends."""
    if not isinstance(model, Served):
        raise TypeError(f"serve: takes what @dmise.actor(..), @dmise.detector, @dmise.sensor or @dmise.tracker marks, got "
                        f"{type(model).__name__}")
    address = os.environ.get(ADDRESS_VARIABLE)
    if not address:
        sys.exit(f"{ADDRESS_VARIABLE} is not set: this program is started by a scenario with "
                 "nodes: [{name: .., run: [python3, ..]}], or by dmise join SCENARIO NAME --program 'python3 ..'")
    try:
        _Conversation(address, model).run()
    except _Failed:
        sys.exit(1)


class _Failed(Exception):
    """The model can't go on, and the run has been told."""


class _Conversation:
    def __init__(self, address: str, served: Actor | Detector | Observer | Tracker) -> None:
        self._served = served
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.PAIR)
        self._socket.maxmsgsize = LONGEST_REQUEST_BYTES
        self._socket.reconnect_ivl = -1
        self._lost = self._socket.get_monitor_socket(zmq.EVENT_DISCONNECTED)
        self._socket.connect(address)
        self._poller = zmq.Poller()
        self._poller.register(self._socket, zmq.POLLIN)
        self._poller.register(self._lost, zmq.POLLIN)
        self._lock = threading.Lock()  # of the socket while the model works
        self._working = False
        self._held: list[list[bytes]] = []  # answers; the other thread's while the model works, as the socket is
        self._held_since_s = 0.0
        self._over = threading.Event()
        if hasattr(sys.stdout, "reconfigure"):
            sys.stdout.reconfigure(line_buffering=True)  # what it prints is in the log at once

    def run(self) -> None:
        try:
            while (frames := self._next()) is not None:
                request = protocol.OwnNodeRequest.FromString(frames[0])
                if request.HasField("end"):
                    return
                self._set_working(True)
                self._answer(request, frames[1:])
        finally:
            self._over.set()
            self._set_working(False)
            self._send_held()
            self._socket.disable_monitor()
            self._context.destroy(linger=LINGER_MS)

    def _next(self) -> list[bytes] | None:
        """The next request; None if the run is gone."""
        try:
            return self._socket.recv_multipart(zmq.NOBLOCK)
        except zmq.Again:
            self._send_held()
        ready = dict(self._poller.poll())
        return self._socket.recv_multipart() if self._socket in ready else None

    def _answer(self, request: Any, more: list[bytes]) -> None:
        try:
            body = request.WhichOneof("body")
            if body == "begin":
                frames = self._begin(request.begin, more)
            elif body == "frame":
                frames = self._search(request.frame, more[0])
            elif body == "observe":
                frames = self._observe(request.observe, more)
            elif body == "track":
                frames = self._track(request.track, more)
            else:
                frames = self._step(request.step, more[0])
        except Exception as error:
            traceback.print_exc()
            self._send([protocol.OwnNodeAnswer(failed=_text_of(error, self._served)).SerializeToString()])
            raise _Failed from error
        self._send(frames)

    def _send(self, frames: list[bytes]) -> None:
        self._set_working(False)
        now_s = time.monotonic()
        if not self._held:
            self._held_since_s = now_s
        self._held.append(frames)
        if len(self._held) == HELD_ANSWERS or now_s - self._held_since_s > HELD_S:
            self._send_held()

    def _send_held(self) -> None:
        for frames in self._held:
            self._socket.send_multipart(frames)
        self._held.clear()

    def _set_working(self, working: bool) -> None:
        with self._lock:
            self._working = working

    def _show_life(self, every_s: float) -> None:
        alive = protocol.OwnNodeAnswer(alive=protocol.OwnNodeAlive()).SerializeToString()
        while not self._over.wait(every_s):
            with self._lock:
                if self._working:
                    self._send_held()
                    self._socket.send(alive)

    def _begin(self, begin: Any, more: list[bytes]) -> list[bytes]:
        if begin.schema_version != protocol.SCHEMA_VERSION:
            raise ValueError(f"the run has schema version {begin.schema_version}, this package {protocol.SCHEMA_VERSION}")
        threading.Thread(target=self._show_life, args=(begin.alive_every_s,), daemon=True).start()
        self._begun = begin
        self._start = start_of(begin.start_utc)
        self._objects = [each.name for each in begin.objects]
        self._states = StatesWriter(begin.objects)
        self._options = json.loads(begin.options_json)
        self._known = own_tracker.known_of(begin.tracking, more, self._start) if begin.HasField("tracking") else Known()
        self._roster = own_sensor.roster_of(more, self._start) if begin.HasField("observing") else ObjectRoster()
        self._require_role()
        self._model = self._served.make()
        if begin.HasField("checkpoint"):
            self._model.restore(begin.checkpoint)
        return [protocol.OwnNodeAnswer(ready=protocol.OwnNodeReady()).SerializeToString()]

    def _require_role(self) -> None:
        """What the program does is what the scenario has it do."""
        served, begun = self._served, self._begun
        roles = ((Detector, "detects"), (Tracker, "tracks"), (Observer, "observes"), (Actor, "moves objects"))
        does = next(role for kind, role in roles if isinstance(served, kind))
        wanted = f"detect in the frames of {begun.sensor}" if begun.HasField("sensor") else \
            "track" if begun.HasField("tracking") else \
            f"observe as {begun.observing.sensor.name}" if begun.HasField("observing") else f"move {', '.join(self._objects)}"
        if does.split()[0].rstrip("s") != wanted.split()[0]:
            raise ValueError(f"the program {does}, the scenario has it {wanted}")
        if isinstance(served, Actor) and served.names and sorted(served.names) != sorted(self._objects):
            raise ValueError(f"the program moves {', '.join(served.names)}, the scenario has it {wanted}")

    def _search(self, frame: Any, counts: bytes) -> list[bytes]:
        said = self._said_by(own_detector.frame_of(frame, counts, self._begun.node), self._options)
        return [protocol.OwnNodeAnswer(found=own_detector.packed(said)).SerializeToString()]

    def _said_by(self, *arguments: Any) -> Any:
        said = self._model(*arguments)
        return asyncio.run(_result_of(said)) if inspect.isawaitable(said) else said

    def _world(self, at: Any, environment: bytes, messages: tuple[Any, ...] = ()) -> World:
        return World(at.tick, at.time_ns, environment, self._start, self._begun.node, self._objects, self._begun.seed,
                     self._known, messages)

    def _checkpoint(self, asked: Any, answer: Any) -> None:
        if asked.give_checkpoint and hasattr(self._model, "checkpoint"):
            answer.checkpoint = self._model.checkpoint()

    def _step(self, step: Any, environment: bytes) -> list[bytes]:
        said = self._said_by(step.time_ns / 1e9, self._world(step, environment, tuple(step.heard)), self._options)
        stepped = protocol.OwnNodeStepped()
        self._checkpoint(step, stepped)
        return [protocol.OwnNodeAnswer(stepped=stepped).SerializeToString(), *self._states.frames(said, step.tick, step.time_ns)]

    def _observe(self, asked: Any, more: list[bytes]) -> list[bytes]:
        exposure = own_sensor.exposure_of(asked)
        world = World(asked.tick, asked.middle_ns, more[0], self._start, self._begun.node, seed=self._begun.seed,
                      truth=own_sensor.truth_of(more[1:], self._roster, self._start))
        said = self._said_by(exposure, world, self._options)
        return [protocol.OwnNodeAnswer(observed=own_sensor.packed(said, exposure)).SerializeToString()]

    def _track(self, track: Any, more: list[bytes]) -> list[bytes]:
        frames = own_tracker.frames_of(more[1:], self._start)
        said = self._said_by(track.time_ns / 1e9, frames, self._world(track, more[0]), self._options)
        tracked, tracks = own_tracker.packed(said, track.tick, track.time_ns)
        self._checkpoint(track, tracked)
        return [protocol.OwnNodeAnswer(tracked=tracked).SerializeToString(), tracks.SerializeToString()]


async def _result_of(said: Any) -> Any:
    return await said


def _text_of(error: Exception, served: Served) -> str:
    """"ValueError: no orbit (gnc.py:12)": the last line that is not of this package, else where the model is defined."""
    here = os.path.dirname(__file__)
    lines = [f"{os.path.basename(frame.filename)}:{frame.lineno}" for frame in traceback.extract_tb(error.__traceback__)
             if os.path.dirname(frame.filename) != here] or served.places()
    return f"{type(error).__name__}: {error}" + (f" ({lines[-1]})" if lines else "")
