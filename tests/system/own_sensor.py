"""A program of the user's is a sensor: what it observes is in the products and the tracks, also when it dies; what it says wrongly ends
the run with sensor, node, frame and reason.

    own_sensor.py DMISE
"""

import json
import math
import os
import pathlib
import re
import subprocess
import sys

from harness import CAMERA, PATIENCE_S, Run, check, check_same, main, products, wait_until
from own_detector import lines_of, without_digest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SILENT_AFTER_S = 3.0
LIGHT_M_PER_S = 299792458.0

ORBIT = "semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0"
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 5, seed: 1}}
nodes: [{{name: laser, {laser}}}, {{name: blind, {blind}}}]
objects:
  - name: newcomer
    radius_m: 4
    motion:
      sgp4:
        line1: 1 99999U 18001A   18021.01041667  .00000000  00000-0  00000-0 0  9992
        line2: 2 99999  66.0000  22.9510 0000001   0.0000  33.5590 13.98200000000018
  - {{name: watcher, motion: {{two_body: {{{orbit}}}}}}}
fusion: on
sensors:
  - {{name: eye, site: atlanta, camera: small.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark, detection: off}}
  - {{name: ranger, node: laser, truth: on, site: atlanta, exposure_s: 1, cadence_s: 5}}
  - {{name: lidar, node: blind, platform: watcher, exposure_s: 0.5, cadence_s: 10, first_exposure_s: 1, half_angle_deg: 5}}
network: {{on_silent_node: {policy}, silent_after_s: {silent_after_s}, restarts: 20}}
output: {{png: false}}
"""
RANGING = {"sigma_arcsec": 5, "sigma_m": 2, "sigma_m_per_s": 0.1, "least_elevation_deg": 20, "farthest_m": 2.0e6}


def program(name, **options):
    told = ", ".join(f"{key}: {json.dumps(value)}" for key, value in options.items())
    return f"run: [{sys.executable}, {name}.py], options: {{{told}}}"


def write(directory, name, laser, policy="fail", duration_s=80):
    camera = CAMERA.replace("columns: 512, rows: 384", "columns: 128, rows: 96")
    (directory / "small.yaml").write_text(camera.replace("view_deg: 15", "view_deg: 40").replace("aperture_m: 0.02",
                                                                                                 "aperture_m: 0.0005"))
    for file in [*(HERE / "own_sensor").glob("*.py"), ROOT / "clients/python/examples/ranging.py"]:
        (directory / file.name).write_bytes(file.read_bytes())
    path = directory / name
    path.write_text(SCENARIO.format(laser=laser, blind=program("blind"), policy=policy, duration_s=duration_s, orbit=ORBIT,
                                    silent_after_s=SILENT_AFTER_S))
    return path


def dmise(binary, *arguments, code=0):
    """Runs a command to its end; returns what it says on stderr."""
    done = subprocess.run([binary, *map(str, arguments)], capture_output=True, text=True, timeout=PATIENCE_S)
    check(done.returncode == code, f"dmise {arguments[0]}: code {done.returncode} {done.stderr[-500:] if done.returncode != code else ''}")
    return done.stderr


def unit_of(ra_deg, dec_deg):
    ra, dec = math.radians(ra_deg), math.radians(dec_deg)
    return [math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def minus(a, b):
    return [x - y for x, y in zip(a, b, strict=True)]


def measures_the_object(out):
    """Directions, ranges and range rates agree with the truth of a camera at the same place, by the renderer's own geometry."""
    truths = {row["frame"]: row for row in lines_of(out / "eye/truth.jsonl") if row["name"] == "newcomer"}
    cameras = {row["frame"]: row for row in lines_of(out / "eye/frames.jsonl")}
    detections = {row["frame"]: row for row in lines_of(out / "ranger/detections.jsonl")}
    both = sorted(truths.keys() & detections.keys())
    check(len(both) >= 5, f"{len(both)} frames of camera and station show the object")
    sums = [0.0, 0.0, 0.0]
    for frame in both:
        truth, d, camera = truths[frame], detections[frame], cameras[frame]
        sensor, velocity = camera["sensor_position_gcrs_m"], camera["sensor_velocity_gcrs_m_per_s"]
        check(d["sensor_position_gcrs_m"] == sensor and d["time_ns"] == camera["middle_ns"] and d["magnitude"] == 99,
              f"frame {frame}: the station is where the camera is")
        line = minus(truth["true_position_gcrs_m"], sensor)
        seconds = math.sqrt(dot(line, line)) / LIGHT_M_PER_S
        line = minus(line, [seconds * v for v in truth["true_velocity_gcrs_m_per_s"]])
        range_m = math.sqrt(dot(line, line))
        towards = [x / range_m for x in line]
        rate = dot(towards, minus(truth["true_velocity_gcrs_m_per_s"], velocity)) \
            / (1 + dot(towards, truth["true_velocity_gcrs_m_per_s"]) / LIGHT_M_PER_S)
        off_arcsec = 206264.8 * math.dist(unit_of(d["corrected_ra_deg"], d["corrected_dec_deg"]), towards)
        off = (off_arcsec / RANGING["sigma_arcsec"], (d["range_m"] - range_m) / d["range_sigma_m"],
               (d["range_rate_m_per_s"] - rate) / d["range_rate_sigma_m_per_s"])
        check(max(map(abs, off)) < 5, f"frame {frame}: {off[0]:.2f}, {off[1]:.2f}, {off[2]:.2f} sigmas off in direction, range, rate")
        sums = [total + value**2 for total, value in zip(sums, off, strict=True)]
    means = [total / len(both) for total in sums]
    check(0.4 < means[0] < 6 and 0.2 < means[1] < 3 and 0.2 < means[2] < 3, f"mean squares of these: {means}")


