"""What the samples of a scenario share in this process: its text, catalogues and stars."""
from __future__ import annotations

import functools
import operator
import os
from typing import Any

from .engine import core
from .errors import ScenarioError
from .scenario_text import Scenario, source_of

def samples_of(scenario: Scenario, seed: Any) -> Any:
    """Of each frame its key, image, mask and JSON of labels."""
    number = operator.index(seed)
    if not 0 <= number <= core.max_sample_seed:
        raise ScenarioError(f"seed: must be in 0..{core.max_sample_seed}, got {number}")
    return _maker_of(scenario).make(number)


def _maker_of(scenario: Scenario) -> Any:
    text, name = source_of(scenario)
    if text is not None:
        return _maker_of_text(text, name)
    try:
        facts = os.stat(name)
    except OSError:
        return core.Samples.of_file(name)  # which says why there is none
    return _maker_of_file(os.path.abspath(name), facts.st_mtime_ns, facts.st_size)


@functools.lru_cache(maxsize=4)
def _maker_of_text(text: str, name: str) -> Any:
    return core.Samples.of_text(text, name)


@functools.lru_cache(maxsize=4)
def _maker_of_file(path: str, _modified_ns: int, _size: int) -> Any:
    return core.Samples.of_file(path)
