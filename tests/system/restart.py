"""Nodes killed with -9 or stopped at random moments: started again, and the products are the same bytes.

    restart.py DMISE [SCHEDULES [SEED]]
"""

import json
import os
import random
import signal
import sys
import time

from harness import Run, check, check_same, main, wait_until, write_scenario

DURATION_S = 120
REAL_TIME = 24  # so that a run lasts 5 s and can be met in the middle
SILENT_AFTER_S = 1.0
NODES = ("alpha", "beta", "orbit-node", "environment-node", "broker")


def disturb(binary, directory, scenario, reference, number, rng):
    out = directory / f"run-{number}"
    faults = sorted((rng.uniform(0.3, 4.5), rng.choice(NODES), rng.choice((signal.SIGKILL,) * 3 + (signal.SIGSTOP,)))
                    for _ in range(rng.randint(1, 3)))
    story = ", ".join(f"{f[2].name} to {f[1]} at {f[0]:.2f} s" for f in faults)
    with Run(binary, "launch", scenario, "--out", out) as run:
        wait_until(lambda: list(out.glob("*/frames.jsonl")), f"a first frame in {out}")
        began = time.monotonic()
        hit = 0
        for at_s, name, what in faults:
            wait_until(lambda: time.monotonic() - began >= at_s, "the next fault")
            pid = run.node(name)
            if pid:  # else it is being started again, or the run is over
                os.kill(pid, what)
                hit += 1
        code, _ = run.finish()
        check(code == 0, f"{story}: code {code} {run.stderr[-400:] if code else ''}")
        run.nothing_left()
    check_same(out, reference, story)
    restarts = json.loads((out / "logs/master.json").read_text())["restarts"]
    return hit, sum(restarts.values())


def test(binary, directory):
    schedules = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    scenario = write_scenario(directory, duration_s=DURATION_S, on_silent_node="restart",
                              silent_after_s=SILENT_AFTER_S, network=f", real_time: {REAL_TIME}")
    reference = directory / "reference"
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0, "the undisturbed run is complete")
    hits = restarts = 0
    for number in range(schedules):
        more = disturb(binary, directory, scenario, reference, number, random.Random(seed * 1000 + number))
        hits, restarts = hits + more[0], restarts + more[1]
    check(restarts > 0, f"{hits} faults in {schedules} runs, {restarts} processes started again")


if __name__ == "__main__":
    main(test)
