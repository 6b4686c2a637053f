"""The page of a run, in Debian's Chromium and without a network: no error of its script, directions beside astropy's,
keyboard, axe-core; names that would be markup; runs that were killed, and directories that hold none.

    report.py DMISE NODE NODE_PACKAGES
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import warnings

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/system"))
from harness import CAMERA, check, main  # noqa: E402

NODE, PACKAGES = sys.argv[2], pathlib.Path(sys.argv[3])
WITH_BROWSER = (shutil.which(NODE) and pathlib.Path("/usr/bin/chromium").exists() and
                (PACKAGES / "node_modules/playwright-core").exists() and (PACKAGES / "node_modules/axe-core").exists())
try:
    import numpy as np
    from astropy.io import fits
    from astropy.wcs import WCS
except ImportError as missing:
    print(f"skipped: {missing} (./dmise setup --tests)")
    sys.exit(77)

# A narrow field and a fisheye, whose directions near the horizon are refracted.
SCENARIO = """\
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 50, tick_s: 5, seed: 1}
objects: [{catalogue: demo, only: [GOES 13, GOES 14, GOES 15, GOES 16], radius_m: 5}]
stars: {catalogue: kstars}
sensors:
  - {name: narrow, site: savannah, camera: small.yaml, pointing: {azimuth_deg: 168.7, elevation_deg: 52}, exposure_s: 20, cadence_s: 25}
  - {name: fisheye, site: savannah, camera: fisheye.yaml, pointing: zenith, exposure_s: 0.2, cadence_s: 50}
output: {png: true}
"""
FISHEYE = """\
name: fisheye
optics: {projection: equidistant, columns: 400, rows: 400, pixel_pitch_m: 60e-6, field_of_view_deg: 180, aperture_m: 0.01}
detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
"""
HOSTILE = "</script><script>window.injected=1</script><img src=x onerror='window.injected=1'>"


def report(binary, run):
    done = subprocess.run([binary, "report", run], capture_output=True, text=True, timeout=120, check=False)
    return done.returncode, done.stderr.strip()


def data_of(page):
    return json.loads(page.read_text().split('<script type="application/json" id="run">')[1].split("</script>")[0])


def open_page(page, **wanted):
    """What page.mjs says of a page; a folder in DMISE_SCREENSHOTS gets pictures."""
    shots = [os.environ["DMISE_SCREENSHOTS"]] if "DMISE_SCREENSHOTS" in os.environ else []
    done = subprocess.run([NODE, ROOT / "tests/report/page.mjs", PACKAGES, page, *shots], input=json.dumps(wanted), text=True,
                          capture_output=True, timeout=280, check=False)
    check(done.returncode == 0, f"the browser opens {page.name} {done.stderr[-2000:]}")
    return json.loads(done.stdout)


def apart_px(world, place, ra_deg, dec_deg):
    """Distance of a direction from astropy's of the same pixel, in pixels there."""
    def unit(ra, dec):
        ra, dec = np.radians([ra, dec])
        return np.array([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])
    here, right, down = (unit(*world.all_pix2world([[place[0] + dx, place[1] + dy]], 0)[0])
                         for dx, dy in ((0, 0), (0.5, 0), (0, 0.5)))
    pixel = 2 * min(np.linalg.norm(right - here), np.linalg.norm(down - here))
    return np.linalg.norm(unit(ra_deg, dec_deg) - here) / pixel


def contents(run, data):
    check((run / "index.html").stat().st_size < 10e6, "the page is smaller than 10 MB")
    check([s["name"] for s in data["sensors"]] == ["narrow", "fisheye"] and data["status"] == "complete", "it tells the run")
    for k, sensor in enumerate(("narrow", "fisheye")):
        frames = [f for f in data["frames"] if f["sensor"] == k]
        lines = [json.loads(line) for line in (run / sensor / "frames.jsonl").read_text().splitlines()]
        check([f["number"] for f in frames] == [line["frame"] for line in lines], f"{len(frames)} frames of {sensor}")
        check(all((run / f[key]).exists() for f in frames for key in ("fits", "picture", "marked")), "whose files are there")
    check(all((run / name).exists() for name in data["files"]), "and so are the files that it links")
    truths = [json.loads(line) for line in (run / "truth.jsonl").read_text().splitlines()]
    check(len(data["truths"]) == sum(t["in_frame"] for t in truths) > 0, f"{len(data['truths'])} objects with light")
    count = len((run / "detections.jsonl").read_text().splitlines())
    check(len(data["detections"]) == count > 0, f"all {count} detections")
    costs = [json.loads(line) for line in (run / "narrow/cost.jsonl").read_text().splitlines()]
    detection = next(p for p in data["plan"] if p["sensor"] == 0 and p["effect"] == "detection")
    mean = sum(c["detection_s"] for c in costs) / len(costs)
    check(abs(detection["measured_s"] - mean) < 1e-5, "measured costs are the means of cost.jsonl")
    check(any(p["predicted_s"] for p in data["plan"]), "and predicted ones are there")


