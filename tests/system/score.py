"""`dmise score` of a small run: counts that add up, figures that this program computes again from the run's lines, the same
bytes twice and for lines in another order, the same score of the run's frames with truth as a table, and refusals.

    score.py DMISE
"""

import csv
import json
import math
import random
import shutil
import subprocess

from harness import check, main

SCENARIO = """simulation: {start: 2018-01-21T00:15:00Z, duration_s: 90, tick_s: 5, seed: 1}
objects: [{catalogue: demo}]
stars: {catalogue: kstars}
sensors:
  - {name: metop, platform: "29499", camera: wide-field-cmos, pointing: {ra_deg: 85.2, dec_deg: 0.7}, exposure_s: 2, cadence_s: 15, sky: space}
output: {png: false}
"""


def lines(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def test(binary, directory):
    def score(*arguments, expect=0):
        done = subprocess.run([binary, "score", *map(str, arguments)], capture_output=True, text=True, check=False)
        check(done.returncode == expect, f"score exits with {expect}: {done.stderr[-300:]}")
        if expect:
            check(done.stderr.count("\n") == 1, f"refused in one line: {done.stderr.strip()}")
        return done.stdout

    (directory / "small.yaml").write_text(SCENARIO)
    run = directory / "run"
    subprocess.run([binary, "run", directory / "small.yaml", "--out", run], check=True, capture_output=True)
    truths, detections, frames = (lines(run / f"{name}.jsonl") for name in ("truth", "detections", "frames"))

    text = score(run, "--json", "--csv", directory / "score.csv", "--plots", directory / "plots")
    result = json.loads(text)
    total = result["total"]
    with open(directory / "score.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    fates = [row["fate"] for row in rows]
    check(total["truths"] == len(truths) and total["detections"] == len(detections), "every line is counted")
    check(sum(total[f] for f in ("found", "missed", "faint", "dark", "outside", "unscored")) == len(truths),
          "each truth has one fate")
    check(total["found"] + total["further_pieces"] + total["false_alarms"] == len(detections), "so has each detection")
    check(all(fates.count(name) == total[name] for name in ("found", "missed", "faint", "dark", "outside")) and
          fates.count("false") == total["false_alarms"] and len(rows) == len(truths) + fates.count("false"),
          "the CSV has the same counts")
    check(total["found"] > 20, f"{total['found']} are found")
    check(sum(t["rendered_px"] is None for t in truths) == total["dark"] + total["outside"], "no light, no miss")
    camera = json.loads((run / "run.json").read_text())["scenario"]["sensors"][0]["camera"]
    check(abs(total["megapixels"] - 1e-6 * camera["columns"] * camera["rows"] * len(frames)) < 1e-9, "pixels are counted")

    # Again, by the nearest centroid: this sky is not crowded.
    measured = {"along": [], "across": [], "flux": [], "nees": []}
    for truth in truths:
        if not truth["rendered_px"] or not truth["whole"] or truth["sunlit"] < 1:
            continue
        x, y = truth["rendered_px"]
        near = [d for d in detections if d["frame"] == truth["frame"] and math.hypot(d["x_px"] - x, d["y_px"] - y) < 5]
        if not near or near[0]["saturated"] or near[0]["at_edge"]:
            continue
        found = near[0]
        dx, dy = found["x_px"] - x, found["y_px"] - y
        (x0, y0), (x1, y1) = truth["start_px"], truth["end_px"]
        length = math.hypot(x1 - x0, y1 - y0)
        c, s = (x1 - x0) / length, (y1 - y0) / length
        measured["along"].append(dx * c + dy * s)
        measured["across"].append(dy * c - dx * s)
        measured["flux"].append(-2.5 * math.log10(found["signal_e"] / truth["rendered_signal_e"]))
        xx, xy, yy = found["covariance_px2"]
        measured["nees"].append((dx * dx * yy - 2 * dx * dy * xy + dy * dy * xx) / (xx * yy - xy * xy) / 2)
    streaks = total["errors"]["streaks"]
    check(streaks["along_px"]["count"] == len(measured["along"]), "the same detections are clean")
    for key, name, value in (("along_px", "rms", rms(measured["along"])), ("across_px", "rms", rms(measured["across"])),
                             ("flux", "rms", rms(measured["flux"])),
                             ("nees_px", "mean", sum(measured["nees"]) / len(measured["nees"]))):
        check(abs(streaks[key][name] - value) < 0.01 * abs(value), f"{key} is {value:.6g}, {streaks[key][name]:.6g}")

    plots = [(directory / "plots" / name).read_text() for name in ("detection.svg", "position.svg", "magnitude.svg")]
    check(all(plot.startswith("<svg") for plot in plots), "three plots")
    check("expected SNR" in score(run), "a table to read")
    check(score(run, "--json", "--csv", directory / "again.csv") == text and
          (directory / "again.csv").read_bytes() == (directory / "score.csv").read_bytes(), "a second call gives the same bytes")
    shuffled = directory / "shuffled"
    shutil.copytree(run, shuffled)
    for name in ("truth", "detections", "frames"):
        path = shuffled / f"{name}.jsonl"
        mixed = path.read_text().splitlines(keepends=True)
        random.Random(1).shuffle(mixed)
        path.write_text("".join(mixed))
    check(score(shuffled, "--json") == text, "so do lines in another order")

    table = directory / "truth.csv"
    with open(table, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow("file id x_px y_px end1_x_px end1_y_px end2_x_px end2_y_px signal_e ra_deg dec_deg".split())
        for truth in truths:
            if truth["rendered_px"]:
                out.writerow([f"frame-{truth['frame']:06d}.fits", truth["name"], *truth["rendered_px"], *truth["start_px"],
                              *truth["end_px"], truth["rendered_signal_e"], truth["true_ra_deg"], truth["true_dec_deg"]])
    foreign = json.loads(score("--frames", run / "metop", "--truth", table, "--json"))["total"]
    for key in ("found", "missed", "faint", "false_alarms", "detections"):
        check(foreign[key] == total[key], f"the frames alone have as many {key}")
    for key in ("across_px", "across_arcsec", "nees_px", "flux"):
        a, b = (f["errors_of_all"]["streaks"][key]["rms"] for f in (foreign, total))
        check(abs(a - b) < 0.05 * b, f"{key} of the frames alone is {a:.4g}, {b:.4g}")

    with open(table, "a", encoding="utf-8") as file:
        file.write("frame-000001.fits,bad,abc,5,,,,,,,\n")
    score("--frames", run / "metop", "--truth", table, expect=2)
    score(expect=2)
    score(directory, expect=2)
    (shuffled / "run.json").unlink()  # killed
    score(shuffled, expect=2)
    (run / "truth.jsonl").unlink()
    score(run, expect=2)


main(test)
