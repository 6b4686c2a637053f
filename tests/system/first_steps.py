"""What somebody meets who starts: ./dmise --help lists all commands, before anything is built too; mistyped words and
addresses without their transport are answered with what is meant; `dmise list` tells names that scenarios take; what
commands print is in words of the field.

    first_steps.py DMISE
"""

import os
import pathlib
import re
import shutil
import subprocess

from harness import check, main, write_scenario

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("broker", "environment-node", "fusion-node", "host-agent", "orbit-node", "positions-node", "sensor-node", "time-master")
OUR_WORDS = ("s a frame", "points by", "drawn analytically", "PSS")  # say something to us alone


def call(*command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=60,
                          stdin=subprocess.DEVNULL, check=False, **more)
    return done.returncode, done.stdout, done.stderr.strip()


def commands_of(binary):
    """Commands with what they do, of the program's help, where they stand in groups."""
    text = call(binary, "--help")[1].split("Options:")[1]
    return dict(re.findall(r"^  ([a-z]\S*) +(\S.*)$", text, re.MULTILINE))


def help_of_the_script(binary, directory):
    """The script without anything built: a copy of it and of what it reads at once."""
    script = directory / "checkout/dmise"
    shutil.copytree(ROOT / "launch/setup", script.parent / "launch/setup")
    shutil.copy(ROOT / "dmise", script)
    for source in ROOT.glob("launch/*/command_*.cpp"):
        (script.parent / source.relative_to(ROOT)).parent.mkdir(exist_ok=True)
        shutil.copy(source, script.parent / source.relative_to(ROOT))
    code, text, _ = call(script, "--help")
    listed = dict(re.findall(r"^ {36}([a-z]\S*) +(\S.*)$", text, re.MULTILINE))
    built = commands_of(binary)
    check(code == 0 and listed == built and len(built) > 25,
          f"./dmise --help lists the built command's {len(built)}: {listed.items() ^ built.items()}")
    for name in built.keys() - {"bench", "validate"}:  # whose own programs answer
        check(built[name] in call(binary, name, "--help")[1], f"dmise {name} --help says so, too: {built[name]}")
    for own in ("setup", "build", "demo", "test", "fuzz", "bench", "package", "docs", "clean"):
        check(f"./dmise {own}" in text, f"and its own {own}")
    for wrong, meant in ((("chek",), "check"), (("buld",), "build"), (("setup", "--test"), "--tests")):
        code, _, said = call(script, *wrong)
        check(code == 2 and f"did you mean {meant}?" in said and "\n" not in said, f"./dmise {' '.join(wrong)}: {said}")
    check(not (script.parent / "build").exists(), "nothing was set up for that")


def suggestions(binary, scenario):
    for wrong, meant in ((("chek",), "check"), (("run", scenario, "--thread", "2"), "--threads"),
                         (("launch", scenario, "--host", "2"), "--hosts"), (("list", "camera"), "cameras"),
                         (("clock", "paus"), "pause"), (("bench", "fram"), "frame"),
                         (("visible", scenario, "--sunlight"), "--sunlit"), (("launch", scenario, "--log-format", "txt"), "text"),
                         (("catalogue", "states", "demo", "--at", "2018-01-21T00:00:00Z", "--frame", "tmee"), "teme")):
        code, _, said = call(binary, *wrong)
        check(code == 2 and f"did you mean {meant}?" in said and "\n" not in said, f"{wrong[0]}: {said}")
    for program in PROGRAMS:
        code, _, said = call(binary.parent / f"dmise-{program}", "--log-levl", "info")
        check(code == 2 and "did you mean --log-level?" in said and "\n" not in said, said)
    master = binary.parent / "dmise-time-master"
    for option, wrong, meant in (("--log-level", "wraning", "warning"), ("--log-format", "jsno", "json"),
                                 ("--on-silent", "wiat", "wait")):
        code, _, said = call(master, "--expect", "a", option, wrong)
        check(code == 2 and f"did you mean {meant}?" in said and "\n" not in said, said)


def addresses(binary, directory, scenario):
    out = directory / "out"
    calls = [(binary, "launch", scenario, "--out", out, "--bind"), (binary, "status"), (binary, "clock", "pause"),
             (binary, "health", "alpha", "--master"), (binary, "join", scenario, "alpha", "--master"),
             (binary, "join", scenario, "alpha", "--master", "tcp://127.0.0.1:1", "--host"),
             (binary.parent / "dmise-time-master", "--expect", "a", "--bind"),
             (binary.parent / "dmise-host-agent", "--bind")]
    calls += [(binary.parent / "dmise-broker", option) for option in ("--publish", "--subscribe", "--observe")]
    calls += [(binary.parent / f"dmise-{program}", option) for program in PROGRAMS for option in ("--master", "--host")]
    for command in calls:
        code, _, said = call(*command, "127.0.0.1:7998")
        check(code == 2 and "did you mean tcp://127.0.0.1:7998?" in said and "\n" not in said, said)
    code, _, said = call(binary, "health", "alpha", env=os.environ | {"DMISE_MASTER": "127.0.0.1:7998"})
    check(code == 2 and "tcp://127.0.0.1:7998?" in said, f"DMISE_MASTER: {said}")


def names(binary, directory):
    """Every listed camera, site and filter is taken by a scenario."""
    listed = {}
    for kind in ("cameras", "sites", "filters", "materials", "catalogues"):
        code, text, said = call(binary, "list", kind)
        listed[kind] = [line.split()[0] for line in text.splitlines()]
        check(code == 0 and listed[kind] and all(len(line.split()) > 1 for line in text.splitlines()),
              f"{len(listed[kind])} {kind}, each with what it is {said}")
    for kind in ("cameras", "sites"):
        there = sorted(path.stem for path in (ROOT / "launch" / kind).glob("*.yaml"))
        check(listed[kind] == there, f"{kind} are the files of launch/{kind}")
    sensors = "".join(f"  - {{name: c{i}, site: {listed['sites'][i % len(listed['sites'])]}, camera: {camera}, "
                      "pointing: zenith, exposure_s: 0.1, cadence_s: 5}\n" for i, camera in enumerate(listed["cameras"]))
    path = directory / "names.yaml"
    path.write_text("simulation: {start: 2018-01-21T00:15:00Z, duration_s: 5, tick_s: 5}\n"
                    f"stars: {{catalogue: {listed['catalogues'][1]}}}\n"
                    f"objects: [{{catalogue: {listed['catalogues'][0]}}}]\nsensors:\n{sensors}")
    code, _, said = call(binary, "check", path)
    check(code == 0, f"a scenario of all of them passes {said}")


def words(binary, directory, scenario):
    printed = "".join(call(binary, "run", scenario, "--out", directory / "words", "--force")[1:])
    page = (directory / "words/index.html").read_text()
    printed += re.sub(r"[A-Za-z0-9+/=]{60,}", "", page)  # without pixels
    for word in OUR_WORDS:
        check(word not in printed, f"nothing is called {word!r}")


def test(binary, directory):
    scenario = write_scenario(directory, duration_s=10)
    help_of_the_script(binary, directory)
    suggestions(binary, scenario)
    addresses(binary, directory, scenario)
    names(binary, directory)
    words(binary, directory, scenario)


if __name__ == "__main__":
    main(test)
