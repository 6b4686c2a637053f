"""Detections of a run for Stone Soup (PyPI `stonesoup`): a reader, a model of angles, a model of orbits, an initiator.

States are 6: position [m] and velocity [m/s], GCRS. Times are UTC, without time zone, as Stone Soup has them.
"""
from __future__ import annotations

import datetime
from collections.abc import Iterator
from typing import Any

import numpy as np

try:
    from stonesoup.base import Property
    from stonesoup.buffered_generator import BufferedGenerator
    from stonesoup.initiator.base import GaussianInitiator
    from stonesoup.models.base import GaussianModel
    from stonesoup.models.measurement.nonlinear import NonLinearGaussianMeasurement
    from stonesoup.models.transition.base import TransitionModel
    from stonesoup.reader import DetectionReader as _DetectionReader
    from stonesoup.types.array import CovarianceMatrix, StateVector, StateVectors
    from stonesoup.types.detection import Detection as _Detection
    from stonesoup.types.hypothesis import SingleHypothesis
    from stonesoup.types.prediction import GaussianStatePrediction
    from stonesoup.types.track import Track
    from stonesoup.types.update import GaussianStateUpdate
except ImportError as missing:
    raise ImportError(f"{missing.name}: not installed; dmise.stonesoup needs stonesoup: pip install stonesoup",
                      name=missing.name) from None

from . import records
from .dynamics import apparent_direction, pole_of, propagate
from .orbit_fit import fit_orbit, is_bound, triangulate, velocity_between
from .sight import LineOfSight, line_of_sight
from .subscription import subscribe

_ARCSEC = np.pi / 648000.0


class AngleOnly(NonLinearGaussianMeasurement):
    """East and north of a line of sight [rad], in its tangent plane: no wrap of angles, no pole.

    Predicts where an object of a state is seen from the sensor, with light time; `noise_covar` is 2 x 2.
    """
    sight: LineOfSight = Property(doc="The line of sight whose plane it is")
    ndim_state: int = Property(default=6, doc="Position and velocity")
    mapping: Any = Property(default=(0, 1, 2), doc="Where the position is in a state")

    @property
    def ndim_meas(self) -> int:
        return 2

    def function(self, state: Any, noise: Any = False, **kwargs: Any) -> Any:
        vectors = state.state_vector
        seen = apparent_direction(np.asarray(vectors, dtype=np.float64).reshape(6, -1), self.sight.origin_m)
        offset = self.sight.tangents @ seen / (self.sight.direction @ seen)
        kind = StateVectors if isinstance(vectors, StateVectors) else StateVector
        added = self.rvs(num_samples=offset.shape[1], **kwargs) if noise is True else noise or 0.0
        return kind(offset) + added

    def rvs(self, num_samples: int = 1, **kwargs: Any) -> Any:
        return super().rvs(num_samples, **kwargs)


class TwoBodyJ2(TransitionModel, GaussianModel):
    """Two bodies and J2 about the pole of date. What it lacks is white noise of acceleration, of density `noise_diff_coeff`."""
    noise_diff_coeff: float = Property(default=1e-8, doc="[m^2/s^3]; 1e-8: 1 cm after 20 s, 1 m after 7 min")

    @property
    def ndim_state(self) -> int:
        return 6

    def function(self, state: Any, noise: Any = False, time_interval: Any = None, **kwargs: Any) -> Any:
        vectors = state.state_vector
        moved = propagate(np.asarray(vectors, dtype=np.float64).reshape(6, -1),
                          time_interval.total_seconds() if time_interval else 0.0, pole_of(state.timestamp))
        kind = StateVectors if isinstance(vectors, StateVectors) else StateVector
        added = self.rvs(num_samples=moved.shape[1], time_interval=time_interval, **kwargs) if noise is True else noise or 0.0
        return kind(moved) + added

    def covar(self, time_interval: Any = None, **kwargs: Any) -> Any:
        t = abs(time_interval.total_seconds()) if time_interval else 0.0
        return CovarianceMatrix(np.kron(self.noise_diff_coeff * np.array([[t ** 3 / 3, t ** 2 / 2], [t ** 2 / 2, t]]), np.eye(3)))


def to_stonesoup(detection: records.Detection, sigma_arcsec: float = 0.0) -> Any:
    """A Detection of Stone Soup: at (0, 0) of the plane of its own line of sight.

    sigma_arcsec  error of the sensor's pointing on each axis, of which a detection knows nothing

    Its metadata: `sight`, `id`, `sensor`, `frame`, `ra_rad`, `dec_rad` (corrected), `magnitude`, `snr`.
    """
    sight = line_of_sight(detection)
    sight.covariance_rad2 = sight.covariance_rad2 + (sigma_arcsec * _ARCSEC) ** 2 * np.eye(2)
    metadata = {"sight": sight, "ra_rad": detection.corrected_ra_rad, "dec_rad": detection.corrected_dec_rad}
    metadata.update((name, getattr(detection, name)) for name in ("id", "sensor", "frame", "magnitude", "snr"))
    return _Detection(StateVector([0.0, 0.0]), timestamp=detection.time_utc.replace(tzinfo=None), metadata=metadata,
                      measurement_model=AngleOnly(noise_covar=CovarianceMatrix(sight.covariance_rad2), sight=sight))


