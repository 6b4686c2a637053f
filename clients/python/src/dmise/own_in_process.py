"""Models of one's own that a simulation calls in its process (docs/python.md, Models of your own)."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import protocol
from .errors import ScenarioError
from .own_answers import ModelAnswers, failure
from .own_detector import Detector
from .own_node import Actor
from .own_served import Served

MARKS: dict[str, type[Served]] = {"actor": Actor, "detector": Detector}


def checked_models(own_nodes: list[tuple[str, str, str, list[str]]], given: Mapping[str, Any]) -> dict[str, Served]:
    """The model of each node: name, place in the scenario, mark and objects. Raises ScenarioError for one that is not its model."""
    models: dict[str, Served] = {}
    given = {str(name): model for name, model in given.items()}
    for name, where, mark, objects in own_nodes:
        model = given[name]
        if not isinstance(model, MARKS[mark]):
            raise ScenarioError(f"{where}: its model must be what @dmise.{mark} marks, got {_kind_of(model)}")
        if isinstance(model, Actor) and model.names and sorted(model.names) != sorted(objects):
            raise ScenarioError(f"{where}: its model moves {', '.join(model.names)}, the scenario has it move {', '.join(objects)}")
        models[name] = model
    return models


def _kind_of(model: Any) -> str:
    if isinstance(model, Served):
        return f"what @dmise.{type(model).mark} marks"
    return f"class {model.__name__}" if isinstance(model, type) else type(model).__name__


class ModelsInProcess:
    """The models of a simulation's nodes, for one iteration of its frames: each is made anew by `begin`."""

    def __init__(self, models: Mapping[str, Served]) -> None:
        self._models = models
        self._answers: dict[tuple[str, str], ModelAnswers] = {}

    def __call__(self, node: str, sensor: str, frames: list[bytes]) -> list[bytes]:
        """Answers a request to the model of a node, or to that which works for a sensor.

        Raises what the model raises, with a note of node and tick; what is no answer is one that says why.
        """
        served = self._models[node]
        request = protocol.OwnNodeRequest.FromString(frames[0])
        if request.HasField("begin"):
            self._answers[node, sensor] = ModelAnswers(served)
        answers = self._answers[node, sensor]
        try:
            return answers.to(request, frames[1:])
        except BaseException as error:
            if answers.in_model:
                error.add_note(f"node {node}{_place_of(request)}")
            elif isinstance(error, Exception):
                return failure(error, served)
            raise


def _place_of(request: Any) -> str:
    """" at tick 7", or of a detector also sensor and frame; "" before the first."""
    if request.HasField("step"):
        return f" at tick {request.step.tick}"
    if request.HasField("frame"):
        return f" at frame {request.frame.frame} of {request.frame.sensor} (tick {request.frame.tick})"
    return ""
