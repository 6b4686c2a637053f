"""An actor hears what sensors and the fusion node publish, as late as the scenario says: the same in one process and in many, and
again when it dies.

    own_topics.py DMISE [SCHEDULES [SEED]]
"""

import json
import os
import pathlib
import random
import re
import signal
import sys

import cue
from harness import CAMERA, Run, check, check_same, main, wait_until
from own_actor import ROOT, SILENT_AFTER_S, check_like, dmise

HERE = pathlib.Path(__file__).resolve().parent
TOPICS = "[detection/*, frame/eye, track/*]"
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 1, seed: 1}}
nodes:
  - {{name: gnc, {node}}}
  - {{name: mine, run: [{python}, follow.py], options: {{tasks: off}}}}
objects:
  - {{name: watcher, motion: {{two_body: {{semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}}}}}}
  - {{name: probe, motion: {{node: gnc}}, radius_m: 0.5}}
stars: {{catalogue: kstars}}
fusion: {{node: mine}}
sensors:
  - {{name: eye, platform: watcher, camera: small.yaml, pointing: {{target: probe}}, exposure_s: 0.02, cadence_s: 2, sky: space}}
  - {{name: ground, site: atlanta, camera: small.yaml, pointing: zenith, exposure_s: 0.5, cadence_s: 10, sky: dark}}
