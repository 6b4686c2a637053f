"""Frames of a scenario as arrays, made in this process: no files, no sockets (docs/python.md).

    sim = dmise.Simulation("night.yaml", seed=3)
    for frame in sim.frames("west"):
        print(frame.counts.shape, frame.header["EXPTIME"], frame.detections["magnitude"])
"""
from __future__ import annotations

import functools
import io
import json
import pathlib
import types
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .cards import CardValue, values_of
from .convert import start_of
from .display import with_progress
from .engine import core, streams
from .errors import InputError
from .json_lines import record_of_line
from .late_imports import importing
from .records import Detection, FrameReport, Record, Truth
from .scenario_text import Scenario, encodable, seed_of, source_of
from .tables import Table, table_of

if TYPE_CHECKING:
    from .own_detector import Detector
    from .own_node import Actor
    from .own_served import Served

LAYERS = ("stars", "objects", "sky")


class Simulation:
    """A scenario whose frames are made here: the same bytes as `dmise run` writes for the same scenario and seed.

    scenario    path of a YAML file, YAML text of several lines, or a mapping with the keys of one
    seed        of the random numbers, instead of the scenario's
    nodes       by the names of the scenario's `nodes`, what `@dmise.actor(..)` or `@dmise.detector` marks: models that `frames`
                calls in place of their programs. The model of each node is needed

    Raises `ScenarioError` with file, line, column and key, as the command line prints it, also for a node without a model or with
    one that is not what the scenario has it do.
    """

    def __init__(self, scenario: Scenario, seed: int | None = None, nodes: Mapping[str, Actor | Detector] | None = None) -> None:
        self._text, self._name = source_of(scenario)
        if nodes is not None and not isinstance(nodes, Mapping):
            raise TypeError(f"nodes: must be a mapping of names to models, got {type(nodes).__name__}")
        names = [encodable(str(name), "nodes") for name in nodes or ()]
        if self._text is None:
            self._core = core.Simulation.of_file(self._name, seed_of(seed), names)
        else:
            self._core = core.Simulation.of_text(self._text, self._name, seed_of(seed), names)
        self._models: dict[str, Served] = {}
        if nodes:
            with importing:
                from .own_in_process import checked_models  # which needs protobuf

            self._models = checked_models(self._core.own_nodes, nodes)

    @property
    def sensors(self) -> list[str]:
        """Names of the sensors."""
        return list(self._core.sensors)

    @property
    def seed(self) -> int:
        return int(self._core.seed)

    @property
    def digest(self) -> str:
        """A hash of all that determines the products: that of the run."""
        return str(self._core.digest)

    @property
    def start_utc(self) -> str:
        return str(self._core.start_utc)

    @property
    def duration_s(self) -> float:
        return float(self._core.duration_s)

    @property
    def warnings(self) -> list[str]:
        """Unusual values of the scenario; each names its key."""
        return list(self._core.warnings)

    def frame_count(self, sensor: str) -> int:
        """How many frames a sensor makes."""
        return int(self._core.count_of(sensor))

    @property
    def yaml(self) -> str:
        """The scenario as YAML, to keep it or to give it to the command line; relative paths in it are as given."""
        return pathlib.Path(self._name).read_text(encoding="utf-8") if self._text is None else self._text

    def frames(self, *sensors: str, threads: int = 1, layers: bool = False,
               progress: bool = False) -> Iterator[SimulatedFrame]:
        """Frames of sensors, of all if none is named, in the order of a run. One is made when it is asked for.

        The models of `nodes` are made anew, and called at each tick or frame in order, by the thread that asks. What one raises
        ends the iteration, with a note of node and tick; `EngineError` says what is wrong with its answer.

        threads   that compute; the frames do not depend on them
        layers    keeps the expected light of stars, objects and sky, and masks of objects, which takes longer
        progress  shows a bar; needs tqdm
        """
        chosen = [*dict.fromkeys(sensors)]
        stream = self._core.frames(chosen, threads, layers)
        streams.add(stream)
        frames = self._iterate(stream)
        return with_progress(frames, sum(map(self.frame_count, chosen or self.sensors))) if progress else frames

    def _iterate(self, stream: Any) -> Iterator[SimulatedFrame]:
        start = self.start_utc
        models = self._called_anew()
        try:
            while (made := stream.next(models)) is not None:
                _warn(stream)
                yield SimulatedFrame(made, start)
                del made
            _warn(stream)
        finally:
            stream.stop()

    def _called_anew(self) -> Callable[[str, str, list[bytes]], list[bytes]] | None:
        if not self._models:
            return None
        with importing:
            from .own_in_process import ModelsInProcess

        return ModelsInProcess(self._models)


