"""Two all-sky cameras find what is in no catalogue, and a telescope is cued to it: the same bytes for one process and many,
for nodes that are killed, and for a run that is interrupted and goes on.

    cue.py DMISE
"""

import json
import math
import os
import signal

from harness import Run, check, check_same, main, wait_until

SCENARIO = """\
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 100, tick_s: 5, seed: 1}
objects: [{catalogue: newcomer.tle, radius_m: 4}]
stars: {catalogue: kstars}
fusion: {not_in_catalogue: [NEWCOMER], cue_delay_ticks: 2}
network: {on_silent_node: restart, silent_after_s: 2, real_time: REAL_TIME}
sensors:
  - {name: atlanta, site: atlanta, camera: wide.yaml, pointing: zenith, exposure_s: 1, cadence_s: 10, sky: dark}
  - {name: huntsville, site: huntsville, camera: wide.yaml, pointing: zenith, exposure_s: 1, cadence_s: 10, sky: dark}
  - name: telescope
    site: atlanta
    camera: narrow.yaml
    pointing: {cued: {slew_deg_per_s: 5, slew_deg_per_s2: 3, limiting_magnitude: 12, exposures: 4, least_gain_nats: 0}}
    exposure_s: 0.5
    cadence_s: 2.5
    sky: dark
output: {png: false}
"""
# An all-sky camera of half the usual resolution, and the middle of a telescope's detector.
CAMERAS = {
    "wide.yaml": """\
name: wide
optics: {projection: gnomonic, columns: 1663, rows: 1252, pixel_pitch_m: 10.8e-6, field_of_view_deg: 90, aperture_m: 0.0375,
         transmission: 0.8, psf_fwhm_px: 1.5, equivalent_aperture: true}
detector: {quantum_efficiency: 0.54, dark_e_per_s: 0.02, read_noise_e: 9.3, full_well_e: 25500, gain_e_per_dn: 0.35, bias_dn: 100}
band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}
""",
    "narrow.yaml": """\
name: narrow
optics: {projection: gnomonic, columns: 1024, rows: 1024, pixel_pitch_m: 13.5e-6, focal_length_m: 1.2, aperture_m: 0.4,
         obscuration: 0.4, transmission: 0.75, psf_fwhm_px: 1.6}
detector: {quantum_efficiency: 0.9, dark_e_per_s: 0.1, read_noise_e: 8, full_well_e: 100000, gain_e_per_dn: 1.6, bias_dn: 300}
band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}
""",
    # 900 km above the two sites after a minute.
    "newcomer.tle": """\
NEWCOMER
1 99999U 18001A   18021.01041667  .00000000  00000-0  00000-0 0  9992
2 99999  66.0000  22.9510 0000001   0.0000  33.5590 13.98200000000018
"""}
PIXEL_ARCSEC = math.degrees(13.5e-6 / 1.2) * 3600
CUE_DELAY_NS = 10_000_000_000
PATIENCE_S = 400.0  # a run is 15 s of work, on a loaded machine


def lines_of(file):
    return [json.loads(line) for line in file.read_text().splitlines()]


def whole_lines(path):
    return path.read_text().count("\n") if path.exists() else 0


def check_times(tasks, frames):
    for before, task in zip([None, *tasks], tasks):
        check(task["start_ns"] >= task["given_ns"] + CUE_DELAY_NS, "a task begins two ticks after it is given, or later")
        check(not before or task["start_ns"] >= before["end_ns"], "one task at a time")
        check(task["gain_nats"] > 0 and task["candidates"] >= 1, f"it says why: {task['gain_nats']:.1f} nats")
    inside = [any(t["on_target_ns"] <= f["start_ns"] and f["end_ns"] <= t["end_ns"] for t in tasks) for f in frames]
    check(all(inside), f"all {len(frames)} exposures of the telescope are on a target")
    check(len(frames) == sum(t["exposures"] for t in tasks), "and those are all exposures of its tasks")


def left_of_refraction(d):
    """The covariance [arcsec^2] of a detection without the scatter of the refraction parallax, as who knows the range takes it."""
    ra, dec = math.radians(d["corrected_ra_deg"]), math.radians(d["corrected_dec_deg"])
    east = (-math.sin(ra), math.cos(ra), 0)
    north = (-math.sin(dec) * math.cos(ra), -math.sin(dec) * math.sin(ra), math.cos(dec))
    offset = d["refraction_offset_gcrs_m"]
    up = [x / math.hypot(*offset) for x in offset]
    e, n = (d["refraction_parallax_sigma_arcsec"] * sum(a * b for a, b in zip(up, axis)) for axis in (east, north))
    c = d["covariance_arcsec2"]
    return c[0] - e * e, c[1] - e * n, c[2] - n * n


