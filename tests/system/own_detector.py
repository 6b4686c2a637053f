"""A program of the user's detects in the frames of sensors: what it finds is in the products with its direction, also when it dies;
what it says wrongly ends the run with sensor, node, frame and reason.

    own_detector.py DMISE
"""

import json
import math
import os
import pathlib
import re
import subprocess
import sys

from harness import CAMERA, PATIENCE_S, Run, check, check_same, main, products

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SILENT_AFTER_S = 3.0
PX_ARCSEC = 3 * 3600 / 128

ORBIT = "semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0"
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 5, seed: 1}}
nodes: [{{name: peaks, {node}}}]
objects:
  - {{name: watcher, motion: {{two_body: {{{orbit}, true_anomaly_deg: 0}}}}}}
  - {{name: probe, motion: {motion}, radius_m: 0.5}}
stars: {{catalogue: kstars}}
sensors:
  - {{name: eye, platform: watcher, camera: small.yaml, pointing: {{target: probe, offset_deg: [0.3, 0.2]}}, exposure_s: 0.02, cadence_s: 10, sky: space, detection: {detection}}}
  - {{name: other, platform: watcher, camera: small.yaml, pointing: {{target: probe}}, exposure_s: 0.02, cadence_s: 20, sky: space, detection: {other}}}
