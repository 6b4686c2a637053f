"""A sensor of one's own in a run: `sensor` marks it, `serve` runs it (docs/howto/plug-in-a-model.md).

    @dmise.sensor
    def look(exposure, world, options):
        return [dmise.Sighting(direction=.., sigma_rad=.., range_m=.., range_sigma_m=..)]
    dmise.serve(look)
"""
from __future__ import annotations

import datetime
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import protocol
from .convert import numbers_of, record_of, with_arrays
from .own_served import Served, list_of, number_of, numbers_in, one_by_one, variance_of
from .records import Floats
from .world import ObjectRoster, ObjectStates

ROUNDING_NS = 1000  # times in seconds are rounded by no more


@dataclass
class Exposure:
    """What a sensor is told of an exposure. Times are seconds since the scenario's start, of reception."""
    sensor: str
    frame: int  # from 1
    tick: int  # the first that is not before its end
    start_s: float
    middle_s: float
    end_s: float
    start_ns: int
    middle_ns: int
    end_ns: int
    position_m: Floats  # where the sensor is in GCRS, at mid exposure
    velocity_m_per_s: Floats


@dataclass
class Sighting:
    """What a sensor saw in one direction; or n of them, if `range_m`, `ra_rad` or `direction` are arrays.

    direction        GCRS, of any length (3, or 3 x n): from the sensor to where the light or the echo left the object, without
                     aberration and refraction; or
    ra_rad, dec_rad  the same as ICRS angles
    sigma_rad        standard error on each axis; or
    covariance_rad2  var(ra cos dec), cov, var(dec) (3, or 3 x n)
    time_s           of reception, within the exposure; mid exposure if it is left out
    magnitude, magnitude_sigma   V above the atmosphere, if it is measured
    snr              signal to noise, if it is known
    range_m, range_sigma_m       distance to that place, if it is measured
    range_rate_m_per_s, range_rate_sigma_m_per_s   its derivative, with the motion of the sensor
    """
    direction: Any = None
    ra_rad: Any = None
    dec_rad: Any = None
    sigma_rad: Any = None
    covariance_rad2: Any = None
    time_s: Any = None
    magnitude: Any = None
    magnitude_sigma: Any = None
    snr: Any = None
    range_m: Any = None
    range_sigma_m: Any = None
    range_rate_m_per_s: Any = None
    range_rate_sigma_m_per_s: Any = None


@dataclass
class Sightings:
    """What a sensor says of an exposure.

    boresight           the middle of its field: GCRS, of any length; if it is left out, away from the Earth's centre
    limiting_magnitude  V of what it sees half the time; if it is left out, nothing follows from what it does not see
    """
    sightings: Sequence[Sighting] = ()
    boresight: Any = None
    limiting_magnitude: float | None = None


class Observer(Served):
    """A function `f(exposure, world, options)` that returns sightings, or a class whose instances are called so."""

    mark = "sensor"


def sensor(model: Callable[..., Any]) -> Observer:
    """Marks a function or class that is a sensor."""
    return Observer(model)


def roster_of(frames: Sequence[bytes], start: datetime.datetime | None) -> ObjectRoster:
    """All objects, to a sensor that is told the truth; none to others."""
    if not frames:
        return ObjectRoster()
    message = protocol.ObjectRoster.FromString(frames[0])
    roster: ObjectRoster = with_arrays(record_of(message, start), message.arrays, frames[1])
    return roster


def truth_of(frames: Sequence[bytes], roster: ObjectRoster, start: datetime.datetime | None) -> ObjectStates | None:
    """The states of all objects at mid exposure; None to a sensor that is not told the truth."""
    if not frames:
        return None
    message = protocol.ObjectStates.FromString(frames[0])
    states: ObjectStates = with_arrays(record_of(message, start), message.arrays, frames[1])
    states.roster = roster
    return states


