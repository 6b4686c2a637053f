"""Faults of a user's programs at random ticks and frames: the run has the bytes of an undisturbed one, or ends in time with the name
of the node, the tick and the reason.

    own_schedules.py DMISE [--seed S] [--first N] [--count N]

A schedule is drawn from its seed and number alone: an actor or a detector, `run` or `launch`, a policy, a fault and its moment. All
combinations of these are in 32 schedules that follow each other.
"""

import argparse
import os
import random
import re
import sys

import own_actor
import own_detector
from harness import Run, check, main

FAULTS = (  # an actor's fault, a detector's, and what the run says of each
    ("SIGKILL", "SIGKILL", r"its program was killed \(Killed\)"),
    ("SIGSTOP", "SIGSTOP", r"its program has not answered for (?P<silent>\d+\.\d) s"),
    ("raises", "raises", r"ValueError: no (fuel|stars) \(wrong.py:\d+\)"),
    ("wrong_shape", "shape", r"ValueError: \w+: must have the shape \(3,\), got \(2,\)"),
    ("nan", "nan", r"(position_m|found\[0\].x_px): .*"),
    ("past", "ready", r"its (states are of tick|program answers a frame by something else).*"),
    ("rubbish", "rubbish", r"what its program says is no answer \(1000000 bytes\)"),
    ("late", "two_frames", r"its (states are of tick .*|program answers in 2 frames instead of 1)"),
)
RAW = ("past", "ready", "rubbish", "late", "two_frames")
TICKS, FRAMES = 40, 4
LATER_S = 3.0  # a busy machine hears of a silent program so much later


def write_actor(directory, number, rng, fault, policy):
    at = rng.randrange(1, TICKS)
    options = {"fault": fault, "at": at} if not fault.startswith("SIG") else {
        "lives": str(directory / f"lives-{number}"), "ends": [at], "how": [fault]}
    program = own_actor.program(name_of("walk", fault), **options)
    return own_actor.write(directory, f"{number}.yaml", node=program, policy=policy, duration_s=TICKS, cadence_s=20), at


def write_detector(directory, number, rng, fault, policy):
    at = rng.randrange(1, FRAMES + 1)
    options = {"fault": fault, "at": at} if not fault.startswith("SIG") else {
        **own_detector.PEAKS, "lives": str(directory / f"lives-{number}"), "ends": [at], "how": [fault]}
    program = own_detector.program(name_of("mortal_peaks", fault), **options)
    return own_detector.write(directory, f"{number}.yaml", program, policy=policy), at


def name_of(mortal, fault):
    return mortal if fault.startswith("SIG") else "wrong_raw" if fault in RAW else "wrong"


def undisturbed(binary, directory, detects):
    """The products of a run without a fault, which is made once."""
    out = directory / f"undisturbed-{'detector' if detects else 'actor'}"
    if not out.exists():
        scenario = (own_detector.write(directory, "undisturbed.yaml", own_detector.program("detector", **own_detector.PEAKS))
                    if detects else own_actor.write(directory, "undisturbed.yaml", node=own_actor.program("walk"),
                                                    duration_s=TICKS, cadence_s=20))
        own_actor.dmise(binary, "run", scenario, "--allow-programs", "--out", out)
    return out


def check_schedule(binary, directory, seed, number):
    rng = random.Random(seed * 1000 + number)
    of_actor, of_detector, words = FAULTS[number % 8]
    detects, command = number // 8 % 2, ("run", "launch")[number // 16 % 2]
    fault, policy = (of_detector if detects else of_actor), rng.choice(("fail", "restart"))
    scenario, at = (write_detector if detects else write_actor)(directory, number, rng, fault, policy)
    place = rf"peaks: frame {at} \(tick \d+\): " if detects else r"gnc: tick (?P<first>\d+)(?: to (?P<last>\d+))?: "
    told = f"{number}: {command}, {'detector' if detects else 'actor'}, {policy}, {fault} at {at}"
    out = directory / f"run-{number}"
    with Run(binary, command, scenario, "--allow-programs", "--out", out) as run:
        code, _ = run.finish()
        last = run.stderr.strip().splitlines()[-1]
        run.nothing_left()
    if policy == "restart" and fault.startswith("SIG"):
        check(code == 0, f"{told}: code {code} {last if code else ''}")
        return own_actor.check_like(out, undisturbed(binary, directory, detects), f"{told}: the bytes of an undisturbed run")
    found = re.search(place + words, last)
    silent_s = float(found["silent"]) if found and fault == "SIGSTOP" else 0.0
    limit_s = own_detector.SILENT_AFTER_S if detects else own_actor.SILENT_AFTER_S
    ticks = (int(found["first"]), int(found["last"] or found["first"])) if found and not detects else (at, at)
    asked_ahead = ticks[0] < ticks[1] and fault.startswith("SIG")  # a program that dies may be at any tick that it was asked for
    check(code == 1 and found and ticks[0] <= at <= ticks[1] and (asked_ahead or ticks == (at, at)) and silent_s < limit_s + LATER_S,
          f"{told}: code {code}: {last}")


def test(binary, directory):
    os.environ["PYTHONPATH"] = str(own_actor.ROOT / "build/python")
    parser = argparse.ArgumentParser()
    parser.add_argument("binary")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=40)
    options = parser.parse_args(sys.argv[1:])
    for number in range(options.first, options.first + options.count):
        check_schedule(binary, directory, options.seed, number)


if __name__ == "__main__":
    main(test)
