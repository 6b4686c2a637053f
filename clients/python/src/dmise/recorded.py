"""A published message as a recording holds it: a `RecordedMessage` that has the frames as the bytes that came.

Frames are put in and taken out as they are, for a message of Protocol Buffers that is read and written again may have other bytes.
"""
from __future__ import annotations

from collections.abc import Sequence

from . import protocol
from .message import Message

SCHEMA = "dmise.v1.RecordedMessage"
RUN_CHANNEL, CLOCK_CHANNEL = "run", "clock"  # carry Endpoints and Grants; no topic has such a name
ENVELOPE, ARRAYS, OTHER_PAYLOAD = 1, 2, 99   # fields of RecordedMessage; others are kinds
_LENGTH_DELIMITED = 2


def descriptors() -> bytes:
    """A FileDescriptorSet of all messages of dmise.v1: the schema of every channel."""
    from google.protobuf import descriptor_pb2

    files: dict[str, None] = {}

    def add(file: object) -> None:
        for dependency in file.dependencies:  # type: ignore[attr-defined]
            add(dependency)
        files[file.serialized_pb] = None  # type: ignore[attr-defined]

    for module in protocol.modules:
        add(module.DESCRIPTOR)
    return descriptor_pb2.FileDescriptorSet(
        file=[descriptor_pb2.FileDescriptorProto.FromString(file) for file in files]).SerializeToString()


def pack(message: Message) -> bytes:
    """The bytes of a RecordedMessage."""
    packed = _field(ENVELOPE, message.frames[1])
    if message.frames[2] or message.has_content:
        packed += _field(_payload_field(message), message.frames[2])
    if len(message.frames) == 4:
        packed += _field(ARRAYS, message.frames[3])
    return packed


def unpack(topic: str, packed: bytes) -> list[bytes]:
    """The frames of the message, as they came. Raises ValueError for bytes that `pack` has not made."""
    frames = [topic.encode(), b"", b""]
    at = 0
    while at < len(packed):
        tag, at = _varint(packed, at)
        length, at = _varint(packed, at)
        if tag & 7 != _LENGTH_DELIMITED or at + length > len(packed):
            raise ValueError("not a RecordedMessage")
        contents = packed[at:at + length]
        at += length
        if tag >> 3 == ARRAYS:
            frames.append(contents)
        else:
            frames[1 if tag >> 3 == ENVELOPE else 2] = contents
    return frames


def _payload_field(message: Message) -> int:
    kind = int(message.envelope.kind)
    try:
        known = kind in protocol.RecordedMessage.DESCRIPTOR.fields_by_number and message.body is not None
    except ValueError:  # not what its kind says: it would make the whole record unreadable
        known = False
    return kind if known and kind != OTHER_PAYLOAD else OTHER_PAYLOAD


def _field(number: int, contents: bytes) -> bytes:
    return _bytes_of(number << 3 | _LENGTH_DELIMITED) + _bytes_of(len(contents)) + contents


def _bytes_of(number: int) -> bytes:
    out = bytearray()
    while number > 127:
        out.append(number & 127 | 128)
        number >>= 7
    return bytes([*out, number])


def _varint(data: Sequence[int], at: int) -> tuple[int, int]:
    number = shift = 0
    while at < len(data) and shift < 64:
        number |= (data[at] & 127) << shift
        at, shift = at + 1, shift + 7
        if data[at - 1] < 128:
            return number, at
    raise ValueError("not a RecordedMessage")
