"""The connection to a time-master of somebody who only asks: hello, and what it answers."""
from __future__ import annotations

import time
from typing import Any

import zmq

from . import keys as keys_
from . import protocol
from .errors import NoAnswer

OVER = (protocol.PHASE_ENDED, protocol.PHASE_FAILED)
LONGEST_CONTROL_BYTES = 1 << 20


def make_socket(context: zmq.Context, kind: int, longest_bytes: int = LONGEST_CONTROL_BYTES) -> zmq.Socket:
    socket = context.socket(kind)
    socket.linger = 0
    socket.maxmsgsize = longest_bytes
    return socket


class Master:
    """Asks for `Endpoints`. Raises NoAnswer if none come, ValueError for an address that is none."""

    def __init__(self, context: zmq.Context, address: str, keys: keys_.Keys | None = None) -> None:
        self.address = address
        self.socket = make_socket(context, zmq.DEALER)
        try:
            keys_.call(self.socket, keys, keys_.MASTER, address)
        except zmq.ZMQError as error:
            raise ValueError(f"{address}: {error}; an address is tcp://HOST:PORT") from None
        self.asked_at = -1e9  # monotonic
        self._unanswered_since: float | None = None

    def silent_s(self) -> float:
        """For how long a question has been unanswered [s]. Who does not ask, being busy with messages, hears no silence."""
        return time.monotonic() - self._unanswered_since if self._unanswered_since is not None else 0.0

    def ask(self) -> None:
        """Asks without waiting; `answer` has what comes."""
        self.asked_at = time.monotonic()
        if self._unanswered_since is None:
            self._unanswered_since = self.asked_at
        self.socket.send(protocol.NodeMessage(hello=protocol.Hello()).SerializeToString(), zmq.DONTWAIT)

    def answer(self) -> Any:
        """The next answer that has come, an Endpoints; None: none."""
        while self.socket.poll(0):
            try:
                reply = protocol.MasterMessage.FromString(self.socket.recv())
            except Exception:  # whatever a library makes of wrong bytes
                continue
            if reply.HasField("endpoints"):
                self._unanswered_since = None
                return reply.endpoints
        return None

    def ask_and_wait(self, within_s: float) -> Any:
        self.ask()
        deadline = time.monotonic() + within_s
        while (remaining_s := deadline - time.monotonic()) > 0:
            self.socket.poll(int(1000 * remaining_s) + 1)
            if (endpoints := self.answer()) is not None:
                return endpoints
        raise NoAnswer(f"{self.address}: no time-master answers within {within_s:g} s")
