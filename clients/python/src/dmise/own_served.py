"""What models of one's own have in common: they are marked and served, and what they say is checked."""
from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields
from typing import Any

import numpy as np


class Served:
    """A function of the user's, or a class whose instances are called so. `mark`: the name in dmise of what marks it."""

    mark = ""

    def __init__(self, model: Callable[..., Any]) -> None:
        self._model = model

    def make(self) -> Any:
        return self._model() if isinstance(self._model, type) else self._model

    def __call__(self, *arguments: Any) -> Any:
        return self._model(*arguments)

    def places(self) -> list[str]:
        """Where the model is defined: "gnc.py:7"; of a class the function that is called; none if it has no source."""
        called = self._model.__call__ if isinstance(self._model, type) else self._model
        try:
            file, (lines, first) = inspect.getfile(called), inspect.getsourcelines(called)
        except (OSError, TypeError):
            return []
        names = [i for i, line in enumerate(lines) if line.lstrip().startswith(("def ", "async def "))]
        return [f"{os.path.basename(file)}:{first + min(names, default=0)}"]


def list_of(said: Any, kind: type, wanted: str) -> list[Any]:
    """What a model returned, if it is some of a kind. `wanted`: what it should be, for the TypeError."""
    if isinstance(said, (str, bytes)) or not isinstance(said, Iterable):
        raise TypeError(f"{wanted}, got {type(said).__name__}")
    each = list(said)
    if wrong := [one for one in each if not isinstance(one, kind)]:
        raise TypeError(f"{wanted}, got one {type(wrong[0]).__name__}")
    return each


def one_by_one(together: Any, count: int | None) -> Iterable[Any]:
    """The `count` of which a dataclass has arrays, one by one; without a count it is one."""
    if count is None:
        return [together]
    columns: dict[str, Sequence[Any]] = {}
    for each in fields(together):
        value = getattr(together, each.name)
        if value is None or np.ndim(value) == 0:
            columns[each.name] = [value] * count
            continue
        array = np.asarray(value, np.float64)
        if array.shape[-1] != count:
            raise ValueError(f"{each.name}: must have {count} columns, got the shape {array.shape}")
        columns[each.name] = list(array.T)
    return [type(together)(**{name: column[i] for name, column in columns.items()}) for i in range(count)]


def number_of(source: Any, name: str) -> float:
    try:
        return float(getattr(source, name))
    except (TypeError, ValueError):
        raise ValueError(f"{name}: must be a number, got {getattr(source, name)!r}") from None


def numbers_in(source: Any, name: str, count: int) -> list[float]:
    numbers = np.asarray(getattr(source, name), np.float64)
    if numbers.shape != (count,):
        raise ValueError(f"{name}: must have the shape {(count,)}, got {numbers.shape}")
    return [float(number) for number in numbers]


def variance_of(source: Any, sigma_name: str) -> float:
    sigma = number_of(source, sigma_name)
    if not sigma > 0.0:
        raise ValueError(f"{sigma_name}: must be > 0, got {sigma:g}")
    return sigma**2
