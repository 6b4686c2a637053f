"""An FMU moves an object: as FMPy's own simulation says, in `run` and `launch`, also when it dies; what is wrong is told in a line.

    own_fmu.py DMISE
"""

import importlib
import json
import math
import os
import pathlib
import re
import sys
import zipfile

import own_actor
from harness import check, check_same, main

try:
    import fmpy
    import numpy as np
    for needed in ("pythonfmu", "pythonfmu3"):
        importlib.import_module(needed)
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

HERE = pathlib.Path(__file__).resolve().parent
GAIN_PER_S = 1e-3
TICKS = 150
INPUTS = {f"along_{axis}": f"velocity_{axis}_m_per_s" for axis in "xyz"}
OUTPUTS = {"position_m": ["x", "y", "z"], "velocity_m_per_s": ["vx", "vy", "vz"]}


def make_unit(directory, version, keeps_state=True):
    """An FMU of tests/system/own_fmu; its name."""
    name = f"orbit{version}{'' if keeps_state else '-forgetful'}.fmu"
    builder = importlib.import_module({2: "pythonfmu.builder", 3: "pythonfmu3.builder"}[version]).FmuBuilder
    word = {2: "FMUstate", 3: "FMUState"}[version]
    made = builder.build_FMU(HERE / f"own_fmu/orbit{version}.py", directory,
                             **{f"canGetAndSet{word}": keeps_state, f"canSerialize{word}": keeps_state})
    pathlib.Path(made).rename(directory / name)
    return name


def node(unit, inputs=None, outputs=None, options=None):
    """What a scenario says of the node after its name."""
    def table(values):
        return json.dumps(values).replace('"', "")

    return (f"fmu: {unit}, inputs: {table(INPUTS if inputs is None else inputs)}, outputs: {table(outputs or OUTPUTS)}, "
            f"options: {table(options or {'gain': GAIN_PER_S})}")


def write(directory, name, of_node, **more):
    return own_actor.write(directory, name, node=of_node, duration_s=TICKS, cadence_s=75, output=", positions: [jsonl]", **more)


def path_of(out):
    rows = [json.loads(line) for line in (out / "positions.jsonl").read_text().splitlines()]
    return {row["tick"]: [1e3 * x for x in (*row["position_km"], *row["velocity_km_per_s"])] for row in rows if row["name"] == "probe"}


def simulated(unit, path):
    """What FMPy says of the same inputs: x, y, z, vx, vy, vz by tick."""
    rows = [(float(tick), *path[tick][3:]) for tick in sorted(path)]
    signals = np.array(rows, dtype=[("time", float)] + [(name, float) for name in INPUTS])
    names = OUTPUTS["position_m"] + OUTPUTS["velocity_m_per_s"]
    result = fmpy.simulate_fmu(str(unit), start_time=0.0, stop_time=float(TICKS), output_interval=1.0, input=signals, output=names,
                               start_values={"gain": GAIN_PER_S})
    return {round(row["time"]): [float(row[name]) for name in names] for row in result}


def is_as_simulated(binary, directory, version):
    unit = make_unit(directory, version)
    scenario = write(directory, f"fmu{version}.yaml", node(unit))
    for command in ("run", "launch"):
        own_actor.dmise(binary, command, scenario, "--allow-programs", "--out", directory / f"{command}{version}")
    check_same(directory / f"launch{version}", directory / f"run{version}", f"FMI {version}: run and launch give the same bytes")
    ours = path_of(directory / f"run{version}")
    theirs = simulated(directory / unit, ours)
    check(ours.keys() == theirs.keys() and len(ours) == TICKS + 1, f"FMI {version}: {len(ours)} ticks")
    off_m = max(math.dist(ours[k][:3], theirs[k][:3]) for k in ours)
    off_m_per_s = max(math.dist(ours[k][3:], theirs[k][3:]) for k in ours)
    pushed_m_per_s = math.hypot(*ours[TICKS][3:]) - math.hypot(*ours[0][3:])
    check(off_m < 1e-5 and off_m_per_s < 1e-8 and pushed_m_per_s > 100,
          f"FMI {version}: off by {off_m:.1e} m and {off_m_per_s:.1e} m/s after {pushed_m_per_s:.0f} m/s of thrust")


