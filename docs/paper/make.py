#!/usr/bin/python3
"""Writes docs/paper.md: the results of the DMISE-GHOST paper (AMOS 2021), Figures 5 to 10 and Tables 1 to 3, beside ours.

    ./dmise paper [--dmise PROGRAM] [--out out/paper] [--only figure8 ...]

Runs launch/scenarios/paper/*.yaml. What a step found is kept in OUT/STEP.json under the digest of the program and of the
step's files: an interrupted call goes on, a repeated one takes seconds. Pictures go to docs/paper. $DMISE_DATA, else
../shared/data, has the catalogue of 2019-12-19; without it Debian's is taken.
"""

import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np
import yaml
from astropy.io import fits

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))
import page  # noqa: E402
from drawing import binned, side_by_side, stretched, svg_chart, svg_map, write_png  # noqa: E402

SCENARIOS = ROOT / "launch/scenarios/paper"
CATALOGUE = pathlib.Path(os.environ.get("DMISE_DATA", ROOT / "../shared/data")) / "tle/catalog_3le_2019-12-19_18470.txt.gz"


class Maker:
    def __init__(self, program, out, pictures=HERE):
        self.pictures = pathlib.Path(pictures)
        self.program, self.out = pathlib.Path(program).resolve(), pathlib.Path(out).resolve()
        self.out.mkdir(parents=True, exist_ok=True)
        self.digest = hashlib.sha256(self.program.read_bytes()).hexdigest()

    def call(self, *arguments):
        done = subprocess.run([self.program, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            raise SystemExit(f"dmise {' '.join(map(str, arguments))}: {done.stderr.strip().splitlines()[-1:]}")
        return done.stdout

    def referee(self, script, *arguments):
        """What a program of tests/reference prints."""
        done = subprocess.run(["/usr/bin/python3", ROOT / "tests/reference" / script, self.program, *map(str, arguments)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            raise SystemExit(f"{script}: {(done.stderr or done.stdout).strip()}")
        return done.stdout

    def run(self, name, scenario=None):
        """Frames and truth of a scenario of the paper."""
        self.call("run", scenario or SCENARIOS / f"{name}.yaml", "--out", self.out / name, "--force")
        return [json.loads(line) for line in (self.out / name / "truth.jsonl").read_text().splitlines()]

    def image(self, name, sensor, frame=1):
        """Electrons above the bias."""
        with fits.open(self.out / name / sensor / f"frame-{frame:06}.fits") as file:
            hdu = next(h for h in file if h.data is not None)
            return (hdu.data.astype(float) - hdu.header["BIASLVL"]) * hdu.header["GAIN"]


def figure5(make):
    scenario = yaml.load((ROOT / "launch/scenarios/figure5.yaml").read_text(), yaml.BaseLoader)
    real = CATALOGUE.exists()
    if real:
        scenario["objects"] = [{"catalogue": str(CATALOGUE)}]
        scenario["simulation"]["start"] = "2019-12-19T00:00:00Z"
    path = make.out / "figure5.yaml"
    path.write_text(json.dumps(scenario))
    text = make.call("visible", path, "--out", make.out / "figure5", "--rows", 1, "--threads", 2, "--sunlit")
    counts = json.loads(make.referee("figure5_counts.py", "--json", "--counts", make.out / "figure5/atlanta/counts.csv"))
    passes = [json.loads(line) for line in (make.out / "figure5/atlanta/passes.jsonl").read_text().splitlines()]
    low = sum(one.get("orbit") == "LEO" for one in passes)
    return {"catalogue": "18,470 objects of 2019-12-19" if real else "Debian's of 2018-01-20",
            "passes": len(passes), "objects": len({one["catalogue_number"] for one in passes}),
            "low_share": low / max(1, len(passes)), "line": [t for t in text.splitlines() if "passes of" in t][:1],
            "counts": counts["rows"]}


def figure6(make):
    truth = make.run("figure6")[0]
    image = make.image("figure6", "omnissa")
    start, end = np.array(truth["start_px"]), np.array(truth["end_px"])
    x, y = np.round((start + end) / 2).astype(int)
    crop = image[max(0, y - 180) : y + 180, max(0, x - 350) : x + 350]
    write_png(make.pictures / "figure6.png", stretched(crop, 0, np.percentile(crop, 99.8), 0.02))
    return {"magnitude": truth["true_magnitude"], "length_px": float(np.hypot(*(end - start))),
            "range_km": truth["true_range_m"] / 1e3, "elevation_deg": truth["true_elevation_deg"],
            "signal_e": truth["rendered_signal_e"]}


LAMPS = {"lps": "low-pressure sodium", "hps": "high-pressure sodium", "led": "LED 4000 K"}


def figure7(make):
    """Contrast as rendered, and what exposure, lamps and sky would give the paper's."""
    bands = json.loads(make.referee("streak_contrast.py", "--json"))
    # Excess of the ridge [e-]: the same for every exposure longer than the streak stays on a pixel.
    excess = {b: (row["2 s"] - 1) * row["sky_e_per_s"] * 2 for b, row in bands.items()}
    magnitudes = [16.0, 16.5, 17.0, 17.5, 18.0, 18.5, 19.0]
    filters = {"B": "bessell-B", "G": "bessell-V", "R": "bessell-R"}
    sensors = []
    for magnitude in magnitudes:
        for lamp in LAMPS:
            for band, name in filters.items():
                (make.out / f"figure7-{band}.yaml").write_text(json.dumps({
                    "name": f"omnissa-{band}",
                    "optics": {"projection": "gnomonic", "columns": 64, "rows": 48, "pixel_pitch_m": 5.4e-6,
                               "focal_length_m": 0.0089802, "aperture_m": 0.0375, "transmission": 0.80, "psf_fwhm_px": 1.5,
                               "equivalent_aperture": True},
                    "detector": {"quantum_efficiency": 0.54, "full_well_e": 1e9, "gain_e_per_dn": 8, "bias_dn": 0, "adc_bits": 16},
                    "band": {"filter": name}}))
                sensors.append({"name": f"{lamp}-{band}-{round(10 * magnitude)}", "site": "atlanta", "camera": f"figure7-{band}.yaml",
                                "pointing": "zenith", "exposure_s": 1, "cadence_s": 10,
                                "sky": {"preset": "urban", "zenith_mag_per_arcsec2": magnitude,
                                        "lamps": {name: int(name == lamp) for name in LAMPS}}})
    scenario = {"simulation": {"start": "2019-12-15T05:20:20Z", "duration_s": 10, "tick_s": 2, "seed": 1},
                "effects": {"photon_noise": "off", "dark_current": "off", "read_noise": "off"}, "detection": "off",
                "sensors": sensors}
    path = make.out / "figure7.yaml"
    path.write_text(json.dumps(scenario))
    rates = {s["name"]: s["frames"][0]["background_e"] for s in json.loads(make.call("check", path, "--json"))["sensors"]}
    wanted = {"B": 2.03, "G": 1.12}
    solutions, ratios = [], {name: [] for name in LAMPS.values()}
    for magnitude in magnitudes:
        for lamp, name in LAMPS.items():
            sky = {b: rates[f"{lamp}-{b}-{round(10 * magnitude)}"] for b in filters}
            ratios[name].append((excess["B"] / sky["B"]) / (excess["G"] / sky["G"]))
        for k in range(11):
            for j in range(11 - k):
                shares = {"lps": k / 10, "hps": j / 10, "led": (10 - k - j) / 10}
                sky = {b: sum(s * rates[f"{lamp}-{b}-{round(10 * magnitude)}"] for lamp, s in shares.items()) for b in filters}
                seconds = {b: excess[b] / sky[b] / (wanted[b] - 1) for b in wanted}
                middle = float(np.sqrt(seconds["B"] * seconds["G"]))
                got = {b: 1 + excess[b] / sky[b] / middle for b in filters}
                solutions.append({"magnitude": magnitude, **shares, "exposure_s": middle, **got,
                                  "miss": float(abs(np.log(seconds["B"] / seconds["G"])))})
    solutions.sort(key=lambda s: s["miss"])
    (make.pictures / "figure7.svg").write_text(svg_chart({name: (magnitudes, values) for name, values in ratios.items()},
                                                "zenith sky, V mag/arcsec2", "(B - 1) / (G - 1)",
                                                marks=[(18.0, 1.03 / 0.12, "the paper's 8.6")]))
    shares = [k / 10 for k in range(11)]
    surface = [[float(np.exp(min(s["miss"] for s in solutions if s["magnitude"] == m and abs(s["lps"] - share) < 1e-9)))
                for share in shares] for m in magnitudes]
    (make.pictures / "figure7-surface.svg").write_text(svg_map(shares, magnitudes, surface, "share of low-pressure sodium",
                                                               "zenith sky, V mag/arcsec2"))
    ordered = [s for s in solutions if s["B"] > s["R"] > s["G"]]
    return {"bands": bands, "excess_e": excess, "best": solutions[:6], "tried": len(solutions), "ordered": ordered[:2],
            "at_18": [s for s in solutions if s["magnitude"] == 18.0][:1],
            "within_20_percent": int(sum(s["miss"] < np.log(1.2) for s in solutions))}


def figure8(make):
    truths = {t["sensor"]: t for t in make.run("figure8")}
    pictures = []
    for sensor in ("radiance", "short", "long"):
        image = make.image("figure8", sensor)
        crop = image[156:356, 156:356]
        crop = np.kron(crop, np.ones((2, 2)))
        pictures.append(stretched(crop, np.percentile(crop, 5), np.percentile(crop, 99.9), 0.1))
    write_png(make.pictures / "figure8.png", side_by_side(pictures))
    make.run("speckle")
    frames = np.array([centred(make.image("speckle", "speckle", k)) for k in range(1, 41)])
    mean = frames.mean(axis=0)
    y, x = np.indices(mean.shape)
    core = np.hypot(x - 255.5, y - 255.5) < 15

    def contrast(stack):
        return float(np.sqrt(stack.var(axis=0, ddof=1)[core].sum() / (mean[core] ** 2).sum()))

    rows = {str(n): contrast(frames.reshape(40 // n, n, *mean.shape).mean(axis=1)) for n in (1, 2, 4, 8)}
    return {"contrast": rows, "theory": pixel_contrast(), "range_km": truths["short"]["true_range_m"] / 1e3,
            "magnitude": truths["short"]["true_magnitude"], "frames": len(frames)}


def centred(image):
    """With the centroid in the middle: what is left is speckle, without the motion of the whole image."""
    y, x = np.indices(image.shape)
    shift = [round(255.5 - float((image * axis).sum() / image.sum())) for axis in (y, x)]
    return np.roll(image, shift, (0, 1))


def pixel_contrast(pixel_per_wave=0.0189 / 206264.806 / (0.55e-6 / 3.0), obscuration=0.3):
    """Contrast of fully developed speckle that a square pixel averages: the root of the mean over pairs of points of
    the pixel of |transform of the pupil|^2 (Goodman, Statistical Optics, section 6.1.2 of the first edition)."""
    n = 256
    grid = (np.arange(n) - n / 2 + 0.5) / (n / 2)
    radius = np.hypot(*np.meshgrid(grid, grid))
    pupil = (radius <= 1) & (radius >= obscuration)
    u, v = (axis[pupil] / 2 for axis in np.meshgrid(grid, grid))  # in diameters
    lags = np.linspace(-1, 1, 41) * pixel_per_wave  # lambda / D
    weights = np.outer(1 - np.abs(np.linspace(-1, 1, 41)), 1 - np.abs(np.linspace(-1, 1, 41)))
    coherence = np.array([[abs(np.exp(2j * np.pi * (a * u + b * v)).mean()) ** 2 for a in lags[::2]] for b in lags[::2]])
    weights = weights[::2, ::2]
    return float(np.sqrt((coherence * weights).sum() / weights.sum()))


def figure9(make):
    library = yaml.safe_load((ROOT / "launch/materials/library.yaml").read_text())["materials"]
    lines = {name: (library[key]["wavelength_um"], library[key]["reflectance"])
             for name, key in (("silicon cell", "silicon-cell"), ("germanium cell", "germanium-cell"), ("mylar", "mylar"))}
    (make.pictures / "figure9.svg").write_text(svg_chart(lines, "wavelength, um", "reflectance", bands=((0.90, 0.95), (1.40, 1.45))))
    return {name: [float(np.interp(w, *line)) for w in (0.95, 1.40)] for name, line in lines.items()}


def figure10(make):
    truths = make.run("space-imager")
    first = [t for t in truths if t["sensor"] == "red" and t["frame"] == 1]
    image = make.image("space-imager", "red")
    places = {t["name"]: t["middle_px"] for t in first if t["in_frame"]}
    x = [p[0] for p in places.values()]
    y = [p[1] for p in places.values()]
    middle = int(np.mean(x)), int(np.mean(y))
    crop = image[middle[1] - 380 : middle[1] + 380, middle[0] - 380 : middle[0] + 380]
    background = np.median(crop)
    write_png(make.pictures / "figure10.png", stretched(binned(crop, 2), background - 15, background + 60, 0.5))
    report = json.loads(make.call("discriminate", make.out / "space-imager", "--materials", SCENARIOS / "cells.yaml",
                                  "--is", "STARLINK-1014=silicon", "--is", "unknown=germanium", "--threads", 2, "--json"))
    forecast = json.loads(make.call("check", SCENARIOS / "space-imager.yaml", "--json"))["sensors"][0]["frames"][0]
    names = {n: p for n, p in places.items()}
    return {"report": report, "limb_angle_deg": forecast.get("limb_angle_deg"), "places_px": names,
            "range_km": {t["name"]: t["true_range_m"] / 1e3 for t in first}, "background_e": float(background)}


def table3(make):
    figures = {}
    for line in subprocess.run([make.program, "bench", "paper", "--json", "--no-night"], stdout=subprocess.PIPE, text=True).stdout.splitlines():
        one = json.loads(line)
        figures[one["name"]] = one
    design = json.loads(make.call("discriminate", "--design", SCENARIOS / "space-imager.yaml", "--materials",
                                  SCENARIOS / "cells.yaml", "--among", "silicon,germanium", "--area-m2", 0.05, "--json"))
    pairs = json.loads(make.call("discriminate", "--design", SCENARIOS / "space-imager.yaml", "--among",
                                 "silicon-cell,germanium-cell", "--area-m2", 0.05, "--json"))
    points = [p for p in design["by_range"] if p["exposure_s"]]
    (make.pictures / "design.svg").write_text(svg_chart(
        {"exposure of each band": ([p["range_m"] / 1e3 for p in points], [p["exposure_s"] for p in points])},
        "distance, km", "exposure, s", logarithmic=(True, True)))
    return {"figures": figures, "design": design, "pairs": pairs["pairs"][:5]}


STEPS = {"figure5": figure5, "figure6": figure6, "figure7": figure7, "figure8": figure8, "figure9": figure9,
         "figure10": figure10, "table3": table3}


def kept(make, name):
    """What a step found, of this call or of an earlier one with the same program and files."""
    digest = hashlib.sha256(make.digest.encode())
    for path in sorted(SCENARIOS.iterdir()) + [pathlib.Path(__file__), ROOT / "launch/materials/library.yaml"]:
        digest.update(path.read_bytes())
    digest, path = digest.hexdigest(), make.out / f"{name}.json"
    if path.exists():
        earlier = json.loads(path.read_text())
        if earlier.get("digest") == digest:
            return earlier["found"]
    found = STEPS[name](make)
    path.write_text(json.dumps({"digest": digest, "found": found}, default=float))
    return found


def show(done, text):
    if sys.stderr.isatty():
        width = 28
        filled = round(width * done / len(STEPS))
        print(f"\r[{'#' * filled}{'.' * (width - filled)}] {text:24}", end="" if done < len(STEPS) else "\n", file=sys.stderr)


def main():
    arguments = argparse.ArgumentParser(description="Writes docs/paper.md: the paper's results beside ours.")
    arguments.add_argument("--dmise", default=ROOT / "build/release/bin/dmise")
    arguments.add_argument("--out", default=ROOT / "out/paper")
    arguments.add_argument("--only", nargs="+", choices=STEPS, help="run these steps and write no page")
    options = arguments.parse_args()
    os.environ.setdefault("DMISE_HOME", str(ROOT))
    make = Maker(options.dmise, options.out)
    found, begun = {}, time.monotonic()
    for k, name in enumerate(options.only or STEPS):
        show(k, name)
        found[name] = kept(make, name)
    show(len(STEPS), f"{time.monotonic() - begun:.0f} s")
    if options.only:
        print(json.dumps(found, indent=1))
    else:
        (ROOT / "docs/paper.md").write_text(page.text(found))


if __name__ == "__main__":
    main()
