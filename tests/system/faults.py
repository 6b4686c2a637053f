"""Random faults on networks of real processes: kill -9, stop, slow, cut, a narrow link, under every policy.

    faults.py DMISE [--seed S] [--schedules N] [--first NUMBER] [--where launch|spread] [--json FILE]

A schedule is drawn from the seed and its number alone. A run must end, its exit code and last line must say why,
nobody may be left running, no product may be wrong, and where the policy promises it all products are the bytes of
an undisturbed run. Hosts that can be cut off are network namespaces: without the right to make them the schedules
that need them are left out, and it says so.
"""

import argparse
import collections
import json
import pathlib
import shutil
import sys
import tempfile
import time

from disturbance.attack import Attack
from disturbance.hosts import Hosts, may_make_hosts
from disturbance.network import Launched, Spread
from disturbance.scene import EVERYBODY, write_scene
from disturbance.schedule import draw
from disturbance.verdict import (EVERYBODY_NEEDS, dropped, expected, names_a_cause, nothing_wrong,
                                 survivors_complete)
from harness import Failure, Run, products, tell_figures

PATIENCE_S = 150.0  # for the end of a run that has been disturbed for the last time


class Field:
    """Where schedules are played: binary, directory, hosts and the undisturbed run."""

    def __init__(self, binary, directory, with_hosts):
        self.binary, self.directory = binary, directory
        self.reference = directory / "reference"
        scenario = write_scene(directory, "fail", 0)
        with Run(binary, "run", scenario, "--out", self.reference) as run:
            if run.finish(PATIENCE_S)[0] != 0:
                raise Failure(f"the undisturbed run: {run.stderr[-500:]}")
        self.digest = json.loads((self.reference / "run.json").read_text())["digest"]
        self.hosts = Hosts(("time-master", *EVERYBODY)) if with_hosts else None
        if self.hosts:
            self.keys = directory / "keys"
            with Run(binary, "keygen", self.keys, "--scenario", scenario) as keygen:
                keygen.finish()

    def network(self, schedule, out):
        scenario = write_scene(self.directory, schedule.policy, schedule.wall_s)
        if schedule.where == "launch":
            return Launched(self.binary, scenario, out)
        return Spread(self.hosts, self.binary, scenario, out, self.keys, self.digest, schedule.policy, schedule.wall_s)

    def play(self, schedule):
        """Failure when anything does not hold. Returns (what was done, outcome)."""
        out = self.directory / f"run-{schedule.number}"
        shutil.rmtree(out, ignore_errors=True)
        with self.network(schedule, out) as network:
            attack = Attack(network, schedule, self.hosts if schedule.where == "spread" else None)
            try:
                outcome = self._judge(schedule, network, attack, out)
            except Failure as failure:
                raise Failure(f"{failure}\n  done: {'; '.join(str(f) for f, _ in attack.done)}\n{network.tell()}") from None
            finally:
                attack.mend_all()
        shutil.rmtree(out, ignore_errors=True)
        return attack.done, outcome

    def _judge(self, schedule, network, attack, out):
        attack.run()
        code, line = network.finish(PATIENCE_S)
        attack.mend_all()
        left = network.left()
        if left:
            raise Failure(f"left running: {left}")
        done = [fault for fault, _ in attack.done]
        should = expected(schedule, done)
        outcome = "complete" if code == 0 else "failed"
        if should not in ("either", outcome):
            raise Failure(f"should be {should}, but it ended with code {code}: {line}")
        nothing_wrong(out, self.reference)
        gone = dropped(out) if schedule.policy == "drop" and code == 0 else set()
        if code != 0:
            killed_launcher = any(f.victim == "dmise" for f in done)
            if not killed_launcher and not names_a_cause(line, done):
                raise Failure(f"the last line does not name a cause: {line!r}")
            self._resume(schedule, out)
        elif gone:
            victims = {f.victim for f in done}
            needed = victims & set(EVERYBODY_NEEDS)
            if not gone <= victims and not needed:
                raise Failure(f"dropped {gone}, who was not harmed")
            survivors_complete(out, self.reference, gone)
        else:
            self._same(schedule, out)
        return outcome

    def _resume(self, schedule, out):
        """A run that was cut short goes on, and gives the same bytes."""
        scenario = write_scene(self.directory, schedule.policy, 0)
        # Without a launch there is no run.json, and nobody knows whose products there are.
        force = () if (out / "run.json").exists() else ("--force",)
        with Run(self.binary, "launch", scenario, "--out", out, *force) as run:
            code, _ = run.finish(PATIENCE_S)
            if code != 0:
                raise Failure(f"taken up again it ends with code {code}: {run.stderr[-500:]}")
        self._same(schedule, out, "taken up again: ")

    def _same(self, schedule, out, when=""):
        ours, theirs = products(out), products(self.reference)
        if schedule.where == "spread" and not when:  # nobody merges
            theirs = {p: b for p, b in theirs.items() if "/" in p or p.startswith("positions")}
        differ = sorted(p for p in ours.keys() | theirs.keys() if ours.get(p) != theirs.get(p))
        if differ:
            raise Failure(f"{when}{len(differ)} of {len(theirs)} files differ: {differ[:4]}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--schedules", type=int, default=8)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--where", choices=("launch", "spread"))
    parser.add_argument("--json", help="append a line of figures to this file")
    parser.add_argument("--keep-going", action="store_true", help="play all, also after a failure")
    options = parser.parse_args()
    no_hosts = may_make_hosts()
    began, failures, counts = time.monotonic(), [], collections.Counter()
    with tempfile.TemporaryDirectory(prefix="dmise-faults-") as directory:
        field = Field(pathlib.Path(options.dmise).resolve(), pathlib.Path(directory), not no_hosts)
        for number in range(options.first, options.first + options.schedules):
            schedule = draw(options.seed, number, options.where)
            if schedule.where == "spread" and no_hosts:
                print(f"left out: {schedule}: no network namespaces here: {no_hosts}", flush=True)
                counts["left_out"] += 1
                continue
            start = time.monotonic()
            try:
                done, outcome = field.play(schedule)
                counts[f"ended_{outcome}"] += 1
                counts.update(f.kind for f, _ in done)
                counts.update([f"policy_{schedule.policy}"])
                print(f"ok: {outcome} in {time.monotonic() - start:.1f} s: {schedule}", flush=True)
            except Failure as failure:
                failures.append(number)
                print(f"FAIL: {schedule}\n  {failure}", flush=True)
                if not options.keep_going:
                    break
        if field.hosts:
            field.hosts.close()
    figures = {"name": "fault_schedules", "seed": options.seed, "first": options.first, "value": options.schedules,
               "failed": failures, "wall_s": round(time.monotonic() - began, 1), **counts}
    tell_figures(figures, options.json)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
