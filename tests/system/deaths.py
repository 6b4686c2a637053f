"""How soon a dead node is named: processes that die at random moments, and the time to the line that says so.

    deaths.py DMISE [--trials N] [--seed S] [--json FILE]

A network of small nodes; in each trial one of them, or the broker, is killed (-9), stopped, or cut off from the
network where namespaces may be made, at any moment from its start on. The time-master must name it within the
declared time.
"""

import argparse
import os
import pathlib
import random
import select
import signal
import subprocess
import sys
import tempfile
import time

from disturbance.hosts import Hosts, may_make_hosts
from harness import tell_figures

DECLARED_S = 5.0  # the default of --silent-after
NODES = ("orbit", "a", "b", "recorder", "broker")
PATIENCE_S = 60.0


class Stack:
    """Master, broker, orbit, two cameras and a recorder; with `hosts` each on its own and with keys."""

    def __init__(self, binary, hosts=None, keys=None):
        self._bin, self._hosts, self._keys = binary.parent, hosts, keys
        self._text = ""
        self.pid = {}
        self._processes = []
        master = self._start("time-master", [
            self._bin / "dmise-time-master", "--expect", "orbit,a,b,recorder", "--ticks", 10**8, "--announce-fd", 1,
            "--bind", self._at("time-master")], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self._master = master
        self._address = master.stdout.readline().decode().strip()
        os.set_blocking(master.stderr.fileno(), False)

    def _at(self, name):
        return f"tcp://{self._hosts.address[name] if self._hosts else '127.0.0.1'}:0"

    def _start(self, name, command, **streams):
        command = [*map(str, command), *(["--keys", str(self._keys)] if self._keys else [])]
        if self._hosts:
            command = self._hosts.on(name, command)
        streams = streams or dict(stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, **streams)
        self._processes.append(process)
        self.pid[name] = process.pid
        return process

    def start_nodes(self):
        own = lambda name: [] if name == "broker" else ["--host", self._at(name)]
        for name in NODES:
            role = "camera" if name in ("a", "b") else name
            program = ([self._bin / "dmise-broker", *(f for s in ("--publish", "--subscribe", "--observe")
                                                      for f in (s, self._at(name)))]
                       if name == "broker" else [self._bin / "toy-node", "--role", role, "--name", name])
            self._start(name, [*program, "--master", self._address, *own(name)])

    def line(self, holds, within_s):
        """The first line of the master for which holds(line); None after the time or when the master has ended."""
        deadline = time.monotonic() + within_s
        while True:
            *lines, self._text = self._text.split("\n")
            for number, line in enumerate(lines):
                if holds(line):
                    self._text = "\n".join(lines[number + 1:] + [self._text])
                    return line
            left_s = deadline - time.monotonic()
            if left_s <= 0 or not select.select([self._master.stderr], [], [], left_s)[0]:
                return None
            more = self._master.stderr.read()
            if not more:
                return None
            self._text += more.decode()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self._processes:
            process.kill()
        for process in self._processes:
            process.wait()
        self._master.stdout.close()
        self._master.stderr.close()


def trial(binary, rng, kind, hosts, keys):
    """(seconds from the death to the line that names it, what was done)"""
    victim = rng.choice(NODES)
    early = rng.random() < 0.2
    with Stack(binary, hosts if kind == "cut" else None, keys if kind == "cut" else None) as stack:
        stack.start_nodes()
        joined = stack.line((lambda s: f"{victim} joined" in s) if early else (lambda s: "all are ready" in s), PATIENCE_S)
        if joined is None:
            return None, f"{victim} never began"
        time.sleep(rng.uniform(0.0, 0.2 if early else 1.0))  # the moment is the trial's
        died = time.monotonic()
        if kind == "cut":
            hosts.cut(victim)
        else:
            os.kill(stack.pid[victim], signal.SIGKILL if kind == "kill" else signal.SIGSTOP)
        line = stack.line(lambda s: f" {victim} has " in s or f" {victim} is lost" in s, PATIENCE_S)
        took_s = time.monotonic() - died
        if kind == "cut":
            hosts.mend(victim)
        return (took_s, f"{kind} {victim}{' at the start' if early else ''}: {line}") if line else (None, f"{kind} {victim}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise")
    parser.add_argument("--trials", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--slack", type=float, default=0.0, help="seconds that a loaded machine may be late")
    parser.add_argument("--json", help="append a line of figures to this file")
    options = parser.parse_args()
    binary = pathlib.Path(options.dmise).resolve()
    no_hosts = may_make_hosts()
    if no_hosts:
        print(f"nobody is cut off: no network namespaces here: {no_hosts}")
    rng = random.Random(options.seed)
    took, counts, bad = [], {}, []
    with tempfile.TemporaryDirectory(prefix="dmise-deaths-") as directory:
        hosts = keys = None
        if not no_hosts:
            hosts, keys = Hosts(("time-master", *NODES)), pathlib.Path(directory) / "keys"
            subprocess.run([binary, "keygen", keys, "time-master", *NODES, "--truth"], check=True, capture_output=True)
        for number in range(options.trials):
            kind = "kill" if number % 5 < 3 else "stop" if number % 5 == 3 else "cut" if hosts else "stop"
            took_s, story = trial(binary, rng, kind, hosts, keys)
            counts[kind] = counts.get(kind, 0) + 1
            good = took_s is not None and took_s <= DECLARED_S + options.slack
            if not good:
                bad.append(story)
            took.append(took_s if took_s is not None else PATIENCE_S)
            print(f"{'ok' if good else 'FAIL'}: {took[-1]:.3f} s: {story}", flush=True)
        if hosts:
            hosts.close()
    figures = {"name": "death_named_worst_s", "value": round(max(took), 3), "unit": "s", "target": DECLARED_S,
               "met": max(took) <= DECLARED_S, "named_in_time": sum(t <= DECLARED_S for t in took), "trials": options.trials, "seed": options.seed,
               "median_s": round(sorted(took)[len(took) // 2], 3), **counts}
    tell_figures(figures, options.json)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
