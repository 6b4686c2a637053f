"""A program of the user's moves objects: as files do, also when it dies; what it says wrongly ends the run with its place.

    own_actor.py DMISE [SCHEDULES [SEED]]
"""

import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys

from harness import CAMERA, PATIENCE_S, Run, check, check_same, main, products, wait_until

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SILENT_AFTER_S = 2.0
A, GM, TILT = 7_178_137.0, 3.986004415e14, math.radians(98.6)

SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 1, seed: 1}}
objects:
  - {{catalogue: demo, only: [GOES 14, GOES 16], radius_m: 3}}
  - {{name: watcher, motion: {{two_body: {{semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}}}}}}
  - {{name: probe, motion: {motion}, radius_m: 0.3{more}}}
{nodes}
stars: {{catalogue: kstars}}
sensors:
  - {{name: eye, platform: watcher, camera: small.yaml, pointing: {{target: probe}}, exposure_s: 0.02, cadence_s: {cadence_s}, sky: space}}
  - {{name: aboard, platform: probe, camera: small.yaml, pointing: {{ra_deg: 10, dec_deg: 5}}, exposure_s: 0.5, cadence_s: {cadence_s}, sky: space}}
network: {{on_silent_node: {policy}, silent_after_s: {silent_after_s}, restarts: 20{network}}}
output: {{png: false{output}}}
"""


def write(directory, name, motion="{node: gnc}", node="", policy="fail", duration_s=20, cadence_s=10, more="", network="", output=""):
    """A scenario; `node`: what follows the name of node gnc."""
    (directory / "small.yaml").write_text(CAMERA.replace("columns: 512, rows: 384", "columns: 128, rows: 96").replace("view_deg: 15", "view_deg: 3"))
    for file in (HERE / "own_actor").iterdir():
        (directory / file.name).write_bytes(file.read_bytes())
    path = directory / name
    path.write_text(SCENARIO.format(motion=motion, nodes=f"nodes: [{{name: gnc, {node}}}]" if node else "", policy=policy,
                                    duration_s=duration_s, cadence_s=cadence_s, silent_after_s=SILENT_AFTER_S, more=more,
                                    network=network, output=output))
    return path


def program(name, **options):
    told = ", ".join(f"{key}: {json.dumps(value)}" for key, value in options.items())
    return f"run: [{sys.executable}, {name}.py], options: {{{told}}}"


def write_oem(path):
    """An orbit of which a point is given each 30 s."""
    rate = math.sqrt(GM / A**3)
    lines = []
    for k in range(-4, 12):
        u = math.radians(0.15) + rate * 30 * k
        place = A * math.cos(u), A * math.sin(u) * math.cos(TILT), A * math.sin(u) * math.sin(TILT)
        speed = -A * rate * math.sin(u), A * rate * math.cos(u) * math.cos(TILT), A * rate * math.cos(u) * math.sin(TILT)
        second = 15 * 60 + 37 + 30 * k  # TAI
        numbers = " ".join(f"{x / 1e3:.12f}" for x in (*place, *speed))
        lines.append(f"2018-01-21T00:{second // 60:02d}:{second % 60:02d} {numbers}")
    path.write_text("CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2018-01-20T00:00:00\nORIGINATOR = DMISE\nMETA_START\n"
                    "OBJECT_NAME = PROBE\nOBJECT_ID = 2018-999A\nCENTER_NAME = EARTH\nREF_FRAME = GCRF\nTIME_SYSTEM = TAI\n"
                    f"START_TIME = {lines[0].split()[0]}\nSTOP_TIME = {lines[-1].split()[0]}\nINTERPOLATION = HERMITE\n"
                    "INTERPOLATION_DEGREE = 7\nMETA_STOP\n" + "\n".join(lines) + "\n")


def dmise(binary, *arguments, code=0):
    """Runs a command to its end; returns what it says on stderr."""
    done = subprocess.run([binary, *map(str, arguments)], capture_output=True, text=True, timeout=2 * PATIENCE_S)
    check(done.returncode == code, f"dmise {arguments[0]}: code {done.returncode} {done.stderr[-500:] if done.returncode != code else ''}")
    return done.stderr


def without_digest(content):
    """The bytes of a product without the digest of its scenario, and the sum of the header that it is in."""
    return re.sub(rb"(?s)(SCENARIO|CHECKSUM)= .{70}", b"", content)  # cards of 80 bytes


def check_like(out, reference, claim):
    ours, theirs = products(out), products(reference)
    differ = sorted(p for p in ours.keys() | theirs.keys()
                    if without_digest(ours.get(p, b"")) != without_digest(theirs.get(p, b"")))
    check(theirs and not differ, f"{claim}: {len(theirs)} files, {len(differ)} differ {differ[:3]}")


def follows_a_file(binary, directory):
    write_oem(directory / "probe.oem")
    output = ", positions: [csv, jsonl]"
    by_file = write(directory, "file.yaml", motion="{oem: probe.oem}", output=output)
    dmise(binary, "run", by_file, "--out", directory / "file")
    follows = program("follow_oem", file="probe.oem")
    for command in ("run", "launch"):
        by_node = write(directory, "node.yaml", node=follows, output=output)
        dmise(binary, command, by_node, "--allow-programs", "--out", directory / command)
        check_like(directory / command, directory / "file", f"{command}: a node that follows an OEM is the OEM")
        by_node = write(directory, "taken.yaml", node=follows, output=output, network=", sensors_propagate: off")
        dmise(binary, command, by_node, "--allow-programs", "--out", directory / f"{command}-taken")
        check_like(directory / f"{command}-taken", directory / "file", f"{command}: also where sensors take states")
    return by_file


def steps_far_apart(binary, directory):
    by_node = write(directory, "rare.yaml", node=program("follow_oem", file="probe.oem") + ", period_ticks: 7",
                    output=", positions: [jsonl]")
    dmise(binary, "run", by_node, "--allow-programs", "--out", directory / "rare")

    def places(out):
        rows = map(json.loads, (directory / out / "positions.jsonl").read_text().splitlines())
        return {row["tick"]: (row["position_km"], row["velocity_km_per_s"]) for row in rows if row["name"] == "probe"}

    ours, theirs = places("rare"), places("file")
    check(ours.keys() == theirs.keys() and len(ours) == 21, "a node that is asked each 7th tick has a state at every tick")
    off_m = max(1e3 * math.dist(ours[k][0], theirs[k][0]) for k in ours)
    off_m_per_s = max(1e3 * math.dist(ours[k][1], theirs[k][1]) for k in ours)
    check(off_m < 2e-4 and off_m_per_s < 1e-3, f"cubics are off by {off_m * 1e3:.3f} mm and {off_m_per_s * 1e3:.3f} mm/s")


def turns(binary, directory):
    attitude = "{spinning: {axis: [0, 0, 1], rate_rpm: 3}}"
    rows = []
    for name, motion, more, node in (("spin-file", "{oem: probe.oem}", f", attitude: {attitude}", ""),
                                     ("spin-node", "{oem: probe.oem}", ", attitude: {node: gnc}", program("spin", rate_rpm=3))):
        scenario = write(directory, f"{name}.yaml", motion=motion, more=more, node=node, output=", positions: [jsonl]")
        dmise(binary, "run", scenario, "--allow-programs", "--out", directory / name)
        lines = map(json.loads, (directory / name / "positions.jsonl").read_text().splitlines())
        rows.append([row["quaternion"] for row in lines if row["name"] == "probe"])
    check(len(rows[1]) == 21 and all(math.dist(a, b) < 1e-12 for a, b in zip(*rows)), "a node turns an object as a scenario does")


def tells_an_albedo(binary, directory):
    """The light is that of the scenario's albedo, or of another from a tick on."""
    plain, own = write(directory, "albedo.yaml", node=program("walk"), more=", albedo: 0.4"), program("walk", albedo=0.4)
    dmise(binary, "run", plain, "--allow-programs", "--out", directory / "albedo")
    for command, network in (("run", ""), ("launch", ", sensors_propagate: off")):
        scenario = write(directory, "told.yaml", node=own, network=network)
        dmise(binary, command, scenario, "--allow-programs", "--out", directory / f"told-{command}")
        check_like(directory / f"told-{command}", directory / "albedo", f"{command}: an albedo that is told is that of the scenario")
    magnitudes = []
    for name, node in (("even", program("walk")), ("brighter", program("walk", albedo=0.2, bright_from=10))):
        dmise(binary, "run", write(directory, f"{name}.yaml", node=node), "--allow-programs", "--out", directory / name)
        lines = map(json.loads, (directory / name / "truth.jsonl").read_text().splitlines())
        magnitudes.append([line["true_magnitude"] for line in lines if line["name"] == "probe" and line["sensor"] == "eye"])
    change = [b - a for a, b in zip(*magnitudes)]
    check(len(change) == 2 and change[0] == 0 and abs(change[1] + 2.5 * math.log10(2)) < 1e-9, f"twice as bright from a tick on: {change}")
    for fault, words in ((program("walk", albedo=2000), r"gnc: tick 0: albedo: must be .*got 2000"),
                         (program("walk", albedo=-0.5), r"gnc: tick 0: albedo: must be .*got -0.5")):
        said = dmise(binary, "run", write(directory, "wrong.yaml", node=fault), "--allow-programs", "--out", directory / "dark", "--force",
                     code=1)
        check(re.search(words, said), said.strip().splitlines()[-1])


