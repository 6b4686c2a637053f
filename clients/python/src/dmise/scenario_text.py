"""Scenarios as users give them: files, text, mappings."""
from __future__ import annotations

import datetime
import json
import math
import operator
import os
from collections.abc import Mapping
from typing import Any

from .errors import ScenarioError

MOST_SEED = 2**63 - 1


def text_of(scenario: str | os.PathLike[str] | Mapping[str, Any]) -> str | None:
    """YAML text of a scenario; None of the path of a file."""
    if isinstance(scenario, Mapping):
        return json.dumps(_plain(scenario, ""), indent=1)  # JSON is YAML; lines serve messages
    if isinstance(scenario, os.PathLike):
        return None
    if isinstance(scenario, str):
        return scenario if "\n" in scenario else None
    raise TypeError(f"scenario: must be a path, YAML text or a mapping, got {type(scenario).__name__}")


def seed_of(seed: Any) -> int | None:
    """A seed as whole number; None stays."""
    if seed is None:
        return None
    number = operator.index(seed)
    if not 0 <= number <= MOST_SEED:
        raise ScenarioError(f"seed: must be in 0..{MOST_SEED}, got {number}")
    return number


def _plain(value: Any, path: str) -> Any:
    """A value of a mapping as JSON has it, numbers of numpy, times and paths among them."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner, f"{path}.{key}" if path else str(key)) for key, inner in value.items()}
    if hasattr(value, "tolist"):  # of numpy
        return _plain(value.tolist(), path)
    if isinstance(value, (list, tuple)):
        return [_plain(inner, f"{path}[{i}]") for i, inner in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        raise ScenarioError(f"scenario: {path}: must be finite, got {value}")
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, datetime.datetime):
        utc = value.astimezone(datetime.timezone.utc) if value.tzinfo else value
        return utc.replace(tzinfo=None).isoformat() + "Z"
    raise ScenarioError(f"scenario: {path}: must be a number, text, list or mapping, got {type(value).__name__}")
