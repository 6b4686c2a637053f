"""A program of the user's makes the tracks and gives the tasks: as ours do, also when it dies; what it says wrongly ends the run with
node, tick and reason.

    own_tracker.py DMISE [SCHEDULES [SEED]]
"""

import json
import math
import os
import pathlib
import random
import re
import signal
import subprocess
import sys

import cue
from harness import CAMERA, Run, check, check_same, main, truth_at, wait_until
from own_actor import check_like, dmise

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SILENT_AFTER_S = 3.0
TICK_NS = 1_000_000_000

ORBIT = "semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0"
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 1, seed: 1}}
nodes: [{{name: mine, {node}}}]
objects:
  - {{catalogue: demo, only: [GOES 14, GOES 16], radius_m: 3}}
  - {{name: watcher, motion: {{two_body: {{{orbit}, true_anomaly_deg: 0}}}}}}
  - {{name: probe, motion: {{two_body: {{{orbit}, true_anomaly_deg: 0.15}}}}, radius_m: 0.5}}
stars: {{catalogue: kstars}}
fusion: {{node: mine, cue_delay_ticks: 3{fusion}}}
sensors:
  - {{name: eye, platform: watcher, camera: small.yaml, pointing: {{target: probe}}, exposure_s: 0.02, cadence_s: 2, sky: space}}
  - {{name: ground, site: atlanta, camera: small.yaml, pointing: zenith, exposure_s: 0.5, cadence_s: 10, sky: dark}}
  - name: scope
    site: atlanta
    camera: small.yaml
    pointing: {{cued: {{slew_deg_per_s: 5, slew_deg_per_s2: 3, settle_s: 1, limiting_magnitude: 12, exposures: 4, least_gain_nats: 0}}}}
    exposure_s: 0.2
    cadence_s: 1
    sky: dark
