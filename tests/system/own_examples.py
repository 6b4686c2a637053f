"""The worked examples of models of one's own, as they are shipped: the same bytes in `run` and `launch`, and what they say that they do.

    own_examples.py DMISE NAME    the example clients/python/examples/NAME.py with NAME.yaml, and the function NAME below
"""

import importlib
import json
import math
import os
import pathlib
import subprocess
import sys

import cue
from cue import lines_of
from harness import check, check_same, main, truth_at
from own_actor import dmise

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "clients/python/examples"
NEEDS = {"manoeuvre": "scipy.integrate", "wheels": "Basilisk.architecture.messaging", "detector_sep": "sep",
         "tracker_stonesoup": "stonesoup", "sailor": "pythonfmu"}
GM = 3.986004415e14


def runs(binary, directory, name, output="output: {png: false, positions: [jsonl]}"):
    """Runs an example in one process and in many; the directory of its products."""
    program, text = ((EXAMPLES / f"{name}{kind}").read_text() for kind in (".py", ".yaml"))
    lines = len(program.splitlines())
    check(lines <= 40, f"{name}.py has {lines} lines")
    (directory / f"{name}.py").write_text(program)
    if "fmu:" in text:
        subprocess.run([sys.executable, "-m", "pythonfmu", "build", "-f", f"{name}.py"], cwd=directory, check=True, capture_output=True)
    (directory / f"{name}.yaml").write_text(text if "\noutput:" in text else f"{text}{output}\n")
    for command in ("run", "launch"):
        dmise(binary, command, directory / f"{name}.yaml", "--allow-programs", "--out", directory / command)
    check_same(directory / "launch", directory / "run", f"{name}: run and launch")
    return directory / "run"


def positions(out, name):
    """States of an object at each tick: position and velocity [m, m/s], and its attitude if it has one."""
    rows = [row for row in lines_of(out / "positions.jsonl") if row["name"] == name]
    return [([1e3 * x for x in row["position_km"]], [1e3 * v for v in row["velocity_km_per_s"]], row.get("quaternion"))
            for row in rows]


def finds_all(binary, out, frames):
    """Each sensor finds the object in each of its frames, as `dmise score` has it; its figures by sensor."""
    done = subprocess.run([binary, "score", out, "--json"], capture_output=True, text=True, check=True)
    scored = {each["sensor"]: each for each in json.loads(done.stdout)["sensors"]}
    found = {sensor: each["found"] for sensor, each in scored.items()}
    check(found == frames and not any(each["missed"] for each in scored.values()), f"the object is found in each frame: {found}")
    return scored


def manoeuvre(binary, directory):
    """Thrust along the velocity adds its work to the energy, and coasting adds nothing."""
    out = runs(binary, directory, "manoeuvre")
    path = positions(out, "chaser")
    energy = [math.hypot(*velocity)**2 / 2 - GM / math.hypot(*place) for place, velocity, _ in path]
    drift = max(abs(e - energy[k]) for span, k in ((energy[:31], 0), (energy[60:], 60)) for e in span)
    check(len(path) == 121 and drift < 1e-3, f"its energy changes by {drift:.1e} J/kg without thrust")
    speed = [math.hypot(*velocity) for _, velocity, _ in path[30:61]]  # 1 m/s^2 for 30 s, by Simpson's rule
    work = (speed[0] + speed[-1] + 4 * sum(speed[1:-1:2]) + 2 * sum(speed[2:-1:2])) / 3
    gain = energy[60] - energy[30]
    check(abs(gain / work - 1) < 1e-8, f"it gains {gain:.3f} J/kg by thrust, whose work is {work:.3f}")
    finds_all(binary, out, {"eye": 6})


