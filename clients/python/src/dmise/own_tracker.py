"""A tracker of one's own in a run: `tracker` marks it, `serve` runs it (docs/howto/plug-in-a-model.md).

    @dmise.tracker
    def track(t_s, frames, world, options):
        return dmise.Tracks([dmise.Track(id=1, position_m=.., velocity_m_per_s=.., covariance=..)],
                            tasks=[dmise.Point("telescope", track=1)])
    dmise.serve(track)
"""
from __future__ import annotations

import datetime
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import protocol
from .convert import record_of, with_arrays
from .own_served import Served, list_of
from .records import Detection, Floats, FrameReport, Track
from .world import ObjectRoster

SYMMETRIC_TO = 1e-6  # part of the standard deviations' product


@dataclass
class SearchedFrame:
    """A frame that was searched at a tick, and what was found in it."""
    report: FrameReport
    detections: list[Detection]


@dataclass
class Sensor:
    """What a tracker is told of a sensor: a site on the ground (geodetic, above the ellipsoid), or the object that carries it."""
    name: str
    columns: int
    rows: int
    cued: bool  # it observes what it is tasked with, and nothing else
    exposure_s: float
    cadence_s: float
    platform: str = ""
    latitude_deg: float | None = None
    longitude_deg: float | None = None
    height_m: float | None = None


@dataclass
class Known:
    """What a tracker is told as it begins."""
    sensors: list[Sensor] = field(default_factory=list)
    catalogue: ObjectRoster = field(default_factory=ObjectRoster)  # objects that it may know, with their elements
    cue_delay_ticks: int = 0  # between the tick of a task and its beginning


@dataclass
class Point:
    """A sensor that is cued is to observe a track, if it is free; `exposures` at most, 0: as its settings say."""
    sensor: str
    track: int
    exposures: int = 0


@dataclass
class Tracks:
    """What a tracker says of a tick: the tracks that changed, and tasks; with None the scheduler of the run chooses them."""
    tracks: Sequence[Track] = ()
    tasks: Sequence[Point] | None = None


class Tracker(Served):
    """A function `f(t_s, frames, world, options)` that returns tracks, or a class whose instances are called so.

    A class may have `checkpoint() -> bytes` and `restore(bytes)`; else what it remembers is made again from the first tick.
    """

    mark = "tracker"


def tracker(model: Callable[..., Any]) -> Tracker:
    """Marks a function or class that makes tracks of the detections of all sensors."""
    return Tracker(model)


def known_of(tracking: Any, frames: Sequence[bytes], start: datetime.datetime | None) -> Known:
    """What `begin` and the frames after it say."""
    roster, arrays = frames
    message = protocol.ObjectRoster.FromString(roster)
    catalogue = with_arrays(record_of(message, start), message.arrays, arrays)
    return Known([_sensor(one) for one in tracking.sensors], catalogue, tracking.cue_delay_ticks)


def _sensor(sensor: Any) -> Sensor:
    place = [sensor.site.latitude_deg, sensor.site.longitude_deg, sensor.site.height_m] if sensor.HasField("site") else []
    return Sensor(sensor.name, sensor.columns, sensor.rows, sensor.cued, sensor.exposure_s, sensor.cadence_s, sensor.platform,
                  *place)


def frames_of(frames: Sequence[bytes], start: datetime.datetime | None) -> list[SearchedFrame]:
    """The frames of a request: reports and detections in turn."""
    return [SearchedFrame(record_of(protocol.FrameReport.FromString(report), start),
                          [record_of(one, start) for one in protocol.DetectionSet.FromString(found).detections])
            for report, found in zip(frames[::2], frames[1::2], strict=True)]


def packed(said: Any, tick: int, time_ns: int) -> tuple[Any, Any]:
    """What a tracker says, as OwnNodeTracked and TrackSet."""
    wanted = "a tracker returns dmise.Tracks, or a list of dmise.Track"
    if not isinstance(said, Tracks):
        said = Tracks(list_of(said, Track, wanted))
    tracked, tracks = protocol.OwnNodeTracked(), protocol.TrackSet(tick=tick, time_ns=time_ns)
    for track in sorted(list_of(said.tracks, Track, wanted), key=lambda one: one.id):
        _add(tracks, track, time_ns)
    if said.tasks is not None:
        tracked.points.SetInParent()
        for point in list_of(said.tasks, Point, "the tasks of dmise.Tracks are a list of dmise.Point"):
            tracked.points.points.add(sensor=point.sensor, track=point.track, exposures=point.exposures)
    return tracked, tracks


def _add(tracks: Any, track: Track, time_ns: int) -> None:
    try:
        tracks.tracks.add(id=track.id, status=f"TRACK_STATUS_{track.status.upper()}", time_ns=time_ns,
                          position_m=_numbers(track, "position_m", 3), velocity_m_per_s=_numbers(track, "velocity_m_per_s", 3),
                          covariance=_triangle(track.covariance), existence=track.existence, innovation_d2=track.innovation_d2,
                          catalogue_number=track.catalogue_number, magnitude=track.magnitude, associated=track.associated,
                          drag_m2_per_kg=track.drag_m2_per_kg, drag_sigma_m2_per_kg=track.drag_sigma_m2_per_kg,
                          srp_m2_per_kg=track.srp_m2_per_kg, srp_sigma_m2_per_kg=track.srp_sigma_m2_per_kg)
    except (TypeError, ValueError) as error:
        raise ValueError(f"track {track.id}: {error}") from None


def _numbers(track: Track, name: str, count: int) -> Floats:
    numbers = np.asarray(getattr(track, name), np.float64).ravel()
    if numbers.shape != (count,):
        raise ValueError(f"{name}: must have {count} numbers, got the shape {np.shape(getattr(track, name))}")
    return numbers


def _triangle(covariance: Any) -> Floats:
    """The lower triangle by rows of a matrix, or what is one already."""
    matrix = np.asarray(covariance, np.float64)
    if matrix.shape == (21,):
        return matrix
    if matrix.shape != (6, 6):
        raise ValueError(f"covariance: must have the shape (6, 6), or (21,) of its lower triangle, got {matrix.shape}")
    sigma = np.sqrt(np.abs(np.diag(matrix)))
    if np.any(np.abs(matrix - matrix.T) > SYMMETRIC_TO * np.outer(sigma, sigma)):
        raise ValueError("covariance: must be symmetric")
    return matrix[np.tril_indices(6)]
