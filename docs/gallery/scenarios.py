#!/usr/bin/env python3
"""Writes docs/gallery.md: the scenarios that are shipped, each with what its first lines say and a picture.

    scenarios.py            the page, of the pictures that there are
    scenarios.py DMISE      draws anew the pictures that only this page has, with runs of a minute together

Needs python3-opencv for drawing.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "launch/scenarios"
GALLERY = ROOT / "docs/gallery"
PAGE = ROOT / "docs/gallery.md"
WIDTH_PX = 480
# Pictures that other documents have already; of the paper's scenarios that of the results beside it.
SHARED = {"accuracy-all-sky": "gallery/accuracy-all-sky.svg", "accuracy-resolved": "gallery/accuracy-resolved.svg",
          "accuracy-space": "gallery/accuracy-space.svg", "demo": "gallery/demo.png", "evaluators": "gallery/evaluators.png",
          "figure5": "gallery/figure5.svg", "inspector": "gallery/inspector.png", "survey": "gallery/survey.svg",
          "paper/figure6": "paper/figure6.png", "paper/figure8": "paper/figure8.png"}
# Drawn by this script: frame of which sensor, how long the run takes of the scenario's time, and what of the frame is shown.
DRAWN = {"close-up": ("near-eye", None, None), "three-sites": ("atlanta", 15, (512, 512)), "cooperate": (None, 30, (360, 480)),
         "dataset": ("watcher", None, None), "breakup": ("raven", 50, (700, 700)),
         "proximity": ("servicer-eye", None, None)}


def names():
    return sorted(str(path.relative_to(SCENARIOS).with_suffix("")) for path in SCENARIOS.rglob("*.yaml")
                  if re.search("^simulation:", path.read_text(), re.M))  # else a file that scenarios name


def words(name):
    """What the first comment of a scenario says, and the command that runs it."""
    text = (SCENARIOS / f"{name}.yaml").read_text()
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        if not line.startswith("#   "):  # a command
            lines.append(line[1:].strip())
    command = "dataset" if name == "dataset" else "survey" if name.startswith("survey") else \
        "visible" if name == "figure5" else "observatory" if name == "observatory" else "run"
    description = re.sub(r"(\./)?(dmise \w+ launch/\S+?( --?\S+?( [^-\s.]\S*?)?)*)(?=[.:,]?(\s|$))", r"`\2`", " ".join(lines))
    description = re.sub(r"docs/(\S+?\.md)", r"[\1](\1)", description)
    return description, f"dmise {command} launch/scenarios/{name}.yaml" + (" --seeds 1..10" if name == "dataset" else "")


def picture(name):
    if name in SHARED:
        return SHARED[name]
    own = f"gallery/scenario-{name.replace('/', '-')}.png"
    return own if (ROOT / "docs" / own).exists() else None


def page():
    text = ("# Scenarios that are shipped\n\nIn a checkout they are in `launch/scenarios`, of an installed package in\n"
            "`/usr/share/dmise/launch/scenarios`. Written by `docs/gallery/scenarios.py`.\n")
    for name in names():
        description, command = words(name)
        text += f"\n## {name}\n\n{description}\n\n    {command}\n"
        if shown := picture(name):
            text += f"\n![{name}]({shown})\n"
    return text


def draw(binary, name):
    import cv2
    import numpy as np
    sensor, seconds, middle = DRAWN[name]
    with tempfile.TemporaryDirectory() as directory:
        out = pathlib.Path(directory)
        text = (SCENARIOS / f"{name}.yaml").read_text()
        if seconds:
            text = re.sub(r"duration_s: [0-9]+", f"duration_s: {seconds}", text, count=1)
        if name != "dataset":
            text = re.sub(r"^output: .*$", "output: {png: on}", text, flags=re.M)
        scenario = SCENARIOS / f".{name}-picture.yaml"  # beside the files that it names
        scenario.write_text(text)
        try:
            command = ["dataset", "--seeds", "1..1"] if name == "dataset" else ["run"]
            subprocess.run([binary, command[0], scenario, *command[1:], "--out", out / "run"], check=True, capture_output=True)
        finally:
            scenario.unlink()
        if name == "dataset":
            subprocess.run(["tar", "-xf", next((out / "run").glob("*.tar")), "-C", out], check=True)
            counts = np.load(next(out.glob("*.image.npy"))).astype(float)
            low, high = np.percentile(counts, (40, 99.95))
            frame = out / "frame.png"
            cv2.imwrite(str(frame), np.clip(255 * (counts - low) / (high - low), 0, 255).astype(np.uint8))
        else:
            sensor = sensor or json.loads((out / "run/frames.jsonl").read_text().splitlines()[0])["sensor"]
            frame = sorted((out / "run" / sensor).glob("frame-*[0-9].png"))[-1]
        image = cv2.imread(str(frame))
        if middle:
            y, x = ((image.shape[i] - middle[i]) // 2 for i in (0, 1))
            image = image[y:y + middle[0], x:x + middle[1]]
        if image.shape[1] > WIDTH_PX:
            image = cv2.resize(image, (WIDTH_PX, round(image.shape[0] * WIDTH_PX / image.shape[1])), interpolation=cv2.INTER_AREA)
        cv2.imwrite(str(GALLERY / f"scenario-{name}.png"), image, [cv2.IMWRITE_PNG_COMPRESSION, 9])


def main():
    for binary in sys.argv[1:]:
        for name in DRAWN:
            draw(pathlib.Path(binary).resolve(), name)
    PAGE.write_text(page())


if __name__ == "__main__":
    main()