def knows_no_truth(out):
    reports, detections = lines_of(out / "lidar/frames.jsonl"), lines_of(out / "lidar/detections.jsonl")
    check(len(reports) == 8 and len(detections) == 16, f"lidar: {len(reports)} frames, {len(detections)} detections")
    for report, sun, moon in zip(reports, detections[::2], detections[1::2], strict=True):
        moved = minus(moon["sensor_position_gcrs_m"], sun["sensor_position_gcrs_m"])
        by_velocity = [0.25 * v for v in report["sensor_velocity_gcrs_m_per_s"]]
        check(sun["time_ns"] == report["middle_ns"] and moon["time_ns"] == report["end_ns"] and math.dist(moved, by_velocity) < 0.5
              and report["sensor_position_gcrs_m"] == sun["sensor_position_gcrs_m"] and sun["magnitude"] == -26.7
              and (sun["snr"], moon["snr"]) == (60, 50) and "range_m" not in moon and report["limiting_magnitude"] == 5
              and abs(report["boresight_dec_deg"] - moon["corrected_dec_deg"]) < 1e-9,
              f"{report['sensor']} {report['frame']}: by SNR, each at its time and place")


def error_of(out, name="newcomer"):
    """Error of the last track that was seen at a frame of the camera, and its standard deviation [m]."""
    truth = [row for row in lines_of(out / "eye/truth.jsonl") if row["name"] == name]
    tracks = [row for row in lines_of(out / "tracks.jsonl") if row["name"] == name]
    check(tracks and tracks[-1]["status"] == "confirmed", f"{out.name}: {len(tracks)} states of a confirmed track")
    last = tracks[-1]
    nearest = min(truth, key=lambda row: abs(row["middle_ns"] - last["time_ns"]))
    seconds = (last["time_ns"] - nearest["middle_ns"]) / 1e9
    sigma_m = math.sqrt(sum(last["covariance_gcrs"][k] for k in (0, 2, 5)))
    # Over some seconds, with the attraction of the Earth's centre.
    position = nearest["true_position_gcrs_m"]
    pull = [-3.986004418e14 * x / math.sqrt(dot(position, position))**3 for x in position]
    there = [x + seconds * v + 0.5 * seconds**2 * a
             for x, v, a in zip(position, nearest["true_velocity_gcrs_m_per_s"], pull, strict=True)]
    return math.dist(there, last["position_gcrs_m"]), sigma_m


