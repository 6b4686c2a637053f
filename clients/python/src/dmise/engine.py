"""The engine, which is a module of C++ of its own."""
from __future__ import annotations

import atexit
import weakref
from typing import Any

try:
    from . import _engine  # type: ignore[attr-defined]
except ImportError as missing:
    raise ImportError(f"dmise._engine: {missing}; install the wheel that ./dmise wheel makes, or build all of the "
                      "checkout (docs/python.md)", name="dmise._engine") from None

core: Any = _engine
streams: weakref.WeakSet[Any] = weakref.WeakSet()  # streams of frames, whose threads wait until they are asked


def _end() -> None:
    """What the engine still does in this process ends before its code does."""
    for stream in streams:
        stream.stop()
    core.wait_for_detached(60.0)


atexit.register(_end)
