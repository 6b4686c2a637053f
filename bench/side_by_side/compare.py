#!/usr/bin/env python3
"""The same scene in SatSim's API and in ours: lines, processor time and memory of each, into docs/python.md.

    compare.py SATSIM_PYTHON DMISE_PYTHON [--write]

SATSIM_PYTHON: a Python with satsim 0.27.1 and skyfield-data, whose ephemeris SatSim else fetches. DMISE_PYTHON: one that imports
dmise. Each scene is run in a fresh process, three times; the least counts. --write: into docs/python.md.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parents[1] / "docs/python.md"
CATALOGUE = HERE.parents[1] / "launch/catalogues/demo.tle"
MARKS = "<!-- side by side: written by bench/side_by_side/compare.py -->", "<!-- end of side by side -->"
# Runs a scene, which calls `made` with each image, and tells its costs. TLE: the two lines of its satellite.
RUN = """
import json, pathlib, resource, sys, time
def cpu_s():
    return sum(resource.getrusage(resource.RUSAGE_SELF)[:2])
path, catalogue = sys.argv[1:]
lines = pathlib.Path(catalogue).read_text().splitlines()
TLE = lines[lines.index("GOES 13") + 1:][:2]
at = []
def made(image):
    assert image.shape == (512, 512)
    at.append(cpu_s())
exec(compile(pathlib.Path(path).read_text(), path, "exec"))
print(json.dumps({"frames": len(at), "first_s": at[0], "frame_s": (at[-1] - at[0]) / (len(at) - 1),
                  "mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))
"""
EPHEMERIS = "import skyfield_data, os; print(os.path.join(skyfield_data.get_skyfield_data_path(), 'de421.bsp'))"


def code_lines(path):
    """Without the docstring and blank lines."""
    text = re.sub(r'\A""".*?"""', "", path.read_text(), flags=re.S)
    return sum(bool(line.strip()) for line in text.splitlines())


def measured(python, scene, directory):
    """The least of each figure of three runs."""
    runs = []
    for _ in range(3):
        done = subprocess.run([python, "-c", RUN, scene, CATALOGUE], capture_output=True, text=True, cwd=directory,
                              env={**os.environ, "TF_CPP_MIN_LOG_LEVEL": "3"})
        if done.returncode:
            sys.exit(f"{scene.name}: {done.stderr.strip().splitlines()[-1]}")
        runs.append(json.loads(done.stdout.splitlines()[-1]))
    return {key: min(run[key] for run in runs) for key in runs[0]}


def table(satsim, dmise):
    rows = [("lines of code", *(str(code_lines(HERE / f"{name}_scene.py")) for name in ("dmise", "satsim"))),
            ("import and first frame, processor time", f"{dmise['first_s']:.1f} s", f"{satsim['first_s']:.1f} s"),
            ("each further frame, processor time", f"{dmise['frame_s']:.3f} s", f"{satsim['frame_s']:.2f} s"),
            ("resident memory, at most", f"{dmise['mb']:.0f} MB", f"{satsim['mb']:.0f} MB")]
    return "\n".join(["| 8 frames of 512 x 512 of a geostationary satellite, tracked | DMISE | SatSim 0.27.1 |", "|---|---|---|",
                      *("| " + " | ".join(row) + " |" for row in rows)])


def main(satsim_python, dmise_python, *options):
    with tempfile.TemporaryDirectory() as directory:
        ephemeris = subprocess.run([satsim_python, "-c", EPHEMERIS], capture_output=True, text=True, check=True).stdout.strip()
        (pathlib.Path(directory) / "de421.bsp").symlink_to(ephemeris)
        text = table(measured(satsim_python, HERE / "satsim_scene.py", directory), measured(dmise_python, HERE / "dmise_scene.py", directory))
    print(text)
    if "--write" in options:
        before, _, rest = PAGE.read_text().partition(MARKS[0])
        PAGE.write_text(f"{before}{MARKS[0]}\n{text}\n{MARKS[1]}{rest.partition(MARKS[1])[2]}")


if __name__ == "__main__":
    main(*sys.argv[1:])