def dies_and_goes_on(binary, directory, schedules, seed):
    """Programs that are killed or stopped at random ticks: with checkpoints and without."""
    reference = None
    for number in range(schedules):
        rng = random.Random(seed * 1000 + number)
        command, model = ("run", "launch")[number % 2], ("follow_oem", "walk", "forgetful_walk")[number % 3]
        ends = sorted(rng.sample(range(150), 3))
        how = [rng.choice(("SIGKILL", "SIGKILL", "SIGKILL", "SIGTERM", "SIGSTOP")) for _ in ends]
        options = {"file": "probe.oem", "lives": str(directory / f"lives-{number}"), "ends": ends, "how": how}
        scenario = write(directory, f"mortal-{number}.yaml", node=program(model, **options), policy="restart",
                         duration_s=150, cadence_s=75)
        plain = write(directory, f"immortal-{model}.yaml", node=program(model, file="probe.oem"), duration_s=150, cadence_s=75)
        reference = directory / f"immortal-{model}"
        if not reference.exists():
            dmise(binary, "run", plain, "--allow-programs", "--out", reference)
        out = directory / f"mortal-{number}"
        said = dmise(binary, command, scenario, "--allow-programs", "--out", out)
        log = said + (out / "logs/gnc.log").read_text()
        check(log.count("was restarted") == 3, f"{command}, {model}: {how} at {ends}, and started again each time")
        check_like(out, reference, "the products are those of an undisturbed run")


