"""Observing a run: what anybody may do who reaches its time-master (docs/wire.md, Observing a run)."""
from __future__ import annotations

import collections
import functools
import logging
import pathlib
import threading
import time
from collections.abc import Iterator
from typing import Any

import zmq

from . import keys as keys_
from . import protocol, resend
from .completeness import Completeness
from .convert import start_of
from .errors import NoAnswer, RunFailed
from .master import OVER, Master, make_socket
from .message import Message
from .sequences import Gap, Sequences
from .topics import check_published, is_wanted
from .world import ObjectRoster

log = logging.getLogger("dmise")
ASK_EVERY_S, ASK_AT_START_EVERY_S = 1.0, 0.1
SETTLED = (protocol.PHASE_RUNNING, *OVER)  # all publishers are known
LAST_WORDS_S = 1.0  # messages may arrive later than the news of the end
LATE_EVERY_S = 5.0   # between two requests for what does not come on a topic
LATE_AT_ONCE = 4     # topics; a publisher that does not answer costs a second
QUEUE = 100_000     # messages that wait for a slow reader, of each connection


def subscribe(address: str, *topics: str, keys: str | pathlib.Path | None = None, name: str = "operator",
              raise_on_failure: bool = True, answer_within_s: float = 3.0) -> "Subscription":
    """Observes the run whose time-master is at `address` (tcp://HOST:PORT); iterate for records, in order of arrival.

    topics            "detection/" is all that begins so, "detection/alpha" that topic; none: all but truth
    keys, name        directory of `dmise keygen` and the own key in it; truth needs a key that may receive it
    raise_on_failure  whether RunFailed is raised when the run has failed; it ends the iteration otherwise
    answer_within_s   the longest time until the time-master's first answer [s]

    Raises NoAnswer without a time-master, ValueError for an address or key that is none, and when the run has begun for a
    topic that nobody publishes.
    """
    return Subscription(address, topics, keys_.Keys(keys, name) if keys else None, raise_on_failure, answer_within_s)


