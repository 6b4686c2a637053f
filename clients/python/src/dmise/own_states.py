"""What a model says of its objects at a tick, as ObjectStates and their arrays."""
from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import protocol
from .records import Floats

NO_STATE = 18  # code of an object that its node gives no state
ROSTER_ALBEDO = -1.0


@dataclass
class State:
    """The state of one object at a tick, in GCRS: 3 numbers each; or those of n objects as arrays 3 x n.

    gcrs_from_body  unit quaternion w, x, y, z (4, or 4 x n) with v_gcrs = q v_body q*, of objects that the node turns
    rate_rad_per_s  angular velocity of the body in GCRS axes; without it 0
    slope_m_per_s   derivative of the position where it is not the velocity, for interpolation between ticks
    albedo          of an object that the node moves, instead of the scenario's: a number, or n of them
    """
    position_m: Any = None
    velocity_m_per_s: Any = None
    gcrs_from_body: Any = None
    rate_rad_per_s: Any = None
    slope_m_per_s: Any = None
    albedo: Any = None


class StatesWriter:
    """Writes the states of one tick after the other into the same arrays."""

    def __init__(self, objects: Any) -> None:
        self._names = [one.name for one in objects]
        self._moves = any(one.moved for one in objects)
        self._turned = [i for i, one in enumerate(objects) if one.turned]
        message = protocol.ObjectStates(count=len(objects))
        self._arrays: dict[str, npt.NDArray[Any]] = {}
        n, m = len(objects), len(self._turned)
        layout = [("position_m", "float64", (3, n)), ("slope_m_per_s", "float64", (3, n)),
                  ("velocity_m_per_s", "float64", (3, n)), ("code", "uint8", (n,))]
        if m:
            layout += [("attitude_object", "uint32", (m,)), ("gcrs_from_body", "float64", (4, m)),
                       ("attitude_rate_rad_per_s", "float64", (3, m))]
        self._bytes = bytearray(sum(math.prod(shape) * np.dtype(kind).itemsize for _, kind, shape in layout))
        offset = 0
        for name, kind, shape in layout:
            message.arrays.add(name=name, type=kind, shape=shape, offset_bytes=offset)
            array: npt.NDArray[Any] = np.ndarray(shape, np.dtype(kind).newbyteorder("<"), self._bytes, offset)
            self._arrays[name] = array
            offset += array.nbytes
        self._layout = message.SerializeToString()  # fields follow each other in any order
        if m:
            self._arrays["attitude_object"][:] = self._turned

    def frames(self, said: Any, tick: int, time_ns: int) -> list[bytes]:
        """ObjectStates of what the model said, and their arrays. Raises TypeError or ValueError if it is no such thing."""
        count = len(self._names)
        code = self._arrays["code"]
        code[:] = 0
        if not isinstance(said, State):
            each = _of_each(said, self._names)
            code[[state is None for state in each]] = NO_STATE
            said = _together(each)
        position_m, velocity_m_per_s, slope_m_per_s = (
            _matrix(said, name, 3, count) for name in ("position_m", "velocity_m_per_s", "slope_m_per_s"))
        if self._moves and (position_m is None or velocity_m_per_s is None):
            raise ValueError("position_m and velocity_m_per_s: are needed of objects that the node moves")
        gcrs_from_body, rate_rad_per_s = _matrix(said, "gcrs_from_body", 4, count), _matrix(said, "rate_rad_per_s", 3, count)
        if self._turned and gcrs_from_body is None:
            raise ValueError("gcrs_from_body: is needed of objects that the node turns")
        self._write("position_m", position_m)
        self._write("slope_m_per_s", velocity_m_per_s if slope_m_per_s is None else slope_m_per_s)
        self._write("velocity_m_per_s", velocity_m_per_s)
        if self._turned:
            self._write("gcrs_from_body", gcrs_from_body, self._turned)
            self._write("attitude_rate_rad_per_s", rate_rad_per_s, self._turned)
        head = protocol.ObjectStates(tick=tick, time_ns=time_ns)
        arrays = bytes(self._bytes)
        if (albedo := _albedos(said, count)) is not None:
            head.arrays.add(name="albedo", type="float64", shape=(count,), offset_bytes=len(arrays))
            arrays += albedo.astype("<f8").tobytes()
        return [self._layout + head.SerializeToString(), arrays]

    def _write(self, name: str, values: Floats | None, columns: list[int] | slice = slice(None)) -> None:
        self._arrays[name][:] = 0.0 if values is None else values[:, columns]


def _of_each(said: Any, names: list[str]) -> list[State | None]:
    """The state of each object: of a mapping by name, of a list by place, or of the only one."""
    if isinstance(said, Mapping):
        if unknown := set(said) - set(names):
            raise ValueError(f"{min(unknown)}: the node has no such object, only {', '.join(names)}")
        said = [said.get(name) for name in names]
    each = [said] if said is None else list(said)
    if wrong := [one for one in each if not (one is None or isinstance(one, State))]:
        raise TypeError(f"a dmise.State is needed of each object, got {type(wrong[0]).__name__} in {type(said).__name__}")
    if len(each) != len(names):
        raise ValueError(f"a state is needed of each of {len(names)} objects, got {len(each)}")
    return each


def _together(each: list[State | None]) -> State:
    def columns(name: str, rows: int) -> Floats | None:
        given = [None if state is None else getattr(state, name) for state in each]
        if all(one is None for one in given):
            return np.zeros((rows, len(each))) if all(state is None for state in each) else None
        return np.column_stack([np.zeros(rows) if one is None else _shaped(one, (rows,), name) for one in given])

    return State(columns("position_m", 3), columns("velocity_m_per_s", 3), columns("gcrs_from_body", 4),
                 columns("rate_rad_per_s", 3), columns("slope_m_per_s", 3), _albedos_of(each))


def _albedos_of(each: list[State | None]) -> list[float] | None:
    given = [None if state is None else state.albedo for state in each]
    if all(one is None for one in given):
        return None
    return [ROSTER_ALBEDO if one is None else _shaped(one, (), "albedo").item() for one in given]


def _albedos(said: State, count: int) -> Floats | None:
    if said.albedo is None:
        return None
    return np.full(count, said.albedo, np.float64) if np.ndim(said.albedo) == 0 else _shaped(said.albedo, (count,), "albedo")


def _matrix(state: State, name: str, rows: int, count: int) -> Floats | None:
    value = getattr(state, name)
    if value is None:
        return None
    numbers = np.asarray(value, dtype=np.float64)
    if count == 1 and numbers.ndim == 1:
        return _shaped(numbers, (rows,), name).reshape(rows, 1)
    return _shaped(numbers, (rows, count), name)


def _shaped(value: Any, shape: tuple[int, ...], name: str) -> Floats:
    numbers = np.asarray(value, dtype=np.float64)
    if numbers.shape != shape:
        raise ValueError(f"{name}: must have the shape {shape}, got {numbers.shape}")
    return numbers
