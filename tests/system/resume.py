"""A run that is cut short goes on where it stopped, and gives the same bytes: in one process and in many,
interrupted, killed with -9, and the one going on with what the other has left.

    resume.py DMISE
"""

import json
import os
import re
import signal

from harness import Run, check, check_same, main, wait_until, write_scenario


DURATION_S = 200


def whole_lines(path):
    return path.read_text().count("\n") if path.exists() else 0


def cut_short(binary, command, scenario, out, how, frames):
    with Run(binary, command, scenario, "--out", out) as run:
        wait_until(lambda: whole_lines(out / "beta/frames.jsonl") >= frames, f"{frames} frames in {out}")
        if how == signal.SIGINT:
            run.interrupt()
        else:
            for pid in run.living():
                os.kill(pid, how)
        code, _ = run.finish()
        check(code != 0, f"{command}: {how.name} after {frames} frames ends it with code {code}")


def tells_what_there_is(run, out, reference):
    """What is told of a run that goes on counts what it found in its directory."""
    told = [tuple(map(int, found)) for found in re.findall(
        r"simulated (\d+) of (\d+) s, frames (\d+) of (\d+), detections (\d+)", run.stderr)]
    frames = whole_lines(reference / "frames.jsonl")
    check(told and all(line[1] == DURATION_S and line[3] == frames for line in told),
          f"each line says of how much: {told}")
    check(told[0][0] > 0 and told[0][2] > 0, "the first says what is there already")
    return told[-1]


def goes_on(binary, command, scenario, out, reference):
    with Run(binary, command, scenario, "--out", out) as run:
        code, _ = run.finish()
        last = tells_what_there_is(run, out, reference)
        if command == "run":  # whose last line is of the end
            frames, detections = (whole_lines(reference / f"{name}.jsonl") for name in ("frames", "detections"))
            check((last[2], last[4]) == (frames, detections),
                  f"at the end it tells frames {last[2]}, detections {last[4]}: {detections} lines are there")
        check(code == 0 and "continuing at tick" in run.stdout, f"{command}: {run.stdout.splitlines()[0]}")
    check_same(out, reference, f"{command}: the products are those of a run that was not cut short")


def parts_are_added_up(out, parts, least_s):
    """Wall time and timeline of the whole run, not of its last part."""
    record = json.loads((out / "run.json").read_text())
    check(record["parts"] == parts and record["wall_s"] > least_s,
          f"run.json: {record['parts']} parts, {record['wall_s']:.1f} s, of which the first took {least_s:.1f} s")
    return record["wall_s"]


def timeline_has_all_parts(binary, scenario, out):
    cut_short(binary, "launch", scenario, out, signal.SIGINT, 5)
    first_s = json.loads((out / "run.json").read_text())["wall_s"]
    with Run(binary, "launch", scenario, "--out", out) as run:
        check(run.finish()[0] == 0, "the second part ends the run")
    whole_s = parts_are_added_up(out, 2, first_s)
    page = (out / "index.html").read_text()
    ticks = json.loads(page.split('<script type="application/json" id="run">')[1].split("</script>")[0])["ticks"]
    check(ticks[0][0] == 0 and ticks[-1][2] <= whole_s and all(a[1] <= b[1] for a, b in zip(ticks, ticks[1:])),
          f"the report's timeline begins at tick {ticks[0][0]} and ends at {ticks[-1][2]:.1f} s of {whole_s:.1f}")


def test(binary, directory):
    timeline_has_all_parts(binary, write_scenario(directory, duration_s=DURATION_S), directory / "timeline")
    scenario = write_scenario(directory, duration_s=DURATION_S)
    reference = directory / "reference"
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0, "the undisturbed run is complete")
    cases = (("run", signal.SIGINT, "launch"), ("launch", signal.SIGKILL, "run"),
             ("launch", signal.SIGINT, "launch"), ("run", signal.SIGKILL, "run"))
    for number, (first, how, second) in enumerate(cases):
        out = directory / f"case-{number}"
        cut_short(binary, first, scenario, out, how, 4 + 7 * number)
        # A line that was being written when the power went.
        with open(out / "alpha/detections.jsonl", "a") as file:
            file.write('{"id":"alpha/')
        goes_on(binary, second, scenario, out, reference)


if __name__ == "__main__":
    main(test)