network: {{on_silent_node: {policy}, silent_after_s: {silent_after_s}, restarts: 20{network}}}
output: {{png: false}}
"""


def write(directory, name, node, policy="fail", duration_s=90, fusion="", network=""):
    (directory / "small.yaml").write_text(
        CAMERA.replace("columns: 512, rows: 384", "columns: 128, rows: 96").replace("view_deg: 15", "view_deg: 3"))
    for file in [*(HERE / "own_tracker").iterdir(), ROOT / "clients/python/examples/tracker_node.py"]:
        if file.is_file():
            (directory / file.name).write_bytes(file.read_bytes())
    path = directory / name
    path.write_text(SCENARIO.format(node=node, policy=policy, duration_s=duration_s, fusion=fusion, network=network, orbit=ORBIT,
                                    silent_after_s=SILENT_AFTER_S))
    return path


def program(name, **options):
    told = ", ".join(f"{key}: {json.dumps(value)}" for key, value in options.items())
    return f"run: [{sys.executable}, {name}.py], options: {{{told}}}"


def runs(binary, command, scenario, out, *more):
    return dmise(binary, command, scenario, "--allow-programs", "--out", out, *more)


def tasks_the_telescope(binary, directory):
    """Detections of two sites, the example's track, its tasks, and exposures of the telescope."""
    for name, text in cue.CAMERAS.items():
        (directory / name).write_text(text)
    ours = "fusion: {not_in_catalogue: [NEWCOMER], cue_delay_ticks: 2}"
    own = f"nodes: [{{name: mine, {program('tracker_node', sigma_arcsec=10, gate_deg=0.1)}}}]\n" \
        "fusion: {node: mine, not_in_catalogue: [NEWCOMER], cue_delay_ticks: 2}"
    check(ours in cue.SCENARIO, "the scenario of cue.py")
    scenario = directory / "loop.yaml"
    scenario.write_text(cue.SCENARIO.replace("REAL_TIME", "0").replace(ours, own))
    runs(binary, "run", scenario, directory / "loop")
    tasks, frames = cue.lines_of(directory / "loop/tasks.jsonl"), cue.lines_of(directory / "loop/telescope/frames.jsonl")
    tracks = cue.lines_of(directory / "loop/tracks.jsonl")
    check(len(tasks) >= 2, f"the telescope has {len(tasks)} tasks")
    cue.check_times(tasks, frames)
    check(tasks[0]["given_ns"] == tracks[0]["time_ns"] and tasks[0]["start_ns"] == tasks[0]["given_ns"] + cue.CUE_DELAY_NS,
          "the first is of the track's first tick, and begins two ticks later")
    last = tracks[-1]
    check({i.split("/")[0] for t in tracks for i in t["associated"]} == {"atlanta", "huntsville", "telescope"},
          "the track has detections of both sites and of the telescope")
    check(last["detections"] == sum(len(t["associated"]) for t in tracks), f"{last['detections']} in all")
    off_m = math.dist(truth_at(last["time_ns"], cue.lines_of(directory / "loop/truth.jsonl")), last["position_gcrs_m"])
    sigma_m = math.sqrt(sum(last["covariance_gcrs"][k] for k in (0, 2, 5)))
    check(off_m < 5 * sigma_m and off_m < 1000, f"it is {off_m:.0f} m from the truth, of {sigma_m:.0f} m that it says")
    scored = json.loads(subprocess.run([binary, "score", directory / "loop", "--json"], capture_output=True, check=True).stdout)
    check(scored["total"]["found"] > 0, "dmise score reads the run")
    dmise(binary, "export", directory / "loop", "--to", "oem", "--tracks")
    check("COVARIANCE_START" in (directory / "loop/export/tracks.oem").read_text(), "its track is exported")
    page = json.loads((directory / "loop/index.html").read_text().split('id="run">')[1].split("</script>")[0])
    check(page["cue_count"] == len(tasks) and any(t["cues"] for t in page["tracks"]), "the page draws it")
    runs(binary, "launch", scenario, directory / "loop-launch", "--hosts", 2)
    check_same(directory / "loop-launch", directory / "loop", "run, and launch over two hosts")


def points_as_told(binary, directory):
    """Exposures of the cued sensor are those of the tasks, which begin when they were told to."""
    scenario = write(directory, "follow.yaml", program("follow"))
    said = runs(binary, "run", scenario, directory / "follow")
    tasks, frames = cue.lines_of(directory / "follow/tasks.jsonl"), cue.lines_of(directory / "follow/scope/frames.jsonl")
    tracks = cue.lines_of(directory / "follow/tracks.jsonl")
    check(tasks and len(frames) == sum(t["exposures"] for t in tasks), f"{len(tasks)} tasks, {len(frames)} exposures")
    check(all(t["exposures"] == 2 and t["track"] == 1 for t in tasks[:-1]), "of two each, as the program says")
    check(all(b["start_ns"] == max(a["end_ns"], b["given_ns"] + 3 * TICK_NS) for a, b in zip(tasks, tasks[1:])),
          "a task begins three ticks after its own, or when the one before ends")
    first = tasks[0]["given_ns"]
    check(tasks[0]["start_ns"] == first + 3 * TICK_NS and any(t["time_ns"] == first for t in tracks), "the first three ticks later")
    check(said.count("scope can't observe track 1") == len(set(re.findall(r"scope can't observe .*: (.*)", said))) >= 1,
          f"why not is told once: {re.findall('scope can.t observe.*', said)}")
    taken = [i for t in tracks for i in t["associated"]]
    check(tracks[-1]["detections"] == len(taken) > 0 and tracks[-1]["existence"] == 1,
          f"{len(taken)} detections are counted")
    runs(binary, "launch", scenario, directory / "follow-launch")
    check_same(directory / "follow-launch", directory / "follow", "run and launch")
    free = write(directory, "free.yaml", program("follow", tasks=False))
    runs(binary, "run", free, directory / "free")
    tasks = cue.lines_of(directory / "free/tasks.jsonl")
    check(tasks and max(t["exposures"] for t in tasks) == 4, f"without a word of tasks our scheduler gives {len(tasks)}")


