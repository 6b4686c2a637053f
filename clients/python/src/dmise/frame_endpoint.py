"""The frame endpoint of a sensor (docs/wire.md, Frames): one request, one answer."""
from __future__ import annotations

import time
from typing import Any

import zmq

from . import keys as keys_
from . import protocol
from .convert import record_of
from .master import make_socket
from .records import FrameReport

LONGEST_FRAME_BYTES = 1 << 32
ASK_AGAIN_S = 5.0  # an answer may be lost with its connection


class FrameEndpoint:
    """A reader of one sensor's frames.

    over  whether the sensor has said that it makes no more
    lost  frames that the sensor made after the first that came, and no longer kept when they were asked for
    """

    def __init__(self, context: zmq.Context, keys: keys_.Keys | None, publisher: Any, run_id: int, latest: bool,
                 after: int = 0) -> None:
        self.sensor, self.endpoint = str(publisher.name), str(publisher.frames_endpoint)
        self.after, self.over, self.lost = after, False, 0
        self._latest, self._run_id, self._sequence = latest, run_id, 0
        self._asked_at: float | None = None
        self.heard_at = 0.0  # monotonic
        self.socket = make_socket(context, zmq.DEALER, LONGEST_FRAME_BYTES)
        keys_.call(self.socket, keys, self.sensor, self.endpoint)

    def ask(self) -> None:
        """Asks for the next frame, unless the question is under way."""
        if self.over or self._asked_at is not None and (
                time.monotonic() - self._asked_at < ASK_AGAIN_S or self.socket.poll(0)):
            return
        which = {"latest_after" if self._latest else "next_after": self.after}
        self._asked_at = time.monotonic()
        try:
            self.socket.send(protocol.FrameRequest(run_id=self._run_id, **which).SerializeToString(), zmq.DONTWAIT)
        except zmq.Again:
            pass

    def take(self, start: Any) -> tuple[FrameReport, bytes] | None:
        """A frame that has come: its report and its FITS file; None: none has."""
        while self.socket.poll(0):
            frames = self.socket.recv_multipart()
            self.heard_at = time.monotonic()
            try:
                answer = protocol.FrameAnswer.FromString(frames[0])
            except Exception:  # whatever a library makes of wrong bytes
                continue
            if answer.run_id != self._run_id:
                continue
            if answer.status == protocol.FrameAnswer.STATUS_OVER:
                self.over = True
            elif answer.report.frame <= self.after:
                continue  # to a question that was asked twice
            self._asked_at = None
            if answer.status == protocol.FrameAnswer.STATUS_OVER:
                return None
            self.after = answer.report.frame
            if answer.status != protocol.FrameAnswer.STATUS_SENT or len(frames) != 2:
                self.lost += 1  # its file is gone
                continue
            if self._sequence and not self._latest:
                self.lost += answer.sequence - self._sequence - 1
            self._sequence = answer.sequence
            return record_of(answer.report, start), frames[1]
        return None

    def close(self) -> None:
        self.socket.close(0)
