"""A Functional Mock-up Unit (FMI 2.0 or 3.0, co-simulation) that moves or turns an object.

`nodes: [{name: gnc, fmu: gnc.fmu, ..}]` of a scenario starts `python3 -m dmise.fmi gnc.fmu` (docs/howto/plug-in-a-model.md). Needs
FMPy: pip install "dmise[fmi]".
"""
from __future__ import annotations

import importlib
import pickle
import sys
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .dynamics import rotation_matrix
from .own_node import World, actor
from .own_socket import serve
from .own_states import State
from .records import Floats

NUMBERS = ("Real", "Float32", "Float64")
AXES = "xyz"


class Unit:
    """An instance of an FMU, whose variables have names. Raises ValueError that names the file and the variable."""

    def __init__(self, path: str) -> None:
        try:
            fmpy = importlib.import_module("fmpy")
        except ImportError as missing:
            raise ValueError(f"{path}: needs FMPy: pip install \"dmise[fmi]\" ({missing})") from None
        self._path = path
        try:
            self._description = fmpy.read_model_description(path)
            platforms = fmpy.supported_platforms(path)
        except Exception as error:
            raise ValueError(f"{path}: is no FMU: {str(error).splitlines()[0]}") from None
        if self._description.coSimulation is None:
            raise ValueError(f"{path}: must be for co-simulation")
        if self._description.fmiVersion.split(".")[0] not in ("2", "3"):
            raise ValueError(f"{path}: must be of FMI 2.0 or 3.0, got {self._description.fmiVersion}")
        if not {fmpy.platform, fmpy.platform_tuple} & set(platforms):
            raise ValueError(f"{path}: is for {', '.join(platforms) or 'no platform'}, this machine is {fmpy.platform}")
        self._variables = {one.name: one for one in self._description.modelVariables}
        self._directory = tempfile.TemporaryDirectory(prefix="dmise-fmu-")
        fmpy.extract(path, self._directory.name)
        self._fmu = fmpy.instantiate_fmu(self._directory.name, self._description, "CoSimulation")
        self._of_version_2 = self._description.fmiVersion == "2.0"

    @property
    def keeps_state(self) -> bool:
        """Whether its state can be saved as bytes."""
        able = self._description.coSimulation
        return bool(able.canGetAndSetFMUstate and able.canSerializeFMUstate)

    def require(self, key: str, name: str, causalities: Sequence[str], types: Sequence[str] = NUMBERS) -> None:
        """Raises ValueError unless the variable that the scenario names at `key` is what it is used for."""
        variable = self._variables.get(name)
        if variable is None:
            raise ValueError(f"{key}: {self._path} has no variable {name}")
        if variable.causality not in causalities:
            raise ValueError(f"{key}: {name} must be {' or '.join(causalities)}, its causality is {variable.causality}")
        if types and variable.type not in types:
            raise ValueError(f"{key}: {name} must be a real number, its type is {variable.type}")
        if variable.dimensions:
            raise ValueError(f"{key}: {name} must be one number, it is an array")

    def set(self, values: Mapping[str, float]) -> None:
        for name, value in values.items():
            variable = self._variables[name]
            number = float(value) if variable.type in NUMBERS else int(value)
            getattr(self._fmu, "set" + variable.type)([variable.valueReference], [number])

    def get(self, names: Sequence[str]) -> list[float]:
        return [float(getattr(self._fmu, "get" + variable.type)([variable.valueReference])[0])
                for variable in (self._variables[name] for name in names)]

    def initialise(self, t_s: float, start: Mapping[str, float], inputs: Mapping[str, float]) -> None:
        self.set(start)
        if self._of_version_2:
            self._fmu.setupExperiment(startTime=t_s)
            self._fmu.enterInitializationMode()
        else:
            self._fmu.enterInitializationMode(startTime=t_s)
        self.set(inputs)
        self._fmu.exitInitializationMode()

    def step(self, t_s: float, step_s: float) -> None:
        self._fmu.doStep(t_s, step_s)

    def state(self) -> bytes:
        state = self._fmu.getFMUState()
        kept: bytes = bytes(self._fmu.serializeFMUState(state))
        self._fmu.freeFMUState(state)
        return kept

    def restore(self, kept: bytes) -> None:
        state = self._fmu.deserializeFMUState(kept)
        self._fmu.setFMUState(state)
        self._fmu.freeFMUState(state)


