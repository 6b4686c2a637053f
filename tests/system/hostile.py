"""Strangers against a run: each case starts a small launched run, attacks it, and compares its products byte for byte
with those of an undisturbed run; memory of each process and the time taken are watched.

    hostile.py DMISE [--case NAME] [--group GROUP] [--list] [--json FILE]

A case with keys is one of a stranger who holds a key that may come in. A new case is a function in tests/system/hostile.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile
import time

from disturbance.scene import write_scene
from disturbance.verdict import nothing_wrong
from hostile import load
from hostile.memory import MemoryWatch
from hostile.target import Target
from harness import PATIENCE_S, Failure, Run, check, check_same, tell_figures


SILENT_AFTER_S = 10.0  # longer than a busy machine is silent


class Field:
    """Where cases are played: binary, directory, keys and the undisturbed run."""

    def __init__(self, binary, directory):
        self.binary, self.directory = binary, directory
        self.reference = directory / "reference"
        with Run(binary, "run", write_scene(directory, "fail", 0), "--out", self.reference) as run:
            if run.finish()[0] != 0:
                raise Failure(f"the undisturbed run: {run.stderr[-500:]}")

    def keys(self, scenario, hosts):
        directory = self.directory / f"keys-{hosts}"
        if not directory.exists():
            more = ["--hosts", str(hosts)] if hosts else []
            for arguments in (["--scenario", scenario, *more], ["stranger"]):
                subprocess.run([self.binary, "keygen", directory, *arguments], check=True, stdout=subprocess.DEVNULL)
        return directory

    def play(self, case):
        """Failure when anything does not hold. Returns figures."""
        scenario = write_scene(self.directory, "fail", case.wall_s, SILENT_AFTER_S)
        out = self.directory / case.name
        keys = self.keys(scenario, case.hosts) if case.keys else None
        with Target(self.binary, scenario, out, keys, case.hosts) as target:
            memory = MemoryWatch(target.run)
            memory.start()
            began = time.monotonic()
            case.attack(target)
            code, _ = target.run.finish(PATIENCE_S)
            took_s = time.monotonic() - began
            who, before_mib, peak_mib = memory.stop()
            last = (target.run.stderr.strip().splitlines() or [""])[-1]
            if code == 0:
                check_same(out, self.reference, f"{case.name}: products are those of an undisturbed run")
            else:
                nothing_wrong(out, self.reference)
                check(case.may_fail and last, f"{case.name}: the run fails with a cause: {last}")
            check(peak_mib - before_mib <= case.growth_mib,
                  f"{case.name}: nobody grows by more than {case.growth_mib:g} MiB: {who} {before_mib:.0f} -> {peak_mib:.0f}")
            check(took_s <= case.wall_s + case.late_s, f"{case.name}: over after {took_s:.1f} s")
            target.run.nothing_left()
        return {"name": f"hostile_{case.name}", "exit_code": code, "worst": who, "before_mib": round(before_mib, 1),
                "peak_mib": round(peak_mib, 1), "seconds": round(took_s, 1)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise")
    parser.add_argument("--case", action="append", default=[], help="this one alone; may be given several times")
    parser.add_argument("--group", action="append", default=[], help="the cases of this file alone")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--json", help="append lines of figures to this file")
    options = parser.parse_args()
    sys.stdout.reconfigure(line_buffering=True)
    cases = load()
    unknown = [name for name in options.case if name not in cases]
    if unknown:
        sys.exit(f"no case named {', '.join(unknown)}; --list names them")
    chosen = [c for c in cases.values() if (not options.case or c.name in options.case)
              and (not options.group or c.group in options.group)]
    if options.list:
        for c in chosen:
            print(f"{c.group:12} {c.name:44} {(c.attack.__doc__ or '').splitlines()[0]}")
        return
    if not chosen:
        sys.exit("no such case")
    failed = []
    with tempfile.TemporaryDirectory(prefix="dmise-hostile-") as directory:
        field = Field(pathlib.Path(options.dmise).resolve(), pathlib.Path(directory))
        for c in chosen:
            try:
                tell_figures(field.play(c), options.json)
            except Failure as failure:
                print(f"FAIL: {c.name}: {failure}", flush=True)
                failed.append(c.name)
    if failed:
        sys.exit(f"FAIL: {len(failed)} of {len(chosen)} cases: {', '.join(failed)}")


if __name__ == "__main__":
    main()