def node_dies(binary, directory):
    """The process that runs the program is killed, and with it the program; the launcher starts another."""
    scenario = write(directory, "slow.yaml", node=program("walk", sleep_s=0.03), policy="restart", duration_s=150, cadence_s=75)
    with Run(binary, "launch", scenario, "--allow-programs", "--out", directory / "slow") as run:
        wait_until(lambda: (directory / "slow/aboard/frame-000001.fits").exists(), "a frame")
        os.kill(run.node("gnc"), 9)
        code, _ = run.finish()
        check(code == 0, f"the node killed, and started again: code {code} {run.stderr[-300:] if code else ''}")
        run.nothing_left()
    waited_for_s = json.loads((directory / "slow/logs/master.json").read_text())["waited_for_s"]
    check(max(waited_for_s, key=waited_for_s.get) == "gnc", f"the clock waited for the slow node, and tells so: {waited_for_s}")
    check_like(directory / "slow", directory / "immortal-walk", "the products are those of an undisturbed run")


FAULTS = {  # what a program does at tick 3, and what the run says of it
    "raises": r"gnc: tick 3: ValueError: no fuel \(wrong.py:\d+\)",
    "exits": r"gnc: tick 3: its program has ended with code 7",
    "wrong_shape": r"gnc: tick 3: ValueError: position_m: must have the shape \(3,\), got \(2,\)",
    "nan": r"gnc: tick 3: position_m: .*",
    "far": r"gnc: tick 3: position_m: must be in \[-1e\+15, 1e\+15\], got 1e\+16",
    "fast": r"gnc: tick 3: velocity_m_per_s: must be in \[-299792458, 299792458\], got 300000000",
    "signature": r"gnc: tick 0: TypeError: orbit\(\) takes 1 positional argument but 3 were given \(signature.py:5\)",
    "nothing": r"gnc: tick 3: ValueError: position_m and velocity_m_per_s: are needed.*",
    "another_object": r"gnc: tick 3: ValueError: ghost: the node has no such object, only probe",
    "past": r"gnc: tick 3: its states are of tick 2, 2 s",
    "two_objects": r"gnc: tick 3: count: must be 1, one for each object, got 2",
    "turned": r"gnc: tick 3: attitude_object: must be none, the objects that it turns, got 0",
    "rubbish": r"gnc: tick 3: what its program says is no answer \(1000000 bytes\)",
    "two_frames": r"gnc: tick 3: its program answers in 2 frames instead of 3",
    "killed_between_ticks": r"gnc: tick \d+: its program was killed \(Killed\)",
    "never_connects": r"gnc: tick 0: its program has ended with code 1 before it was ready",
    "killed": r"gnc: tick 3: its program was killed \(Killed\)",
    "stopped": r"gnc: tick 3: its program has not answered for \d\.\d s",
    "hangs_silently": r"gnc: tick 3: its program has not answered for \d\.\d s",
}