def wheels(binary, directory):
    """The neighbour is where Basilisk's attitude has it, and ends in the middle of the field."""
    import numpy as np

    out = runs(binary, directory, "wheels")
    truth = {row["frame"]: row for row in lines_of(out / "truth.jsonl")}
    ours, others = positions(out, "inspector"), positions(out, "neighbour")
    check(1 not in truth and len(truth) > 15, f"the neighbour is out of the field at first, then in {len(truth)} frames")
    worst_px = 0.0
    for frame, row in truth.items():
        (own, _, (w, *axis)), (other, _, _) = ours[tick := 5 * (frame - 1)], others[tick]
        axis, sight = np.array(axis), np.subtract(other, own)
        x, y, z = sight - 2 * w * np.cross(axis, sight) + 2 * np.cross(axis, np.cross(axis, sight))  # in body axes
        expected = 319.5 - 3000 * z / y, 239.5 - 3000 * x / y  # y ahead, x up: a focal length of 3000 px
        worst_px = max(worst_px, math.dist(expected, row["start_px"]))
    check(worst_px < 0.3, f"it is within {worst_px:.2f} px of where the attitude has it")
    last, speed = truth[max(truth)]["middle_px"], max(math.hypot(*state[1]) for state in ours)
    check(math.dist(last, (319.5, 239.5)) < 20 and abs(speed - 7451.83) < 0.01, f"it ends at {last}")


def detector(binary, directory):
    """It finds the object that the camera looks at."""
    finds_all(binary, runs(binary, directory, "detector"), {"eye": 3})


def detector_sep(binary, directory):
    """One telescope with SEP, one with our detector: both are as accurate as photons allow, and the track has detections of both."""
    out = runs(binary, directory, "detector_sep")
    for sensor, scored in finds_all(binary, out, {"atlanta": 6, "huntsville": 6}).items():
        points = scored["errors"]["points"]
        check(0.2 < points["nees_px"]["mean"] < 2 and points["over_bound"]["rms"] < 2 and abs(points["flux"]["mean"]) < 0.01,
              f"{sensor}: {points['along_px']['rms']:.4f} px off, {points['over_bound']['rms']:.2f} of the bound, light by "
              f"{points['flux']['mean']:.4f} mag, {scored['false_alarms']} false alarms")
    taken = {i.split("/")[0] for track in lines_of(out / "tracks.jsonl") for i in track["associated"]}
    check(taken == {"atlanta", "huntsville"}, "the track has detections of both")


def follows(binary, directory, name, objects):
    """A tracker finds objects by two sites, and has the telescope observe each."""
    out = runs(binary, directory, name)
    tasks, tracks, truth = (lines_of(out / f"{file}.jsonl") for file in ("tasks", "tracks", "truth"))
    cue.check_times(tasks, lines_of(out / "telescope/frames.jsonl"))
    ends = {track["id"]: track for track in tracks}
    seen = {track["id"] for track in tracks if any(i.startswith("telescope/") for i in track["associated"])}
    check(set(ends) == seen == {task["track"] for task in tasks}, f"{len(ends)} tracks, {len(tasks)} tasks, detections of all of them")
    found = set()
    for track in ends.values():
        off_m = {one: math.dist(truth_at(track["time_ns"], [row for row in truth if row["name"] == one]), track["position_gcrs_m"])
                 for one in objects}
        nearest, sigma_m = min(off_m, key=off_m.get), math.sqrt(sum(track["covariance_gcrs"][k] for k in (0, 2, 5)))
        found.add(nearest)
        check(off_m[nearest] < 10 and sigma_m < 200, f"{nearest}: {off_m[nearest]:.1f} m off, of {sigma_m:.0f} m that the track says")
    check(found == set(objects), f"they are of {found}")


def tracker_node(binary, directory):
    follows(binary, directory, "tracker_node", ["newcomer"])


def tracker_stonesoup(binary, directory):
    follows(binary, directory, "tracker_stonesoup", ["newcomer", "follower"])


def sailor(binary, directory):
    """An FMU that the example makes moves what a camera sees."""
    finds_all(binary, runs(binary, directory, "sailor"), {"eye": 6})


def test(binary, directory):
    os.environ["PYTHONPATH"] = str(ROOT / "build/python")
    os.environ["PATH"] = f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"
    globals()[sys.argv[2]](binary, directory)


if __name__ == "__main__":
    try:
        importlib.import_module(NEEDS.get(sys.argv[2], "numpy"))
    except ImportError as missing:
        print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
        sys.exit(77)
    main(test)
