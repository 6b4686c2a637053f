"""The engine, which is a module of C++ of its own."""
from __future__ import annotations

import atexit
import os
from typing import Any

try:
    from . import _engine  # type: ignore[attr-defined]
except ImportError as missing:
    raise ImportError(f"dmise._engine: {missing}; install the wheel that ./dmise wheel makes, or build all of the "
                      "checkout (docs/python.md)", name="dmise._engine") from None

core: Any = _engine
_process = os.getpid()


def _end() -> None:
    """What the engine still computes in this process, for nobody, ends before its code does."""
    if os.getpid() == _process:
        core.wait_for_detached(60.0)


atexit.register(_end)