def ends_with_a_reason(binary, directory):
    for number, (fault, words) in enumerate(FAULTS.items()):
        raw = fault in ("past", "two_objects", "turned", "rubbish", "two_frames", "hangs_silently")
        named = {"never_connects": "no_module", "signature": "signature"}.get(fault, "wrong_raw" if raw else "wrong")
        scenario = write(directory, "wrong.yaml", node=program(named, fault=fault), network=", real_time: 10")
        command = ("run", "launch")[number % 2 or fault == "killed_between_ticks"]  # run has no pace
        with Run(binary, command, scenario, "--allow-programs", "--out", directory / f"wrong-{fault}") as run:
            code, waited_s = run.finish()
            last = run.stderr.strip().splitlines()[-1]
            check(code == 1 and re.search(words, last), f"{command}, {fault}: code {code}: {last}")
            run.nothing_left()


def tells_where_it_may_have_died(binary, directory):
    """A program that is asked ahead has died at one of the ticks that it was asked for."""
    for fault, words in (("killed", "was killed \\(Killed\\)"), ("exits", "has ended with code 7"), ("stopped", "has not answered for ")):
        scenario = write(directory, "ahead.yaml", node=program("wrong", fault=fault, at=40), duration_s=60, cadence_s=30)
        said = dmise(binary, "run", scenario, "--allow-programs", "--out", directory / f"ahead-{fault}", code=1)
        place = re.search(r"gnc: tick (\d+)(?: to (\d+))?: its program " + words, said)
        check(place and int(place[1]) <= 40 <= int(place[2] or place[1]) <= 60, said.strip().splitlines()[-1])


def asks_of_what_is_odd(binary, directory):
    """What a sensor misses is told with what the model may have forgotten."""
    for fault, words in {"no_return": "gnc: no object has a state at tick 0: does the model return what it computes?",
                         "kilometres": "is under the ground; are its positions in m?"}.items():
        scenario = write(directory, "odd.yaml", node=program("wrong", fault=fault, at=0))
        said = dmise(binary, "run", scenario, "--allow-programs", "--out", directory / fault, code=1)
        check(words in said and "eye: probe has no state at frame 1" in said, words)


