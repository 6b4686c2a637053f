"""Motion of an object around the Earth: two bodies and J2, good to 1 m in a pass of a LEO object, to 1 km in a revolution."""
from __future__ import annotations

import datetime
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from .records import Floats
from .sight import SPEED_OF_LIGHT_M_PER_S

GM_M3_PER_S2 = 3.986004418e14      # EGM2008
EARTH_RADIUS_M = 6378136.3         # EGM2008, of J2
J2 = 1.08262617e-3                 # EGM2008, zero-tide
LONGEST_STEP_S = 20.0              # a step's error at 300 km: 1 mm
_J2000 = datetime.datetime(2000, 1, 1, 12)
_POLE_RATE_RAD_PER_S = math.radians(2004.191903 / 3600.0) / (36525.0 * 86400.0)


def pole_of(time_utc: datetime.datetime) -> Floats:
    """The Earth's pole, GCRS unit vector: its precession, IAU 2006, without nutation, to 0.3 arcmin for a century."""
    x = _POLE_RATE_RAD_PER_S * (time_utc.replace(tzinfo=None) - _J2000).total_seconds()
    return np.array([x, 0.0, math.sqrt(1.0 - x * x)])


def rotation_matrix(quaternion: Sequence[float] | Floats) -> Floats:
    """3 x 3, of a unit quaternion w, x, y, z: the matrix of v' = q v q*."""
    w, x, y, z = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def acceleration(position_m: Floats, pole: Floats) -> Any:
    """3 x n [m/s^2] at 3 x n positions, GCRS, of the Earth's mass and its J2 about a pole."""
    r2 = np.sum(position_m ** 2, axis=0)
    along = pole @ position_m
    factor = 1.5 * J2 * EARTH_RADIUS_M ** 2 / r2
    central = position_m * (1.0 + factor * (1.0 - 5.0 * along ** 2 / r2))
    return -GM_M3_PER_S2 / r2 ** 1.5 * (central + 2.0 * factor * along * pole[:, None])


def propagate(states: Floats, interval_s: float, pole: Floats) -> Any:
    """States 6 x n (position, velocity; m, m/s; GCRS) after an interval, which may be negative. Runge-Kutta of order 4."""
    def rate(y: Any) -> Any:
        return np.concatenate([y[3:], acceleration(y[:3], pole)])

    y = np.array(states, dtype=np.float64)
    steps = max(1, math.ceil(abs(interval_s) / LONGEST_STEP_S))
    h = interval_s / steps
    for _ in range(steps if interval_s else 0):
        k1 = rate(y)
        k2 = rate(y + h / 2 * k1)
        k3 = rate(y + h / 2 * k2)
        k4 = rate(y + h * k3)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return y


def apparent_direction(states: Floats, origin_m: Floats) -> Any:
    """3 x n unit vectors from an origin to where objects were when the light left them that arrives at the states' time."""
    range_m = np.linalg.norm(states[:3] - origin_m[:, None], axis=0)
    seen = states[:3] - states[3:] * (range_m / SPEED_OF_LIGHT_M_PER_S) - origin_m[:, None]
    return seen / np.linalg.norm(seen, axis=0)
