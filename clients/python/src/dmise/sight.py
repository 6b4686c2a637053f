"""The line of sight of a detection: where the object is, as far as one frame tells."""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .records import Detection, Floats

SPEED_OF_LIGHT_M_PER_S = 299_792_458.0


@dataclass
class LineOfSight:
    """An object of unknown range rho is at `origin_m + rho * direction`, when its light left it: rho / c before `time_ns`.

    time_ns           of reception, since the start of the scenario
    origin_m          3, GCRS: the sensor, displaced to where the line outside the air begins
    direction         3, GCRS, unit: without aberration; what is left of refraction is in `origin_m`
    covariance_rad2   2 x 2, along east and north (ra cos dec, dec)
    """
    time_ns: int
    origin_m: Floats
    direction: Floats
    covariance_rad2: Floats

    @property
    def ra_rad(self) -> float:
        return math.atan2(self.direction[1], self.direction[0])

    @property
    def dec_rad(self) -> float:
        return math.asin(self.direction[2])

    @property
    def tangents(self) -> Floats:
        """2 x 3, GCRS: unit vectors east and north on the sky at `direction`."""
        return np.array([[-math.sin(self.ra_rad), math.cos(self.ra_rad), 0.0],
                         np.cross(self.direction, [-math.sin(self.ra_rad), math.cos(self.ra_rad), 0.0])])


def direction_of(ra_rad: float, dec_rad: float) -> Floats:
    """The unit vector of a right ascension and declination."""
    return np.array([math.cos(dec_rad) * math.cos(ra_rad), math.cos(dec_rad) * math.sin(ra_rad), math.sin(dec_rad)])


def line_of_sight(detection: Detection) -> LineOfSight:
    """The line of sight of a detection whose range will be found (docs/wire.md, Directions of detections).

    A detection assumes a mean refraction parallax and has its scatter in the covariance, for it knows no range; both
    are removed, and the line starts `refraction_offset_m` beside the sensor instead.
    """
    covariance = np.array([[detection.covariance_rad2[0], detection.covariance_rad2[1]],
                           [detection.covariance_rad2[1], detection.covariance_rad2[2]]])
    sight = LineOfSight(detection.time_ns, detection.sensor_position_m + detection.refraction_offset_m,
                        direction_of(detection.corrected_ra_rad, detection.corrected_dec_rad), covariance)
    offset_m = float(np.linalg.norm(detection.refraction_offset_m))
    if offset_m > 0.0:
        upwards = detection.refraction_offset_m / offset_m
        along = sight.tangents @ upwards
        sight.covariance_rad2 -= detection.refraction_parallax_sigma_rad ** 2 * np.outer(along, along)
        lowered = sight.direction - detection.refraction_parallax_rad * upwards
        sight.direction = lowered / np.linalg.norm(lowered)
    return sight
