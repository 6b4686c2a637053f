"""Processes that end before they have joined, and a disk that is full: what the policy says happens, soon, and is told.

    early_ends.py DMISE
"""

import json
import os
import signal
import time

from harness import Run, check, check_same, main, wait_until, write_scenario
from schedules import Fault, Launch, harm

JOIN_WITHIN_S = 60


def killed_at_once(binary, scenario, out, name, *more):
    """A run in which a process is killed as soon as it is there: (exit code, seconds, run.json, restarts, what it said)"""
    with Run(binary, "launch", scenario, "--out", out, *more) as run:
        os.kill(wait_until(lambda: run.node(name), f"{name} to be started"), signal.SIGKILL)
        began = time.monotonic()
        code, _ = run.finish()
        took_s = time.monotonic() - began
        run.nothing_left()
    restarts = json.loads((out / "logs/master.json").read_text())["restarts"]
    return code, took_s, json.loads((out / "run.json").read_text()), restarts, run.stderr


def test(binary, directory):
    reference = directory / "reference"
    plain = write_scenario(directory, duration_s=20)
    with Run(binary, "run", plain, "--out", reference) as run:
        check(run.finish()[0] == 0, "the undisturbed run is complete")

    scenario = write_scenario(directory, duration_s=20, on_silent_node="restart", name="restart.yaml",
                              network=f", join_within_s: {JOIN_WITHIN_S}")
    for name in ("alpha", "orbit-node", "host-1"):
        out = directory / f"restart-{name}"
        code, took_s, _, restarts, said = killed_at_once(binary, scenario, out, name, "--hosts", 2)
        check(code == 0 and took_s < JOIN_WITHIN_S / 2, f"behind agents, {name} killed at once: code {code} after {took_s:.1f} s: {said[-600:] if code else ''}")
        check(restarts.get(name, 0) <= 1, f"it was started again once: {restarts}")
        check_same(out, reference, f"{name} was started again")

    scenario = write_scenario(directory, duration_s=20, on_silent_node="drop", name="drop.yaml", network=", join_within_s: 4")
    out = directory / "drop"
    code, took_s, record, _, said = killed_at_once(binary, scenario, out, "alpha")
    check(code == 0 and record["status"] == "incomplete" and record["dropped"] == ["alpha"],
          f"without alpha, which was killed at once, the run goes on: code {code}, {record['status']}, {record['dropped']}")
    check("alpha" in said, "and names it")
    theirs = {path.name: path.read_bytes() for path in (reference / "beta").glob("*.fits")}
    check(theirs == {path.name: path.read_bytes() for path in (out / "beta").glob("*.fits")}, "beta's frames are as ever")
    with Run(binary, "launch", scenario, "--out", out) as run:
        check(run.finish()[0] == 0, "the same command makes the rest")
    check_same(out, reference, "alpha is made later")

    slow = write_scenario(directory, duration_s=20, network=", real_time: 4", name="slow.yaml")
    out = directory / "full"
    with Launch(binary, "launch", slow, "--out", out) as run:
        wait_until(lambda: list(out.glob("*/frames.jsonl")), "a first frame")
        harm(run, Fault(0.0, "disk"), [], 0.0)
        code, _ = run.finish()
    record = json.loads((out / "run.json").read_text())
    check(code == 1 and record["status"] == "failed" and record["reason"], f"a full disk: code {code}, {record}")
    with Run(binary, "launch", plain, "--out", out) as run:
        check(run.finish()[0] == 0, "the same command goes on where there is room")
    check_same(out, reference, "after a full disk")


if __name__ == "__main__":
    main(test)
