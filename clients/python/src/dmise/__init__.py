"""Simulates frames in this process, takes part in runs of DMISE, and reads what they leave.

    for frame in dmise.Simulation("night.yaml").frames("west"):
        print(frame.counts.mean(), frame.detections["magnitude"])

`Simulation` makes frames as arrays; `detect` and `solve` read frames of any camera, `propagate` moves a catalogue; `check`, `score`,
`survey`, `tradeoff` and `visible` are commands. `subscribe` observes a run, `aio.subscribe` does so in asyncio, `Node` takes part in its
clock, `actor` and `serve` move objects in it, `detector` finds sources in its frames, `sensor` observes, `tracker` makes the
tracks, `open_run` reads the directory of a run that is over, `datasets` labelled frames for training; `record` writes all that is on the wire into a file,
`open_recording` reads it and `Replay` plays it to observers.
Units are in the names of fields; directions are ICRS, positions GCRS.
"""
import importlib
import os
import re
import sys
from typing import Any

__version__ = "1.0.0"
_NEEDED = {"google": "protobuf", "google.protobuf": "protobuf", "numpy": "numpy", "zmq": "pyzmq"}


def _module_of_names() -> dict[str, str]:
    """The module that each name of the package is in, by the package's stub; of a module nothing."""
    with open(os.path.join(os.path.dirname(__file__), "__init__.pyi"), encoding="utf-8") as stub:
        lines = re.findall(r"^from \.(\w*) import (.+)$", stub.read(), re.M)
    return {name: module for module, names in lines for name in re.findall(r"(\w+) as \1", names)}


_MODULE_OF = _module_of_names()
__all__ = sorted(_MODULE_OF)


def __getattr__(name: str) -> Any:
    """Modules are imported when a name of theirs is used: those of the wire need pyzmq and protobuf, others do not."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        module = importlib.import_module(f".{_MODULE_OF[name] or name}", __name__)
    except ImportError as missing:
        if missing.name not in _NEEDED:
            raise
        raise ImportError(f"{missing.name}: not installed for {sys.executable}; dmise.{name} needs {_NEEDED[missing.name]}: apt install python3-zmq "
                          "python3-protobuf python3-numpy, or pip install pyzmq protobuf numpy", name=missing.name) from None
    found = getattr(module, name) if _MODULE_OF[name] else module
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
