"""What sensors publish, as objects (`world` has the rest): fields, names and units are those of proto/dmise/v1, which says what they mean.

Lists of numbers are numpy arrays, matrices have two dimensions, enumerations are their names in small letters.
Times `X_ns` are nanoseconds since the start of the scenario at the rate of TAI; `X_utc` is the same as UTC.
"""
from __future__ import annotations

import dataclasses
import datetime
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .leap_seconds import utc_after

ArrayLike = npt.NDArray[Any]
Floats = npt.NDArray[np.float64]
Instant = Literal["start", "middle", "end"]
MagnitudeSystem = Literal["v_solar", "vega", "ab"]  # docs/models/sky.md


def no_numbers() -> Floats:
    """What a list of numbers is until it is given."""
    return np.zeros(0)


class Record:
    """Fields are equal if all numbers are. `start_utc_of_run`: what times are counted from."""

    start_utc_of_run: datetime.datetime | None = None

    def utc(self, time_ns: int) -> datetime.datetime:
        """A time of this record as UTC, to the microsecond before; a leap second is the second 59 with fold = 1."""
        if self.start_utc_of_run is None:
            raise ValueError("the run does not tell when it starts")
        return utc_after(self.start_utc_of_run, time_ns // 1000)

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and all(
            np.array_equal(getattr(self, f.name), getattr(other, f.name))
            for f in dataclasses.fields(self))  # type: ignore[arg-type]


@dataclass(eq=False)
class LightPeriod(Record):
    """A period in the light of a streak."""
    period_px: float = 0.0  # along the line
    period_sigma_px: float = 0.0
    period_s: float = 0.0  # by the time that the object takes from end to end
    period_sigma_s: float = 0.0
    amplitude: float = 0.0  # half of most less least light, over the mean light
    amplitude_sigma: float = 0.0
    harmonics: int = 0
    false_alarm: float = 0.0  # probability, at most


@dataclass(eq=False)
class LightCurve(Record):
    """Light of a streak over time, in bins along its line, from end 1 to end 2."""
    bin_px: float = 0.0
    along_px: Floats = field(default_factory=no_numbers)  # middle of each bin, from end 1
    time_s: Floats = field(default_factory=no_numbers)  # after the start of the exposure
    light_e: Floats = field(default_factory=no_numbers)
    sigma_e: Floats = field(default_factory=no_numbers)
    correlation: Floats = field(default_factory=no_numbers)  # between the errors of a bin and of the next one
    period: LightPeriod | None = None
    min_period_px: float | None = None  # where the light varies without showing its period: shorter ones are ruled out
    min_period_s: float | None = None

    @property
    def covariance_e2(self) -> Floats:
        """Covariance of the bins' light; without the small covariances of bins that are no neighbours."""
        both = self.correlation[:-1] * self.sigma_e[:-1] * self.sigma_e[1:]
        return np.diag(self.sigma_e ** 2) + np.diag(both, 1) + np.diag(both, -1)


@dataclass(eq=False)
class Detection(Record):
    """One source found in one frame, from its pixels and header alone."""
    id: str = ""
    sensor: str = ""
    frame: int = 0
    index: int = 0
    kind: Literal["point", "streak"] = "point"
    epoch: Instant = "start"
    time_ns: int = 0
    ra_rad: float = 0.0
    dec_rad: float = 0.0
    corrected_ra_rad: float = 0.0
    corrected_dec_rad: float = 0.0
    covariance_rad2: Floats = field(default_factory=no_numbers)
    sensor_position_m: Floats = field(default_factory=no_numbers)
    sensor_velocity_m_per_s: Floats = field(default_factory=no_numbers)
    light_time_removed: bool = False
    aberration_removed: bool = False
    refraction_removed: bool = False
    magnitude: float = 0.0
    magnitude_sigma: float = 0.0
    band: str = ""
    snr: float = 0.0
    x_px: float = 0.0
    y_px: float = 0.0
    covariance_px2: Floats = field(default_factory=no_numbers)
    signal_e: float = 0.0
    end1_x_px: float = 0.0
    end1_y_px: float = 0.0
    end2_x_px: float = 0.0
    end2_y_px: float = 0.0
    end1_ra_rad: float = 0.0
    end1_dec_rad: float = 0.0
    end2_ra_rad: float = 0.0
    end2_dec_rad: float = 0.0
    end1_time_ns: int = 0
    end2_time_ns: int = 0
    direction_known: bool = False
    length_px: float = 0.0
    rate_rad_per_s: float = 0.0
    saturated: bool = False
    at_edge: bool = False
    star_like: bool = False
    end1_covariance_rad2: Floats = field(default_factory=no_numbers)
    end2_covariance_rad2: Floats = field(default_factory=no_numbers)
    refraction_offset_m: Floats = field(default_factory=no_numbers)
    refraction_parallax_rad: float = 0.0
    refraction_parallax_sigma_rad: float = 0.0
    position_angle_rad: float = 0.0
    magnitude_system: MagnitudeSystem = "v_solar"
    excluded: bool = False  # Sun, Moon or limb was nearer to the axis than the camera allows
    range_m: float | None = None  # if the sensor measures it
    range_sigma_m: float | None = None
    range_rate_m_per_s: float | None = None
    range_rate_sigma_m_per_s: float | None = None
    light_curve: LightCurve | None = None  # for a streak, where the detector was asked for it

    @property
    def time_utc(self) -> datetime.datetime:
        return self.utc(self.time_ns)

    @property
    def end1_time_utc(self) -> datetime.datetime:
        return self.utc(self.end1_time_ns)

    @property
    def end2_time_utc(self) -> datetime.datetime:
        return self.utc(self.end2_time_ns)


@dataclass(eq=False)
class Track(Record):
    """What is known of one object at a tick. `associated`: ids of the detections that it took at this tick."""
    id: int = 0
    status: Literal["tentative", "confirmed", "lost"] = "tentative"
    time_ns: int = 0
    position_m: Floats = field(default_factory=no_numbers)
    velocity_m_per_s: Floats = field(default_factory=no_numbers)
    covariance: Floats = field(default_factory=no_numbers)
    drag_m2_per_kg: float = 0.0
    drag_sigma_m2_per_kg: float = 0.0
    srp_m2_per_kg: float = 0.0
    srp_sigma_m2_per_kg: float = 0.0
    catalogue_number: int = 0
    name: str = ""
    existence: float = 0.0
    detections: int = 0
    associated: list[str] = field(default_factory=list)
    innovation_d2: float = 0.0
    last_seen_ns: int = 0
    magnitude: float = 0.0

    @property
    def time_utc(self) -> datetime.datetime:
        return self.utc(self.time_ns)

    @property
    def last_seen_utc(self) -> datetime.datetime:
        return self.utc(self.last_seen_ns)

    @property
    def covariance_matrix(self) -> Floats:
        """6 x 6, of position and velocity."""
        matrix = np.zeros((6, 6))
        matrix[np.tril_indices(6)] = self.covariance
        return matrix + np.tril(matrix, -1).T


@dataclass(eq=False)
class Task(Record):
    """What a fusion node tells a sensor to observe, and why: from `on_target_ns` to `end_ns` it follows the predicted path.

    `path_m`, `path_m_per_s`: 3 x n, all of the first point first, every `path_step_s` from `path_start_ns`.
    """
    id: int = 0
    sensor: str = ""
    track: int = 0
    catalogue_number: int = 0
    name: str = ""
    given_ns: int = 0
    start_ns: int = 0
    on_target_ns: int = 0
    end_ns: int = 0
    first_frame: int = 0
    exposures: int = 0
    gain_nats: float = 0.0
    gain_nats_per_s: float = 0.0
    candidates: int = 0
    runner_up: int = 0
    runner_up_nats_per_s: float = 0.0
    in_field: float = 0.0
    detection_probability: float = 0.0
    sigma_rad: float = 0.0
    slew_rad: float = 0.0
    slew_s: float = 0.0
    covariance: Floats = field(default_factory=no_numbers)
    path_start_ns: int = 0
    path_step_s: float = 0.0
    path_m: Floats = field(default_factory=no_numbers)
    path_m_per_s: Floats = field(default_factory=no_numbers)

    @property
    def given_utc(self) -> datetime.datetime:
        return self.utc(self.given_ns)

    @property
    def on_target_utc(self) -> datetime.datetime:
        return self.utc(self.on_target_ns)

    @property
    def end_utc(self) -> datetime.datetime:
        return self.utc(self.end_ns)


class _Exposure(Record):
    start_ns: int
    middle_ns: int
    end_ns: int

    @property
    def start_utc(self) -> datetime.datetime:
        return self.utc(self.start_ns)

    @property
    def middle_utc(self) -> datetime.datetime:
        return self.utc(self.middle_ns)

    @property
    def end_utc(self) -> datetime.datetime:
        return self.utc(self.end_ns)


@dataclass(eq=False)
class Truth(_Exposure):
    """One object near one frame as it was."""
    sensor: str = ""
    frame: int = 0
    catalogue_number: int = 0
    name: str = ""
    start_ns: int = 0
    middle_ns: int = 0
    end_ns: int = 0
    true_range_m: float = 0.0
    true_ra_rad: float = 0.0
    true_dec_rad: float = 0.0
    apparent_ra_rad: float = 0.0
    apparent_dec_rad: float = 0.0
    true_elevation_rad: float = 0.0
    phase_angle_rad: float = 0.0
    sunlit: float = 0.0
    true_magnitude: float = 0.0
    rendered_signal_e: float = 0.0
    rendered_x_px: float = 0.0
    rendered_y_px: float = 0.0
    start_x_px: float = 0.0
    start_y_px: float = 0.0
    middle_x_px: float = 0.0
    middle_y_px: float = 0.0
    end_x_px: float = 0.0
    end_y_px: float = 0.0
    in_frame: bool = False
    whole: bool = False
    resolved: bool = False
    camera_from_gcrs: Floats = field(default_factory=no_numbers)
    true_position_m: Floats = field(default_factory=no_numbers)
    true_velocity_m_per_s: Floats = field(default_factory=no_numbers)
    defocus_disc_px: float = 0.0


@dataclass(eq=False)
class WcsRefraction(Record):
    """The air's own part of a frame's world coordinates."""
    zenith: Floats = field(default_factory=no_numbers)
    focal_length_px: float = 0.0
    pressure_hpa: float = 0.0
    temperature_c: float = 0.0
    humidity: float = 0.0
    wavelength_um: float = 0.0
    offset_x_px: float = 0.0
    offset_y_px: float = 0.0
    cell_px: float = 0.0
    lens: int | None = None
    lens_coefficients: Floats = field(default_factory=no_numbers)


@dataclass(eq=False)
class Wcs(Record):
    """A frame's world coordinates: `cd_deg` is 2 x 2, polynomials are (order + 1) x (order + 1)."""
    crpix_x_px: float = 0.0
    crpix_y_px: float = 0.0
    ra_rad: float = 0.0
    dec_rad: float = 0.0
    cd_deg: Floats = field(default_factory=no_numbers)
    order: int = 0
    a: Floats = field(default_factory=no_numbers)
    b: Floats = field(default_factory=no_numbers)
    ap: Floats = field(default_factory=no_numbers)
    bp: Floats = field(default_factory=no_numbers)
    rms_px: float = 0.0
    max_px: float = 0.0
    projection: int = 0
    coefficients: Floats = field(default_factory=no_numbers)
    refraction: WcsRefraction | None = None

    def __post_init__(self) -> None:
        self.cd_deg = self.cd_deg.reshape(-1, 2)
        for name in ("a", "b", "ap", "bp"):
            polynomial = getattr(self, name)
            setattr(self, name, polynomial.reshape(-1, self.order + 1) if polynomial.size else polynomial)


@dataclass(eq=False)
class FrameReport(_Exposure):
    """One exposure, also if nothing was found in it."""
    sensor: str = ""
    frame: int = 0
    start_ns: int = 0
    middle_ns: int = 0
    end_ns: int = 0
    boresight_ra_rad: float = 0.0
    boresight_dec_rad: float = 0.0
    wcs: Wcs | None = None
    sensor_position_m: Floats = field(default_factory=no_numbers)
    sensor_velocity_m_per_s: Floats = field(default_factory=no_numbers)
    limiting_magnitude: float = 0.0
    background_e: float = 0.0
    noise_e: float = 0.0
    zero_point_mag: float = 0.0
    detections: int = 0
    star_like: int = 0
    saturated_px: int = 0
    stars_rendered: int = 0
    objects_rendered: int = 0
    plan: str = ""
    detection_off: bool = False
    psf_fwhm_px: float = 0.0
    psf_stars: int = 0
    stars_expected: int = 0
    stars_found: int = 0
    magnitude_system: MagnitudeSystem = "v_solar"  # all magnitudes here and of the frame's detections
    solar_colour_mag: float = 0.0  # a magnitude in it less the V-solar one of the same source
    shutter_closed: bool = False  # because of a body that excludes: the frame is dark, and detection_off
    sun_excludes: bool = False  # it was nearer to the axis than the camera allows
    moon_excludes: bool = False
    earth_limb_excludes: bool = False
