"""Hosts that are network namespaces, joined by a switch whose cables can be pulled. Needs root."""

import atexit
import os
import subprocess


def may_make_hosts():
    """Whether this machine lets us make network namespaces; the reason if not."""
    probe = f"dmise-{os.getpid()}-probe"
    made = subprocess.run(["ip", "netns", "add", probe], capture_output=True, text=True) if _has_ip() else None
    if made is None:
        return "there is no ip command"
    if made.returncode:
        return made.stderr.strip()
    try:
        pair = subprocess.run(["ip", "-n", probe, "link", "add", "left", "type", "veth", "peer", "name", "right"],
                              capture_output=True, text=True)
        return pair.stderr.strip()
    finally:
        subprocess.run(["ip", "netns", "del", probe], check=False)


def _has_ip():
    return any(os.access(os.path.join(p, "ip"), os.X_OK) for p in os.environ["PATH"].split(":") + ["/usr/sbin", "/sbin"])


def _ip(*arguments):
    subprocess.run(["ip", *map(str, arguments)], check=True, capture_output=True, text=True)


class Hosts:
    """One namespace for each name, and one that is the switch; all are gone when it is closed."""

    def __init__(self, names):
        prefix = f"dmise-{os.getpid()}"
        self._switch = f"{prefix}-switch"
        self._space = {name: f"{prefix}-{i}" for i, name in enumerate(names)}
        self._cable = {name: f"cable{i}" for i, name in enumerate(names)}
        self.address = {name: f"10.99.0.{i + 1}" for i, name in enumerate(names)}
        atexit.register(self.close)
        _ip("netns", "add", self._switch)
        _ip("-n", self._switch, "link", "add", "bridge", "type", "bridge")
        _ip("-n", self._switch, "link", "set", "bridge", "up")
        for name in names:
            self._add(name)

    def _add(self, name):
        space, cable = self._space[name], self._cable[name]
        _ip("netns", "add", space)
        _ip("-n", self._switch, "link", "add", cable, "type", "veth", "peer", "name", "port", "netns", space)
        _ip("-n", self._switch, "link", "set", cable, "master", "bridge", "up")
        _ip("-n", space, "address", "add", f"{self.address[name]}/24", "dev", "port")
        _ip("-n", space, "link", "set", "port", "up")
        _ip("-n", space, "link", "set", "lo", "up")

    def on(self, name, command):
        """The command that runs `command` on a host, in a process of the same id."""
        return ["nsenter", f"--net=/run/netns/{self._space[name]}", *map(str, command)]

    def cut(self, name):
        _ip("-n", self._switch, "link", "set", self._cable[name], "down")

    def mend(self, name):
        _ip("-n", self._switch, "link", "set", self._cable[name], "up")

    def narrow(self, name, megabits_per_s):
        """Packets above this rate are dropped, in both directions."""
        for space, device in ((self._space[name], "port"), (self._switch, self._cable[name])):
            subprocess.run(["tc", "-n", space, "qdisc", "replace", "dev", device, "root", "tbf",
                            "rate", f"{megabits_per_s:g}mbit", "burst", "64kbit", "latency", "50ms"],
                           check=True, capture_output=True)

    def widen(self, name):
        for space, device in ((self._space[name], "port"), (self._switch, self._cable[name])):
            subprocess.run(["tc", "-n", space, "qdisc", "del", "dev", device, "root"], capture_output=True)

    def close(self):
        for space in (*self._space.values(), self._switch):
            subprocess.run(["ip", "netns", "del", space], capture_output=True)
        self._space = {}
