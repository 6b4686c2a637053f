"""A run bears that its connections break: each of each process once, all of them again and again, and those to the
time-master through a proxy that is late, drops and closes. The products are those of an undisturbed run.

    connections.py DMISE [--rounds N]
"""

import argparse
import json
import pathlib
import tempfile
import time

from disturbance.cutter import Proxy, connections_of, cut
from disturbance.network import Spread
from disturbance.scene import NODES, write_scene
from harness import PATIENCE_S, Failure, Run, check, check_same, products, wait_until

WALL_S = 8.0  # the undisturbed run takes so long
BETWEEN_CUTS_S = 0.7


def pid_of(run, name):
    return run.process.pid if name == "dmise" else run.node(name)


def cut_each(run, out, names, rounds):
    """Each connection of each process, one after the other. Returns how many were cut."""
    wait_until(lambda: list(out.glob("*/frames.jsonl")) or run.process.poll() is not None, "a first frame")
    count = 0
    for _ in range(rounds):
        for name in names:
            pid = pid_of(run, name)
            for descriptor in connections_of(pid) if pid else ():
                if run.process.poll() is not None:
                    return count
                count += cut(pid, descriptor)
                time.sleep(0.02)
    return count


def launched(binary, scenario, out, reference, names, rounds, claim, *more):
    with Run(binary, "launch", scenario, "--out", out, *more) as run:
        count = cut_each(run, out, names, rounds)
        code, _ = run.finish()
        check(code == 0, f"{claim}: {count} connections were cut, the run ends with {code}: {run.stderr[-300:] if code else ''}")
        check(count >= len(names), f"{claim}: while it ran")
    check_same(out, reference, claim)


class Loopback:
    """In place of hosts of their own."""

    def __init__(self):
        self.address = dict.fromkeys(("time-master", "broker", *NODES), "127.0.0.1")

    @staticmethod
    def on(_, command):
        return [str(word) for word in command]


class Proxied(Spread):
    """Nodes reach the time-master through a proxy each."""

    def __init__(self, *arguments):
        self.proxies = {}
        super().__init__(Loopback(), *arguments)

    def _start(self, name, command):
        if name != "time-master":
            at = [str(word) for word in command].index("--master") + 1
            self.proxies[name] = Proxy(int(command[at].rsplit(":", 1)[1]), delay_s=0.02)
            command[at] = f"tcp://127.0.0.1:{self.proxies[name].port}"
        super()._start(name, command)


def cut_all(network):
    cuts = 0
    while not network.ended() and cuts < 60 * WALL_S:
        for proxy in network.proxies.values():
            proxy.cut()
        cuts += 1
        time.sleep(BETWEEN_CUTS_S)
    check(cuts > 1, f"all connections were cut {cuts} times")


def swallow_one(network):
    network.proxies["orbit-node"].swallow(0)  # over which it says what it has done
    check(not network.ended(), "what one node says is dropped from the first frame on")


def proxied(binary, work, scenario, reference, harm):
    out, keys = work / harm.__name__, work / "keys"
    if not keys.exists():
        with Run(binary, "keygen", keys, "--scenario", scenario) as keygen:
            check(keygen.finish()[0] == 0, "there are keys")
    digest = json.loads((reference / "run.json").read_text())["digest"]
    with Proxied(binary, scenario, out, keys, digest, "wait", WALL_S) as network:
        wait_until(lambda: list(out.glob("*/frames.jsonl")) or network.ended(), "a first frame")
        harm(network)
        code, line = network.finish(PATIENCE_S)
        check(code == 0, f"the run through proxies that are late ends well: {line}")
    ours = products(out)
    theirs = {p: b for p, b in products(reference).items() if "/" in p or p.startswith("positions")}  # nobody merges
    differ = sorted(p for p in ours.keys() | theirs.keys() if ours.get(p) != theirs.get(p))
    check(not differ, f"and has its products: {len(theirs)} files, {len(differ)} differ {differ[:3]}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise")
    parser.add_argument("--rounds", type=int, default=2)
    options = parser.parse_args()
    binary = pathlib.Path(options.dmise).resolve()
    with tempfile.TemporaryDirectory(prefix="dmise-connections-") as name:
        work = pathlib.Path(name)
        scenario = write_scene(work, "wait", WALL_S)
        reference = work / "reference"
        with Run(binary, "run", write_scene(work, "wait", 0), "--out", reference) as run:
            if run.finish()[0] != 0:
                raise Failure(f"the undisturbed run: {run.stderr[-400:]}")
        everybody = (*NODES, "broker", "time-master")
        launched(binary, scenario, work / "each", reference, everybody, options.rounds, "each connection")
        launched(binary, scenario, work / "hosts", reference, ("host-1", "host-2", *NODES), options.rounds,
                 "each connection, behind agents", "--hosts", "2")
        for harm in (cut_all, swallow_one):
            proxied(binary, work, scenario, reference, harm)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        raise SystemExit(f"FAIL: {failure}") from None
