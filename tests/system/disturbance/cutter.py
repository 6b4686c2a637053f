"""Cuts connections of living processes, and a proxy that delays, drops and closes."""

import ctypes
import os
import pathlib
import re
import socket
import threading
import time

PIDFD_GETFD = 438  # the same on all architectures


def sockets_of(pid):
    """Descriptors of the connections of a process over TCP or Unix sockets."""
    found = []
    for entry in pathlib.Path(f"/proc/{pid}/fd").iterdir():
        try:
            if re.fullmatch(r"socket:\[\d+\]", os.readlink(entry)):
                found.append(int(entry.name))
        except OSError:
            continue
    return sorted(found)


def borrowed(pid, descriptor):
    """The socket of another process, as one of this; None if it is gone, or no connection."""
    try:
        handle = os.pidfd_open(pid)
    except ProcessLookupError:
        return None
    try:
        own = ctypes.CDLL(None, use_errno=True).syscall(PIDFD_GETFD, handle, descriptor, 0)
    finally:
        os.close(handle)
    if own < 0:
        return None
    taken = socket.socket(fileno=own)
    try:
        taken.getpeername()
    except OSError:
        taken.close()
        return None
    return taken


def connections_of(pid):
    """The descriptors that can be cut."""
    open_ones = []
    for descriptor in sockets_of(pid):
        taken = borrowed(pid, descriptor)
        if taken and taken.family in (socket.AF_INET, socket.AF_UNIX):
            open_ones.append(descriptor)
        if taken:
            taken.close()
    return open_ones


def cut(pid, descriptor):
    """Ends one connection of a process, for both ends. False if it is gone."""
    taken = borrowed(pid, descriptor)
    if not taken:
        return False
    with taken:
        try:
            taken.shutdown(socket.SHUT_RDWR)
        except OSError:
            return False
    return True


class Proxy:
    """Passes connections on to an address of this host, late. `cut` closes all and drops what is under way; `swallow` drops
    all from then on of one connection, the how manieth that was made, which stays open."""

    def __init__(self, port, delay_s=0.0):
        self._port, self.delay_s = port, delay_s
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._pairs, self._made, self._swallowed, self._lock = set(), [], set(), threading.Lock()
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                near, _ = self._listener.accept()
            except OSError:
                return
            try:
                far = socket.create_connection(("127.0.0.1", self._port))
            except OSError:
                near.close()
                continue
            pair = (near, far)
            with self._lock:
                self._pairs.add(pair)
                self._made.append(pair)
            for source, sink in (pair, pair[::-1]):
                source.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                threading.Thread(target=self._pass, args=(pair, source, sink), daemon=True).start()

    def _pass(self, pair, source, sink):
        try:
            while piece := source.recv(1 << 16):
                time.sleep(self.delay_s)
                if pair not in self._pairs:
                    return
                if pair in self._swallowed:
                    continue
                sink.sendall(piece)
        except OSError:
            pass
        finally:
            self._end(pair)

    def _end(self, pair):
        with self._lock:
            self._pairs.discard(pair)
        for one in pair:
            try:
                one.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
            one.close()

    def swallow(self, number):
        self._swallowed.add(self._made[number])

    def cut(self):
        for pair in list(self._pairs):
            self._end(pair)

    def close(self):
        self._listener.close()
        self.cut()
