"""Ctrl-C ends a run within 2 s; what is finished is kept and whole, and nothing is left running.

    ctrl_c.py DMISE SCENARIO
"""

import json
import sys

from harness import Run, check, first_frame, main

DEADLINE_S = 2.0
FITS_BLOCK = 2880


def interrupted(binary, directory, command):
    out = directory / command
    with Run(binary, command, sys.argv[2], "--out", out) as run:
        first_frame(out)
        run.interrupt()
        code, waited_s = run.finish()
        check(waited_s < DEADLINE_S, f"{command}: ends {waited_s:.2f} s after Ctrl-C")
        check(code == 130, f"{command}: exit code {code}")
        run.nothing_left()
    frames = sorted(out.glob("*/frame-*.fits"))
    torn = [path for path in frames if path.stat().st_size % FITS_BLOCK or path.stat().st_size < 1e5]
    check(frames and not torn, f"{command}: {len(frames)} frames are kept, {len(torn)} torn")
    reports = [json.loads(line) for line in (out / "frames.jsonl").read_text().splitlines()]
    absent = [r for r in reports if not (out / r["sensor"] / f"frame-{r['frame']:06d}.fits").exists()]
    check(not absent, f"{command}: {len(reports)} frame reports, {len(absent)} without a frame")
    for name in ("detections.jsonl", "truth.jsonl"):
        for line in (out / name).read_text().splitlines():
            json.loads(line)
    status = json.loads((out / "run.json").read_text())["status"]
    check(status == "interrupted", f"{command}: run.json says {status}")


def test(binary, directory):
    interrupted(binary, directory, "launch")
    interrupted(binary, directory, "run")


if __name__ == "__main__":
    main(test)