def _warn(stream: Any) -> None:
    """Warns of what a run says of its models."""
    for note in stream.take_notes():
        warnings.warn(note, RuntimeWarning, stacklevel=3)


class SimulatedFrame:
    """One exposure of a simulation, with what is true of it."""

    def __init__(self, made: Any, start_utc: str) -> None:
        self._made, self._start = made, start_utc

    def __repr__(self) -> str:
        rows, columns = self.counts.shape
        return f"<SimulatedFrame {self.number} of {self.sensor}, {rows} x {columns}>"

    @property
    def sensor(self) -> str:
        return str(self._made.sensor)

    @property
    def number(self) -> int:
        """Among the frames of the sensor, from 1."""
        return int(self._made.number)

    @functools.cached_property
    def counts(self) -> npt.NDArray[np.uint16]:
        """Rows x columns [DN]: the memory of the frame, which cannot be written."""
        return self._made.counts()  # type: ignore[no-any-return]

    @functools.cached_property
    def header(self) -> Mapping[str, CardValue]:
        """The values of the frame's FITS header by keyword."""
        return types.MappingProxyType(values_of(self._made.cards()))

    @functools.cached_property
    def wcs(self) -> Any:
        """The frame's astropy.wcs.WCS: pixels as in detections, of ICRS. Needs astropy."""
        from astropy.io import fits
        from astropy.wcs import WCS

        with fits.open(io.BytesIO(self.to_fits())) as hdus, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # astropy warns about headers that it corrects
            return WCS(hdus[0].header, hdus)

    @functools.cached_property
    def detections(self) -> Table:
        """What was found in the frame, a row each: fields and units of `dmise.Detection`."""
        return table_of(self._records(self._made.detections(), Detection), Detection)

    @functools.cached_property
    def truth(self) -> Table:
        """The objects near the frame as they were, a row each: fields and units of `dmise.Truth`."""
        return table_of(self._records(self._made.truths(), Truth), Truth)

    @functools.cached_property
    def report(self) -> FrameReport:
        report: FrameReport = self._records([self._made.report()], FrameReport)[0]
        return report

    @functools.cached_property
    def plan(self) -> dict[str, Any]:
        """The frame's plan of effects as in run.json: budget, error, each effect with its level; {} of one without."""
        plan: dict[str, Any] = json.loads(self._made.plan())
        return plan

    def layers(self, *names: str) -> Any:
        """Expected electrons, rows x columns float32: of "stars", "objects" or "sky"; of several a list.

        They need `layers=True`. The sky holds Sun, Moon and Earth as well. Their sum is what the exposure expects,
        before the detector.
        """
        if unknown := [name for name in names if name not in LAYERS]:
            raise InputError(f"layers: must be of {', '.join(LAYERS)}, got {unknown[0]!r}")
        self._need_layers()
        found = [getattr(self._made, name)() for name in names or LAYERS]
        return found[0] if len(names) == 1 else found

    @functools.cached_property
    def mask(self) -> npt.NDArray[np.uint16]:
        """Rows x columns: k where the k-th row of `truth`, from 1, has its light, else 0. Needs `layers=True`."""
        self._need_layers()
        return self._made.labels()  # type: ignore[no-any-return]

    def to_fits(self) -> bytes:
        """The frame as a FITS file, to the byte as `dmise run` writes it uncompressed."""
        return bytes(self._made.fits())

    def to_png(self) -> bytes:
        """A grey picture, for display only, as `dmise run` writes it: wide frames are averaged over squares of pixels."""
        return bytes(self._made.png())

    _repr_png_ = to_png  # notebooks show it

    def _need_layers(self) -> None:
        if not self._made.has_layers:
            raise InputError("layers: the frame was made without; ask for frames(.., layers=True)")

    def _records(self, lines: list[str], cls: type[Record]) -> list[Any]:
        start = start_of(self._start)
        return [record_of_line(json.loads(line), cls, start) for line in lines]
