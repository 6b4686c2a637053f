"""Scenarios as users give them: files, text, mappings."""
from __future__ import annotations

import datetime
import json
import math
import operator
import os
import re
from collections.abc import Iterator, Mapping
from typing import Any

from .errors import ScenarioError

Scenario = str | os.PathLike[str] | Mapping[str, Any]  # the path of a file, YAML text, or a mapping with its keys
MAX_SEED = 2**63 - 1
_PLAIN_KEY = re.compile("[A-Za-z][A-Za-z0-9_]*")  # a text that YAML takes without quotes
_NOT_UTF8 = re.compile("[\0\ud800-\udfff]")
_NO_TEXT = {"true", "false", "null", "on", "off", "yes", "no", "y", "n"}  # in any case, unless in quotes


def source_of(scenario: Scenario) -> tuple[str | None, str]:
    """The YAML text of a scenario with its name in messages; of a file None with its path."""
    if isinstance(scenario, Mapping):
        return json.dumps(_plain(scenario, ""), indent=1), "scenario"  # JSON is YAML; lines serve messages
    if isinstance(scenario, str) and "\n" in scenario:
        return encodable(scenario), "scenario"
    if isinstance(scenario, (str, os.PathLike)):
        return None, encodable(os.fsdecode(scenario))
    raise TypeError(f"scenario: must be a path, YAML text or a mapping, got {type(scenario).__name__}")


def to_yaml(scenario: Mapping[str, Any]) -> str:
    """A mapping with the keys of a scenario as YAML; numbers of numpy, paths and datetimes may stand in it."""
    if not isinstance(scenario, Mapping):
        raise TypeError(f"scenario: must be a mapping, got {type(scenario).__name__}")
    return "".join(_block(_plain(scenario, ""), ""))


def _block(value: Any, indent: str) -> Iterator[str]:
    """Lines of a mapping or list that is no leaf, each leaf as JSON has it."""
    pairs = [(f"{_leaf(key)}:", inner) for key, inner in value.items()] if isinstance(value, dict) else [("-", x) for x in value]
    for head, inner in pairs:
        if isinstance(inner, (dict, list)) and any(isinstance(x, (dict, list)) for x in _parts(inner)):
            yield f"{indent}{head}\n"
            yield from _block(inner, indent + "  ")
        else:
            yield f"{indent}{head} {_leaf(inner)}\n"


def _parts(value: Any) -> Any:
    return value.values() if isinstance(value, dict) else value


def encodable(text: str, what: str = "scenario") -> str:
    """The text. Raises ScenarioError for one that the engine cannot take."""
    if _NOT_UTF8.search(text):
        raise ScenarioError(f"{what}: has NUL, or a character that UTF-8 cannot encode")
    return text


def _leaf(value: Any) -> str:
    """A number, text, or short list or mapping: JSON, which is YAML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_leaf(key)}: {_leaf(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_leaf, value)) + "]"
    if isinstance(value, float) and "e" in (text := repr(value)) and "." not in text:
        return text.replace("e", ".0e")  # else a text in YAML 1.1
    return value if isinstance(value, str) and _PLAIN_KEY.fullmatch(value) and value.lower() not in _NO_TEXT else json.dumps(value)


def seed_of(seed: Any) -> int | None:
    """A seed as whole number; None stays."""
    if seed is None:
        return None
    number = operator.index(seed)
    if not 0 <= number <= MAX_SEED:
        raise ScenarioError(f"seed: must be in 0..{MAX_SEED}, got {number}")
    return number


def _plain(value: Any, path: str) -> Any:
    """A value of a mapping as JSON has it, numbers of numpy, times and paths among them."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner, f"{path}.{key}" if path else str(key)) for key, inner in value.items()}
    if hasattr(value, "tolist"):  # a number or array of numpy
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