def needed_by(name: str) -> set[str]:
    """The outputs without which there is no input of this name."""
    return {key for word, key in (("position", "position_m"), ("velocity", "velocity_m_per_s"), ("earth", "position_m"),
                                  ("body", "gcrs_from_body")) if word in name.split("_")}


def source(name: str, t_s: float, world: World, own: Mapping[str, Floats]) -> float:
    """What an input is given ("sun_body_x"): at t_s [s], with the object's own state as the FMU said it, in SI units.

    Without a position the directions of Sun and Moon are from the Earth's centre.
    """
    if name == "time_s":
        return t_s
    what, *frame, axis = name.removesuffix("_m_per_s").removesuffix("_m").split("_")
    if what in ("position", "velocity"):
        return float(own["position_m" if what == "position" else "velocity_m_per_s"][AXES.index(axis)])
    body_m = {"sun": world.environment.sun_m, "moon": world.environment.moon_m, "earth": np.zeros(3)}[what]
    direction = body_m - own.get("position_m", np.zeros(3))
    if frame == ["body"]:
        direction = rotation_matrix(own["gcrs_from_body"]).T @ direction
    return float(direction[AXES.index(axis)] / np.linalg.norm(direction))


class Model:
    """The unit of the command line. Inputs of a step are those of its beginning.

    Before the first one those that need no state of its own are given; the others are as the unit starts.
    """

    def __init__(self) -> None:
        self._unit = Unit(sys.argv[1])
        self._own: dict[str, Floats] = {}  # what it said last
        self._last: tuple[float, World] | None = None  # when
        if self._unit.keeps_state:
            self.checkpoint = self._checkpoint

    def __call__(self, t_s: float, world: World, options: Any) -> State:
        if self._last is None:
            self._require(world, options)
            self._unit.initialise(t_s, options["options"], self._inputs(t_s, world, options))
        else:
            before_s, before = self._last
            self._unit.set(self._inputs(before_s, before, options))
            self._unit.step(before_s, t_s - before_s)
        self._own = {key: np.array(self._unit.get(names)) for key, names in options["outputs"].items()}
        self._last = t_s, world
        return State(**self._own)

    def _inputs(self, t_s: float, world: World, options: Any) -> dict[str, float]:
        return {name: source(what, t_s, world, self._own) for name, what in options["inputs"].items()
                if needed_by(what) <= self._own.keys()}

    def _require(self, world: World, options: Any) -> None:
        if len(world.objects) != 1:
            raise ValueError(f"an FMU moves or turns one object, the scenario has it move {', '.join(world.objects)}")
        for name, what in options["inputs"].items():
            self._unit.require(f"inputs.{name}", name, ("input",))
            if missing := needed_by(what) - options["outputs"].keys():
                raise ValueError(f"inputs.{name}: {what} needs outputs.{min(missing)}")
        for key, names in options["outputs"].items():
            for name in names:
                self._unit.require(f"outputs.{key}", name, ("output", "local"))
        for name in options["options"]:
            self._unit.require(f"options.{name}", name, ("parameter", "input"), ())

    def _checkpoint(self) -> bytes:
        return pickle.dumps((self._own, self._last, self._unit.state()))

    def restore(self, kept: bytes) -> None:
        self._own, self._last, state = pickle.loads(kept)
        self._unit.restore(state)


if __name__ == "__main__":
    serve(actor()(Model))
