"""Taking part in the clock of a run: the run waits for this node (docs/wire.md, Taking part)."""
from __future__ import annotations

import pathlib
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import zmq

from . import keys as keys_
from . import protocol, resend
from .completeness import Completeness
from .convert import start_of
from .errors import NoAnswer, Refused, RunFailed
from .master import OVER, make_socket
from .message import Message
from .sequences import Sequences


@dataclass
class Tick:
    """A tick of which everything is there. `messages`: with content, by topic as consumed, then by sequence."""
    number: int
    time_ns: int
    messages: list[Message] = field(default_factory=list)

    @property
    def records(self) -> list[Any]:
        """The records of all messages, one after the other."""
        return [record for message in self.messages for record in message.records]


class Node:
    """A node that consumes topics: iterate for its ticks, each of which is done when the next is asked for.

    name      one of the nodes that the time-master expects
    consumes  whole topics, "detection/alpha"
    keys      directory of `dmise keygen`, with the key of `name`

    Raises Refused with the time-master's reason, NoAnswer, RunFailed with the cause when the run has failed.
    """

    def __init__(self, address: str, name: str, consumes: Sequence[str], keys: str | pathlib.Path | None = None,
                 answer_within_s: float = 30.0) -> None:
        self.address, self.name, self.consumes = address, name, list(consumes)
        self._keys = keys_.Keys(keys, name) if keys else None
        self._context = zmq.Context()
        self._over = threading.Event()
        self._granted, self._phase, self._cause = -1, protocol.PHASE_CONNECTING, ""
        self._heard_clock = self._ready = False
        self._probed: set[str] = set()
        self._sequences = Sequences()
        self._waiting: dict[int, list[Message]] = {}
        self._broker = (0, "")
        self._data: zmq.Socket | None = None
        self._direct: dict[str, zmq.Socket] = {}
        self._topology: Any = None
        self._master = make_socket(self._context, zmq.DEALER)
        keys_.call(self._master, self._keys, keys_.MASTER, address)
        self._join(answer_within_s)
        self._complete = Completeness(self._welcome.last_tick, self.consumes.__contains__)
        self._clock = make_socket(self._context, zmq.SUB)
        keys_.call(self._clock, self._keys, keys_.MASTER, self._welcome.tick_endpoint)
        self._clock.subscribe("")
        self._heart = threading.Thread(target=self._beat, daemon=True)
        self._heart.start()

    def __iter__(self) -> Iterator[Tick]:
        following = 0
        try:
            while self._phase not in OVER:
                self._pump()
                if not self._ready and self._heard_clock and self._topology and self._probed >= set(self.consumes):
                    self._tell(ready=protocol.Ready())
                    self._ready = True
                while self._ready and following <= min(self._granted, self._complete.through()):
                    messages = self._waiting.pop(following, [])
                    messages.sort(key=lambda m: (self.consumes.index(m.topic), m.sequence))
                    yield Tick(following, following * self._welcome.tick_ns, messages)
                    self._tell(done=protocol.Done(tick=following))
                    following += 1
        finally:
            self._leave()
        if self._phase == protocol.PHASE_FAILED:
            raise RunFailed(self._cause or "the run has failed")

    def _tell(self, **body: Any) -> None:
        self._master.send(protocol.NodeMessage(run_id=self._welcome.run_id, **body).SerializeToString())

    def _join(self, within_s: float) -> None:
        join = protocol.Join(name=self.name, consumes=self.consumes)
        self._master.send(protocol.NodeMessage(join=join).SerializeToString())
        if not self._master.poll(int(1000 * within_s)):
            raise NoAnswer(f"{self.address}: no time-master answers within {within_s:g} s")
        answer = protocol.MasterMessage.FromString(self._master.recv())
        if answer.HasField("refuse"):
            raise Refused(answer.refuse.reason)
        self._welcome = answer.welcome

    def _beat(self) -> None:
        """Heartbeats, from a connection of their own; a time-master that is silent ends the run for this node."""
        socket = make_socket(self._context, zmq.DEALER)
        keys_.call(socket, self._keys, keys_.MASTER, self.address)
        beat = protocol.Heartbeat(name=self.name, incarnation=self._welcome.incarnation,
                                  token=self._welcome.heartbeat_token)
        answered_at = time.monotonic()
        while not self._over.wait(self._welcome.heartbeat_s):
            socket.send(protocol.NodeMessage(run_id=self._welcome.run_id, heartbeat=beat).SerializeToString())
            while socket.poll(0):
                socket.recv()
                answered_at = time.monotonic()
            if time.monotonic() - answered_at > max(1.0, self._welcome.silent_after_s):
                self._cause, self._phase = "the time-master is silent", protocol.PHASE_FAILED
        socket.close(0)

    def _pump(self) -> None:
        sockets = [s for s in (self._master, self._clock, self._data, *self._direct.values()) if s is not None]
        for socket in zmq.select(sockets, [], [], 0.2)[0]:
            if socket is self._master:
                self._hear_master(protocol.MasterMessage.FromString(socket.recv()))
            elif socket is self._clock:
                self._hear_grant(protocol.Grant.FromString(socket.recv()))
            else:
                self._hear_data(socket)

    def _hear_master(self, answer: Any) -> None:
        if answer.HasField("grant"):
            self._hear_grant(answer.grant)
        elif answer.HasField("topology"):
            self._follow(answer.topology)

    def _hear_grant(self, grant: Any) -> None:
        if grant.run_id != self._welcome.run_id:
            return
        self._heard_clock = True
        self._granted = max(self._granted, grant.tick)
        if self._phase not in OVER:
            self._phase, self._cause = grant.phase, grant.cause
        for closed in grant.closed:
            self._complete.close(closed.topic, closed.from_tick)

    def _follow(self, topology: Any) -> None:
        """Connects to where the topics come from, anew if that has changed."""
        self._topology = topology
        self._complete.expect(topology.publishers)
        broker = topology.broker_incarnation, topology.subscribe_endpoint
        if broker != self._broker:
            if self._data is not None:
                self._data.close(0)
            self._broker, self._data = broker, self._subscriber()
            if topology.broker_password:  # without keys: only nodes of the run are told
                self._data.plain_username = self.name.encode()
                self._data.plain_password = topology.broker_password.encode()
            keys_.call(self._data, self._keys, keys_.BROKER, topology.subscribe_endpoint)
        for publisher in topology.publishers:
            if publisher.direct_endpoint not in self._direct and set(publisher.direct_topics) & set(self.consumes):
                socket = self._direct[publisher.direct_endpoint] = self._subscriber()
                keys_.call(socket, self._keys, publisher.name, publisher.direct_endpoint)

    def _subscriber(self) -> zmq.Socket:
        socket = make_socket(self._context, zmq.SUB, resend.LONGEST_DATA_BYTES)
        socket.rcvhwm = 0  # bounded by the window
        for topic in self.consumes:
            socket.subscribe(topic)
        return socket

    def _hear_data(self, socket: zmq.Socket) -> None:
        while socket.poll(0):
            try:
                message = Message(socket.recv_multipart())
            except ValueError:
                continue
            if message.topic not in self.consumes or message.envelope.run_id != self._welcome.run_id:
                continue  # only begins like one of ours
            self._probed.add(message.topic)
            if message.sequence > 0:
                gap = self._sequences.gap_before(message)
                for lost in self._missing(gap) if gap else []:
                    self._accept(lost)
                self._accept(message)

    def _missing(self, gap: Any) -> list[Message]:
        publisher = next(p for p in self._topology.publishers if gap.topic in [*p.topics, *p.direct_topics])
        return resend.missing(self._context, self._keys, publisher, self._welcome.run_id, gap.topic, gap.first,
                              gap.last)

    def _accept(self, message: Message) -> None:
        if self._sequences.is_new(message):
            self._complete.heard(message)
            if message.has_content:
                self._waiting.setdefault(message.tick, []).append(message)

    def _leave(self) -> None:
        over = self._phase in OVER
        self._tell(leave=protocol.Leave(interrupted=not over))
        self._over.set()
        self._heart.join()
        for socket in (self._clock, self._data, *self._direct.values()):
            if socket is not None:
                socket.close(0)
        self._master.close(1000)
        self._context.term()
