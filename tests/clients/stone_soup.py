"""Trackers of other people hear a live run of three 0.4 m sites that follow a LEO object, with errors of 1 arcsec: Stone Soup's
unscented filter, by the shipped example, and the shipped tracker in numpy end within 100 m of the truth; the shipped view in Rerun has the track.

    stone_soup.py DMISE
"""

import datetime
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "clients/python/examples"
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "build/python")]
os.environ["PYTHONPATH"] = str(ROOT / "build/python")
from harness import Run, check, main, tell_figures, wait_until  # noqa: E402

try:
    import numpy as np
    import rerun.dataframe
    import stonesoup  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
import dmise  # noqa: E402
from dmise.stonesoup import to_stonesoup  # noqa: E402

ARCSEC = 1.0
WITHIN_M = 100.0


def last_states(stone_soup, plain, start):
    """(time [s] in the run, state, detections) of each tracker's last line."""
    lines = [line.split() for line in stone_soup.splitlines()]
    time, track, states, *numbers = lines[-1]
    check(len({line[1] for line in lines}) == 1, "Stone Soup has one track, and keeps it")
    seconds = (datetime.datetime.fromisoformat(time) - start).total_seconds()
    yield "stone_soup", seconds, np.array(numbers, float), int(states) + 3  # its first state is of four detections
    lines = [line.split() for line in plain.splitlines()]
    yield "numpy", float(lines[-1][0]), np.array(lines[-1][1:], float), len(lines) + 4


def measured_errors(left, truth):
    """Errors of detections on each axis [arcsec]: what the sensors' mounts do."""
    errors = []
    for detection in left.detections:
        true = truth[detection.time_ns]
        sight = dmise.line_of_sight(detection)
        seen = dmise.apparent_direction(true[:, None], sight.origin_m)[:, 0]
        errors.append(sight.tangents @ (seen - sight.direction) * 206264.806)
    errors = np.array([error for error in errors if np.linalg.norm(error) < 10.0])  # others are pieces of trails
    return errors


def test(binary, directory):
    out = directory / "out"
    with Run(binary, "launch", ROOT / "launch/scenarios/three-sites.yaml", "--out", out) as run:
        announced = out / "logs/master.address"
        address = wait_until(lambda: announced.exists() and announced.read_text().strip(), "the time-master's address")
        with Run(sys.executable, EXAMPLES / "track_stonesoup.py", address, str(ARCSEC)) as stone_soup, \
                Run(sys.executable, EXAMPLES / "tracker.py", address, str(ARCSEC)) as plain, \
                Run(sys.executable, EXAMPLES / "rerun_view.py", address, str(ARCSEC), "-", directory / "shown.rrd") as view:
            check(run.finish(400)[0] == 0, "the run is complete")
            for each in (stone_soup, plain, view):
                check(each.finish()[0] == 0, f"a tracker ends with the run {each.stderr[-500:]}")
    left = dmise.open_run(out)
    truth = {t.middle_ns: np.concatenate([t.true_position_m, t.true_velocity_m_per_s]) for t in left.truth}
    errors = measured_errors(left, truth)
    rms = float(np.sqrt(np.mean(errors ** 2)))
    check(len(errors) >= 60 and 0.85 < rms < 1.15, f"{len(errors)} detections, {rms:.2f} arcsec on each axis")
    detected = to_stonesoup(left.detections[0], ARCSEC)
    check(np.allclose(detected.measurement_model.covar(), dmise.line_of_sight(left.detections[0]).covariance_rad2
                      + (ARCSEC / 206264.806) ** 2 * np.eye(2)), "Stone Soup's covariance is the detection's and the mount's")
    for name, seconds, state, used in last_states(stone_soup.stdout, plain.stdout, left.start_utc.replace(tzinfo=None)):
        true = truth[min(truth, key=lambda time_ns: abs(time_ns / 1e9 - seconds))]
        error_m = float(np.linalg.norm(state[:3] - true[:3]))
        tell_figures({"name": f"tracker_{name}", "detections": used, "arcsec": round(rms, 2), "error_m": round(error_m, 2),
                      "error_m_per_s": round(float(np.linalg.norm(state[3:] - true[3:])), 3)})
        check(used >= 60 and error_m < WITHIN_M, f"{name}: {error_m:.1f} m from the truth after {used} detections")
    shown = {column.entity_path for column in rerun.dataframe.load_recording(directory / "shown.rrd").schema().component_columns()}
    check(any(path.startswith("/space/track-") for path in shown), f"Rerun shows the track: {sorted(shown)}")


if __name__ == "__main__":
    main(test)
