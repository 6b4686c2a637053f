"""ZMTP 3.0 without keys, spoken by hand (https://rfc.zeromq.org/spec/23): what no library sends."""

import select
import socket
import time

GREETING = b"\xff" + bytes(8) + b"\x7f\x03\x00" + b"NULL".ljust(20, b"\0") + b"\0" + bytes(31)
SMALL_FRAME = b"\x01\x01\x02"  # "more follows", one byte


def ready(socket_type):
    body = b"\x05READY" + b"\x0bSocket-Type" + len(socket_type).to_bytes(4, "big") + socket_type
    return b"\x04" + bytes([len(body)]) + body


def connect(port, socket_type):
    """A connection that has said who it is, or None."""
    try:
        peer = socket.create_connection(("127.0.0.1", port), timeout=2.0)
        peer.sendall(GREETING + ready(socket_type))
        peer.setblocking(False)
        return peer
    except OSError:
        return None


def pour(peers, seconds, chunk=SMALL_FRAME * 30_000):
    """Frames of a message without end over each, for so long; returns bytes sent and how many were cut."""
    rest = {peer: b"" for peer in peers if peer}  # what is left of a chunk that was taken in part
    sent, cut, until = 0, 0, time.monotonic() + seconds
    while rest and time.monotonic() < until:
        for peer in select.select([], list(rest), [], 0.1)[1]:
            try:
                now = rest[peer] or chunk
                taken = peer.send(now)
                rest[peer] = now[taken:]
                sent += taken
            except BlockingIOError:
                continue
            except OSError:
                del rest[peer]
                peer.close()
                cut += 1
    for peer in rest:
        peer.close()
    return sent, cut
