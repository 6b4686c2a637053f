"""The messages of proto/dmise/v1 by their names."""
from __future__ import annotations

import functools
import importlib
import pkgutil
from typing import Any

try:
    import dmise.v1 as _package
except ImportError as missing:
    raise ImportError(f"{missing}: the messages are made by ./dmise build (into build/python), or by "
                      "pip install ./clients/python") from None

SCHEMA_VERSION = 1
modules: list[Any] = [importlib.import_module(f"dmise.v1.{found.name}")
                      for found in pkgutil.iter_modules(_package.__path__) if found.name.endswith("_pb2")]


def __getattr__(name: str) -> Any:
    """A message class, an enumeration or a value of one."""
    for module in modules:
        if hasattr(module, name):
            return globals().setdefault(name, getattr(module, name))  # found at once from now on
    raise AttributeError(name)


@functools.cache
def class_of_kind(kind: int) -> Any:
    """The message that the payload of this kind of envelope is; None: a kind without payload, or one that is unknown.

    KIND_DETECTION_SET is of a DetectionSet, and so on.
    """
    name = __getattr__("Kind").Name(kind) if kind in __getattr__("Kind").values() else ""
    words = name.removeprefix("KIND_").lower().split("_")
    try:
        return __getattr__("".join(word.capitalize() for word in words))
    except AttributeError:
        return None
