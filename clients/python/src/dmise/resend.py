"""Messages that a publisher keeps, from the publisher itself (docs/wire.md, Missing messages)."""
from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import zmq

from . import keys as keys_
from . import protocol
from .master import make_socket
from .message import Message

LONGEST_DATA_BYTES = 256 << 20
ANSWER_WITHIN_S = 1.0
QUIET_S = 0.1  # an answer has no end: none comes any more


def _fetch(context: zmq.Context, keys: keys_.Keys | None, publisher: Any, request: Any) -> Iterator[list[bytes]]:
    socket = make_socket(context, zmq.DEALER, LONGEST_DATA_BYTES)
    try:
        keys_.call(socket, keys, publisher.name, publisher.resend_endpoint)
        socket.send(request.SerializeToString())
        wait_s, deadline = ANSWER_WITHIN_S, time.monotonic() + 2 * ANSWER_WITHIN_S
        while time.monotonic() < deadline and socket.poll(int(1000 * wait_s)):
            yield socket.recv_multipart()
            wait_s = QUIET_S
    except (zmq.ZMQError, ValueError):
        return  # no such endpoint, or no key of its publisher: nothing is kept for us
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


def _messages(fetched: Iterator[list[bytes]], topic: str) -> Iterator[Message]:
    for frames in fetched:
        try:
            message = Message(frames)
        except ValueError:
            continue
        if message.topic == topic:
            yield message