def in_browser(run, data):
    for frame, f in enumerate(data["frames"]):
        if f["number"] != 1:
            continue
        sensor, view = data["sensors"][f["sensor"]]["name"], data["views"][f["view"]]
        with warnings.catch_warnings(), fits.open(run / f["fits"]) as file:
            warnings.simplefilter("ignore")
            world = WCS(file[0].header, file)
            counts = file[0].data.astype(float)
        # A bright star of the catalogue well above the horizon, where astropy has it; and places all over the frame.
        middle = (view["columns"] / 2, view["rows"] / 2)
        star = next(s for s in view["stars"] if np.hypot(s[1] - middle[0], s[2] - middle[1]) < 0.6 * min(middle))
        x, y = world.all_world2pix([[star[3], star[4]]], 0)[0]
        check(np.hypot(star[1] - x, star[2] - y) < 0.1, f"{sensor}: a bright star is marked where astropy has it")
        row, column = int(round(y)), int(round(x))
        around = counts[max(0, row - 10):row + 11, max(0, column - 10):column + 11]
        noise = 1.48 * np.median(abs(around - np.median(around)))
        peak = counts[max(0, row - 2):row + 3, max(0, column - 2):column + 3].max()
        check(sensor == "fisheye" or peak > np.median(around) + 8 * noise, f"{sensor}: and there the frame is bright")
        random = np.random.default_rng(3)
        places = [(x, y)] + [tuple(p) for p in random.uniform((0, 0), (view["columns"] - 1, view["rows"] - 1), (40, 2))]
        seen = open_page(run / "index.html", frame=frame, places=places, axe=True)
        check(not seen["errors"] and not seen["requests"], f"{sensor}: no error and no request {seen['errors']} {seen['requests']}")
        star_seen = seen["hover"][0]
        check(apart_px(world, (x, y), float(star_seen["ra"]), float(star_seen["dec"])) < 1,
              f"{sensor}: hovering over the star gives its direction to 1 px")
        check(f"star {star[0]}" in star_seen["text"], f"{sensor}: and its name")
        errors = [apart_px(world, (float(h["x"]), float(h["y"])), float(h["ra"]), float(h["dec"]))
                  for h in seen["hover"] if h.get("ra")]
        check(len(errors) > 20 and max(errors) < 0.2,
              f"{sensor}: {len(errors)} directions are astropy's to {max(errors):.3f} px")
        for h in seen["hover"]:
            if view["bin"] == 1:
                value = counts[int(np.floor(float(h["y"]) + 0.5)), int(np.floor(float(h["x"]) + 0.5))]
                if abs(float(h["value"]) - value) > view["step_dn"] / 2 + 1e-3:
                    check(False, f"{sensor}: the pixel's value is {h['value']}, in the file {value}")
        check(not seen["violations"], f"{sensor}: axe-core finds nothing, dark and light {seen['violations']}")
        check(seen["cross"]["x"] == str(round(view["columns"] / 2)) and 1.4 < seen["zoomed"] < 1.6, "the keyboard moves the cross and zooms")
        check(len({round(s, 1) for s in seen["stretches"]}) == 3, f"three stretches differ: {seen['stretches']}")
        check(seen["closed"] and seen["focus"] == str(frame), "escape closes the frame and goes back to its thumbnail")
        check({"Summary", "Frames", "Pointings and passes", "Detection", "Plan of effects", "Files"} <= set(seen["sections"]),
              f"sections {seen['sections']}")


def seconds_of(text):
    """Seconds that a page shows, and what rounding to the digits shown may hide."""
    number, unit = text.split()
    scale = 1e-3 if unit == "ms" else 1.0
    return float(number) * scale, 0.51 * 10.0 ** -len(number.partition(".")[2]) * scale


def costs_are_compared_alike(data, text):
    """Measured seconds beside predicted ones are those of the effects that have a prediction: without detection and files."""
    for k, sensor in enumerate(data["sensors"]):
        rows = [p for p in data["plan"] if p["sensor"] == k]
        told = re.search(rf"{sensor['name']}: (\S+ m?s) a frame; effects with a prediction take (\S+ m?s) of it, predicted (\S+ m?s)", text)
        check(told, f"{sensor['name']}: measured and predicted costs stand together")
        (whole, _), (measured, measured_error), (predicted, predicted_error) = map(seconds_of, told.groups())
        of = [p for p in rows if p["predicted_s"] is not None]
        check("detection" not in {p["effect"] for p in of} and abs(measured - sum(p["measured_s"] for p in of)) < measured_error
              and abs(predicted - sum(p["predicted_s"] for p in of)) < predicted_error and measured < whole,
              f"{sensor['name']}: {told.group(0)}")


