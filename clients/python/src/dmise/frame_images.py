"""Frames of a run while it goes on: the report from the wire, the image from the run's directory."""
from __future__ import annotations

import pathlib
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .message import Message
from .records import FrameReport
from .subscription import Subscription, subscribe

WRITTEN_WITHIN_S = 30.0


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
            warnings.simplefilter("ignore")  # of headers that astropy corrects
            return WCS(self.header)


def frames(address: str, *sensors: str, directory: str | pathlib.Path, latest: bool = False,
           **options: Any) -> Iterator[Frame]:
    """Frames of a live run, in order of arrival; needs astropy, and the run's directory, as images are not on the wire.

    sensors    names; none: all
    directory  of the run, with `output: {fits: true}`: this machine's, or shared
    latest     whether of frames that wait only each sensor's last is given, for who is slower than the run
    options    as of `subscribe`, with its errors

    Raises FileNotFoundError for a frame that is not written within 30 s.
    """
    with subscribe(address, *([f"frame/{sensor}" for sensor in sensors] or ["frame/"]), **options) as subscription:
        for message in subscription.messages():
            waiting = {each.topic: each for each in (_and_what_waits(subscription, message) if latest else [message])}
            for each in waiting.values():
                for report in subscription.records_of(each):
                    yield read_frame(directory, report)


def _and_what_waits(subscription: Subscription, message: Message) -> Iterator[Message]:
    yield message
    while (following := subscription.receive(0.001)) is not None:
        if following.has_content:
            yield following


def read_frame(directory: str | pathlib.Path, report: FrameReport) -> Frame:
    """The frame of a report. Raises FileNotFoundError if it is not written within 30 s."""
    from astropy.io import fits

    path = pathlib.Path(directory) / report.sensor / f"frame-{report.frame:06d}.fits"
    deadline = time.monotonic() + WRITTEN_WITHIN_S
    while not path.exists():  # it is renamed into place when it is whole
        if time.monotonic() > deadline:
            raise FileNotFoundError(f"{path}: there is no such frame; are frames written there (output: {{fits: true}})?")
        time.sleep(0.02)
    with fits.open(path) as hdus:
        hdu = next(h for h in hdus if h.data is not None)  # a compressed image is in the second
        return Frame(report, np.asarray(hdu.data), hdu.header)
