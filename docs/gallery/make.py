#!/usr/bin/env python3
"""Makes the pictures of docs/gallery: all of them, or those that are named.

    make.py [--dmise DMISE] [--run RUN] [--out DIRECTORY] [PICTURE ..]
    make.py --list                the pictures, and what each is made by

RUN is a run of the demonstration to show, instead of a new one. Needs the programs and packages of `./dmise setup --tests`;
of a browser's pictures Chromium and the packages in build/node.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
DEMO = ROOT / "launch/scenarios/demo.yaml"


class Gallery:
    def __init__(self, dmise, out, run, work):
        self.dmise, self.out, self.demo_run, self.work = dmise, out, run, work

    def call(self, *command):
        done = subprocess.run([str(c) for c in command], cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{command[0]}: {(done.stderr.strip() or 'no reason given').splitlines()[-1]}")
        return done.stdout

    def python(self, script, *arguments):
        self.call(sys.executable, script, *arguments)

    def demo(self):
        if not self.demo_run:
            self.demo_run = self.work / "demo"
            self.call(self.dmise, "run", DEMO, "--out", self.demo_run)
        return self.demo_run

    def in_place(self, picture, script, *arguments):
        """Runs a script that writes into docs/gallery alone."""
        self.python(script, *arguments)
        if self.out != HERE:
            shutil.copy(HERE / picture, self.out / picture)

    def shrunk(self, frame, picture, wide_px):
        import cv2
        image = cv2.imread(str(frame))
        if image.shape[1] > wide_px:
            image = cv2.resize(image, (wide_px, round(image.shape[0] * wide_px / image.shape[1])), interpolation=cv2.INTER_AREA)
        cv2.imwrite(str(self.out / picture), image, [cv2.IMWRITE_PNG_COMPRESSION, 9])


def report(g, picture):
    self_made = g.demo()
    g.call(g.dmise, "report", self_made)
    g.call("node", HERE / "report.mjs", ROOT / "build/node", self_made / "index.html", g.out / picture)


def psf(g, picture):
    g.call(g.dmise, "run", HERE / "psf.yaml", "--out", g.work / "psf", "--force")
    g.python(HERE / "psf.py", g.work / "psf", g.out / picture)


def drawn(g, picture):  # objects with a shape, and the light of one that turns
    folder = g.work / "drawn"
    folder.mkdir(exist_ok=True)
    g.call(ROOT / "build/release/bin/draw-gallery", folder)
    if picture == "light-curve.png":
        g.in_place(picture, HERE / "plot.py", folder)
    else:
        shutil.copy(folder / picture, g.out / picture)


def first_frame(g, picture):
    name = picture.removesuffix(".png")
    run = g.demo() if name == "demo" else g.work / name
    if name != "demo":
        g.call(g.dmise, "run", ROOT / f"launch/scenarios/{name}.yaml", "--out", run, "--force")
    sensor = "atlanta" if name == "demo" else sorted(f.parent.name for f in run.glob("*/frame-000001.png"))[0]
    marked = run / sensor / "frame-000001-marked.png"
    g.shrunk(marked if marked.exists() else run / sensor / "frame-000001.png", picture, 720)


def survey(g, picture):
    g.call(g.dmise, "survey", ROOT / "launch/scenarios/survey.yaml", "--out", g.work / "survey")
    shutil.copy(g.work / "survey/map.svg", g.out / picture)


def figure5(g, picture):
    g.call(g.dmise, "visible", ROOT / "launch/scenarios/figure5.yaml", "--out", g.work / "figure5", "--rows", 1, "--sunlit")
    shutil.copy(g.work / "figure5/atlanta/figure.svg", g.out / picture)


def live_view(g, picture):
    wide, high = (960, 600) if picture == "live-view.png" else (480, 449)
    objects, sensors = (979, 4) if picture == "live-view.png" else (20000, 100)
    g.call("node", ROOT / "tests/system/view/pictures.mjs", ROOT / "build/node/node_modules", "/usr/bin/chromium",
           ROOT / "build/dashboard", objects, sensors, 5, wide, high, g.out / picture)


def by(script, *arguments):
    def make(g, picture):
        g.in_place(picture, ROOT / script, *(g.dmise if a == "DMISE" else a for a in arguments))
    make.__doc__ = script
    return make


PICTURES = {
    "accuracy-all-sky.svg": by("bench/accuracy.py"), "accuracy-resolved.svg": by("bench/accuracy.py"),
    "accuracy-space.svg": by("bench/accuracy.py"), "scaling.png": by("bench/scaling.py"),
    "detector.png": by("docs/gallery/detector.py", "DMISE"), "evaluators.png": by("docs/gallery/evaluators.py", "DMISE"),
    "sky.png": by("docs/gallery/sky.py", "DMISE"), "psf.png": psf,
    "box-wing.png": drawn, "starlink-like.png": drawn, "light-curve.png": drawn, "inspector.png": drawn,
    "demo.png": first_frame, "figure5.svg": figure5, "survey.svg": survey,
    "report.png": report, "report-frame.jpg": report, "live-view.png": live_view, "live-view-objects.png": live_view,
    **{f"scenario-{name}.png": by("docs/gallery/scenarios.py", "DMISE") for name in ("breakup", "close-up", "cooperate", "dataset", "proximity", "three-sites")},
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pictures", nargs="*", metavar="PICTURE")
    parser.add_argument("--dmise", type=pathlib.Path, default=ROOT / "build/release/bin/dmise")
    parser.add_argument("--run", type=pathlib.Path, help="a run of the demonstration")
    parser.add_argument("--out", type=pathlib.Path, default=HERE)
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    if options.list:
        for picture, make in sorted(PICTURES.items()):
            print(picture, make.__doc__ or "docs/gallery/make.py")
        return
    if unknown := [p for p in options.pictures if p not in PICTURES]:
        sys.exit(f"no picture called {', '.join(unknown)}; there are {', '.join(sorted(PICTURES))}")
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="dmise-gallery-") as work:
        gallery = Gallery(options.dmise.resolve(), options.out.resolve(), options.run and options.run.resolve(), pathlib.Path(work))
        for picture in options.pictures or PICTURES:
            PICTURES[picture](gallery, picture)
            print(options.out / picture)


if __name__ == "__main__":
    main()