def is_a_sensor(binary, directory):
    scenario = write(directory, "ranging.yaml", program("ranging", **RANGING))
    for command in ("run", "launch"):
        dmise(binary, command, scenario, "--allow-programs", "--out", directory / command)
        logs = sorted(path.name for path in (directory / command / "logs").glob("*-*r.log") if path.name != "time-master.log")
        check(logs == ["blind-lidar.log", "laser-ranger.log"], f"{command}: each sensor has a program, with its log {logs}")
    check_same(directory / "launch", directory / "run", "run and launch give the same bytes")
    out = directory / "run"
    measures_the_object(out)
    knows_no_truth(out)
    record = json.loads((out / "run.json").read_text())
    frames = {(row["sensor"], row["frame"]) for row in record["frames"]}
    check({("ranger", k) for k in range(1, 17)} <= frames and (out / "index.html").stat().st_size > 10_000,
          f"{len(frames)} frames are in run.json, and there is a report")
    merged = [row["sensor"] for row in lines_of(out / "detections.jsonl")]
    check(merged.count("lidar") == 16 and merged.count("ranger") >= 5, "detections.jsonl has those of all sensors")
    for arguments in (["score", out], ["export", out, "--to", "tdm", "--out", directory / "run.tdm"],
                      ["export", out, "--to", "czml", "--out", directory / "run.czml"]):
        dmise(binary, *arguments)
    text = (directory / "run.tdm").read_text()
    check("DATA_TYPES = ANGLE_1,ANGLE_2,RANGE,DOPPLER_INSTANTANEOUS" in text and "\nRANGE = " in text,
          "the TDM has ranges and their rates")
    dmise(binary, "run", write(directory, "angles.yaml", program("ranges_off", **RANGING)), "--allow-programs", "--out",
          directory / "angles")
    for name in ("run", "angles"):
        error_m, sigma_m = error_of(directory / name)
        check(error_m < 5 * sigma_m, f"{name}: the track is {error_m:.1f} m off, sigma {sigma_m:.1f} m")
    check(error_of(out)[1] < 0.5 * error_of(directory / "angles")[1], "ranges make the track more accurate")


def dies_and_goes_on(binary, directory):
    reference = {path: without_digest(content) for path, content in products(directory / "run").items()}
    for command, how in (("run", ["SIGKILL", "SIGSTOP", "SIGKILL"]), ("launch", ["SIGKILL", "SIGTERM", "SIGKILL"])):
        options = {**RANGING, "lives": str(directory / f"lives-{command}"), "ends": [1, 3, 3], "how": how}
        scenario = write(directory, f"mortal-{command}.yaml", program("mortal", **options), policy="restart")
        out = directory / f"mortal-{command}"
        said = dmise(binary, command, scenario, "--allow-programs", "--out", out)
        log = said + ((out / "logs/ranger.log").read_text() if (out / "logs/ranger.log").exists() else "")
        ours = {path: without_digest(content) for path, content in products(out).items()}
        check(log.count("was restarted") >= 3 and ours == reference,
              f"{command}: a sensor that is killed thrice observes the same: {len(ours)} files")


def goes_on_after_a_stop(binary, directory):
    """Also in its first second, when no exposure is over yet."""
    reference = {path: without_digest(content) for path, content in products(directory / "run").items()}
    scenario = write(directory, "slow.yaml", program("mortal", **RANGING, lives=str(directory / "slow"), ends=[], how=[], sleep_s=0.2))
    for first, second, begun in (("run", "launch", "logs/laser-ranger.log"), ("launch", "run", "logs/laser-ranger.log"),
                                 ("run", "run", "logs"), ("launch", "launch", "ranger/frames.jsonl")):
        out = directory / f"stopped-{first}-{second}"
        with Run(binary, first, scenario, "--allow-programs", "--out", out) as run:
            wait_until(lambda: (out / begun).exists(), begun)
            run.interrupt()
            code, _ = run.finish()
            check(code == 130, f"{first} stops after Ctrl-C as soon as there is {begun}: code {code}")
            run.nothing_left()
        dmise(binary, second, scenario, "--allow-programs", "--out", out)
        ours = {path: without_digest(content) for path, content in products(out).items()}
        check(ours == reference, f"{second} goes on: the products are those of a run that was not stopped")


