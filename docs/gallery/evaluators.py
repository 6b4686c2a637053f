"""Draws evaluators.png: error and time of snapshots, deposited and drawn by OpenGL, against the path
integral, over their number. Makes its own runs of launch/scenarios/evaluators.yaml.

    python3 docs/gallery/evaluators.py [DMISE] [PICTURE]
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import matplotlib
import numpy
import yaml
from astropy.io import fits

matplotlib.use("Agg")
from matplotlib import pyplot

here = pathlib.Path(__file__).resolve().parent
dmise = sys.argv[1] if len(sys.argv) > 1 else here.parents[1] / "build/release/bin/dmise"
picture = sys.argv[2] if len(sys.argv) > 2 else here / "evaluators.png"
counts = [2**k for k in range(9)]
cameras = {"path": "gnomonic, in orbit", "sky-path": "equidistant, whole sky"}
scenarios = here.parents[1] / "launch/scenarios"


def scenario(duration_s=60):  # two frames: OpenGL starts in the first
    """Each camera of the scenario along the path and with every number of snapshots."""
    text = (scenarios / "evaluators.yaml").read_text()
    whole = yaml.load(text, yaml.BaseLoader)
    whole["simulation"]["duration_s"] = duration_s
    for thing in whole["objects"]:
        if thing.pop("geometry", None):
            thing["radius_m"] = 0.01  # else nearly all light would be its own, and stand
    whole["detection"] = "off"
    whole["output"] = {"planes": ["sources"], "png": "off"}
    paths = [sensor for sensor in whole["sensors"] if sensor["name"] in cameras]
    whole["sensors"] = paths + [
        sensor | {"name": f"{sensor['name']}-{evaluator}-{n}",
                  "effects": {"integration": "snapshots", "snapshots": n, "evaluator": evaluator}}
        for sensor in paths for evaluator in ("analytic", "opengl") for n in counts]
    return json.dumps(whole)


def frame(folder, name):
    """Light of stars and objects, and the least seconds that drawing them took."""
    light = fits.getdata(folder / name / "frame-000001-sources.fits").astype(float)
    lines = (folder / name / "cost.jsonl").read_text().splitlines()
    effects = [json.loads(line)["effects_s"] for line in lines]
    return light, min(sum(e.get(effect, 0.0) for effect in ("stars", "objects", "psf")) for e in effects)


with tempfile.TemporaryDirectory() as temporary:
    folder = pathlib.Path(temporary)
    (folder / "evaluators.yaml").write_text(scenario())
    subprocess.run([dmise, "run", folder / "evaluators.yaml", "--out", folder / "out"], check=True)
    figure, axes = pyplot.subplots(2, 2, figsize=(7.5, 5.5))
    for (left, right), (camera, title) in zip(axes, cameras.items()):
        exact, path_s = frame(folder / "out", camera)
        for evaluator, style, label in (("analytic", "o-", "deposited"), ("opengl", "s--", "OpenGL")):
            error, time_s = [], []
            for n in counts:
                light, seconds = frame(folder / "out", f"{camera}-{evaluator}-{n}")
                error.append(abs(light - exact).sum() / exact.sum() / 2)
                time_s.append(seconds)
            print(camera, evaluator, *(f"{n}:{e:.2g}/{1e3 * s:.3g}ms"
                                       for n, e, s in zip(counts, error, time_s)))
            left.loglog(counts, error, style, markersize=3, label=label)
            bound = max(n * e for n, e in zip(counts, error))
            right.loglog(counts, 1e3 * numpy.array(time_s), style, markersize=3, label=label)
        print(camera, f"path {1e3 * path_s:.3g} ms")
        left.loglog(counts, [min(1, bound / n) for n in counts], ":", color="grey",
                    label=f"bound {bound:.2g}/N")
        right.axhline(1e3 * path_s, linestyle=":", color="grey", label="path integral")
        left.set_ylabel("misplaced share of light")
        right.set_ylabel("time [ms]")
        left.set_title(title, fontsize=10)
        for axis in (left, right):
            axis.set_xlabel("snapshots N")
            axis.grid(alpha=0.3)
            axis.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=90)
