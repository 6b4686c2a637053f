"""Random schedules of faults on whole runs, each of which is taken up again until it is complete.

    schedules.py [DMISE] [--seed S] [--first N] [--count N] [--seconds S] [--keep-going] [--json FILE]

A schedule is drawn from its seed and number alone: with or without fusion and cues, agents, keys; a policy; up to three faults at
random moments: a process is killed or stopped, its connections are cut, the disk is full, Ctrl-C. Of each run: it ends, leaves no
process, its exit code and the status in run.json say how; no product has a row twice, or one that an undisturbed run does not
have. What is not complete is continued by the same command, at times cut short once more, and has then the bytes of an undisturbed
run. `--seconds` begins no further schedule after that time.
"""

import argparse
import collections
import contextlib
import dataclasses
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from disturbance.cutter import connections_of, cut
from harness import Failure, Run, products, tell_figures, wait_until

BUILT = pathlib.Path(__file__).resolve().parents[2] / "build/release/bin/dmise"
SILENT_AFTER_S = 10.0  # longer than a busy machine is silent
TICKS, TICK_S, WALL_S = 10, 5, 4.0
PATIENCE_S = 240.0
ROOM = 600  # bytes that files may have when the disk is full: a block that exists already
SENSORS = ("atlanta", "huntsville", "telescope")
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: {tick_s}, seed: 1}}
objects: [{{catalogue: newcomer.tle, radius_m: 4}}]
stars: {{catalogue: kstars}}
{fusion}
network: {{on_silent_node: {policy}, silent_after_s: {silent_after_s}, join_within_s: 60, restarts: 9, real_time: {real_time}}}
sensors:
  - {{name: atlanta, site: atlanta, camera: small.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark}}
  - {{name: huntsville, site: huntsville, camera: small.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark}}
  - {{name: telescope, site: atlanta, camera: small.yaml, pointing: {pointing}, exposure_s: 0.5, cadence_s: 2.5, sky: dark}}
output: {{png: false}}
"""
CUED = "{cued: {slew_deg_per_s: 5, slew_deg_per_s2: 3, limiting_magnitude: 12, exposures: 4, least_gain_nats: 0}}"
FILES = {
    "small.yaml": """\
name: small
optics: {projection: gnomonic, columns: 64, rows: 64, pixel_pitch_m: 43.2e-6, field_of_view_deg: 15, aperture_m: 0.02}
detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
""",
    # 900 km above the two sites after a minute.
    "newcomer.tle": """\
