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
    """Key, image, mask and JSON of labels of each frame."""
    number = operator.index(seed)
    if not 0 <= number <= core.max_sample_seed:
        raise ScenarioError(f"seed: must be in 0..{core.max_sample_seed}, got {number}")
    return _maker_of(scenario).make(number)


def _maker_of(scenario: Scenario) -> Any:
    text, name = source_of(scenario)
    # A maker serves one process: in a forked one a thread that is not there may hold its lock.
    if text is not None:
        return _maker_of_text(text, name, os.getpid())
    try:
        facts = os.stat(name)
    except OSError:
        return core.Samples.of_file(name)  # which says why there is none
    version = facts.st_dev, facts.st_ino, facts.st_size, facts.st_mtime_ns, facts.st_ctime_ns
    return _maker_of_file(os.path.abspath(name), version, os.getpid())


@functools.lru_cache(maxsize=4)
def _maker_of_text(text: str, name: str, _process: int) -> Any:
    return core.Samples.of_text(text, name)


@functools.lru_cache(maxsize=4)
def _maker_of_file(path: str, _version: tuple[int, ...], _process: int) -> Any:
    return core.Samples.of_file(path)
