"""What the samples of a scenario share in this process: its text, catalogues and stars."""
from __future__ import annotations

import functools
import operator
import os
from collections.abc import Mapping
from typing import Any

from .engine import core
from .errors import ScenarioError
from .scenario_text import text_of

MOST_SEED = 999_999_999  # that keys of samples have room for


def samples_of(scenario: str | os.PathLike[str] | Mapping[str, Any], seed: Any) -> Any:
    """Of each frame its key, image, mask and JSON of labels."""
    number = operator.index(seed)
    if not 0 <= number <= MOST_SEED:
        raise ScenarioError(f"seed: must be in 0..{MOST_SEED}, got {number}")
    return _maker_of(scenario).make(number)


def _maker_of(scenario: str | os.PathLike[str] | Mapping[str, Any]) -> Any:
    text = text_of(scenario)
    if text is not None or isinstance(scenario, Mapping):
        return _maker_of_text(text)
    path = os.fspath(scenario)
    try:
        facts = os.stat(path)
    except OSError:
        return core.Samples.of_file(path)  # which says why there is none
    return _maker_of_file(os.path.abspath(path), facts.st_mtime_ns, facts.st_size)


@functools.lru_cache(maxsize=4)
def _maker_of_text(text: str | None) -> Any:
    return core.Samples.of_text(text, "scenario")


@functools.lru_cache(maxsize=4)
def _maker_of_file(path: str, _modified_ns: int, _size: int) -> Any:
    return core.Samples.of_file(path)
