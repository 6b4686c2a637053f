"""A run as processes that can be harmed: started by `dmise launch`, or one by one on hosts of their own."""

import pathlib
import subprocess
import time

from disturbance.scene import SENSORS, SILENT_AFTER_S, TICK_S, TICKS
from harness import PATIENCE_S, Failure, Run, command_of, wait_until


def last_error(log):
    """The message of the last line of a log that says error."""
    lines = [line for line in log.splitlines() if " error: " in line]
    return lines[-1].split(" error: ", 1)[1] if lines else ""


def wait_for_none(living, patience_s=PATIENCE_S + 15):
    deadline = time.monotonic() + patience_s
    while living() and time.monotonic() < deadline:
        time.sleep(0.02)
    return living()


class Launched:
    """`dmise launch`: everything on this host, plain."""

    def __init__(self, binary, scenario, out):
        self.out = out
        self._run = Run(binary, "launch", scenario, "--out", out)
        self._again = {}  # processes started by hand, by name

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self._again.values():
            process.kill()
            process.wait()
        self._run.__exit__()

    def ended(self):
        return self._run.process.poll() is not None

    def pid(self, name):
        if name == "dmise":
            return self._run.process.pid if not self.ended() else None
        if name in self._again and self._again[name].poll() is None:
            return self._again[name].pid
        return self._run.node(name)

    def start_again(self, name, command):
        with open(self.out / f"logs/{name}.log", "a", encoding="utf-8") as log:
            self._again[name] = subprocess.Popen(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL)

    def has_failed(self, name):
        """A process started by hand has ended: perhaps the one before it is not given up yet."""
        process = self._again.get(name)
        return process is not None and process.poll() not in (None, 0)

    def finish(self, patience_s):
        """(exit code, the line that says why)"""
        code, _ = self._run.finish(patience_s)
        return code, (self._run.stderr.strip().splitlines() or [""])[-1]

    def left(self):
        """Who lives longer than a process can know that the run is over, or that nobody watches it any more."""
        if self._run.process.returncode >= 0 and self._run.living():
            return self._names(self._run.living())  # the launcher has seen everybody to their end
        return wait_for_none(lambda: self._names(
            self._run.living() | {p.pid for p in self._again.values() if p.poll() is None}))

    @staticmethod
    def _names(pids):
        return [" ".join(command_of(pid)) for pid in pids]

    def tell(self):
        return self._run.stderr[-1500:]


class Spread:
    """Each process on a host of its own, with keys, started one by one."""

    def __init__(self, hosts, binary, scenario, out, keys, digest, policy, wall_s):
        self.out = out
        self._hosts = hosts
        self._bin = pathlib.Path(binary).parent
        self._processes = {}
        self._old = []
        self._logs = out / "logs"
        self._logs.mkdir(parents=True)
        announced = self._logs / "master.address"
        nodes = ("orbit-node", "environment-node", "positions-node", *SENSORS)
        self._start("time-master", [
            self._bin / "dmise-time-master", "--keys", keys, "--bind", f"tcp://{hosts.address['time-master']}:0",
            "--announce", announced, "--expect", ",".join(nodes), "--ticks", TICKS + 1,
            "--tick-ns", TICK_S * 10**9, "--window", 4, "--silent-after", SILENT_AFTER_S, "--start-within", 60,
            "--on-silent", policy, "--rejoin-within", 30,
            "--real-time", TICKS * TICK_S / wall_s if wall_s else 0, "--report", self._logs / "master.json"])
        wait_until(announced.exists, "the master's address")
        master = announced.read_text().strip()
        at = lambda name: f"tcp://{hosts.address[name]}:0"
        self._start("broker", [self._bin / "dmise-broker", "--master", master, "--keys", keys, "--publish", at("broker"),
                               "--subscribe", at("broker"), "--observe", at("broker")])
        for name in nodes:
            program = "dmise-sensor-node" if name in SENSORS else f"dmise-{name}"
            own = ["--name", name, "--digest", digest] if name in SENSORS else []
            if name in SENSORS or name == "positions-node":
                own += ["--out", out]
            self._start(name, [self._bin / program, "--master", master, "--host", at(name), "--keys", keys,
                               "--config", scenario, *own])

    def _start(self, name, command):
        self.start_again(name, self._hosts.on(name, command))

    def start_again(self, name, command):
        if name in self._processes:
            self._old.append(self._processes[name])
        if command[0] != "nsenter":
            command = self._hosts.on(name, command)
        with open(self._logs / f"{name}.log", "a", encoding="utf-8") as log:
            self._processes[name] = subprocess.Popen(list(map(str, command)), stdout=log, stderr=log,
                                                     stdin=subprocess.DEVNULL, start_new_session=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in (*self._processes.values(), *self._old):
            if process.poll() is None:
                process.kill()
            process.wait()

    def ended(self):
        return self._processes["time-master"].poll() is not None

    def pid(self, name):
        process = self._processes[name]
        return process.pid if process.poll() is None and command_of(process.pid)[:1] != ["nsenter"] else None

    def has_failed(self, name):
        return self._processes[name].poll() not in (None, 0)

    def finish(self, patience_s):
        try:
            code = self._processes["time-master"].wait(patience_s)
        except subprocess.TimeoutExpired:
            raise Failure(f"still runs after {patience_s:g} s") from None
        return code, last_error((self._logs / "time-master.log").read_text())

    def left(self):
        """Who lives longer than a host can know that the run is over."""
        return wait_for_none(lambda: [n for n, p in self._processes.items() if p.poll() is None])

    def tell(self):
        return "\n".join(f"{p.stem}: {p.read_text()[-300:]}" for p in sorted(self._logs.glob("*.log")))