RANGER = r"ranger: laser: frame 2 \(tick 2\): "
FAULTS = {  # what a program does in frame 2, and what the run says of it
    "raises": r"ValueError: no echo \(wrong.py:\d+\)",
    "exits": r"its program has ended with code 7",
    "wrong_type": r"TypeError: a sensor returns dmise.Sightings, or a list of dmise.Sighting, got str",
    "wrong_item": r"TypeError: a sensor returns dmise.Sightings, or a list of dmise.Sighting, got one tuple",
    "too_many": r"sightings: must be at most 100000, got 100001",
    "past": r"sightings\[0\].time_ns: must be within the exposure, 5000000000 to 6000000000, got 4000000000",
    "nan": r"sightings\[0\].range_m: must be finite, got nan",
    "no_error": r"ValueError: sigma_rad: must be > 0, got 0",
    "flat": r"sightings\[0\].covariance_rad2: must be > 0, got 0",
    "covariance": r"sightings\[0\].covariance_rad2: must be positive definite, got covariance 2e-09",
    "shape": r"ValueError: covariance_rad2: must have the shape \(3,\), got \(2,\)",
    "no_sigma": r"ValueError: sigma_rad or covariance_rad2: is needed",
    "no_range_sigma": r"ValueError: range_sigma_m: must be a number, got None",
    "no_range": r"sightings\[0\].range_m: must be > 0, got 0",
    "no_rate_sigma": r"sightings\[0\].range_rate_sigma_m_per_s: must be > 0, got 0",
    "no_direction": r"ValueError: direction: must be a finite direction, got \[0.0, 0.0, 0.0\]",
    "word": r"ValueError: ra_rad: must be a number, got 'east'",
    "declination": r"sightings\[0\].dec_rad: must be from -1.57079633 to 1.57079633, got 2",
    "killed": r"its program was killed \(Killed\)",
    "stopped": r"its program has not answered for \d\.\d s",
    "rubbish": r"what its program says is no answer \(1000000 bytes\)",
    "two_frames": r"its program answers in 2 frames instead of 1",
    "ready": r"its program answers a frame by something else",
    "another_frame": r"it answers for frame 7",
    "half_a_covariance": r"sightings\[0\].covariance_rad2: must be 3 numbers, got 2",
    "no_boresight": r"boresight_dec_rad: must be finite, got nan",
    "hangs_silently": r"its program has not answered for \d\.\d s",
}
RAW = ("rubbish", "two_frames", "ready", "another_frame", "half_a_covariance", "no_boresight", "hangs_silently")
LAUNCHED = ("exits", "nan", "hangs_silently")


def ends_with_a_reason(binary, directory):
    for fault, words in FAULTS.items():
        scenario = write(directory, "wrong.yaml", program("wrong_raw" if fault in RAW else "wrong", fault=fault), duration_s=20)
        command = "launch" if fault in LAUNCHED else "run"
        with Run(binary, command, scenario, "--allow-programs", "--out", directory / f"wrong-{fault}") as run:
            code, _ = run.finish()
            last = run.stderr.strip().splitlines()[-1]
            check(code == 1 and re.search(RANGER + words, last), f"{command}, {fault}: code {code}: {last}")
            run.nothing_left()
    said = dmise(binary, "run", write(directory, "detects.yaml", program("detects")), "--allow-programs", "--out",
                 directory / "detects", code=1)
    check("ranger: laser: frame 1 (tick 1): ValueError: the program detects, the scenario has it observe as ranger" in said,
          said.strip()[-150:])


def asks_first(binary, directory):
    scenario = write(directory, "ask.yaml", program("mortal", **RANGING, lives=str(directory / "never"), ends=[], how=[]))
    for command in ("run", "launch"):
        said = dmise(binary, command, scenario, "--out", directory / "ask", code=2)
        check("ask.yaml:2:" in said and "mortal.py" in said and "--allow-programs" in said,
              f"{command} asks: {said.strip()[-150:]}")
    for command in (["check"], ["explain"], ["visible", "--print-only"]):
        dmise(binary, command[0], scenario, *command[1:])
    check(not list(directory.glob("never*")), "none of them starts it")


def test(binary, directory):
    os.environ["PYTHONPATH"] = str(ROOT / "build/python")
    asks_first(binary, directory)
    is_a_sensor(binary, directory)
    dies_and_goes_on(binary, directory)
    goes_on_after_a_stop(binary, directory)
    ends_with_a_reason(binary, directory)


if __name__ == "__main__":
    main(test)
