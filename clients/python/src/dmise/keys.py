"""Keys as `dmise keygen` makes them (docs/wire.md, Keys)."""
from __future__ import annotations

import pathlib

import zmq

MASTER, BROKER = "time-master", "broker"


class Keys:
    """The own key pair, of NAME.key, and the public keys of others, in a directory of `dmise keygen`.

    Raises ValueError, with the file, if there is no such key.
    """

    def __init__(self, directory: str | pathlib.Path, name: str = "operator") -> None:
        self.directory = pathlib.Path(directory)
        own = self._entry(name, "key")
        if "secret" not in own:
            raise ValueError(f"{self.directory}/{name}.key: not a key of dmise keygen: it has no secret half")
        self.public, self.secret = own["public"].encode(), own["secret"].encode()

    def call(self, socket: zmq.Socket, peer: str) -> None:
        """Makes a socket encrypt, and believe `peer` alone. Call before connecting."""
        socket.curve_publickey, socket.curve_secretkey = self.public, self.secret
        socket.curve_serverkey = self._entry(peer, "pub")["public"].encode()

    def _entry(self, name: str, ending: str) -> dict[str, str]:
        path = self.directory / f"{name}.{ending}"
        if path.exists():
            found = _entries(path, name)
            if "public" in found.get(name, {}):
                return found[name]
            raise ValueError(f"{path}: not a key of dmise keygen")
        for ring in sorted(self.directory.glob(f"*.{ending}s")):
            found = _entries(ring, "")
            if "public" in found.get(name, {}):
                return found[name]
        raise ValueError(f"{path}: there is no such key")


def _entries(path: pathlib.Path, name: str) -> dict[str, dict[str, str]]:
    """Words and values of a key file by the name whose key they are; a ring has several names."""
    entries: dict[str, dict[str, str]] = {}
    words = path.read_text().split()
    for word, value in zip(words[::2], words[1::2]):
        if word == "name":
            name = value
        entries.setdefault(name, {}).setdefault(word, value)
    return entries


def call(socket: zmq.Socket, keys: Keys | None, peer: str, address: str) -> None:
    """Connects a socket to the process `peer` of the run, encrypted if there are keys."""
    if keys is not None:
        keys.call(socket, peer)
    socket.connect(address)