class DetectionReader(_DetectionReader):
    """Detections of a live run, or of a replay: a set for each frame, in the order of complete ticks, then of time.

    Sets of frames that different sensors took at once have the same time, each its own set: a tracker gives a track at most
    one detection of a set. Errors are those of `dmise.subscribe`.
    """
    address: str = Property(doc="tcp://HOST:PORT of the time-master")
    topics: Any = Property(default=("detection/",), doc="As of dmise.subscribe")
    sigma_arcsec: float = Property(default=0.0, doc="Error of the sensors' pointing on each axis")
    options: Any = Property(default=None, doc="Further options of dmise.subscribe, a dictionary")
    heard: Any = Property(default=None, doc="Is called with the records of each message, in the same order; None: nobody is")

    @BufferedGenerator.generator_method
    def detections_gen(self) -> Iterator[tuple[datetime.datetime, set[Any]]]:
        with subscribe(self.address, *self.topics, **(self.options or {})) as subscription:
            for _, messages in subscription.ticks():
                for found in sorted(filter(None, map(subscription.records_of, messages)), key=_time_and_sensor):
                    if self.heard is not None:
                        self.heard(found)
                    by_time: dict[int, set[Any]] = {}
                    for detection in found:
                        if isinstance(detection, records.Detection):
                            by_time.setdefault(detection.time_ns, set()).add(to_stonesoup(detection, self.sigma_arcsec))
                    for time_ns in sorted(by_time):
                        yield next(iter(by_time[time_ns])).timestamp, by_time[time_ns]


def _time_and_sensor(found: list[Any]) -> tuple[int, str]:
    return getattr(found[0], "time_ns", getattr(found[0], "middle_ns", 0)), getattr(found[0], "sensor", "")


class TriangulationInitiator(GaussianInitiator):
    """Begins tracks of objects that two sites saw at two times: triangulated at each, then fitted to all four lines of sight.

    A fit needs a bound orbit and a chi-squared of its two degrees of freedom below `most_chi_squared`.
    """
    memory_s: float = Property(default=60.0, doc="How long detections are kept for a second time [s]")
    most_miss_squared: float = Property(default=16.0, doc="Of two lines of sight, squared distance over its variance")
    most_chi_squared: float = Property(default=16.0, doc="Of the fit")

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._loose: list[Any] = []
        self._pairs: list[tuple[Any, Any, Any]] = []

    def initiate(self, detections: Any, timestamp: datetime.datetime, **kwargs: Any) -> set[Any]:
        horizon = timestamp - datetime.timedelta(seconds=self.memory_s)
        self._loose = [loose for loose in self._loose if loose.timestamp == timestamp]
        self._pairs = [pair for pair in self._pairs if pair[0].timestamp >= horizon]
        tracks: set[Any] = set()
        used: set[Any] = set()
        for new in sorted(detections, key=lambda d: d.metadata["id"]):
            for other in self._loose:
                here = triangulate(other.metadata["sight"], new.metadata["sight"]) \
                    if other.metadata["sensor"] != new.metadata["sensor"] and not {other, new} & used else None
                if here is None or here.miss_squared > self.most_miss_squared:
                    continue
                begun = self._begin(other, new, here)
                if begun is None:
                    self._pairs.append((other, new, here))
                    continue
                track, pair = begun
                tracks.add(track)
                used |= {other, new}
                self._pairs = [p for p in self._pairs if not {p[0], p[1]} & {pair[0], pair[1], other, new}]
            self._loose.append(new)
        self._loose = [loose for loose in self._loose if loose not in used]
        return tracks

    def _begin(self, first: Any, second: Any, here: Any) -> Any:
        """The track, and the pair before, of the best fit; None: none is good."""
        pole, time_ns, best = pole_of(second.timestamp), second.metadata["sight"].time_ns, None
        for pair in self._pairs:
            interval_s = (time_ns - pair[0].metadata["sight"].time_ns) / 1e9
            if interval_s <= 0.0:
                continue
            start = np.concatenate([here.position_m, velocity_between(pair[2].position_m, here.position_m, interval_s, pole)])
            if not is_bound(start):
                continue
            try:
                orbit = fit_orbit([d.metadata["sight"] for d in (*pair[:2], first, second)], start, time_ns, pole)
            except np.linalg.LinAlgError:
                continue
            if is_bound(orbit.state) and orbit.chi_squared < (best[0].chi_squared if best else self.most_chi_squared):
                best = orbit, pair
        return best and (self._track(best[0], second), best[1])

    @staticmethod
    def _track(orbit: Any, last: Any) -> Any:
        covariance = CovarianceMatrix((orbit.covariance + orbit.covariance.T) / 2.0)
        prediction = GaussianStatePrediction(StateVector(orbit.state), covariance, timestamp=last.timestamp)
        return Track([GaussianStateUpdate(StateVector(orbit.state), covariance, timestamp=last.timestamp,
                                          hypothesis=SingleHypothesis(prediction, last))])