network: {{on_silent_node: {policy}, silent_after_s: {silent_after_s}, restarts: 20}}
output: {{png: false}}
"""


def write(directory, name, node, policy="fail", duration_s=40, detection="{node: peaks}", other="off",
          motion=f"{{two_body: {{{ORBIT}, true_anomaly_deg: 0.15}}}}"):
    (directory / "small.yaml").write_text(
        CAMERA.replace("columns: 512, rows: 384", "columns: 128, rows: 96").replace("view_deg: 15", "view_deg: 3"))
    for file in [*(HERE / "own_detector").iterdir(), ROOT / "clients/python/examples/detector.py"]:
        if file.is_file():
            (directory / file.name).write_bytes(file.read_bytes())
    path = directory / name
    path.write_text(SCENARIO.format(node=node, policy=policy, duration_s=duration_s, detection=detection, other=other,
                                    motion=motion, orbit=ORBIT, silent_after_s=SILENT_AFTER_S))
    return path


def program(name, **options):
    told = ", ".join(f"{key}: {json.dumps(value)}" for key, value in options.items())
    return f"run: [{sys.executable}, {name}.py], options: {{{told}}}"


PEAKS = {"threshold": 8, "most": 20}


def dmise(binary, *arguments, code=0):
    """Runs a command to its end; returns what it says on stderr."""
    done = subprocess.run([binary, *map(str, arguments)], capture_output=True, text=True, timeout=PATIENCE_S)
    check(done.returncode == code, f"dmise {arguments[0]}: code {done.returncode} {done.stderr[-500:] if done.returncode != code else ''}")
    return done.stderr


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def distance_arcsec(a, b):
    """Between two directions ra, dec [deg]."""
    east = (a[0] - b[0]) * math.cos(math.radians(a[1]))
    return 3600 * math.hypot(east, a[1] - b[1])


def finds_the_object(binary, directory):
    scenario = write(directory, "peaks.yaml", program("detector", **PEAKS), other="{node: peaks}")
    for command in ("run", "launch"):
        dmise(binary, command, scenario, "--allow-programs", "--out", directory / command)
        logs = sorted(path.name for path in (directory / command / "logs").glob("peaks*"))
        check(logs == ["peaks-eye.log", "peaks-other.log"], f"{command}: each sensor has a program, with its log {logs}")
    check_same(directory / "launch", directory / "run", "run and launch give the same bytes")
    out = directory / "run"
    truths = [row for row in lines_of(out / "truth.jsonl") if row["name"] == "probe"]
    detections = lines_of(out / "detections.jsonl")
    reports = lines_of(out / "frames.jsonl")
    check(len(truths) == len(reports) == 6, f"{len(truths)} frames with the object")
    for truth, report in zip(truths, reports, strict=True):
        of_frame = [d for d in detections if (d["sensor"], d["frame"]) == (truth["sensor"], truth["frame"])]
        at = truth["middle_px"]
        best = min(of_frame, key=lambda d: math.dist((d["x_px"], d["y_px"]), at))
        off_px = math.dist((best["x_px"], best["y_px"]), at)
        off_arcsec = distance_arcsec((best["corrected_ra_deg"], best["corrected_dec_deg"]),
                                     (truth["apparent_ra_deg"], truth["apparent_dec_deg"]))
        sigma_arcsec = math.sqrt(best["covariance_px2"][0]) * PX_ARCSEC
        check(off_px < 0.2 and off_arcsec < 0.2 * PX_ARCSEC and best["kind"] == "point"
              and abs(math.sqrt(best["covariance_arcsec2"][2]) / sigma_arcsec - 1) < 0.3
              and abs(best["magnitude"] - truth["true_magnitude"]) < 0.5,
              f"{best['id']}: {off_px:.3f} px and {off_arcsec:.2f} arcsec off, magnitude {best['magnitude']:.2f} of "
              f"{truth['true_magnitude']:.2f}")
        check([d["index"] for d in of_frame] == list(range(len(of_frame))) and report["detections"] == len(of_frame)
              and [d["snr"] for d in of_frame] == sorted((d["snr"] for d in of_frame), reverse=True)
              and "detection_off" not in report and report["noise_e"] > 5 and report["limiting_magnitude"] > 3,
              f"{report['sensor']} {report['frame']}: {len(of_frame)} detections by falling SNR, limit "
              f"{report['limiting_magnitude']:.2f} mag")


def without_digest(content):
    return re.sub(rb"(?s)(SCENARIO|CHECKSUM)= .{70}", b"", content)  # cards of 80 bytes


def dies_and_goes_on(binary, directory):
    reference = {path: without_digest(content) for path, content in products(directory / "run").items()}
    for command, how in (("run", ["SIGKILL", "SIGSTOP", "SIGKILL"]), ("launch", ["SIGKILL", "SIGTERM", "SIGKILL"])):
        options = {**PEAKS, "lives": str(directory / f"lives-{command}"), "ends": [1, 1, 2], "how": how}
        scenario = write(directory, f"mortal-{command}.yaml", program("mortal_peaks", **options), policy="restart",
                         other="{node: peaks}")
        out = directory / f"mortal-{command}"
        said = dmise(binary, command, scenario, "--allow-programs", "--out", out)
        log = said + "".join((out / f"logs/{sensor}.log").read_text() for sensor in ("eye", "other")
                             if (out / f"logs/{sensor}.log").exists())
        ours = {path: without_digest(content) for path, content in products(out).items()}
        check(log.count("was restarted") >= 6 and ours == reference,
              f"{command}: a detector that is killed thrice finds the same: {len(ours)} files")


EYE = r"eye: peaks: frame 2 \(tick 3\): "
FAULTS = {  # what a program does in frame 2, and what the run says of it
    "raises": r"ValueError: no stars \(wrong.py:\d+\)",
    "exits": r"its program has ended with code 7",
    "wrong_type": r"TypeError: a detector returns dmise.Found, or a list of them, got str",
    "wrong_item": r"TypeError: a detector returns dmise.Found, or a list of them, got one tuple",
    "too_many": r"found: must be at most 100000 sources, got 100001",
    "nan": r"found\[0\].x_px: must be finite, got nan",
    "outside": r"found\[0\].y_px: must be from -16 to 111, got 113",
    "no_light": r"found\[0\].flux_e: must be > 0, got 0",
    "no_snr": r"found\[0\].snr: must be > 0, got -1",
    "word": r"ValueError: snr: must be a number, got 'much'",
    "no_error": r"ValueError: sigma_px: must be > 0, got 0 \(wrong.py:\d+\)",
    "flat": r"found\[0\].var_x_px2: must be > 0, got 0",
    "covariance": r"found\[0\].cov_xy_px2: must be .*, got 2",
    "shape": r"ValueError: covariance_px2: must have the shape \(3,\), got \(2,\)",
    "one_end": r"ValueError: end1_px and end2_px: a streak has both",
    "end_outside": r"found\[0\].end1.x_px: must be from -16 to 143, got -17",
    "no_length": r"found\[0\].end2: must be another place than end1.*",
    "killed": r"its program was killed \(Killed\)",
    "stopped": r"its program has not answered for \d\.\d s",
    "rubbish": r"what its program says is no answer \(1000000 bytes\)",
    "two_frames": r"its program answers in 2 frames instead of 1",
    "ready": r"its program answers a frame by something else",
    "half_a_streak": r"found\[0\]: a streak has end1 and end2, got one of them",
    "hangs_silently": r"its program has not answered for \d\.\d s",
}
RAW = ("rubbish", "two_frames", "ready", "half_a_streak", "hangs_silently")
LAUNCHED = ("exits", "nan", "hangs_silently")


def ends_with_a_reason(binary, directory):
    for fault, words in FAULTS.items():
        scenario = write(directory, "wrong.yaml", program("wrong_raw" if fault in RAW else "wrong", fault=fault), duration_s=20)
        command = "launch" if fault in LAUNCHED else "run"
        with Run(binary, command, scenario, "--allow-programs", "--out", directory / f"wrong-{fault}") as run:
            code, _ = run.finish()
            last = run.stderr.strip().splitlines()[-1]
            check(code == 1 and re.search(EYE + words, last), f"{command}, {fault}: code {code}: {last}")
            run.nothing_left()


def asks_first(binary, directory):
    never = str(directory / "never")
    scenario = write(directory, "ask.yaml", program("mortal_peaks", **PEAKS, lives=never, ends=[], how=[]))
    for command in ("run", "launch"):
        said = dmise(binary, command, scenario, "--out", directory / "ask", code=2)
        check("ask.yaml:2:" in said and "mortal_peaks.py" in said and "--allow-programs" in said,
              f"{command} asks: {said.strip()[-150:]}")
    dmise(binary, "check", scenario)
    for command in (["tradeoff"], ["dataset", "--seeds", "1..2"]):
        said = dmise(binary, *command, scenario, "--out", directory / "ask", code=2)
        check("runs no nodes of one's own" in said, said.strip()[-150:])
    check(not list(directory.glob("never*")), "none of them starts it")


def test(binary, directory):
    os.environ["PYTHONPATH"] = str(ROOT / "build/python")
    asks_first(binary, directory)
    finds_the_object(binary, directory)
    dies_and_goes_on(binary, directory)
    ends_with_a_reason(binary, directory)


if __name__ == "__main__":
    main(test)
