"""The states of the world that a run publishes, as objects like those of `records`."""
from __future__ import annotations

import datetime
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from .records import Floats, Record, no_numbers


class _OfATick(Record):
    time_ns: int

    @property
    def time_utc(self) -> datetime.datetime:
        return self.utc(self.time_ns)


@dataclass(eq=False)
class EarthOrientation(_OfATick):
    """Orientation of the Earth around a time; rotations are 3 x 3."""
    time_ns: int = 0
    cirs_from_gcrs: Floats = field(default_factory=no_numbers)
    itrs_from_tirs: Floats = field(default_factory=no_numbers)
    era_rad: float = 0.0
    era_rate_rad_per_s: float = 0.0
    gmst82_rad: float = 0.0
    gmst82_rate_rad_per_s: float = 0.0

    def __post_init__(self) -> None:
        self.cirs_from_gcrs = self.cirs_from_gcrs.reshape(-1, 3)
        self.itrs_from_tirs = self.itrs_from_tirs.reshape(-1, 3)


@dataclass(eq=False)
class EnvironmentState(_OfATick):
    """The world that all sensors share."""
    tick: int = 0
    time_ns: int = 0
    earth: EarthOrientation | None = None
    sun_m: Floats = field(default_factory=no_numbers)
    moon_m: Floats = field(default_factory=no_numbers)
    earth_barycentric_m: Floats = field(default_factory=no_numbers)
    earth_velocity_m_per_s: Floats = field(default_factory=no_numbers)
    tt_jd1_days: float = 0.0
    tt_jd2_days: float = 0.0
    moon_velocity_m_per_s: Floats = field(default_factory=no_numbers)
    earth_beside: list[EarthOrientation] = field(default_factory=list)


@dataclass(eq=False)
class SiteState(_OfATick):
    """The air over a sensor on the ground."""
    tick: int = 0
    time_ns: int = 0
    sensor: str = ""
    extinction_mag_per_airmass: float = 0.0
    pressure_hpa: float = 0.0
    temperature_c: float = 0.0
    humidity: float = 0.0
    cloud_transmission: float = 0.0
    r0_m: float = 0.0
    isoplanatic_angle_rad: float = 0.0
    tau0_s: float = 0.0
    turbulence_m_per_s: float = 0.0


@dataclass(eq=False)
class SunTrackingPanel(Record):
    """A panel that turns about its hinge; body axes."""
    hinge_x: float = 0.0
    hinge_y: float = 0.0
    hinge_z: float = 0.0
    normal_x: float = 0.0
    normal_y: float = 0.0
    normal_z: float = 0.0


@dataclass(eq=False)
class ObjectInfo(Record):
    """An object of the roster."""
    catalogue_number: int = 0
    name: str = ""
    designator: str = ""
    radius_m: float = 0.0
    albedo: float = 0.0
    element_age_s: float = 0.0
    panel: SunTrackingPanel | None = None


@dataclass(eq=False)
class ObjectRoster(Record):
    """All objects of the run; an object's place in the list is its index. `elements`: 9 x k, of the first k."""
    objects: list[ObjectInfo] = field(default_factory=list)
    elements: Floats = field(default_factory=no_numbers)

    def index_of(self, name: str | int) -> int:
        """The index of an object by its name or catalogue number. Raises KeyError."""
        for index, known in enumerate(self.objects):
            if name in (known.name, known.catalogue_number):
                return index
        raise KeyError(name)


@dataclass(eq=False)
class ObjectStates(_OfATick):
    """States of all objects of the roster at a tick, GCRS. Arrays are 3 x count; `code` is 0 or why there is no state.

    Attitudes are of the objects in `attitude_object` alone: empty where no object has one.
    """
    tick: int = 0
    time_ns: int = 0
    count: int = 0
    position_m: Floats = field(default_factory=no_numbers)
    slope_m_per_s: Floats = field(default_factory=no_numbers)
    velocity_m_per_s: Floats = field(default_factory=no_numbers)
    code: npt.NDArray[np.uint8] = field(default_factory=lambda: np.zeros(0, np.uint8))
    attitude_object: npt.NDArray[np.uint32] = field(default_factory=lambda: np.zeros(0, np.uint32))
    gcrs_from_body: Floats = field(default_factory=no_numbers)
    attitude_rate_rad_per_s: Floats = field(default_factory=no_numbers)
    albedo: Floats = field(default_factory=no_numbers)  # `count` numbers, < 0: that of the roster; empty: all are
    roster: ObjectRoster | None = field(default=None, repr=False)
