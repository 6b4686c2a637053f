"""Looks for the glints of launch/models whose light curves have the power of the fitted half of what was measured.

    fit_glints.py DMISE_VALIDATE [--trials 40]

Each trial writes parts in view and the shares of the narrowest and widest lobes into a copy of the models, and runs `dmise validate brightness`, which
tells the model's power over the measured, as mean and median over tracks. The narrowest lobe is the Sun's disc, the widest moves through a pass. The
cost is the squared logarithm of each ratio; octaves of periods with much noise or few tracks weigh less. Trials are about the best so far.
"""
import argparse
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FAMILIES = {"oneweb": (0.04, 0.010, 0.03), "iridium-next": (0.07, 0.0065, 0.018)}  # where the search begins
WEIGHTS = {"2s": 0.5, "4s": 0.7, "8s": 1, "16s": 1, "32s": 0.7, "all": 4}


def with_glints(text, parts_in_view, least, most):
    edges = text[text.index("  edges:"):] if "  edges:" in text else ""
    return text[: text.index("glints:")] + (
        f"glints:\n  lobe_deg: [0.15, 4.8]\n  parts_in_view: {parts_in_view:.4g}\n  share: [{least:.4g}, {most:.4g}]\n{edges}")


def ratios(program, home, glints):
    for family, numbers in glints.items():
        path = home / f"launch/models/{family}.yaml"
        path.write_text(with_glints(path.read_text(), *numbers))
    done = subprocess.run([program, "brightness", "--json"], capture_output=True, text=True, check=True,
                          env=dict(os.environ, DMISE_HOME=str(home)))
    return {figure["name"]: figure["value"] for figure in map(json.loads, done.stdout.splitlines())}


def cost(figures, family):
    return sum(weight * math.log(max(figures[f"{family}_fitted_power_{band}_{what}"], 0.01)) ** 2
               for band, weight in WEIGHTS.items() for what in ("mean", "median"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--trials", type=int, default=40)
    arguments = parser.parse_args()
    drawn = random.Random(1)
    best = {}
    with tempfile.TemporaryDirectory() as home:
        home = pathlib.Path(home)
        for folder in ("models", "materials"):
            shutil.copytree(SOURCE / "launch" / folder, home / "launch" / folder)
        for trial in range(arguments.trials):
            wide = 0.0 if trial == 0 else 0.4
            glints = {family: tuple(number * math.exp(drawn.gauss(0, wide)) for number in best.get(family, (0, start))[1])
                      for family, start in FAMILIES.items()}
            figures = ratios(arguments.program, home, glints)
            for family, numbers in glints.items():
                found = cost(figures, family), numbers
                if family not in best or found < best[family]:
                    best[family] = found
                    print(family, f"cost {found[0]:.2f}:", "parts in view {:.3g}, shares {:.3g} and {:.3g}".format(*numbers), flush=True)


if __name__ == "__main__":
    main()
