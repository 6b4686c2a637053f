"""The directory of a run that is over."""
from __future__ import annotations

import functools
import html
import json
import pathlib
from collections.abc import Iterator
from typing import Any

from .convert import start_of
from .display import table_html
from .json_lines import read_lines
from .records import Detection, FrameReport, Task, Track, Truth
from .tables import to_pandas


class Records(list[Any]):
    """A list of records that can become a table."""

    def to_pandas(self) -> Any:
        """As `dmise.to_pandas`."""
        return to_pandas(self)


class Run:
    """What a run left: lists of records are read when first used, in the files' order: time, sensor, index."""

    def __init__(self, directory: str | pathlib.Path) -> None:
        self.directory = pathlib.Path(directory)
        path = self.directory / "run.json"
        try:
            self.info: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
            self.start_utc = start_of(self.info["scenario"]["simulation"]["start"])
        except OSError as error:
            raise FileNotFoundError(f"{path}: {error.strerror}; is this the directory of a run that is over?") from None
        except (ValueError, TypeError, KeyError) as error:
            raise ValueError(f"{path}: not the record of a run: {error}") from None

    def __repr__(self) -> str:
        return f"<Run of {self.directory}, {self.status}, sensors {', '.join(self.sensors)}>"

    def _repr_html_(self) -> str:
        """What each sensor made, in notebooks."""
        def rows() -> Iterator[tuple[Any, ...]]:
            for sensor in self.sensors:
                yield sensor, *(sum(record.sensor == sensor for record in records)
                                for records in (self.frames, self.truth, self.detections))

        return f"<p>Run of {html.escape(str(self.directory))}, {html.escape(self.status)}, begins {self.start_utc}</p>" + table_html(
            ["sensor", "frames", "truth", "detections"], rows(), f"{len({track.id for track in self.tracks})} tracks")

    @property
    def status(self) -> str:
        """"complete", or how it ended."""
        return str(self.info["status"])

    @property
    def sensors(self) -> list[str]:
        """Names of the sensors."""
        return [sensor["name"] for sensor in self.info["scenario"]["sensors"]]

    @functools.cached_property
    def detections(self) -> Records:
        """All detections."""
        return self._read("detections.jsonl", Detection)

    @functools.cached_property
    def frames(self) -> Records:
        """A FrameReport of each exposure."""
        return self._read("frames.jsonl", FrameReport)

    @functools.cached_property
    def truth(self) -> Records:
        """All truths, none if the scenario says `truth: false`."""
        return self._read("truth.jsonl", Truth)

    @functools.cached_property
    def tracks(self) -> Records:
        """A Track for each tick at which one changed, none if the scenario has no `fusion`."""
        return self._read("tracks.jsonl", Track)

    @functools.cached_property
    def tasks(self) -> Records:
        """A Task for each cue, none if the scenario cues no sensor."""
        return self._read("tasks.jsonl", Task)

    @functools.cached_property
    def orbits(self) -> list[dict[str, Any]]:
        """A line of orbits.jsonl for each arc of a kept orbit, none unless the scenario's `fusion` has `keep_orbits`."""
        return self._lines("orbits.jsonl")

    @functools.cached_property
    def breakups(self) -> list[dict[str, Any]]:
        """A line of breakups.jsonl for each breakup, and again for each further member; none unless the scenario's `fusion` has `keep_orbits`."""
        return self._lines("breakups.jsonl")

    def images(self, sensor: str) -> Iterator[tuple[int, pathlib.Path]]:
        """(frame, its FITS file) of a sensor, in order."""
        for path in sorted((self.directory / sensor).glob("frame-*.fits")):
            yield int(path.stem.removeprefix("frame-")), path

    def image(self, sensor: str, frame: int) -> Any:
        """A frame as astropy's HDUList, open; needs astropy. `astropy.wcs.WCS(hdus[0].header, hdus)` has its WCS."""
        from astropy.io import fits

        return fits.open(self.directory / sensor / f"frame-{frame:06d}.fits")

    def _lines(self, name: str) -> list[dict[str, Any]]:
        path = self.directory / name
        return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []

    def _read(self, name: str, cls: Any) -> Records:
        path = self.directory / name
        return Records(read_lines(path, cls, self.start_utc)) if path.exists() else Records()


def open_run(directory: str | pathlib.Path) -> Run:
    """Opens what a run left. Raises FileNotFoundError or ValueError if the directory has no run.json of a run."""
    return Run(directory)
