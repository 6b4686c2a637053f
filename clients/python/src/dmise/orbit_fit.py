"""Where an object is by lines of sight from several sites, and its orbit."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .dynamics import GM_M3_PER_S2, acceleration, apparent_direction, propagate
from .records import Floats
from .sight import LineOfSight


@dataclass
class Triangulated:
    """A position (3, GCRS) [m] with its 3 x 3 covariance, and how far the lines are apart, squared over the variance of that."""
    position_m: Floats
    covariance_m2: Floats
    miss_squared: float


def triangulate(a: LineOfSight, b: LineOfSight) -> Triangulated | None:
    """The position nearest to two lines of the same time; None if they meet behind a sensor or are parallel.

    Light time is not put right: the position is of up to 30 ms before, for two ranges in a LEO differ by less than 1 ms.
    """
    baseline = b.origin_m - a.origin_m
    along = np.array([[1.0, -(c := float(a.direction @ b.direction))], [c, -1.0]])
    if 1.0 - c * c < 1e-12:
        return None
    ranges = np.linalg.solve(along, [a.direction @ baseline, b.direction @ baseline])
    if min(ranges) <= 0.0:
        return None
    normal, right = np.zeros((3, 3)), np.zeros(3)
    for sight, range_m in zip((a, b), ranges):
        weight = sight.tangents.T @ np.linalg.inv(sight.covariance_rad2 * range_m ** 2) @ sight.tangents
        normal += weight
        right += weight @ sight.origin_m
    covariance: Floats = np.asarray(np.linalg.inv(normal), dtype=np.float64)
    position = covariance @ right
    miss = sum(float(e @ np.linalg.solve(s.covariance_rad2 * rho ** 2, e)) for s, rho in zip((a, b), ranges)
               for e in [s.tangents @ (position - s.origin_m)])
    return Triangulated(position, covariance, miss)


@dataclass
class Orbit:
    """A state (6: position [m], velocity [m/s]; GCRS) at a time, its covariance, and the sum of squared residuals over their variances."""
    time_ns: int
    state: Floats
    covariance: Floats
    chi_squared: float


def fit_orbit(sights: Sequence[LineOfSight], state: Floats, time_ns: int, pole: Floats, iterations: int = 5) -> Orbit:
    """Least squares of all lines of sight, from an approximate state at a time: with light time, two bodies and J2.

    Raises numpy.linalg.LinAlgError if the lines do not determine an orbit.
    """
    steps = np.array([10.0] * 3 + [0.1] * 3)
    normal = np.eye(6)
    chi_squared = 0.0
    for _ in range(iterations):
        normal, right, chi_squared = np.zeros((6, 6)), np.zeros(6), 0.0
        around = np.column_stack([state, state[:, None] + np.diag(steps), state[:, None] - np.diag(steps)])
        for sight in sights:
            seen = apparent_direction(propagate(around, (sight.time_ns - time_ns) / 1e9, pole), sight.origin_m)
            offset = sight.tangents @ seen / (sight.direction @ seen)
            jacobian = (offset[:, 1:7] - offset[:, 7:]) / (2.0 * steps)
            weighted = np.linalg.solve(sight.covariance_rad2, np.column_stack([jacobian, offset[:, 0]]))
            normal += jacobian.T @ weighted[:, :6]
            right -= jacobian.T @ weighted[:, 6]
            chi_squared += float(offset[:, 0] @ weighted[:, 6])
        # Positions and velocities differ by 1e3 in size.
        state = state + steps * np.linalg.solve(normal * np.outer(steps, steps), right * steps)
    covariance: Floats = np.asarray(np.linalg.inv(normal * np.outer(steps, steps)) * np.outer(steps, steps), np.float64)
    return Orbit(time_ns, state, covariance, chi_squared)


def velocity_between(first_m: Floats, second_m: Floats, interval_s: float, pole: Floats) -> Any:
    """The velocity at the second of two positions [m/s], for intervals far below a revolution."""
    middle = acceleration(((first_m + second_m) / 2.0)[:, None], pole)[:, 0]
    return (second_m - first_m) / interval_s + 0.5 * interval_s * middle


def is_bound(state: Floats, lowest_m: float = 6_478_000.0) -> bool:
    """Whether a state is of an orbit whose perigee is not below a radius."""
    position, velocity = state[:3], state[3:]
    radius = float(np.linalg.norm(position))
    energy = float(velocity @ velocity) / 2.0 - GM_M3_PER_S2 / radius
    if radius < lowest_m or energy >= 0.0:
        return False
    momentum = float(np.linalg.norm(np.cross(position, velocity)))
    eccentricity = np.sqrt(max(0.0, 1.0 + 2.0 * energy * momentum ** 2 / GM_M3_PER_S2 ** 2))
    return bool(-GM_M3_PER_S2 / (2.0 * energy) * (1.0 - eccentricity) >= lowest_m)