def fits_screens(run):
    """Desks and phones: nothing is cut or must be scrolled sideways, frames are drawn unseen, axes can be read."""
    seen = open_page(run / "index.html", widths=[1280, 1180, 390])
    costs_are_compared_alike(data_of(run / "index.html"), seen["text"])
    check(not seen["errors"], f"no error on any screen {seen['errors']}")
    for screen in seen["widths"]:
        of = f"{screen['width']} px: "
        check(screen["page"] <= screen["width"] and not screen["tables"] and not screen["cut"],
              f"{of}all fits, {screen['page']} px wide {screen['tables']} {screen['cut']}")
        check(screen["labels"] and min(screen["labels"]) >= 3, f"{of}axes have three labels or more {screen['labels']}")
        check(screen["astray"] == 0, f"{of}{screen['astray']} intervals are not at their dots")


def hostile_names(binary, run, directory):
    """Names in the products that would be markup or script."""
    copy = directory / "hostile"
    shutil.copytree(run, copy)
    name = HOSTILE.replace("/", "\\")  # no name of a directory has a slash
    for path in [copy / "run.json", *copy.rglob("*.jsonl")]:
        path.write_text(path.read_text().replace('"narrow', json.dumps(name)[:-1]))
    (copy / "narrow").rename(copy / name)
    truth = copy / name / "truth.jsonl"
    rows = [json.loads(line) for line in truth.read_text().splitlines()]
    for row in rows:
        row["name"] = HOSTILE + row["name"]
    truth.write_text("".join(json.dumps(row) + "\n" for row in rows))
    code, said = report(binary, copy)
    check(code == 0, f"a run with hostile names has a page {said}")
    page = (copy / "index.html").read_text()
    check(page.count("<script") == 2 and "<img" not in page.split("</script>")[0], "no name is markup in it")
    if WITH_BROWSER:
        seen = open_page(copy / "index.html")
        check(not seen["injected"] and not seen["errors"] and seen["images"] == 0, f"and none runs {seen['errors']}")
        check(name in seen["text"], "they are shown as they are")


def killed(binary, run, directory):
    """As kill -9 leaves it: run.json as it began, nothing merged, a last line without its end."""
    copy = directory / "killed"
    shutil.copytree(run, copy)
    digest = json.loads((run / "run.json").read_text())["digest"]
    (copy / "run.json").write_text(json.dumps({"status": "begun", "digest": digest}))
    for name in ("index.html", "frames.jsonl", "detections.jsonl", "truth.jsonl"):
        (copy / name).unlink()
    lines = (copy / "narrow/frames.jsonl").read_text()
    (copy / "narrow/frames.jsonl").write_text(lines[:-20])
    code, said = report(binary, copy)
    check(code == 0, f"a run that was killed has a page {said}")
    data = data_of(copy / "index.html")
    check(data["status"] == "begun" and len(data["frames"]) == len(lines.splitlines()) - 1 +
          len((run / "fisheye/frames.jsonl").read_text().splitlines()), "with the frames that are whole")
    if WITH_BROWSER:
        seen = open_page(copy / "index.html")
        check(not seen["errors"] and "has not ended" in seen["text"], f"and it says so {seen['errors']}")


def refused(binary, run, directory):
    (directory / "empty").mkdir()
    for path in (directory / "empty", directory / "nowhere"):
        code, said = report(binary, path)
        check(code == 2 and "\n" not in said and str(path) in said, said)
    copy = directory / "broken"
    shutil.copytree(run, copy)
    with (copy / "narrow/truth.jsonl").open("a") as file:
        file.write('{"sensor":"narrow","frame":"one"}\n')
    code, said = report(binary, copy)
    check(code == 2 and "narrow/truth.jsonl:" in said and "frame" in said and "\n" not in said, said)


def test(binary, directory):
    (directory / "small.yaml").write_text(CAMERA)
    (directory / "fisheye.yaml").write_text(FISHEYE)
    (directory / "scenario.yaml").write_text(SCENARIO)
    run = directory / "run"
    done = subprocess.run([binary, "run", directory / "scenario.yaml", "--out", run], capture_output=True, text=True, timeout=200,
                          check=False)
    check(done.returncode == 0, f"the run ends {done.stderr}")
    page = (run / "index.html").read_bytes()
    code, said = report(binary, run)
    check(code == 0 and (run / "index.html").read_bytes() == page, f"`dmise report` writes the page that the run ended with {said}")
    data = data_of(run / "index.html")
    contents(run, data)
    refused(binary, run, directory)
    if WITH_BROWSER:
        in_browser(run, data)
        fits_screens(run)
    hostile_names(binary, run, directory)
    killed(binary, run, directory)
    if not WITH_BROWSER:
        print("skipped in part: no Chromium, Node or its packages (./dmise setup --tests)")
        sys.exit(77)


if __name__ == "__main__":
    main(test)