def asks_first(binary, directory):
    scenario = write(directory, "ask.yaml", node=program("walk", lives=str(directory / "never"), ends=[], how=[]))
    for command in ("run", "launch"):
        said = dmise(binary, command, scenario, "--out", directory / "ask", code=2)
        check("ask.yaml:6:" in said and "walk.py" in said and "--allow-programs" in said, f"{command} asks: {said.strip()[-150:]}")
    dmise(binary, "check", scenario)
    check(not (directory / "never").exists(), "neither they nor check start it")
    trusts(binary, directory)
    said = dmise(binary, "check", write(directory, "bad.yaml", node=program("wakl")), code=2)
    check(re.search(r"bad.yaml:6:\d+: nodes\[0\].run\[1\]: there is no such file in .*, got wakl.py", said), said.strip())
    bad = {"node: gnd": "no node of `nodes` has this name, did you mean gnc?"}
    for motion, words in bad.items():
        said = dmise(binary, "check", write(directory, "bad.yaml", motion=f"{{{motion}}}", node=program("walk")), code=2)
        check(words in said and "bad.yaml:5:" in said, said.strip())


def trusts(binary, directory):
    """The user's list of trusted directories is the word of --allow-programs, unless others may write there."""
    (directory / "home/dmise").mkdir(parents=True, mode=0o755)
    os.environ["XDG_CONFIG_HOME"] = str(directory / "home")
    mine = directory / "home/dmise/trusted-directories"
    mine.write_text(f"# of mine\n{directory}\n")
    for path in (directory, directory / "home/dmise", mine):
        path.chmod(0o755)
    scenario = write(directory, "trusted.yaml", node=program("walk"))
    for command in ("run", "launch"):
        dmise(binary, command, scenario, "--out", directory / f"trusted-{command}")
    directory.chmod(0o775)
    said = dmise(binary, "run", scenario, "--out", directory / "trusted", code=2)
    check(f"{mine}:2: does not count: others may write to {directory} (chmod go-w)" in said, said.strip()[-200:])
    directory.chmod(0o755)
    mine.write_text("/usr\n")
    said = dmise(binary, "launch", scenario, "--out", directory / "trusted", code=2)
    check(f"no line of {mine} is {directory} or above it" in said and said.count("\n") == 1, said.strip()[-200:])


def joins(binary, directory):
    scenario = write(directory, "join.yaml", node="elsewhere: on", duration_s=150, cadence_s=75)
    out = directory / "join"
    dmise(binary, "run", scenario, "--out", out, code=2)
    with Run(binary, "launch", scenario, "--out", out) as run:
        address = out / "logs/master.address"
        wait_until(lambda: address.exists() and address.read_text().strip(), "the time-master")
        with Run(binary, "join", scenario, "gnc", "--master", address.read_text().strip(), "--out", out, "--program",
                 f"{sys.executable} -u {directory}/walk.py") as joined:
            code, _ = run.finish()
            check(code == 0, f"launch: code {code} {run.stderr[-300:] if code else ''}")
            code, _ = joined.finish()
            check(code == 0, f"a program from elsewhere joins: code {code} {joined.stderr[-300:] if code else ''}")
    check_like(out, directory / "immortal-walk", "the products are those of one that was started")


def test(binary, directory):
    os.environ["PYTHONPATH"] = str(ROOT / "build/python")
    schedules = int(sys.argv[2]) if len(sys.argv) > 2 else 6
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    asks_first(binary, directory)
    follows_a_file(binary, directory)
    steps_far_apart(binary, directory)
    turns(binary, directory)
    tells_an_albedo(binary, directory)
    ends_with_a_reason(binary, directory)
    tells_where_it_may_have_died(binary, directory)
    asks_of_what_is_odd(binary, directory)
    dies_and_goes_on(binary, directory, schedules, seed)
    node_dies(binary, directory)
    joins(binary, directory)


if __name__ == "__main__":
    main(test)