def check_directions(detections):
    """Without refraction the error is that in the image: a bright source is known to hundredths of an arcsecond."""
    for d in detections:
        a, b, c = left_of_refraction(d)
        px = d["covariance_px2"]
        of_image = PIXEL_ARCSEC ** 4 * (px[0] * px[2] - px[1] ** 2)
        if d["kind"] == "point":
            check(a > 0 and abs(a * c - b * b - of_image) < 0.1 * of_image, f"{d['id']}: {math.sqrt(a):.4f} arcsec east")


def check_cues(run):
    """The telescope is cued to what the sites found, sees it at once, and its orbit improves."""
    tasks, frames = lines_of(run / "tasks.jsonl"), lines_of(run / "telescope" / "frames.jsonl")
    check(len(tasks) >= 2, f"the telescope has {len(tasks)} tasks")
    check_times(tasks, frames)
    first = {f["frame"] for f in frames[:2]}
    seen = {d["frame"] for d in lines_of(run / "telescope" / "detections.jsonl")}
    check(seen & first, f"it is detected in one of the first two exposures: in {sorted(seen)}")
    check_directions(lines_of(run / "telescope" / "detections.jsonl"))
    truth = {t["frame"]: t for t in lines_of(run / "telescope" / "truth.jsonl")}
    off = max(math.dist(truth[f["frame"]]["middle_px"], (511.5, 511.5)) for f in frames)
    check(off < 400, f"it is within {off:.0f} px of the middle")

    tracks = lines_of(run / "tracks.jsonl")
    confirmed = [t for t in tracks if t["status"] == "confirmed"]
    check(len({t["id"] for t in confirmed}) == 1, "one track is confirmed")
    check("telescope" in {i.split("/")[0] for t in confirmed for i in t["associated"]}, "with detections of the telescope")
    sigma = {t["time_ns"]: math.sqrt(sum(t["covariance_gcrs"][k] for k in (0, 2, 5))) for t in tracks}
    before = sigma[max(t for t in sigma if t <= tasks[0]["given_ns"])]
    first, last = sigma[min(t for t in sigma if t >= tasks[0]["end_ns"])], sigma[max(sigma)]
    check(first < before / 1.5 and last < before / 3, f"the orbit improves: {before:.0f} m before, {first:.0f} m after the first task, {last:.0f} m at the end")
    page = json.loads((run / "index.html").read_text().split('id="run">')[1].split("</script>")[0])
    check(page["cue_count"] == len(tasks) and any(t["cues"] and len(t["curve"]) > 1 for t in page["tracks"]), "the page draws it")


def is_complete(run, what):
    code, _ = run.finish(PATIENCE_S)
    check(code == 0, f"{what}: code {code} {run.stderr[-400:] if code else ''}")


def killed_nodes(binary, scenario, out, reference):
    """The telescope and the fusion node die, each when the telescope has made some exposures, and are started again."""
    frames = out / "telescope" / "frames.jsonl"
    with Run(binary, "launch", scenario, "--out", out) as run:
        for name, exposures in (("telescope", 2), ("fusion-node", 5)):
            wait_until(lambda: whole_lines(frames) >= exposures, f"{exposures} exposures")
            os.kill(wait_until(lambda: run.node(name), name), signal.SIGKILL)
        is_complete(run, "telescope and fusion node are killed")
    restarts = json.loads((out / "logs/master.json").read_text())["restarts"]
    check({"telescope", "fusion-node"} <= {name for name, count in restarts.items() if count}, f"both were started again: {restarts}")
    check_same(out, reference, "nodes that were killed")


def interrupted(binary, scenario, out, reference, first, second):
    """All is killed when the telescope has made some exposures; the directory goes on with the run."""
    with Run(binary, first, scenario, "--out", out) as run:
        wait_until(lambda: whole_lines(out / "telescope" / "frames.jsonl") >= 3, "three exposures")
        for pid in run.living():
            os.kill(pid, signal.SIGKILL)
        run.finish()
    with Run(binary, second, scenario, "--out", out) as run:
        is_complete(run, f"{second} goes on with what {first} left")
        check("continuing at tick" in run.stdout, run.stdout.splitlines()[0])
    check_same(out, reference, f"{second} after {first}")


def test(binary, work):
    for name, text in CAMERAS.items():
        (work / name).write_text(text)
    scenario, paced = work / "cue.yaml", work / "paced.yaml"
    scenario.write_text(SCENARIO.replace("REAL_TIME", "0"))
    paced.write_text(SCENARIO.replace("REAL_TIME", "20"))
    reference = work / "run"
    with Run(binary, "run", scenario, "--out", reference) as run:
        is_complete(run, "one process")
    check_cues(reference)
    with Run(binary, "launch", scenario, "--out", work / "launch", "--hosts", 2) as run:
        is_complete(run, "two hosts")
    check_same(work / "launch", reference, "two hosts")
    killed_nodes(binary, paced, work / "killed", reference)
    interrupted(binary, paced, work / "launch-run", reference, "launch", "run")
    interrupted(binary, paced, work / "run-launch", reference, "run", "launch")


if __name__ == "__main__":
    main(test)
