"""What must hold of a run that was disturbed, by its policy."""

import json

from disturbance.scene import SENSORS
from harness import Failure, products

EVERYBODY_NEEDS = ("orbit-node", "environment-node")  # nothing can be made without them


def expected(schedule, done):
    """complete, failed or either; `done`: the faults that were really done."""
    done = [f for f in done if f.victim != "dmise" or f.kind == "kill"]  # a launcher that stood still did no harm
    watchers = [f for f in done if f.victim in ("time-master", "dmise")]
    if any(f.fatal for f in watchers):
        return "failed"
    if not all(f.borne for f in watchers):
        return "either"
    if schedule.policy == "restart":
        return "complete"
    if schedule.policy == "wait":
        # A process that was killed is started again by hand.
        return "either" if any(f.lasts_s == float("inf") for f in done if f.kind != "kill") else "complete"
    if all(f.borne for f in done):
        return "complete"
    if schedule.policy == "drop":
        lost = [f for f in done if not f.borne]
        return "either" if any(f.victim in (*EVERYBODY_NEEDS, "broker") for f in lost) or schedule.early else "complete"
    return "failed" if any(f.fatal for f in done) else "either"


def names_a_cause(line, done):
    """The line names a victim that could be lost, or what has happened to the master's own processes."""
    causes = [f.victim for f in done if not f.borne]
    return any(name in line for name in causes)


def nothing_wrong(out, reference):
    """Every frame that is there is whole and the undisturbed one, every whole line one of its lines."""
    ours, theirs = products(out), products(reference)
    for path, content in ours.items():
        if path not in theirs:
            raise Failure(f"{path}: the undisturbed run has no such file")
        if path.endswith(".fits"):
            if content != theirs[path]:
                raise Failure(f"{path}: is not what it is in an undisturbed run")
        else:
            whole = content[: content.rfind(b"\n") + 1].splitlines()
            known = set(theirs[path].splitlines())
            strange = [line for line in whole if line not in known]
            if strange:
                raise Failure(f"{path}: {len(strange)} lines that no undisturbed run has: {strange[0][:100]!r}")
    return len(ours)


def survivors_complete(out, reference, lost):
    """Under drop: sensors that were not lost have all that they have in an undisturbed run."""
    ours, theirs = products(out), products(reference)
    for name in SENSORS:
        if name in lost:
            continue
        missing = [p for p in theirs if p.startswith(f"{name}/") and ours.get(p) != theirs[p]]
        if missing:
            raise Failure(f"{name} was not lost, but {len(missing)} of its files are not the undisturbed ones: {missing[0]}")


def dropped(out):
    return set(json.loads((out / "logs/master.json").read_text())["dropped"])
