"""Messages as docs/wire.md describes them, made by hand: what a stranger needs to speak in another's name."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "build/python"))

from dmise.v1 import detection_pb2, environment_pb2, frame_pb2, node_pb2, state_pb2, time_pb2  # noqa: E402, F401


def _table():
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


CRC32C = _table()


def crc32c(*parts):
    """CRC-32C (Castagnoli, RFC 3720) of the parts one after the other."""
    crc = 0xFFFFFFFF
    for part in parts:
        for byte in part:
            crc = crc >> 8 ^ CRC32C[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def sealed(topic, payload=b"", arrays=b"", **fields):
    """The frames of a message with a seal that holds; `fields` of its Envelope."""
    topic = topic.encode()
    envelope = node_pb2.Envelope(schema_version=1, **fields).SerializeToString()
    seal = b"\x7d" + crc32c(topic, envelope, payload, arrays).to_bytes(4, "little")
    return [topic, envelope + seal, payload] + [arrays] * bool(arrays)


def resealed(frames, payload=None, arrays=None, **fields):
    """A message that was heard, with other content or another envelope, and a seal that holds."""
    envelope = node_pb2.Envelope.FromString(frames[1])
    envelope.ClearField("seal_crc32c")
    for name, value in fields.items():
        setattr(envelope, name, value)
    payload = frames[2] if payload is None else payload
    arrays = (frames[3] if len(frames) > 3 else b"") if arrays is None else arrays
    unsealed = envelope.SerializeToString()
    seal = b"\x7d" + crc32c(frames[0], unsealed, payload, arrays).to_bytes(4, "little")
    return [frames[0], unsealed + seal, payload] + [arrays] * bool(arrays)