NEWCOMER
1 99999U 18001A   18021.01041667  .00000000  00000-0  00000-0 0  9992
2 99999  66.0000  22.9510 0000001   0.0000  33.5590 13.98200000000018
"""}
STATUS = {0: ("complete", "incomplete"), 1: ("failed",), 130: ("interrupted",), -signal.SIGKILL: ("begun",),
          -signal.SIGINT: ("none", "begun", "interrupted")}  # before it listens to signals


@dataclasses.dataclass(frozen=True)
class Fault:
    at_s: float  # after the launch
    kind: str  # kill, stop, cut, disk, interrupt
    victim: str = ""
    lasts_s: float = 0.0  # length of a stop; 0: for ever

    def __str__(self):
        return f"{self.kind} {self.victim} at {self.at_s:.2f} s{f' for {self.lasts_s:.1f} s' if self.lasts_s else ''}"

    @property
    def borne(self):
        return self.kind == "cut" or (self.kind == "stop" and 0 < self.lasts_s)


@dataclasses.dataclass(frozen=True)
class Schedule:
    number: int
    policy: str
    fusion: bool
    hosts: int
    keys: bool
    faults: tuple
    again: tuple  # when it is continued the first time

    def __str__(self):
        parts = [self.policy, *["fusion"] * self.fusion, *["agents"] * bool(self.hosts), *["keys"] * self.keys]
        later = f"; then {', '.join(map(str, self.again))}" if self.again else ""
        return f"{self.number} {' '.join(parts)}: {', '.join(map(str, self.faults))}{later}"


def draw(seed, number):
    rng = random.Random(f"schedules/{seed}/{number}")
    policy = rng.choice(("fail", "wait", "restart", "restart", "drop"))
    fusion, keys = rng.random() < 0.5, rng.random() < 0.25
    hosts = 2 if policy != "drop" and rng.random() < 0.35 else 0
    nodes = [*SENSORS, "orbit-node", "environment-node", *["fusion-node"] * fusion]
    everybody = [*nodes, "broker", *[f"host-{i + 1}" for i in range(hosts)]]

    def one():
        at_s = rng.uniform(0.0, WALL_S + 1.0)
        kind = rng.choice(("kill", "kill", "stop", "cut", "cut", "disk", "interrupt"))
        if kind in ("disk", "interrupt"):
            return Fault(at_s, kind)
        victim = rng.choice(nodes if policy == "drop" else everybody)
        if kind == "kill" and (policy == "wait" or rng.random() < 0.2):
            victim = rng.choice(("dmise", "time-master"))  # who else is killed is waited for until somebody starts it again
        if kind == "stop":
            lasts_s = 0.0 if policy in ("fail", "restart", "drop") and rng.random() < 0.2 else rng.uniform(0.1, 2.0)
            return Fault(at_s, kind, victim, lasts_s)
        if kind == "cut":
            victim = rng.choice([*everybody, "time-master"])
        return Fault(at_s, kind, victim)

    faults = tuple(sorted((one() for _ in range(rng.choice((1, 1, 2, 3)))), key=lambda f: f.at_s))
    again = (Fault(rng.uniform(0.2, WALL_S), rng.choice(("interrupt", "disk"))),) if rng.random() < 0.3 else ()
    return Schedule(number, policy, fusion, hosts, keys, faults, again)


class Field:
    """Where schedules are played, and what undisturbed runs give."""

    def __init__(self, binary, work):
        self.binary, self.work, self._references = binary, work, {}
        for file, text in FILES.items():
            (work / file).write_text(text)

    def scenario(self, policy, fusion, paced):
        path = self.work / f"{policy}-{fusion}-{paced}.yaml"
        path.write_text(SCENARIO.format(
            duration_s=TICKS * TICK_S, tick_s=TICK_S, policy=policy, silent_after_s=SILENT_AFTER_S,
            real_time=TICKS * TICK_S / WALL_S if paced else 0, pointing=CUED if fusion else "zenith",
            fusion="fusion: {not_in_catalogue: [NEWCOMER], cue_delay_ticks: 2}" if fusion else ""))
        return path

    def reference(self, fusion):
        if fusion not in self._references:
            out = self.work / f"reference-{fusion}"
            with Run(self.binary, "run", self.scenario("fail", fusion, False), "--out", out) as run:
                if run.finish(PATIENCE_S)[0] != 0:
                    raise Failure(f"the undisturbed run: {run.stderr[-400:]}")
            self._references[fusion] = products(out)
        return self._references[fusion]

    def more(self, schedule, scenario):
        words = ["--hosts", schedule.hosts] if schedule.hosts else []
        if schedule.keys:
            keys = self.work / f"keys-{schedule.fusion}-{schedule.hosts}"
            if not keys.exists():
                hosts = ("--hosts", schedule.hosts) if schedule.hosts else ()
                with Run(self.binary, "keygen", keys, "--scenario", scenario, *hosts) as keygen:
                    if keygen.finish()[0] != 0:
                        raise Failure(f"keygen: {keygen.stderr}")
            words += ["--keys", keys]
        return words

    def play(self, schedule):
        """Failure when anything does not hold. Returns the outcomes of its runs."""
        out, wanted = self.work / "run", self.reference(schedule.fusion)
        shutil.rmtree(out, ignore_errors=True)
        paced, outcomes = self.scenario(schedule.policy, schedule.fusion, True), []
        for faults in (schedule.faults, schedule.again, ()):
            scenario = paced if faults else self.scenario(schedule.policy, schedule.fusion, False)
            outcomes.append(self._run(schedule, scenario, out, faults, wanted))
            if outcomes[-1] == "complete":
                break
        if outcomes[-1] != "complete":
            raise Failure(f"it does not become complete: {outcomes}")
        ours = products(out)
        differ = sorted(p for p in ours.keys() | wanted.keys() if ours.get(p) != wanted.get(p))
        if differ:
            raise Failure(f"{outcomes}: {len(differ)} files are not those of an undisturbed run: {differ[:4]}")
        page = out / "index.html"
        if not page.exists() and any(f.kind == "disk" or (f.kind == "kill" and f.victim == "dmise") for f in (*schedule.faults, *schedule.again)):
            # A full disk had no room for it, which is said, or the launcher was killed before: the same command writes it.
            self._run(schedule, self.scenario(schedule.policy, schedule.fusion, False), out, (), wanted)
        if not page.exists():
            raise Failure("there is no report")
        return outcomes

    def _run(self, schedule, scenario, out, faults, wanted):
        with Launch(self.binary, "launch", scenario, "--out", out, *self.more(schedule, scenario)) as run:
            done = apply(run, faults)
            code, _ = run.finish(PATIENCE_S)
            for pid in run.stopped:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGCONT)
            wait_until(lambda: not run.living(), "its processes to end", SILENT_AFTER_S + 60)
            if code not in STATUS:
                raise Failure(f"exit code {code}: {run.stderr[-400:]}")
            record = out / "run.json"
            status = json.loads(record.read_text())["status"] if record.exists() else "none"
            # A process that is killed while it begins has written nothing; in its last moment, all, which is compared.
            killed = status in ("none", "begun", "complete") and any(f.kind == "kill" and f.victim == "dmise" for f in done)
            interrupted = any(f.kind == "interrupt" for f in done) and code in (-signal.SIGINT, 130)
            if status not in STATUS[code] and not killed and not (interrupted and status in ("none", "begun", "interrupted")):
                raise Failure(f"exit code {code}, but run.json says {status}: {run.stderr[-400:]}")
            if code == 1 and status != "complete" and all(f.borne for f in done):
                raise Failure(f"nothing that the run does not bear was done ({done}), but it failed: {run.stderr[-400:]}")
        nothing_wrong(out, wanted)
        return status


class Launch(Run):
    """A launch whose files can be denied room."""

    def __init__(self, *arguments):
        self.stdout = self.stderr = ""
        self.stopped = []
        self.process = subprocess.Popen([str(a) for a in arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        start_new_session=True, restore_signals=False,
                                        preexec_fn=lambda: signal.signal(signal.SIGXFSZ, signal.SIG_IGN))


def apply(run, faults):
    """Returns the faults that met a living process."""
    done, waking, began = [], [], time.monotonic()
    pending = list(faults)
    while (pending or waking) and run.process.poll() is None:
        now = time.monotonic() - began
        if waking and waking[0][0] <= now:
            with contextlib.suppress(ProcessLookupError):
                os.kill(waking.pop(0)[1], signal.SIGCONT)
        elif pending and pending[0].at_s <= now:
            fault = pending.pop(0)
            if harm(run, fault, waking, now):
                done.append(fault)
            waking.sort()
        else:
            time.sleep(0.01)
    return done


def harm(run, fault, waking, now):
    if fault.kind == "interrupt":
        run.interrupt()
        return True
    if fault.kind == "disk":
        for pid in run.living():
            with contextlib.suppress(ProcessLookupError):
                resource.prlimit(pid, resource.RLIMIT_FSIZE, (ROOM, ROOM))
        return True
    pid = run.process.pid if fault.victim == "dmise" else run.node(fault.victim)
    if pid is None:
        return False
    try:
        if fault.kind == "kill":
            os.kill(pid, signal.SIGKILL)
        elif fault.kind == "stop":
            os.kill(pid, signal.SIGSTOP)
            run.stopped.append(pid)
            if fault.lasts_s:
                waking.append((now + fault.lasts_s, pid))
        else:
            return sum(cut(pid, descriptor) for descriptor in connections_of(pid)) > 0
    except (ProcessLookupError, FileNotFoundError):
        return False
    return True


def nothing_wrong(out, wanted):
    """Whole rows are those of an undisturbed run, each once; so is each frame."""
    for path, content in products(out).items():
        if path not in wanted:
            raise Failure(f"{path}: no undisturbed run has such a file")
        if path.endswith(".fits"):
            if content != wanted[path]:
                raise Failure(f"{path}: is not that of an undisturbed run")
            continue
        rows = collections.Counter(content[: content.rfind(b"\n") + 1].splitlines())
        known = collections.Counter(wanted[path].splitlines())
        # Tracks that lack a node, which was dropped, are made anew.
        strange = [] if path in ("fusion-node/tracks.jsonl", "tracks.jsonl", "fusion-node/tasks.jsonl", "tasks.jsonl") else \
            [row for row in rows if row not in known]
        twice = [row for row, count in rows.items() if count > max(1, known[row])]
        if strange or twice:
            raise Failure(f"{path}: {len(strange)} rows of no undisturbed run, {len(twice)} twice: {(strange + twice)[0][:100]!r}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise", nargs="?", default=BUILT)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--keep-going", action="store_true", help="play all, also after a failure")
    parser.add_argument("--json", help="append a line of figures to this file")
    options = parser.parse_args()
    began, failed, counts, played = time.monotonic(), [], collections.Counter(), 0
    with tempfile.TemporaryDirectory(prefix="dmise-schedules-") as name:
        field = Field(pathlib.Path(options.dmise).resolve(), pathlib.Path(name))
        for number in range(options.first, options.first + options.count):
            if time.monotonic() - began > options.seconds:
                break
            schedule, start = draw(options.seed, number), time.monotonic()
            played += 1
            counts[f"policy_{schedule.policy}"] += 1
            try:
                outcomes = field.play(schedule)
                counts[f"first_{outcomes[0]}"] += 1
                print(f"ok: {', '.join(outcomes)} in {time.monotonic() - start:.1f} s: {schedule}", flush=True)
            except Failure as failure:
                failed.append(number)
                print(f"FAIL: {schedule}\n  {failure}", flush=True)
                if not options.keep_going:
                    break
    tell_figures({"name": "schedules", "seed": options.seed, "first": options.first, "value": played, "failed": failed,
                  "wall_s": round(time.monotonic() - began, 1), **counts}, options.json)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