def exposure_of(asked: Any) -> Exposure:
    """The exposure of a request."""
    return Exposure(asked.sensor, asked.frame, asked.tick, asked.start_ns / 1e9, asked.middle_ns / 1e9, asked.end_ns / 1e9,
                    asked.start_ns, asked.middle_ns, asked.end_ns, numbers_of(asked.position_m),
                    numbers_of(asked.velocity_m_per_s))


def packed(said: Any, exposure: Exposure) -> Any:
    """What a sensor says, as OwnNodeObserved."""
    if not isinstance(said, Sightings):
        said = Sightings([said] if isinstance(said, Sighting) else said)
    boresight = exposure.position_m if said.boresight is None else said.boresight
    ra_rad, dec_rad = _angles(np.asarray(boresight, np.float64), "boresight")
    observed = protocol.OwnNodeObserved(frame=exposure.frame, boresight_ra_rad=ra_rad, boresight_dec_rad=dec_rad)
    if said.limiting_magnitude is not None:
        observed.limiting_magnitude = float(said.limiting_magnitude)
    for each in list_of(said.sightings, Sighting, "a sensor returns dmise.Sightings, or a list of dmise.Sighting"):
        for one in one_by_one(each, _count_of(each)):
            _add(observed, one, exposure)
    return observed


def _count_of(sighting: Sighting) -> int | None:
    """The number of sightings in one, if it is of arrays."""
    if sighting.direction is not None:
        return np.shape(sighting.direction)[1] if np.ndim(sighting.direction) == 2 else None
    return np.shape(sighting.ra_rad)[0] if np.ndim(sighting.ra_rad) == 1 else None


def _angles(direction: Floats, name: str) -> tuple[float, float]:
    if direction.shape != (3,):
        raise ValueError(f"{name}: must have the shape (3,), got {direction.shape}")
    x, y, z = (float(value) for value in direction)
    if not 0.0 < math.hypot(x, y, z) < math.inf:
        raise ValueError(f"{name}: must be a finite direction, got {direction.tolist()}")
    return math.atan2(y, x), math.atan2(z, math.hypot(x, y))


def _add(observed: Any, sighting: Sighting, exposure: Exposure) -> None:
    added = observed.sightings.add(time_ns=_time_ns(sighting, exposure))
    if sighting.direction is not None:
        added.ra_rad, added.dec_rad = _angles(np.asarray(sighting.direction, np.float64), "direction")
    elif sighting.ra_rad is None or sighting.dec_rad is None:
        raise ValueError("direction, or ra_rad and dec_rad: is needed")
    else:
        added.ra_rad, added.dec_rad = number_of(sighting, "ra_rad"), number_of(sighting, "dec_rad")
    if sighting.covariance_rad2 is not None:
        added.covariance_rad2.extend(numbers_in(sighting, "covariance_rad2", 3))
    elif sighting.sigma_rad is not None:
        variance = variance_of(sighting, "sigma_rad")
        added.covariance_rad2.extend([variance, 0.0, variance])
    else:
        raise ValueError("sigma_rad or covariance_rad2: is needed")
    for name, sigma in (("magnitude", "magnitude_sigma"), ("range_m", "range_sigma_m"),
                        ("range_rate_m_per_s", "range_rate_sigma_m_per_s")):
        if getattr(sighting, name) is not None:
            setattr(added, name, number_of(sighting, name))
            setattr(added, sigma, number_of(sighting, sigma))
    if sighting.snr is not None:
        added.snr = number_of(sighting, "snr")


def _time_ns(sighting: Sighting, exposure: Exposure) -> int:
    if sighting.time_s is None:
        return exposure.middle_ns
    time_ns = round(number_of(sighting, "time_s") * 1e9)
    nearest_ns = min(max(time_ns, exposure.start_ns), exposure.end_ns)
    return nearest_ns if abs(time_ns - nearest_ns) <= ROUNDING_NS else time_ns
