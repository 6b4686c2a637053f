"""Measures what accuracy costs in three scenarios, and writes the tables and charts of docs/accuracy.md.

    accuracy.py [--repeats N] [--out DIRECTORY] [--only NAME ..]

Runs `dmise tradeoff` on launch/scenarios/accuracy-{all-sky,resolved,space}.yaml; an interrupted run goes on. Figures of
scenarios that --only leaves out stay as they are.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

import report

DOCUMENT = report.ROOT / "docs/accuracy.md"
GALLERY = report.ROOT / "docs/gallery"
SCENARIOS = {
    "all-sky": "All-sky sensor",
    "resolved": "3 m telescope, a resolved satellite through turbulence",
    "space": "Space imager of 4096 x 4096 pixels",
}
KINDS = {"photometry_mag": "mag", "position_px": "px", "background_sigma": "sigma", "noise": "noise"}


def figure(x):
    return "no bound" if x is None else "0" if x < 1e-6 else f"{x:.2g}"


def saving(row):
    """Time that a level saves, as a share of the reference's frame."""
    saved = 1.0 - row["seconds"] / row["reference_s"]
    return "under 1 %" if saved < 0.01 else f"{100 * saved:.0f} %"


def rows_of(directory):
    return json.loads((directory / "tradeoff.json").read_text())["rows"]


def budget_table(rows):
    budgets = [row for row in rows if row["effect"] == "budget"]
    lines = [[row["level"], f"{row['seconds'] / row['reference_s']:.3f}", f"{1e3 * row['seconds']:.0f}"]
             + [f"{figure(row['measured'][kind])} of {figure(row['bound'][kind])}" for kind in KINDS]
             + [f"{row['residual_sigma']:.2g}", f"{100 * row['detected']:.0f} %"]
             for row in sorted(budgets, key=lambda row: row["seconds"])]
    head = ["budget", "time / reference", "ms"] + [f"{unit}, measured of bound" for unit in KINDS.values()]
    return report.table(head + ["rms residual, sigma", "detected"], lines)


def effect_table(rows):
    lines = []
    for row in rows:
        if row["effect"] == "budget":
            continue
        # What changes nothing in this scene is no trade.
        if max(row["measured"][kind] for kind in KINDS) < 1e-6 and saving(row) == "under 1 %":
            continue
        lines.append([f"`{row['effect']}`", row["level"], saving(row)]
                     + [figure(row["measured"][kind]) for kind in KINDS])
    return report.table(["effect", "level", "time saved"] + list(KINDS.values()), lines)


def section(name, directory):
    rows = rows_of(directory)
    shutil.copy(directory / "budgets.svg", GALLERY / f"accuracy-{name}.svg")
    return (f"### {SCENARIOS[name]}\n\n`launch/scenarios/accuracy-{name}.yaml`, all at the reference: "
            f"{rows[0]['reference_s']:.2f} s of one core.\n\n"
            f"![Error of planned frames against their time](gallery/accuracy-{name}.svg)\n\n"
            f"{budget_table(rows)}\nOne effect at a time below the reference, where that changes the frame or its time:\n\n"
            f"{effect_table(rows)}\n")


def between(text, name, inside):
    """The text with what stands between the markers of `name` replaced."""
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->\n"
    block = begin + inside + end
    if begin in text:
        return re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: block, text, flags=re.DOTALL)
    return text + block


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3, help="frames of each kind that are timed (%(default)s)")
    parser.add_argument("--out", type=pathlib.Path, default=report.ROOT / "out/accuracy")
    parser.add_argument("--only", nargs="*", choices=SCENARIOS, default=list(SCENARIOS), metavar="NAME")
    options = parser.parse_args()
    text = DOCUMENT.read_text()
    for name in options.only:
        directory = options.out / name
        done = subprocess.run([report.BINARY, "tradeoff", report.ROOT / f"launch/scenarios/accuracy-{name}.yaml",
                               "--out", directory, "--repeats", str(options.repeats)], cwd=report.ROOT, check=False)
        if done.returncode:
            sys.exit(f"accuracy: {name}: dmise tradeoff ended with {done.returncode}")
        text = between(text, name, section(name, directory))
    machine = ", ".join(f"{what}: {value}" for what, value in report.machine())
    DOCUMENT.write_text(between(text, "machine", f"Measured on {machine}.\n"))


if __name__ == "__main__":
    main()