class Subscription:
    """Records of a run: iterate; `messages` has them with topic, tick and sequence, `ticks` by complete ticks.

    run     what the time-master said last, an `Endpoints` of proto/dmise/v1/time.proto
    gaps    messages that were lost: those that their publisher still kept are fetched, and are none
    incomplete  when the run is over: topics of which the last messages did not come, and through which tick they did
    refused count of messages that are not of this run or not readable
    """

    def __init__(self, address: str, topics: tuple[str, ...], keys: keys_.Keys | None = None,
                 raise_on_failure: bool = True, answer_within_s: float = 3.0) -> None:
        self.topics = topics or ("",)
        self._wanted = functools.partial(is_wanted, self.topics)
        self.gaps: list[Gap] = []
        self.incomplete: dict[str, int] = {}
        self.refused = 0
        self.over = False
        self.roster: ObjectRoster | None = None
        self._keys, self._raise_on_failure = keys, raise_on_failure
        self._topics_are_known = False
        self._closing = threading.Event()
        self._context = zmq.Context()
        self._ready: collections.deque[Message] = collections.deque()
        self._sequences = Sequences()
        self._retained: set[tuple[str, int]] = set()  # topic, incarnation
        self._sockets: dict[str, zmq.Socket] = {}     # by endpoint
        self._observed = ""                           # endpoint of the broker
        self._over_at = 0.0
        self._came: dict[str, tuple[int, int]] = {}  # by topic: incarnation, last tick that came
        self._late_at: dict[str, float] = {}         # when what is late was asked for
        self._master = Master(self._context, address, keys)
        self.run: Any = self._master.ask_and_wait(answer_within_s)
        self._complete = Completeness(self.run.last_tick, self._wanted)
        self._clock = self._subscriber(keys_.MASTER, self.run.tick_endpoint, [""])
        self._adopt(self.run)

    def __enter__(self) -> "Subscription":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        if hasattr(self, "_clock") and not self.over:  # an iteration was ended early
            self._release()

    def __iter__(self) -> Iterator[Any]:
        for message in self.messages():
            yield from self.records_of(message)

    def messages(self) -> Iterator[Message]:
        """Messages with content, until the run is over. Raises RunFailed as `subscribe` says."""
        for message in self.all_messages():
            if message.has_content:
                yield message

    def all_messages(self) -> Iterator[Message]:
        """As `messages`, with probes and watermarks, which say that a topic is complete."""
        while not self.over:
            message = self.receive(1.0)
            if message is not None:
                yield message
        self.raise_failure()

    def ticks(self) -> Iterator[tuple[int, list[Message]]]:
        """(tick, its messages with content) of each tick that has some, in order, when all topics are complete."""
        waiting: dict[int, list[Message]] = {}
        for message in self.all_messages():
            if message.has_content:
                waiting.setdefault(message.tick, []).append(message)
            through = self._complete.through()
            yield from ((tick, waiting.pop(tick)) for tick in sorted(t for t in waiting if t <= through))
        yield from ((tick, waiting[tick]) for tick in sorted(waiting))

    def receive(self, within_s: float) -> Message | None:
        """The next message; None if there is none within the time, or the run is over (`over`)."""
        deadline = time.monotonic() + within_s
        while not self._ready and not self.over and time.monotonic() < deadline:
            if self._closing.is_set():
                self._release()
            else:
                self._pump(min(0.2, within_s))
        message = self._ready.popleft() if self._ready else None
        if message is not None:  # a topic is complete when whoever iterates has its messages
            self._complete.heard(message)
        return message

    def raise_failure(self) -> None:
        """Raises RunFailed if the run has failed and the subscription says so."""
        if self.run.phase == protocol.PHASE_FAILED and self._raise_on_failure:
            raise RunFailed(self.run.cause or "the run has failed")

    def close(self) -> None:
        """Ends the subscription. May be called from any thread while another iterates; that one lets go."""
        self._closing.set()

    def records_of(self, message: Message) -> list[Any]:
        try:
            records = message.records
        except ValueError as error:
            self._refuse(str(error))
            return []
        for record in records:
            if isinstance(record, ObjectRoster):
                self.roster = record
            elif hasattr(record, "roster"):
                record.roster = self.roster
        return records

    def _subscriber(self, peer: str, endpoint: str, topics: list[str]) -> zmq.Socket:
        socket = make_socket(self._context, zmq.SUB, resend.LONGEST_DATA_BYTES)
        socket.rcvhwm = QUEUE
        keys_.call(socket, self._keys, peer, endpoint)
        for topic in topics:
            socket.subscribe(topic)
        return self._sockets.setdefault(endpoint, socket)

    def _adopt(self, endpoints: Any) -> None:
        """Follows what the time-master says: where the data is, who publishes what, whether the run is over."""
        if endpoints.run_id != self.run.run_id:
            endpoints = type(endpoints)(phase=protocol.PHASE_FAILED, run_id=self.run.run_id,
                                        cause=f"another run is at {self._master.address}")
        if self._over_at and endpoints.phase not in OVER:  # asked before the end
            endpoints.phase, endpoints.cause = self.run.phase, self.run.cause
        settled_tick = self.run.settled_tick  # all have done it, since a while
        self.run = endpoints
        if endpoints.observe_endpoint and endpoints.observe_endpoint != self._observed:
            if self._observed:
                log.warning("the broker has moved to %s", endpoints.observe_endpoint)
                self._sockets.pop(self._observed).close(0)
            self._observed = endpoints.observe_endpoint
            self._subscriber(keys_.BROKER, self._observed, list(self.topics))
        self._complete.expect(endpoints.publishers)
        if endpoints.phase == protocol.PHASE_RUNNING and not self._topics_are_known:
            self._check_topics(endpoints.publishers)
        for publisher in endpoints.publishers:
            direct = [topic for topic in publisher.direct_topics if self._wanted(topic)]
            if direct and publisher.direct_endpoint not in self._sockets:
                self._subscriber(publisher.name, publisher.direct_endpoint, direct)
            self._fetch_retained(publisher)
        if endpoints.phase == protocol.PHASE_RUNNING:
            self._fetch_late(settled_tick)
        if endpoints.phase in OVER and not self._over_at:
            self._over_at = time.monotonic()

    def _check_topics(self, publishers: Any) -> None:
        """Nothing would ever come on a topic that is misspelt: who publishes what is fixed once the run has begun."""
        self._topics_are_known = True
        try:
            check_published(self.topics, (topic for p in publishers for topic in [*p.topics, *p.direct_topics]))
        except ValueError:
            self._release()
            raise

    def _late(self, tick: int) -> list[str]:
        """Topics that have come, and on which something that was said at a tick or before has not."""
        return [topic for topic, (_, came) in self._came.items() if self._complete.is_due(topic, came, tick)]

    def _fetch_late(self, tick: int) -> None:
        """Asks publishers for what does not come: the broker may be gone, and nothing follows that would show a gap."""
        if any(socket.poll(0) for socket in self._sockets.values() if socket is not self._clock):
            return  # it has come, and is not read yet
        now = time.monotonic()
        late = [topic for topic in self._late(tick) if now - self._late_at.get(topic, -1e9) > LATE_EVERY_S]
        for topic in late[:LATE_AT_ONCE]:
            self._late_at[topic] = now
            publisher = next((p for p in self.run.publishers if topic in [*p.topics, *p.direct_topics]), None)
            if publisher is None or not publisher.resend_endpoint or publisher.incarnation != self._came[topic][0]:
                continue
            for message in resend.missing(self._context, self._keys, publisher, self.run.run_id, topic,
                                          self._sequences.following(topic, publisher.incarnation), (1 << 63) - 1):
                self._accept(message)
                self._late_at.pop(topic, None)

    def _fetch_retained(self, publisher: Any) -> None:
        if self.run.phase != protocol.PHASE_RUNNING:
            return  # nothing is published yet, or nobody is left
        for topic in publisher.topics:
            key = topic, publisher.incarnation
            if topic.startswith("state/") and self._wanted(topic) and key not in self._retained:
                for message in resend.retained(self._context, self._keys, publisher, self.run.run_id, topic,
                                               self.run.last_tick):
                    self._deliver(message)

    def _pump(self, within_s: float) -> None:
        poller = zmq.Poller()
        for socket in [self._master.socket, *self._sockets.values()]:
            poller.register(socket, zmq.POLLIN)
        for socket, _ in poller.poll(int(1000 * within_s)):
            if socket is self._clock:
                self._hear_clock()
            elif socket is self._master.socket:
                if (endpoints := self._master.answer()) is not None:
                    self._adopt(endpoints)
            else:
                self._hear_data(socket)
        now = time.monotonic()
        if now - self._master.asked_at > (ASK_EVERY_S if self.run.phase in SETTLED else ASK_AT_START_EVERY_S):
            self._master.ask()
        if self._over_at and (self._all_complete() or now - self._over_at > LAST_WORDS_S) and not self._ready:
            self._release()
        elif self._master.silent_s() > 10 * ASK_EVERY_S and not self._over_at:
            self._release()
            raise NoAnswer(f"{self._master.address}: the time-master has been silent for {10 * ASK_EVERY_S:g} s")

    def _all_complete(self) -> bool:
        return bool(self._complete.topics()) and self._complete.through() >= self.run.granted_tick >= 0

    def _hear_clock(self) -> None:
        while self._clock.poll(0):
            frame = self._clock.recv()
            try:
                grant = protocol.Grant.FromString(frame)
            except Exception:  # whatever a library makes of wrong bytes
                continue
            if grant.run_id == self.run.run_id:
                self._hear_grant(grant, frame)

    def _hear_grant(self, grant: Any, frame: bytes) -> None:
        for closed in grant.closed:
            self._complete.close(closed.topic, closed.from_tick)
        self.run.granted_tick = max(self.run.granted_tick, grant.tick)
        if grant.phase != self.run.phase:
            self._master.asked_at = -1e9  # there may be more publishers than were told
        if grant.phase in OVER and not self._over_at:
            self.run.phase, self.run.cause = grant.phase, grant.cause
            self._over_at = time.monotonic()

    def _hear_data(self, socket: zmq.Socket) -> None:
        for _ in range(1000):  # then the clock's turn
            if not socket.poll(0):
                break
            try:
                message = Message(socket.recv_multipart())
            except ValueError as error:
                self._refuse(str(error))
                continue
            if message.envelope.run_id != self.run.run_id:
                self._refuse(f"{message.topic}: of another run")
            elif self._wanted(message.topic):
                self._accept(message)
        if self._over_at:
            self._over_at = time.monotonic()  # still something to come

    def _accept(self, message: Message) -> None:
        if message.sequence == 0:  # a probe
            self._deliver(message)
            return
        gap = self._sequences.gap_before(message)
        if gap is not None:
            self._fetch(gap)
        if self._sequences.is_new(message):
            self._deliver(message)
        if message.last_of_tick and message.envelope.incarnation >= self._came.get(message.topic, (0, 0))[0]:
            self._came[message.topic] = message.envelope.incarnation, message.tick

    def _fetch(self, gap: Gap) -> None:
        """Delivers what its publisher still keeps of a gap, and counts the rest."""
        publisher = next((p for p in self.run.publishers if gap.topic in [*p.topics, *p.direct_topics]), None)
        following = gap.first
        if publisher is not None and publisher.resend_endpoint:
            for message in resend.missing(self._context, self._keys, publisher, self.run.run_id, gap.topic,
                                          gap.first, gap.last):
                self._note(gap.topic, following, message.sequence - 1)
                following = message.sequence + 1
                if self._sequences.is_new(message):
                    self._deliver(message)
        self._note(gap.topic, following, gap.last)

    def _note(self, topic: str, first: int, last: int) -> None:
        if last >= first:
            self.gaps.append(Gap(topic, first, last))
            log.warning("%s: %d messages are lost, from number %d to %d", topic, last - first + 1, first, last)

    def _deliver(self, message: Message) -> None:
        if message.envelope.kind == protocol.KIND_OBJECT_ROSTER:
            key = message.topic, message.envelope.incarnation
            if key in self._retained:
                return
            self._retained.add(key)
        message.start_utc_of_run = start_of(self.run.start_utc)
        self._ready.append(message)

    def _refuse(self, reason: str) -> None:
        self.refused += 1
        if self.refused <= 10:
            log.warning("refused: %s", reason)

    def _release(self) -> None:
        self.over = True
        if self._over_at:
            self.incomplete = {topic: self._came[topic][1] for topic in self._late(self.run.settled_tick)}
        for topic, tick in self.incomplete.items():
            log.warning("%s: nothing has come after tick %d, though the run went on", topic, tick)
        for socket in [self._master.socket, *self._sockets.values()]:
            socket.close(0)
        self._sockets.clear()
        self._context.term()
