"""Replaying a recording: time-master, broker and publishers of a run that is over, for observers.

What they hear are the messages as they were on the wire, byte for byte, in the order in which the recorder got them.
"""
from __future__ import annotations

import logging
import pathlib
import threading
import time
from collections.abc import Iterator
from typing import Any

import zmq
from zmq.utils.monitor import recv_monitor_message

from . import protocol
from .kept import Kept
from .master import LONGEST_CONTROL_BYTES
from .message import Message
from .recording import Recording, open_recording

log = logging.getLogger("dmise")
MAX_SPEED = float("inf")
QUEUE = 10_000        # messages that wait for a slow observer
PATIENCE_S = 5.0      # the longest time that the replay waits for one that does not read
SETTLED_S = 0.1       # without another subscription, before the first message
REMAIN_S = 5.0        # after the end, for observers that still ask for messages
CLOCK_EVERY_S = 0.5


class Replay:
    """A run to observe: `address` is that of its time-master, `run` plays it.

    path       a file of `dmise.record`
    speed      seconds of the simulation per second; MAX_SPEED: as fast as the slowest observer reads
    listen     tcp://HOST:PORT of the time-master, port 0: any; other endpoints are any ports of the host
    observers  how many observers it waits for before it begins

    Raises FileNotFoundError, or ValueError for a file that is none or damaged, a speed or an address.
    """

    def __init__(self, path: str | pathlib.Path, speed: float = 1.0, listen: str = "tcp://127.0.0.1:0",
                 observers: int = 1) -> None:
        if not speed > 0.0:
            raise ValueError(f"speed: must be > 0, got {speed:g}")
        self.recording: Recording = open_recording(path)
        self.speed, self.observers = speed, observers
        self.dropped_for_slow_readers = False
        self.messages = 0
        self._stop = threading.Event()
        self._context = zmq.Context()
        self._host, _, port = listen.rpartition(":")
        if not (port.isascii() and port.isdigit() and int(port) <= 65535):  # ZeroMQ wraps greater ones around
            raise ValueError(f"{listen}: the port must be in 0..65535; an address is tcp://HOST:PORT")
        self._master = self._bind(zmq.ROUTER, listen)
        self.address = self._endpoint(self._master)
        self._clock = self._bind(zmq.PUB)
        self._data = self._bind(zmq.XPUB)
        self._resend = self._bind(zmq.ROUTER)
        self._kept = Kept(self.recording.run)
        self._direct: dict[str, zmq.Socket] = {}
        self._endpoints = self._describe()
        self._said_at = 0.0
        self._subscribed_at = 0.0
        self._connected = self._gone = 0
        self._monitors = [socket.get_monitor_socket(zmq.EVENT_HANDSHAKE_SUCCEEDED | zmq.EVENT_DISCONNECTED)
                          for socket in (self._data,)]

    def run(self) -> None:
        """Plays the recording once and returns after its end, or after `close`."""
        try:
            self._wait_for_observers()
            began = time.monotonic()
            first_tick: int | None = None
            for _, item in self.recording.everything():
                if self._stop.is_set():
                    return
                if isinstance(item, Message):
                    if first_tick is None and item.sequence:
                        first_tick = item.tick
                    if item.tick > self._endpoints.granted_tick:
                        self._wait(began + (item.tick - (first_tick or 0)) * self._endpoints.tick_ns / 1e9 / self.speed)
                        self._grant(item.tick)
                    self._publish(item)
                elif item.DESCRIPTOR.name == "Grant":
                    self._close(item.closed)
            self._finish()
        finally:
            for socket in (self._master, self._clock, self._data, self._resend, *self._direct.values()):
                socket.close(1000 if socket is self._clock else 0)
            for monitor in self._monitors:
                monitor.close(0)
            self._context.term()

    def close(self) -> None:
        """Ends `run`. May be called from any thread."""
        self._stop.set()

    def _bind(self, kind: int, address: str = "") -> zmq.Socket:
        socket = self._context.socket(kind)
        socket.linger = 0
        socket.maxmsgsize = LONGEST_CONTROL_BYTES
        socket.sndhwm = QUEUE
        if kind == zmq.XPUB:
            socket.setsockopt(zmq.XPUB_NODROP, 1)
            socket.setsockopt(zmq.XPUB_VERBOSE, 1)
        try:
            socket.bind(address or self._host + ":0")
        except zmq.ZMQError as error:
            raise ValueError(f"{address or self._host}: {error}; an address is tcp://HOST:PORT") from None
        return socket

    @staticmethod
    def _endpoint(socket: zmq.Socket) -> str:
        return str(socket.getsockopt_string(zmq.LAST_ENDPOINT))

    def _describe(self) -> Any:
        """What the time-master answers: the recorded run, with this replay's endpoints and the topics that were recorded."""
        recorded = protocol.Endpoints()
        topics: set[str] = set()
        for _, item in self.recording.everything():
            if isinstance(item, Message):
                topics.add(item.topic)
        recorded.CopyFrom(self.recording.run)  # as of the end
        self._end = recorded.phase, recorded.cause, recorded.granted_tick
        endpoints = protocol.Endpoints(
            run_id=recorded.run_id, phase=protocol.PHASE_CONNECTING, granted_tick=-1, last_tick=recorded.last_tick,
            tick_ns=recorded.tick_ns, start_utc=recorded.start_utc, observe_endpoint=self._endpoint(self._data),
            tick_endpoint=self._endpoint(self._clock))
        for publisher in recorded.publishers:
            own = endpoints.publishers.add()
            own.CopyFrom(publisher)
            own.resend_endpoint = self._endpoint(self._resend)
            own.ClearField("direct_endpoint")
            own.ClearField("frames_endpoint")  # pixels are not recorded
            for field in (own.topics, own.direct_topics):
                here = [topic for topic in field if topic in topics]
                del field[:]
                field.extend(here)
            if own.direct_topics:
                socket = self._bind(zmq.XPUB)
                own.direct_endpoint = self._endpoint(socket)
                self._direct.update((topic, socket) for topic in own.direct_topics)
        return endpoints

    def _wait_for_observers(self) -> None:
        while not self._stop.is_set() and self.observers > 0 and not (
                self._connected >= self.observers and self._subscribed_at
                and time.monotonic() - self._subscribed_at > SETTLED_S):
            self._serve(SETTLED_S / 2)
        self._endpoints.phase = protocol.PHASE_RUNNING

    def _wait(self, until: float) -> None:
        """Serves until a time; at the highest speed only what has come."""
        while (left_s := until - time.monotonic()) > 0 and not self._stop.is_set():
            self._serve(min(left_s, CLOCK_EVERY_S))
        self._serve(0.0)

    def _serve(self, within_s: float) -> None:
        """Answers what has come to the time-master and to publishers."""
        poller = zmq.Poller()
        for socket in (self._master, self._resend, self._data, *set(self._direct.values()), *self._monitors):
            poller.register(socket, zmq.POLLIN)
        for socket, _ in poller.poll(int(1000 * within_s) + (within_s > 0)):
            if socket is self._master:
                self._answer(*socket.recv_multipart()[:2])
            elif socket is self._resend:
                for reply in self._kept.answer(*socket.recv_multipart()[:2]):
                    self._try(socket, reply)
            elif socket in self._monitors:
                connected = recv_monitor_message(socket)["event"] == zmq.EVENT_HANDSHAKE_SUCCEEDED
                self._connected += connected
                self._gone += not connected
            elif socket.recv()[:1] == b"\1":
                self._subscribed_at = time.monotonic()
        if time.monotonic() - self._said_at > CLOCK_EVERY_S:
            self._say()

    def _answer(self, peer: bytes, request: bytes = b"") -> None:
        try:
            asked = protocol.NodeMessage.FromString(request).WhichOneof("body")
        except Exception:  # whatever a library makes of wrong bytes
            return
        if asked == "hello":
            answer = protocol.MasterMessage(endpoints=self._endpoints)
        elif asked in ("join", "control"):
            reason = "this is a replay: it can be observed, not " + ("joined" if asked == "join" else "controlled")
            answer = protocol.MasterMessage(refuse=protocol.Refuse(reason=reason))
        else:
            return
        self._try(self._master, [peer, answer.SerializeToString()])

    @staticmethod
    def _try(socket: zmq.Socket, frames: list[bytes]) -> bool:
        try:
            socket.send_multipart(frames, zmq.DONTWAIT)
        except zmq.ZMQError:
            return False
        return True

    def _grant(self, tick: int) -> None:
        self._endpoints.granted_tick = tick
        self._say()

    def _say(self) -> None:
        said = protocol.Grant(run_id=self._endpoints.run_id, tick=self._endpoints.granted_tick, phase=self._endpoints.phase,
                              cause=self._endpoints.cause, closed=self._kept.closed)
        self._try(self._clock, [said.SerializeToString()])
        self._said_at = time.monotonic()

    def _close(self, topics: Iterator[Any]) -> None:
        known = {closed.topic for closed in self._kept.closed}
        self._kept.closed.extend(closed for closed in topics if closed.topic not in known)

    def _publish(self, message: Message) -> None:
        socket = self._direct.get(message.topic, self._data)
        deadline = time.monotonic() + PATIENCE_S
        while not self._try(socket, message.frames):
            if time.monotonic() > deadline:
                log.warning("an observer does not read: from %s %d on it is not waited for", message.topic, message.sequence)
                self.dropped_for_slow_readers = True
                for each in (self._data, *self._direct.values()):
                    each.setsockopt(zmq.XPUB_NODROP, 0)
            self._serve(0.01)
            if self._stop.is_set():
                return
        self._kept.add(message)
        self.messages += 1
        if self.messages % 100 == 0:
            self._serve(0.0)

    def _finish(self) -> None:
        """Says the end as the run said it, and stays for last questions."""
        phase, cause, granted_tick = self._end
        over = phase in (protocol.PHASE_ENDED, protocol.PHASE_FAILED)
        self._endpoints.phase = phase if over else protocol.PHASE_FAILED
        self._endpoints.cause = cause if over else "the recording ends here"
        self._grant(max(granted_tick, self._endpoints.granted_tick))
        deadline = time.monotonic() + REMAIN_S
        while time.monotonic() < deadline and self._gone < self._connected and not self._stop.is_set():
            self._serve(0.05)


def replay(path: str | pathlib.Path, speed: float = 1.0, listen: str = "tcp://127.0.0.1:0", observers: int = 1) -> None:
    """Plays a recording to observers and returns at its end; options and errors are those of `Replay`."""
    Replay(path, speed, listen, observers).run()
