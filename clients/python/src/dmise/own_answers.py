"""What a model of one's own answers to the requests of a run, wherever these come from (proto/dmise/v1/own_node.proto)."""
from __future__ import annotations

import asyncio
import concurrent.futures
import inspect
import json
import os
import traceback
from typing import Any

from . import own_detector, own_sensor, own_tracker, protocol
from .convert import start_of
from .own_detector import Detector
from .own_node import Actor, World
from .own_sensor import Observer
from .own_served import Served
from .own_states import StatesWriter
from .own_tracker import Known, Tracker
from .world import ObjectRoster


class ModelAnswers:
    """The answers of one model, which is made by `begin`.

    in_model  whether what was raised last was raised by the model, not by what checks its answer
    """

    def __init__(self, served: Served) -> None:
        self._served = served
        self.in_model = False

    def to(self, request: Any, more: list[bytes]) -> list[bytes]:
        """The frames of the answer to an OwnNodeRequest, the first an OwnNodeAnswer. `more`: the frames after the request.

        Raises what the model raises, and TypeError or ValueError for what is no answer.
        """
        body = request.WhichOneof("body")
        if body == "begin":
            return self._begin(request.begin, more)
        if body == "frame":
            return self._search(request.frame, more[0])
        if body == "observe":
            return self._observe(request.observe, more)
        if body == "track":
            return self._track(request.track, more)
        return self._step(request.step, more[0])

    def _begin(self, begin: Any, more: list[bytes]) -> list[bytes]:
        if begin.schema_version != protocol.SCHEMA_VERSION:
            raise ValueError(f"the run has schema version {begin.schema_version}, this package {protocol.SCHEMA_VERSION}")
        self._begun = begin
        self._start = start_of(begin.start_utc)
        self._objects = [each.name for each in begin.objects]
        self._states = StatesWriter(begin.objects)
        self._options = json.loads(begin.options_json)
        self._known = own_tracker.known_of(begin.tracking, more, self._start) if begin.HasField("tracking") else Known()
        self._roster = own_sensor.roster_of(more, self._start) if begin.HasField("observing") else ObjectRoster()
        self._require_role()
        self.in_model = True
        self._model = self._served.make()
        if begin.HasField("checkpoint"):
            self._model.restore(begin.checkpoint)
        self.in_model = False
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
        self.in_model = True
        said = self._model(*arguments)
        if inspect.isawaitable(said):
            said = _awaited(said)
        self.in_model = False
        return said

    def _world(self, at: Any, environment: bytes, messages: tuple[Any, ...] = ()) -> World:
        return World(at.tick, at.time_ns, environment, self._start, self._begun.node, self._objects, self._begun.seed,
                     self._known, messages)

    def _checkpoint(self, asked: Any, answer: Any) -> None:
        if asked.give_checkpoint and hasattr(self._model, "checkpoint"):
            self.in_model = True
            kept = self._model.checkpoint()
            self.in_model = False
            answer.checkpoint = kept

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


def _awaited(said: Any) -> Any:
    """The result of a coroutine, also where an event loop calls this, as of a notebook."""
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return asyncio.run(_result_of(said))
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, _result_of(said)).result()


async def _result_of(said: Any) -> Any:
    return await said


def failure(error: Exception, served: Served) -> list[bytes]:
    """The frames of the answer that a model can't go on."""
    return [protocol.OwnNodeAnswer(failed=_text_of(error, served)).SerializeToString()]


def _text_of(error: Exception, served: Served) -> str:
    """"ValueError: no orbit (gnc.py:12)": the last line that is not of this package, else where the model is defined."""
    here = os.path.dirname(__file__)
    lines = [f"{os.path.basename(frame.filename)}:{frame.lineno}" for frame in traceback.extract_tb(error.__traceback__)
             if os.path.dirname(frame.filename) != here] or served.places()
    return f"{type(error).__name__}: {error}" + (f" ({lines[-1]})" if lines else "")
