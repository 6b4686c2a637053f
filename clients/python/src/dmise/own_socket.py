"""`serve`: a model of one's own as a program that a run starts, which it asks over one socket (docs/wire.md, Own nodes)."""
from __future__ import annotations

import os
import sys
import threading
import time
import traceback
from typing import Any

import zmq

from . import protocol
from .own_answers import ModelAnswers, failure
from .own_detector import Detector
from .own_node import Actor
from .own_sensor import Observer
from .own_served import Served
from .own_tracker import Tracker

ADDRESS_VARIABLE = "DMISE_OWN_NODE"
LONGEST_REQUEST_BYTES = 1 << 30  # frames of 500 Mpx
LINGER_MS = 1000  # for the last answer
HELD_ANSWERS, HELD_S = 32, 0.001  # answers of quick steps go together: each message that goes alone wakes three threads


def serve(model: Actor | Detector | Observer | Tracker) -> None:
    """Says what `model` says, tick by tick or frame by frame, to the run that has started this program, until the run ends."""
    if not isinstance(model, Served):
        raise TypeError(f"serve: takes what @dmise.actor(..), @dmise.detector, @dmise.sensor or @dmise.tracker marks, got "
                        f"{type(model).__name__}")
    address = os.environ.get(ADDRESS_VARIABLE)
    if not address:
        sys.exit(f"{ADDRESS_VARIABLE} is not set: this program is started by a scenario with "
                 "nodes: [{name: .., run: [python3, ..]}], or by dmise join SCENARIO NAME --program 'python3 ..'")
    try:
        _Conversation(address, model).run()
    except _Failed:
        sys.exit(1)


class _Failed(Exception):
    """The model can't go on, and the run has been told."""


class _Conversation:
    def __init__(self, address: str, served: Actor | Detector | Observer | Tracker) -> None:
        self._served, self._answers = served, ModelAnswers(served)
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.PAIR)
        self._socket.maxmsgsize = LONGEST_REQUEST_BYTES
        self._socket.reconnect_ivl = -1
        self._lost = self._socket.get_monitor_socket(zmq.EVENT_DISCONNECTED)
        self._socket.connect(address)
        self._poller = zmq.Poller()
        self._poller.register(self._socket, zmq.POLLIN)
        self._poller.register(self._lost, zmq.POLLIN)
        self._lock = threading.Lock()  # held by who uses the socket while the model works
        self._working = False
        self._held: list[list[bytes]] = []  # answers; the other thread's while the model works, as the socket is
        self._held_since_s = 0.0
        self._over = threading.Event()
        if hasattr(sys.stdout, "reconfigure"):
            sys.stdout.reconfigure(line_buffering=True)  # what it prints is in the log at once

    def run(self) -> None:
        try:
            while (frames := self._next()) is not None:
                request = protocol.OwnNodeRequest.FromString(frames[0])
                if request.HasField("end"):
                    return
                self._set_working(True)
                self._answer(request, frames[1:])
        finally:
            self._over.set()
            self._set_working(False)
            self._send_held()
            self._socket.disable_monitor()
            self._context.destroy(linger=LINGER_MS)

    def _next(self) -> list[bytes] | None:
        """The next request; None if the run is gone."""
        try:
            return self._socket.recv_multipart(zmq.NOBLOCK)
        except zmq.Again:
            self._send_held()
        ready = dict(self._poller.poll())
        return self._socket.recv_multipart() if self._socket in ready else None

    def _answer(self, request: Any, more: list[bytes]) -> None:
        if request.HasField("begin"):
            threading.Thread(target=self._show_life, args=(request.begin.alive_every_s,), daemon=True).start()
        try:
            frames = self._answers.to(request, more)
        except Exception as error:
            traceback.print_exc()
            self._send(failure(error, self._served))
            raise _Failed from error
        self._send(frames)

    def _send(self, frames: list[bytes]) -> None:
        self._set_working(False)
        now_s = time.monotonic()
        if not self._held:
            self._held_since_s = now_s
        self._held.append(frames)
        if len(self._held) == HELD_ANSWERS or now_s - self._held_since_s > HELD_S:
            self._send_held()

    def _send_held(self) -> None:
        for frames in self._held:
            self._socket.send_multipart(frames)
        self._held.clear()

    def _set_working(self, working: bool) -> None:
        with self._lock:
            self._working = working

    def _show_life(self, every_s: float) -> None:
        alive = protocol.OwnNodeAnswer(alive=protocol.OwnNodeAlive()).SerializeToString()
        while not self._over.wait(every_s):
            with self._lock:
                if self._working:
                    self._send_held()
                    self._socket.send(alive)
