"""Simulates frames in this process, takes part in runs of DMISE, and reads what they leave.

    for frame in dmise.Simulation("night.yaml").frames("west"):
        print(frame.counts.mean(), frame.detections["magnitude"])

`Simulation` makes frames as arrays; `detect` and `solve` read frames of any camera, `inject` draws objects into them,
`propagate` moves a catalogue;
`check`, `score`, `survey`, `tradeoff` and `visible` are commands. `subscribe` observes a run, `aio.subscribe` does so
in asyncio, `Node` takes part in its clock, `actor` and `serve` move objects in it, `detector` finds sources in its
frames, `sensor` observes, `tracker` makes the tracks, `open_run` reads the directory of a run that is over, `datasets`
labelled frames for training; `record` writes all that is on the wire into a file, `open_recording` reads it and
`Replay` plays it to observers.
Units are in the names of fields; directions are ICRS, positions GCRS.
"""
import importlib
import sys
from typing import Any

from .late_imports import importing

__version__ = "1.0.0"
_NEEDED = {"google": "protobuf", "google.protobuf": "protobuf", "numpy": "numpy", "zmq": "pyzmq"}
# The names of each module; what a type checker sees of them is in __init__.pyi.
_NAMES = {
    "commands": "check score survey tradeoff visible",
    "dynamics": "apparent_direction pole_of",
    "errors": "EngineError InputError NoAnswer Refused RunFailed ScenarioError",
    "frame_images": "Frame Frames frames read_frame",
    "injection": "Injected inject",
    "joint_period": "PossiblePeriod possible_periods",
    "message": "Message",
    "node": "Node Tick",
    "orbit_fit": "Orbit Triangulated fit_orbit triangulate",
    "own_detector": "Detector Found SensorFrame detector",
    "own_node": "Actor World actor",
    "own_sensor": "Exposure Observer Sighting Sightings sensor",
    "own_socket": "serve",
    "own_states": "State",
    "own_tracker": "Point SearchedFrame Sensor Tracker Tracks tracker",
    "propagation": "CatalogueStates propagate",
    "recorder": "Recorded record",
    "recording": "Recording open_recording",
    "records": "ArrayLike Detection FrameReport LightCurve LightPeriod Record Task Track Truth Wcs WcsRefraction",
    "replayer": "Replay",
    "runs": "Run open_run",
    "scenario_text": "to_yaml",
    "sight": "LineOfSight line_of_sight",
    "simulation": "SimulatedFrame Simulation",
    "solution": "Solution detect solve",
    "subscription": "Gap Subscription subscribe",
    "tables": "Table to_pandas",
    "world": "EarthOrientation EnvironmentState ObjectInfo ObjectRoster ObjectStates SiteState SunTrackingPanel",
}
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names.split()}
_MODULES = {"aio", "datasets", "scenario"}
__all__ = sorted({*_MODULE_OF, *_MODULES})


def __getattr__(name: str) -> Any:
    """Modules are imported when a name of theirs is used: those of the wire need pyzmq and protobuf, others do not."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        with importing:
            module = importlib.import_module(f".{_MODULE_OF.get(name, name)}", __name__)
    except ImportError as missing:
        if missing.name not in _NEEDED:
            raise
        raise ImportError(f"{missing.name}: not installed for {sys.executable}; "
                          f"dmise.{name} needs {_NEEDED[missing.name]}: apt install python3-zmq "
                          "python3-protobuf python3-numpy, or pip install pyzmq protobuf numpy",
                          name=missing.name) from None
    found = getattr(module, name) if name in _MODULE_OF else module
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