def dies_and_goes_on(binary, directory, schedules, seed):
    for number in range(schedules):
        rng = random.Random(seed * 1000 + number)
        command, model = ("run", "launch")[number % 2], ("follow", "forgetful")[number // 2 % 2]
        ends = sorted(rng.sample(range(90), 3))
        how = [rng.choice(("SIGKILL", "SIGKILL", "SIGTERM", "SIGSTOP")) for _ in ends]
        scenario = write(directory, f"mortal-{number}.yaml", policy="restart",
                         node=program(model, lives=str(directory / f"lives-{number}"), ends=ends, how=how))
        out = directory / f"mortal-{number}"
        said = runs(binary, command, scenario, out)
        log = said + (out / "logs/fusion-node.log").read_text() if command == "launch" else said
        check(log.count("was restarted") == 3, f"{command}, {model}: {how} at {ends}, and started again each time")
        check_like(out, directory / "follow", "the products are those of an undisturbed run")


def node_dies(binary, directory):
    scenario = write(directory, "slow.yaml", program("follow", sleep_s=0.05), policy="restart")
    out = directory / "slow"
    with Run(binary, "launch", scenario, "--allow-programs", "--out", out) as run:
        for lines in (10, 70):
            wait_until(lambda: cue.whole_lines(out / "tracks.jsonl") >= lines, f"{lines} tracks")
            os.kill(wait_until(lambda: run.node("fusion-node"), "fusion-node"), signal.SIGKILL)
        code, _ = run.finish()
        check(code == 0, f"the fusion node killed twice: code {code} {run.stderr[-300:] if code else ''}")
        run.nothing_left()
    check_like(out, directory / "follow", "the products are those of an undisturbed run")


def goes_on_after_a_stop(binary, directory):
    for first, second in (("run", "launch"), ("launch", "run")):
        scenario = write(directory, f"stop-{first}.yaml", program("follow", sleep_s=0.05))
        out = directory / f"stopped-{first}"
        with Run(binary, first, scenario, "--allow-programs", "--out", out) as run:
            wait_until(lambda: cue.whole_lines(out / "tracks.jsonl") >= 30, "30 tracks")
            run.interrupt()
            code, waited_s = run.finish()
            check(code == 130 and waited_s < 4, f"{first} stops {waited_s:.1f} s after Ctrl-C: code {code}")
            run.nothing_left()
        with Run(binary, second, scenario, "--allow-programs", "--out", out) as run:
            code, _ = run.finish()
            check(code == 0 and "continuing at tick" in run.stdout, f"{second} goes on: code {code} {run.stderr[-300:] if code else ''}")
        check_like(out, directory / "follow", "the products are those of a run that was not stopped")


FAULTS = {  # what a program does at tick 3, and what the run says of it
    "raises": r"ValueError: no orbit \(wrong.py:\d+\)",
    "exits": r"its program has ended with code 7",
    "wrong_type": r"TypeError: a tracker returns dmise.Tracks, or a list of dmise.Track, got int",
    "wrong_item": r"TypeError: a tracker returns dmise.Tracks, or a list of dmise.Track, got one tuple",
    "shape": r"ValueError: track 1: position_m: must have 3 numbers, got the shape \(2,\)",
    "nan": r"position_m: must be in .*, got nan",
    "far": r"position_m: must be in .*",
    "status": r"ValueError: track 1: .*SURE.*",
    "existence": r"existence: must be in .*, got 1.5.*",
    "skew": r"ValueError: track 1: covariance: must be symmetric",
    "indefinite": r"track 1: covariance: must be positive definite",
    "certain": r"track 1: covariance: variance 0 must be > 0 and at most 1e\+24, got 0",
    "vast": r"track 1: covariance: variance 0 must be > 0 and at most 1e\+24, got 1e\+40",
    "no_id": r"id: counts from 1",
    "twice": r"tracks: must be by id",
    "too_many": r"tracks: must be at most 10000, got 10001",
    "unknown_detection": r"track 1: associated: no detection of this tick, got eye/1/7",
    "taken_twice": r"track 2: associated: is taken twice, got eye/\d+/\d+",
    "no_object": r"track 1: catalogue_number: the catalogue has no such object, got 7",
    "other_object": r"track 1: catalogue_number: was \d+, got \d+: another object is another track",
    "comes_back": r"track 1: id: that track has ended",
    "no_sensor": r"tasks: scop: no sensor of this name is cued",
    "not_cued": r"tasks: eye: no sensor of this name is cued",
    "no_track": r"tasks: scope: there is no live track 2",
    "two_tasks": r"tasks: scope: has two tasks at one tick",
    "exposures": r"tasks: scope: exposures: must be at most 1000, got 1001",
    "past": r"its tracks are of tick 2, 2 s",
    "rubbish": r"what its program says is no answer \(1000000 bytes\)",
    "one_frame": r"its program answers in 1 frames instead of 2",
    "ready": r"its program answers a tick by something else",
    "no_tracks": r"not a dmise.v1.TrackSet|not a TrackSet",
    "killed": r"its program was killed \(Killed\)",
    "stopped": r"its program has not answered for \d\.\d s",
    "hangs_silently": r"its program has not answered for \d\.\d s",
}
RAW = ("past", "rubbish", "one_frame", "ready", "no_tracks", "hangs_silently")
LAUNCHED = ("raises", "nan", "killed", "hangs_silently")


def tick_of(fault):
    return r"\d+" if fault == "taken_twice" else 3  # the first that has a detection


def ends_with_a_reason(binary, directory):
    for fault, words in FAULTS.items():
        scenario = write(directory, "wrong.yaml", program("wrong_raw" if fault in RAW else "wrong", fault=fault),
                         duration_s=90 if fault == "taken_twice" else 6)
        command = "launch" if fault in LAUNCHED else "run"
        with Run(binary, command, scenario, "--allow-programs", "--out", directory / f"wrong-{fault}") as run:
            code, _ = run.finish()
            last = run.stderr.strip().splitlines()[-1]
            check(code == 1 and re.search(f"fusion-node: mine: tick {tick_of(fault)}: ({words})", last), f"{command}, {fault}: code {code}: {last}")
            run.nothing_left()


def asks_first(binary, directory):
    never = directory / "never"
    scenario = write(directory, "ask.yaml", program("follow", lives=str(never), ends=[], how=[]))
    for command in ("run", "launch"):
        said = dmise(binary, command, scenario, "--out", directory / "ask", code=2)
        check("ask.yaml:2:" in said and "follow.py" in said and "--allow-programs" in said, f"{command} asks: {said.strip()[-150:]}")
    said = subprocess.run([binary, "check", scenario], capture_output=True, text=True, check=True).stdout
    check("it makes the tracks" in said and not never.exists(), "check names it, and does not start it")
    said = dmise(binary, "check", write(directory, "bad.yaml", program("follow"), fusion=", gate_d2: 9"), code=2)
    check("bad.yaml:8:" in said and "fusion.gate_d2: is of the fusion node's own filters" in said, said.strip())


def test(binary, directory):
    os.environ["PYTHONPATH"] = str(ROOT / "build/python")
    schedules = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    asks_first(binary, directory)
    points_as_told(binary, directory)
    ends_with_a_reason(binary, directory)
    dies_and_goes_on(binary, directory, schedules, seed)
    node_dies(binary, directory)
    goes_on_after_a_stop(binary, directory)
    tasks_the_telescope(binary, directory)


if __name__ == "__main__":
    main(test)
