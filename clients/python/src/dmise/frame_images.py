"""Frames of a run while it goes on, from its sensors; of one that is over, from its directory."""
from __future__ import annotations

import io
import logging
import pathlib
import threading
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import zmq

from . import keys as keys_
from . import protocol
from .convert import start_of
from .errors import NoAnswer, RunFailed
from .frame_endpoint import FrameEndpoint
from .json_lines import read_lines
from .master import OVER, Master, make_socket
from .message import Message
from .records import FrameReport
from .runs import open_run
from .subscription import ASK_AT_START_EVERY_S, ASK_EVERY_S, SETTLED, Subscription, subscribe
from .topics import did_you_mean

log = logging.getLogger("dmise")
WRITTEN_WITHIN_S = 30.0
LAST_WORDS_S = 2.0  # for sensors to say that they make no more, when the run is over


@dataclass
class Frame:
    """An exposure. `image`: rows x columns counts [DN], unsigned; `header`: astropy's, of its FITS file."""
    report: FrameReport
    image: npt.NDArray[Any]
    header: Any

    @property
    def wcs(self) -> Any:
        """The frame's astropy.wcs.WCS: pixels as in detections, of ICRS."""
        from astropy.wcs import WCS

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # astropy warns about headers that it corrects
            return WCS(self.header)


def frames(address: str | None, *sensors: str, mode: str = "all", directory: str | pathlib.Path | None = None,
           keys: str | pathlib.Path | None = None, name: str = "operator", raise_on_failure: bool = True,
           answer_within_s: float = 3.0) -> "Frames":
    """Frames of a run, from its sensors' frame endpoints, each sensor's in order; iterate. Needs astropy.

    sensors    names; none: all
    mode       "all": from the oldest that a sensor still keeps on; "latest": the last that was made whenever one is asked
               for, for who is slower than the run
    directory  of the run, with `output: {fits: true}`: for a run that is over (`address` None, or nobody answers there),
               a replay, and frames that a sensor no longer keeps
    further    as of `subscribe`, with its errors
    """
    if mode not in ("all", "latest"):
        raise ValueError(f'mode: must be "all" or "latest", got {mode!r}')
    return Frames(address, sensors, mode == "latest", pathlib.Path(directory) if directory else None,
                  {"keys": keys, "name": name, "raise_on_failure": raise_on_failure, "answer_within_s": answer_within_s})


