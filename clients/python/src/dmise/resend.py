"""Messages that a publisher keeps, from the publisher itself (docs/wire.md, Missing messages)."""
from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import zmq

from . import keys as keys_
from . import protocol
from .master import make_socket
from .message import Message

LONGEST_DATA_BYTES = 256 << 20
ANSWER_WITHIN_S = 1.0
QUIET_S = 0.1  # an answer has no end: none comes any more


def _ask(context: zmq.Context, keys: keys_.Keys | None, publisher: Any, *requests: Any) -> zmq.Socket | None:
    """A socket to which a publisher answers; None: it has no such endpoint, or we no key of it."""
    socket = make_socket(context, zmq.DEALER, LONGEST_DATA_BYTES)
    try:
        keys_.call(socket, keys, publisher.name, publisher.resend_endpoint)
        for request in requests:
            socket.send(request.SerializeToString())
        return socket
    except (zmq.ZMQError, ValueError):
        socket.close(0)
        return None


def _fetch(context: zmq.Context, keys: keys_.Keys | None, publisher: Any, request: Any) -> Iterator[list[bytes]]:
    socket = _ask(context, keys, publisher, request)
    if socket is None:
        return
    try:
        wait_s, deadline = ANSWER_WITHIN_S, time.monotonic() + 2 * ANSWER_WITHIN_S
        while time.monotonic() < deadline and socket.poll(int(1000 * wait_s)):
            yield socket.recv_multipart()
            wait_s = QUIET_S
    finally:
        socket.close(0)


def missing(context: zmq.Context, keys: keys_.Keys | None, publisher: Any, run_id: int, topic: str,
            first: int, last: int) -> list[Message]:
    """Those that are still kept of the messages `first` to `last` (sequence numbers) of a topic, in their order."""
    request = protocol.ResendRequest(run_id=run_id, topic=topic, from_sequence=first)
    found: dict[int, Message] = {}
    for message in _messages(_fetch(context, keys, publisher, request), topic):
        if first <= message.sequence <= last:
            found[message.sequence] = message
        if message.sequence >= last:
            break
    return [found[sequence] for sequence in sorted(found)]


def retained(context: zmq.Context, keys: keys_.Keys | None, publisher: Any, run_id: int, topic: str,
             last_tick: int) -> list[Message]:
    """What holds for the whole run and was published on the topic already: the roster."""
    request = protocol.ResendRequest(run_id=run_id, topic=topic, catch_up=True, from_tick=last_tick)
    found = []
    for message in _messages(_fetch(context, keys, publisher, request), topic):
        if message.envelope.kind == protocol.KIND_POSITION:
            break
        found.append(message)
    return found


def kept(context: zmq.Context, keys: keys_.Keys | None, asked: Sequence[tuple[Any, list[str]]],
         run_id: int) -> list[Message]:
    """Everything that publishers still keep of (publisher, topics), of all at once; each topic in its order."""
    found: list[list[bytes]] = []
    sockets = [socket for publisher, topics in asked if (socket := _ask(context, keys, publisher, *(
        protocol.ResendRequest(run_id=run_id, topic=topic, from_sequence=1) for topic in topics))) is not None]
    poller = zmq.Poller()
    for socket in sockets:
        poller.register(socket, zmq.POLLIN)
    waiting = set(sockets)
    deadline = time.monotonic() + 2 * ANSWER_WITHIN_S
    while time.monotonic() < deadline and \
            (ready := poller.poll(int(1000 * (ANSWER_WITHIN_S if waiting else QUIET_S)))):
        for socket, _ in ready:
            waiting.discard(socket)
            found.append(socket.recv_multipart())
    for socket in sockets:
        socket.close(0)
    return sorted(_messages(found, None),
                  key=lambda message: (message.topic, message.envelope.incarnation, message.sequence))


def _messages(fetched: Iterable[list[bytes]], topic: str | None) -> Iterator[Message]:
    for frames in fetched:
        try:
            message = Message(frames)
        except ValueError:
            continue
        if topic in (None, message.topic):
            yield message