def dies_and_goes_on(binary, directory, version, keeps_state):
    unit = make_unit(directory, version, keeps_state)
    lives = directory / f"lives-{unit}"
    os.environ["OWN_FMU_LIVES"] = str(lives)
    out = directory / f"mortal-{unit}"
    said = own_actor.dmise(binary, "run", write(directory, f"mortal-{unit}.yaml", node(unit), policy="restart"), "--allow-programs",
                           "--out", out)
    os.environ.pop("OWN_FMU_LIVES")
    check(lives.exists() and said.count("was restarted") == 1 and path_of(out) == path_of(directory / f"run{version}"),
          f"{unit}: killed, and its path is that of one that was not")


def write_elsewhere(directory, unit):
    """The FMU with programs for another platform alone."""
    with zipfile.ZipFile(directory / unit) as source, zipfile.ZipFile(directory / "other.fmu", "w") as other:
        for name in source.namelist():
            if not name.startswith("binaries/"):
                other.writestr(name, source.read(name))
        other.writestr("binaries/win64/Orbit.dll", b"")


def tells_what_is_wrong(binary, directory):
    unit = "orbit2.fmu"
    write_elsewhere(directory, unit)
    (directory / "rubbish.fmu").write_bytes(b"no archive")
    for of_node, words in {
            node(unit, inputs={"nope": "time_s"}): "inputs.nope: orbit2.fmu has no variable nope",
            node(unit, inputs={"gain": "time_s"}): "inputs.gain: gain must be input, its causality is parameter",
            node(unit, inputs={"along_x": "sun_body_x"}): "inputs.along_x: sun_body_x needs outputs.gcrs_from_body",
            node(unit, options={"x": 1}): "options.x: x must be parameter or input, its causality is output",
            node("other.fmu"): "other.fmu: is for win64, this machine is linux64",
            node("rubbish.fmu"): "rubbish.fmu: is no FMU: File is not a zip file"}.items():
        said = own_actor.dmise(binary, "run", write(directory, "wrong.yaml", of_node), "--allow-programs", "--out",
                               directory / "wrong", "--force", code=1)
        check(f"gnc: tick 0: ValueError: {words}" in said, words)
    (directory / "without").mkdir()
    (directory / "without/fmpy.py").write_text("raise ImportError('No module named fmpy')\n")
    before = os.environ["PYTHONPATH"]
    os.environ["PYTHONPATH"] = f"{directory}/without:{before}"
    said = own_actor.dmise(binary, "run", write(directory, "wrong.yaml", node(unit)), "--allow-programs", "--out", directory / "wrong",
                           "--force", code=1)
    os.environ["PYTHONPATH"] = before
    check('needs FMPy: pip install "dmise[fmi]"' in said, "without FMPy a line says what to install")
    for of_node, words in {
            node("gone.fmu"): r":6:\d+: nodes\[0\].fmu: there is no such file in .*, got gone.fmu",
            node(unit, inputs={"along_x": "sun_x"}): r":6:\d+: nodes\[0\].inputs.along_x: .*got sun_x",
            node(unit, outputs={"position_m": ["x", "y", "z"]}):
                r":6:\d+: nodes\[0\].outputs: lacks velocity_m_per_s, which an FMU that moves an object must say",
            node(unit, outputs={"position_m": ["x", "y"]}): r":6:\d+: nodes\[0\].outputs.position_m: must be 3 names"}.items():
        said = own_actor.dmise(binary, "check", write(directory, "wrong.yaml", of_node), code=2)
        check(re.search(words, said), said.strip())
    said = own_actor.dmise(binary, "run", write(directory, "ask.yaml", node(unit)), "--out", directory / "ask", code=2)
    check("--allow-programs" in said and unit in said, said.strip()[-150:])


def test(binary, directory):
    os.environ["PYTHONPATH"] = os.pathsep.join([str(own_actor.ROOT / "build/python"), *os.environ.get("PYTHONPATH", "").split(os.pathsep)])
    os.environ["PATH"] = f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"
    os.environ["TMPDIR"] = str(directory)  # where a unit that is killed leaves its files
    for version in (2, 3):
        is_as_simulated(binary, directory, version)
        dies_and_goes_on(binary, directory, version, keeps_state=True)
        dies_and_goes_on(binary, directory, version, keeps_state=False)
    tells_what_is_wrong(binary, directory)


if __name__ == "__main__":
    main(test)