class Frames:
    """Iterate for frames, until the run is over. `lost` counts those that came too late to be read, by sensor."""

    def __init__(self, address: str | None, sensors: tuple[str, ...], latest: bool, directory: pathlib.Path | None,
                 options: dict[str, Any]) -> None:
        if address is None and directory is None:
            raise ValueError("an address or a directory is needed")
        self._sensors, self._latest, self._directory = sensors, latest, directory
        self._options = options  # passed on to `subscribe`
        self._keys = keys_.Keys(options["keys"], options["name"]) if options["keys"] else None
        self._closing = threading.Event()
        self._readers: dict[str, FrameEndpoint] = {}  # by sensor
        self._lost: dict[str, int] = {}
        self._over_at = 0.0
        self._context = zmq.Context()
        self._run: Any = None
        if address is None:
            return
        self._master = Master(self._context, address, self._keys)
        try:
            self._run = self._master.ask_and_wait(options["answer_within_s"])
        except NoAnswer:
            if directory is None:
                raise
            return
        self._clock = make_socket(self._context, zmq.SUB)  # tells the end, after which the time-master is soon gone
        keys_.call(self._clock, self._keys, keys_.MASTER, self._run.tick_endpoint)
        self._clock.subscribe("")

    @property
    def lost(self) -> dict[str, int]:
        """Frames that a sensor had made and no longer kept, and that no directory had."""
        return {sensor: count for sensor, count in self._lost.items() if count}

    def __iter__(self) -> Iterator[Frame]:
        try:
            if self._run is None:
                yield from self._of_directory()
            elif self._are_served():
                yield from self._of_sensors()
            else:
                yield from self._of_reports()
        finally:
            self._context.destroy(0)

    def close(self) -> None:
        """Ends the iteration. May be called from any thread while another iterates."""
        self._closing.set()

    def _of_directory(self) -> Iterator[Frame]:
        assert self._directory is not None
        reports = [report for report in open_run(self._directory).frames
                   if not self._sensors or report.sensor in self._sensors]
        if self._latest:
            reports = list({report.sensor: report for report in reports}.values())
        for report in reports:
            yield read_frame(self._directory, report)

    def _are_served(self) -> bool:
        """Waits until all have joined; False of a replay, whose frames are in the directory alone."""
        self._adopt(self._run)
        while self._run.phase not in (protocol.PHASE_CONNECTING, *SETTLED) and not self._closing.is_set():
            self._hear()
        if not self._readers and self._directory is None:
            served = [publisher.name for publisher in self._run.publishers if publisher.frames_endpoint]
            meant = did_you_mean(self._sensors[0], served) if self._sensors else ""
            raise ValueError(f"{self._master.address}: no sensor{' named ' if self._sensors else ''}"
                             f"{' or '.join(self._sensors)} serves frames there{meant}; directory= names that of the run")
        return bool(self._readers) or self._closing.is_set()

    def _of_reports(self) -> Iterator[Frame]:
        """Frames of the directory as their reports come over the wire."""
        assert self._directory is not None
        topics = [f"frame/{sensor}" for sensor in self._sensors] or ["frame/"]
        with subscribe(self._master.address, *topics, **self._options) as subscription:
            for message in subscription.messages():
                if self._closing.is_set():
                    return
                waiting = {each.topic: each for each in
                           (_and_what_waits(subscription, message) if self._latest else [message])}
                for each in waiting.values():
                    for report in subscription.records_of(each):
                        yield read_frame(self._directory, report)

    def _of_sensors(self) -> Iterator[Frame]:
        while not self._is_over() and not self._closing.is_set():
            self._hear()
            for reader in list(self._readers.values()):
                before, lost_before = reader.after, reader.lost
                came = reader.take(start_of(self._run.start_utc))
                yield from self._made_up_for(reader, before, lost_before)
                if came is None:
                    reader.ask()
                    continue
                if not self._latest:
                    reader.ask()  # the next comes while this one is looked at
                yield _frame_of(*came)
                reader.ask()
        for reader in self._readers.values():
            if self._directory is not None and not reader.over and not self._closing.is_set():
                yield from self._files_after(reader.sensor, reader.after, None)  # the sensor is gone
        if self._run.phase == protocol.PHASE_FAILED and self._options["raise_on_failure"]:
            raise RunFailed(self._run.cause or "the run has failed")

    def _hear(self) -> None:
        """Waits a little for frames, and asks the time-master how the run is now and then."""
        poller = zmq.Poller()
        for socket in [self._master.socket, self._clock, *(reader.socket for reader in self._readers.values())]:
            poller.register(socket, zmq.POLLIN)
        poller.poll(100)
        while self._clock.poll(0):
            self._hear_clock(self._clock.recv())
        if (endpoints := self._master.answer()) is not None:
            self._adopt(endpoints)
        if time.monotonic() - self._master.asked_at > (
                ASK_EVERY_S if self._run.phase in SETTLED else ASK_AT_START_EVERY_S):
            self._master.ask()
        if self._master.silent_s() > 10 * ASK_EVERY_S and not self._over_at:
            raise NoAnswer(f"{self._master.address}: the time-master has been silent for {10 * ASK_EVERY_S:g} s")

    def _hear_clock(self, frame: bytes) -> None:
        try:
            grant = protocol.Grant.FromString(frame)
        except Exception:  # whatever a library makes of wrong bytes
            return
        if grant.run_id == self._run.run_id and grant.phase in OVER and not self._over_at:
            self._run.phase, self._run.cause = grant.phase, grant.cause
            self._over_at = time.monotonic()

    def _adopt(self, endpoints: Any) -> None:
        """Follows what the time-master says: who serves frames and where, whether the run is over."""
        if endpoints.run_id != self._run.run_id:
            endpoints = type(endpoints)(phase=protocol.PHASE_FAILED, run_id=self._run.run_id,
                                        cause=f"another run is at {self._master.address}")
        if self._over_at and endpoints.phase not in OVER:  # asked before the end
            endpoints.phase, endpoints.cause = self._run.phase, self._run.cause
        self._run = endpoints
        for publisher in endpoints.publishers:
            known = self._readers.get(publisher.name)
            if self._sensors and publisher.name not in self._sensors or not publisher.frames_endpoint:
                continue
            if known is not None and known.endpoint == publisher.frames_endpoint:
                continue
            if known is not None:  # another process is in its place
                known.close()
            self._readers[publisher.name] = FrameEndpoint(self._context, self._keys, publisher, endpoints.run_id,
                                                          self._latest, known.after if known else 0)
        if endpoints.phase in OVER and not self._over_at:
            self._over_at = time.monotonic()

    def _is_over(self) -> bool:
        """Sensors that are done say so; of others nothing comes any more a while after the run."""
        if not self._over_at:
            return False
        heard_at = max([self._over_at, *(reader.heard_at for reader in self._readers.values())])
        return all(reader.over for reader in self._readers.values()) or time.monotonic() - heard_at > LAST_WORDS_S

    def _made_up_for(self, reader: FrameEndpoint, after: int, lost_before: int) -> Iterator[Frame]:
        """What the sensor no longer keeps, from the directory if there is one."""
        lost = reader.lost - lost_before
        if lost == 0:
            return
        found = 0
        if self._directory is not None:
            for frame in self._files_after(reader.sensor, after, reader.after):
                found += 1
                yield frame
        self._lost[reader.sensor] = self._lost.get(reader.sensor, 0) + lost - found
        if lost > found:
            log.warning("%s: %d frames before number %d are lost: they are no longer kept", reader.sensor, lost - found,
                        reader.after)

    def _files_after(self, sensor: str, after: int, before: int | None) -> Iterator[Frame]:
        assert self._directory is not None
        path = self._directory / sensor / "frames.jsonl"
        if not path.exists():
            return
        reports = [report for report in read_lines(path, FrameReport, start_of(self._run.start_utc))
                   if report.frame > after and (before is None or report.frame < before)]
        for report in reports[-1:] if self._latest else reports:
            if (self._directory / sensor / f"frame-{report.frame:06d}.fits").exists():
                yield read_frame(self._directory, report)


def _and_what_waits(subscription: Subscription, message: Message) -> Iterator[Message]:
    yield message
    while (following := subscription.receive(0.001)) is not None:
        if following.has_content:
            yield following


def _frame_of(report: FrameReport, content: bytes) -> Frame:
    return _read(report, io.BytesIO(content))


def _read(report: FrameReport, source: Any) -> Frame:
    from astropy.io import fits

    with fits.open(source) as hdus:
        hdu = next(h for h in hdus if h.data is not None)  # a compressed image is in the second
        return Frame(report, np.asarray(hdu.data), hdu.header)


def read_frame(directory: str | pathlib.Path, report: FrameReport) -> Frame:
    """The frame of a report, from the run's directory. Raises FileNotFoundError if it is not written within 30 s."""
    path = pathlib.Path(directory) / report.sensor / f"frame-{report.frame:06d}.fits"
    deadline = time.monotonic() + WRITTEN_WITHIN_S
    while not path.exists():  # it is renamed into place when it is whole
        if time.monotonic() > deadline:
            raise FileNotFoundError(f"{path}: there is no such frame; are frames written there (output: {{fits: true}})?")
        time.sleep(0.02)
    return _read(report, path)
