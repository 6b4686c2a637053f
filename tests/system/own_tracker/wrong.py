"""A tracker that does something wrong at tick 3."""
import dataclasses
import math
import os
import signal

import dmise
import numpy as np

RIGHT = dmise.Track(id=1, status="confirmed", position_m=[7e6, 0, 0], velocity_m_per_s=[0, 7500, 0], covariance=np.diag([1e4] * 3 + [1.0] * 3))
INDEFINITE = np.diag([1e4] * 3 + [1.0] * 3)
INDEFINITE[0, 1] = INDEFINITE[1, 0] = 2e4
SKEW = np.diag([1e4] * 3 + [1.0] * 3)
SKEW[0, 1] = 1.0
FAULTS = {"nan": {"position_m": [math.nan, 0, 0]}, "far": {"position_m": [1e16, 0, 0]}, "shape": {"position_m": [7e6, 0]},
          "indefinite": {"covariance": INDEFINITE}, "skew": {"covariance": SKEW}, "certain": {"covariance": np.zeros(21)},
          "vast": {"covariance": 1e40 * np.eye(6)},
          "unknown_detection": {"associated": ["eye/1/7"]}, "no_id": {"id": 0}, "status": {"status": "sure"},
          "no_object": {"catalogue_number": 7}, "other_object": {"catalogue_number": 41866}, "existence": {"existence": 1.5}}
TASKS = {"no_sensor": ("scop", 1), "not_cued": ("eye", 1), "no_track": ("scope", 2), "exposures": ("scope", 1, 1001)}


@dmise.tracker
def track(t_s, frames, world, options):
    fault = options["fault"] if world.tick == 3 else ""
    if fault == "raises":
        raise ValueError("no orbit")
    if fault == "exits":
        os._exit(7)
    if fault == "wrong_type":
        return 7
    if fault == "wrong_item":
        return [(1, 2)]
    if fault == "killed":
        os.kill(os.getpid(), signal.SIGKILL)
    if fault == "stopped":
        os.kill(os.getpid(), signal.SIGSTOP)
    if fault == "too_many":
        return [dataclasses.replace(RIGHT, id=k + 1) for k in range(10_001)]
    if fault == "twice":
        return [RIGHT, RIGHT]
    found = [d.id for frame in frames for d in frame.detections]
    if options["fault"] == "taken_twice" and found:
        return [dataclasses.replace(RIGHT, associated=found[:1]), dataclasses.replace(RIGHT, id=2, associated=found[:1])]
    if fault == "two_tasks":
        return dmise.Tracks([RIGHT], [dmise.Point("scope", 1)] * 2)
    if fault in TASKS:
        return dmise.Tracks([RIGHT], [dmise.Point(*TASKS[fault])])
    if options["fault"] == "comes_back" and world.tick == 2:
        return [dataclasses.replace(RIGHT, status="lost")]
    if options["fault"] == "other_object" and world.tick < 3:
        return [dataclasses.replace(RIGHT, catalogue_number=35491)]
    return [dataclasses.replace(RIGHT, **FAULTS.get(fault, {}))]


dmise.serve(track)