network: {{on_silent_node: {policy}, silent_after_s: {silent_after_s}, restarts: 20}}
output: {{png: false}}
"""


def write(directory, name, node, policy="fail", duration_s=90):
    (directory / "small.yaml").write_text(CAMERA.replace("columns: 512, rows: 384", "columns: 128, rows: 96").replace("view_deg: 15", "view_deg: 3"))
    for file in [*(HERE / "own_topics").glob("*.py"), HERE / "own_actor/mortal.py", HERE / "own_tracker/follow.py"]:
        (directory / file.name).write_bytes(file.read_bytes())
    path = directory / name
    path.write_text(SCENARIO.format(node=node, python=sys.executable, policy=policy, duration_s=duration_s, silent_after_s=SILENT_AFTER_S))
    return path


def program(*words, consumes=TOPICS, delay_ticks=1, **options):
    told = ", ".join(f"{key}: {json.dumps(value)}" for key, value in options.items())
    run = ", ".join([sys.executable, "hears.py", *words])
    return f"run: [{run}], consumes: {consumes}, delay_ticks: {delay_ticks}, options: {{{told}}}"


def runs(binary, command, scenario, out, *more):
    return dmise(binary, command, scenario, "--allow-programs", "--out", out, *more)


def heard(out):
    """The tick at which it heard of each thing."""
    return {(topic, name): int(tick) for tick, topic, name in
            re.findall(r"^heard (\d+) (\S+) (\S+)$", (out / "logs/gnc.log").read_text(), re.M)}


def hears_what_is_published(binary, directory):
    ticks = []
    for delay in (1, 4):
        out = directory / f"delay-{delay}"
        runs(binary, "run", write(directory, f"delay-{delay}.yaml", program(delay_ticks=delay)), out)
        ticks.append(heard(out))
        published = {(f"detection/{d['sensor']}", d["id"]): d["time_ns"] for d in cue.lines_of(out / "detections.jsonl")}
        frames = {("frame/eye", str(f["frame"])): f["end_ns"] for f in cue.lines_of(out / "frames.jsonl") if f["sensor"] == "eye"}
        check(len(published) > 10 and len(frames) == 45, f"{len(published)} detections, {len(frames)} frames")
        due = {key: -(-ns // 1_000_000_000) + delay for key, ns in {**published, **frames}.items()}
        wrong = {key: (ticks[-1].get(key), tick) for key, tick in due.items() if tick <= 90 and ticks[-1].get(key) != tick}
        check(not wrong, f"each is heard {delay} ticks after that of its exposure: {list(wrong.items())[:3]}")
        tracks = [key for key in ticks[-1] if key[0] == "track/fusion-node"]
        check(tracks, f"{len(tracks)} tracks are heard, too")
    later = {ticks[1][key] - ticks[0][key] for key in ticks[1] if key[0] != "track/fusion-node"}
    check(later == {3}, f"with three ticks more, all come three ticks later: {later}")


def gives_the_same_bytes(binary, directory):
    scenario = write(directory, "pushed.yaml", program(push_m_per_s=0.1))
    runs(binary, "run", scenario, directory / "pushed")
    runs(binary, "run", write(directory, "free.yaml", program()), directory / "free")
    far = [cue.lines_of(directory / out / "truth.jsonl") for out in ("pushed", "free")]
    check(far[0] != far[1], "what it hears moves it")
    for name, more in (("launch", ()), ("hosts", ("--hosts", 2))):
        runs(binary, "launch", scenario, directory / name, *more)
        check_same(directory / name, directory / "pushed", f"run, and launch {' '.join(map(str, more))}")


def dies_and_goes_on(binary, directory, schedules, seed):
    for number in range(schedules):
        rng = random.Random(seed * 1000 + number)
        command, words = ("run", "launch")[number % 2], ((), ("forgetful",))[number // 2 % 2]
        ends = sorted(rng.sample(range(90), 3))
        how = [rng.choice(("SIGKILL", "SIGKILL", "SIGTERM", "SIGSTOP")) for _ in ends]
        scenario = write(directory, f"mortal-{number}.yaml", policy="restart",
                         node=program(*words, push_m_per_s=0.1, lives=str(directory / f"lives-{number}"), ends=ends, how=how))
        out = directory / f"mortal-{number}"
        log = runs(binary, command, scenario, out) + (out / "logs/gnc.log").read_text()
        check(log.count("was restarted") == 3, f"{command} {words}: {how} at {ends}, and started again each time")
        check_like(out, directory / "pushed", "the products are those of an undisturbed run")


def node_dies(binary, directory):
    scenario = write(directory, "slow.yaml", program(push_m_per_s=0.1, sleep_s=0.05), policy="restart")
    out = directory / "slow"
    with Run(binary, "launch", scenario, "--allow-programs", "--out", out) as run:
        for frames in (5, 30):
            wait_until(lambda: cue.whole_lines(out / "eye/frames.jsonl") >= frames, f"{frames} frames")
            os.kill(wait_until(lambda: run.node("gnc"), "gnc"), signal.SIGKILL)
        code, _ = run.finish()
        check(code == 0, f"the node killed twice: code {code} {run.stderr[-300:] if code else ''}")
        run.nothing_left()
    check_like(out, directory / "pushed", "the products are those of an undisturbed run")


def others_die(binary, directory):
    """Who takes the place of a sensor or the fusion node publishes again what the actor has heard."""
    scenario = write(directory, "others.yaml", program(push_m_per_s=0.1, sleep_s=0.05), policy="restart")
    out = directory / "others"
    with Run(binary, "launch", scenario, "--allow-programs", "--out", out) as run:
        for frames, node in ((5, "eye"), (15, "fusion-node"), (25, "eye")):
            wait_until(lambda: cue.whole_lines(out / "eye/frames.jsonl") >= frames, f"{frames} frames")
            os.kill(wait_until(lambda: run.node(node), node), signal.SIGKILL)
        code, _ = run.finish()
        check(code == 0, f"sensor and fusion node killed: code {code} {run.stderr[-300:] if code else ''}")
    check_like(out, directory / "pushed", "the products are those of an undisturbed run")


def goes_on_after_a_stop(binary, directory):
    for first, second in (("run", "launch"), ("launch", "run")):
        scenario = write(directory, f"stop-{first}.yaml", program(push_m_per_s=0.1, sleep_s=0.05))
        out = directory / f"stopped-{first}"
        with Run(binary, first, scenario, "--allow-programs", "--out", out) as run:
            wait_until(lambda: cue.whole_lines(out / "eye/frames.jsonl") >= 20, "20 frames")
            run.interrupt()
            code, _ = run.finish()
            check(code == 130, f"{first} stops after Ctrl-C: code {code}")
        with Run(binary, second, scenario, "--allow-programs", "--out", out) as run:
            code, _ = run.finish()
            check(code == 0 and "continuing at tick" in run.stdout, f"{second} goes on: code {code} {run.stderr[-300:] if code else ''}")
        check_like(out, directory / "pushed", "the products are those of a run that was not stopped")


def evades(binary, directory):
    """The example: its satellite leaves its path when it was seen, and not before."""
    for name in ("evade.py", "evade.yaml"):
        (directory / name).write_bytes((ROOT / "clients/python/examples" / name).read_bytes())
    scenario = directory / "evade.yaml"
    text = scenario.read_text().replace("[python3,", f"[{sys.executable},")
    scenario.write_text(text)
    calm = directory / "calm.yaml"
    calm.write_text(text.replace("thrust_m_per_s2: 1.0", "thrust_m_per_s2: 0.0"))
    lines = []
    for path, out in ((scenario, "evade"), (calm, "calm")):
        runs(binary, "run", path, directory / out)
        lines.append([t["true_position_gcrs_m"] for t in cue.lines_of(directory / out / "truth.jsonl")])
    differ = [sum((a - b) ** 2 for a, b in zip(*pair)) ** 0.5 for pair in zip(*lines)]
    check(len(differ) == 6 and differ[0] == 0.0, f"until it is seen nothing happens: {differ}")
    check(all(a < b for a, b in zip(differ[1:], differ[2:])) and differ[-1] > 100, f"then it flees: {[round(d, 1) for d in differ]} m")


REFUSED = {  # what follows the name of the node, and what `check` says
    "consumes: [detection/eyes]": r"nodes\[0\].consumes\[0\]: nobody publishes it, did you mean detection/eye\?, got detection/eyes",
    "consumes: [frame/eye, truth/eye]": r"nodes\[0\].consumes\[1\]: nobody publishes it.*, got truth/eye",
    "consumes: [task/*]": r"nodes\[0\].consumes\[0\]: nobody publishes it, .*got task/\*",
    "consumes: [track/*], period_ticks: 2": r"nodes\[0\].consumes: needs period_ticks: 1",
    "delay_ticks: 2": r"nodes\[0\].delay_ticks: is of topics that the node consumes",
    "consumes: [track/*], delay_ticks: 0": r"nodes\[0\].delay_ticks: must be >= 1, got 0",
}


def refuses(binary, directory):
    for keys, words in REFUSED.items():
        said = dmise(binary, "check", write(directory, "bad.yaml", f"run: [{sys.executable}, hears.py], {keys}"), code=2)
        check(re.search(r"bad.yaml:3:\d+: " + words, said), said.strip())


def test(binary, directory):
    os.environ["PYTHONPATH"] = str(ROOT / "build/python")
    schedules = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    refuses(binary, directory)
    hears_what_is_published(binary, directory)
    gives_the_same_bytes(binary, directory)
    dies_and_goes_on(binary, directory, schedules, int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    node_dies(binary, directory)
    others_die(binary, directory)
    goes_on_after_a_stop(binary, directory)
    evades(binary, directory)


if __name__ == "__main__":
    main(test)
