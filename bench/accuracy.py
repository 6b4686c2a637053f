"""Measures what accuracy costs in three scenarios, and writes the tables and charts of docs/accuracy.md.

    accuracy.py [--repeats N] [--out DIRECTORY] [--only NAME ..] [--scenes N] [--seed N]

Runs `dmise tradeoff` on launch/scenarios/accuracy-{all-sky,resolved,space}.yaml; an interrupted run goes on. Then
`dmise bench effects` for its figures. What --only or --scenes 0 leaves out stays as it is.
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


def figure(x, missing="no bound"):
    return missing if x is None else "0" if x < 1e-6 else f"{x:.2g}"


def saving(row):
    """Time that a level saves, as a share of the reference's frame."""
    saved = 1.0 - row["seconds"] / row["reference_s"]
    return "under 1 %" if saved < 0.01 else f"{100 * saved:.0f} %"


def rows_of(directory):
    return json.loads((directory / "tradeoff.json").read_text())["rows"]


def budget_table(rows):
    budgets = [row for row in rows if row["effect"] == "budget"]
    lines = [[row["level"], f"{row['seconds'] / row['reference_s']:.3f}", f"{1e3 * row['seconds']:.0f}"]
             + [f"{figure(row['measured'][kind], '-')} of {figure(row['bound'][kind])}" for kind in KINDS]
             + [f"{row['residual_sigma']:.2g}", "-" if row["detected"] is None else f"{100 * row['detected']:.0f} %"]
             for row in sorted(budgets, key=lambda row: row["seconds"])]
    head = ["budget", "time / reference", "ms"] + [f"{unit}, measured of bound" for unit in KINDS.values()]
    return report.table(head + ["rms residual, sigma", "detected"], lines)


def effect_table(rows):
    lines = []
    for row in rows:
        if row["effect"] == "budget":
            continue
        # What changes nothing in this scene is no trade.
        if max(row["measured"][kind] or 0.0 for kind in KINDS) < 1e-6 and saving(row) == "under 1 %":
            continue
        lines.append([f"`{row['effect']}`", row["level"], saving(row)]
                     + [figure(row["measured"][kind], "-") for kind in KINDS])
    return report.table(["effect", "level", "time saved"] + list(KINDS.values()), lines)


def section(name, directory):
    rows = rows_of(directory)
    shutil.copy(directory / "budgets.svg", GALLERY / f"accuracy-{name}.svg")
    return (f"### {SCENARIOS[name]}\n\n`launch/scenarios/accuracy-{name}.yaml`, all at the reference: "
            f"{rows[0]['reference_s']:.2f} s of one core.\n\n"
            f"![Error of planned frames against their time](gallery/accuracy-{name}.svg)\n\n"
            f"{budget_table(rows)}\nOne effect at a time below the reference, where that changes the frame or its time:\n\n"
            f"{effect_table(rows)}\n")


FIGURES = {
    "scenes_within_budget": "share of random scenes whose planned frames keep every budget",
    "scenes_bounds_hold": "share of them in which the bound of each omitted effect holds",
    "bound_tightness": "bound over measured error, median where the bound is over a tenth of its budget",
    "plan_ms": "planning an exposure, ms",
    "all_sky_thrift": "`standard` over everything at the reference: all-sky sensor",
    "space_thrift": "the same, space imager",
    "resolved_thrift": "the same, 3 m telescope",
    "draft_all_sky_s": "a `draft` frame of the all-sky sensor on one core, s",
    "predicted_within_1_5": "share of stages within a factor of 1.5 of the predicted time",
}


def figures(scenes, seed):
    done = subprocess.run([report.BINARY, "bench", "effects", "--json", "--scenes", str(scenes), "--seed", str(seed)],
                          cwd=report.ROOT, check=False, capture_output=True, text=True)
    told = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"name":')]
    if not told:
        sys.exit(f"accuracy: dmise bench effects: {done.stderr.strip()[-300:]}")
    rows = [[f"`{m['name']}`", FIGURES[m["name"]], f"{m['value']:.3g}", f"{m['target']:.3g}", "yes" if m["met"] else "no"]
            for m in told if m["name"] in FIGURES]
    return (f"`dmise bench effects --scenes {scenes} --seed {seed}`:\n\n"
            + report.table(["figure", "of", "measured", "asked", "reached"], rows))


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
    parser.add_argument("--scenes", type=int, default=30, help="random scenes of `dmise bench effects`; 0: none")
    parser.add_argument("--seed", type=int, default=1, help="of these scenes")
    options = parser.parse_args()
    text = DOCUMENT.read_text()
    for name in options.only:
        directory = options.out / name
        done = subprocess.run([report.BINARY, "tradeoff", report.ROOT / f"launch/scenarios/accuracy-{name}.yaml",
                               "--out", directory, "--repeats", str(options.repeats)], cwd=report.ROOT, check=False)
        if done.returncode:
            sys.exit(f"accuracy: {name}: dmise tradeoff ended with {done.returncode}")
        text = between(text, name, section(name, directory))
    if options.scenes > 0:
        text = between(text, "figures", figures(options.scenes, options.seed))
    machine = ", ".join(f"{what}: {value}" for what, value in report.machine())
    DOCUMENT.write_text(between(text, "machine", f"Measured on {machine}.\n"))


if __name__ == "__main__":
    main()
