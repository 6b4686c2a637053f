"""A detector that does something wrong in a frame, the second if none is told."""
import dataclasses
import math
import os
import signal

import dmise

RIGHT = dmise.Found(x_px=60.0, y_px=40.0, sigma_px=0.1, flux_e=1000.0, snr=20.0)
FAULTS = {"nan": {"x_px": math.nan}, "outside": {"y_px": 113.0}, "no_light": {"flux_e": 0.0}, "no_snr": {"snr": -1.0},
          "word": {"snr": "much"}, "no_error": {"sigma_px": 0.0}, "covariance": {"covariance_px2": [1.0, 2.0, 1.0]},
          "flat": {"covariance_px2": [0.0, 0.0, 0.0]},
          "shape": {"covariance_px2": [1.0, 2.0]}, "one_end": {"end1_px": [50.0, 40.0]},
          "end_outside": {"end1_px": [-17.0, 40.0], "end2_px": [70.0, 40.0]},
          "no_length": {"end1_px": [60.0, 40.0], "end2_px": [60.0, 40.0]}}


@dmise.detector
def find(frame, options):
    fault = options["fault"] if frame.number == options.get("at", 2) else ""
    if fault == "raises":
        raise ValueError("no stars")
    if fault == "exits":
        os._exit(7)
    if fault == "wrong_type":
        return "nothing"
    if fault == "wrong_item":
        return [(60.0, 40.0)]
    if fault == "too_many":
        return [RIGHT] * 100_001
    if fault == "killed":
        os.kill(os.getpid(), signal.SIGKILL)
    if fault == "stopped":
        os.kill(os.getpid(), signal.SIGSTOP)
    return [dataclasses.replace(RIGHT, **FAULTS.get(fault, {}))]


dmise.serve(find)
