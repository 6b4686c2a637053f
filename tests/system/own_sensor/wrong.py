"""A sensor that does something wrong in its second frame."""
import dataclasses
import math
import os
import signal

import dmise

RIGHT = dmise.Sighting(ra_rad=1.0, dec_rad=0.5, sigma_rad=1e-5, range_m=1e6, range_sigma_m=1.0)
FAULTS = {"nan": {"range_m": math.nan}, "no_error": {"sigma_rad": 0.0}, "flat": {"covariance_rad2": [0.0, 0.0, 0.0]}, "covariance": {"covariance_rad2": [1e-9, 2e-9, 1e-9]},
          "shape": {"covariance_rad2": [1e-9, 1e-9]}, "no_sigma": {"sigma_rad": None}, "no_range_sigma": {"range_sigma_m": None},
          "no_range": {"range_m": 0.0}, "no_direction": {"direction": [0.0, 0.0, 0.0]}, "word": {"ra_rad": "east"},
          "declination": {"dec_rad": 2.0}, "no_rate_sigma": {"range_rate_m_per_s": 1.0, "range_rate_sigma_m_per_s": 0.0}}


@dmise.sensor
def look(exposure, world, options):
    fault = options["fault"] if exposure.frame == 2 else ""
    if fault == "raises":
        raise ValueError("no echo")
    if fault == "exits":
        os._exit(7)
    if fault == "wrong_type":
        return "nothing"
    if fault == "wrong_item":
        return [(1.0, 0.5)]
    if fault == "too_many":
        return [RIGHT] * 100_001
    if fault == "past":
        return [dataclasses.replace(RIGHT, time_s=exposure.start_s - 1.0)]
    if fault == "killed":
        os.kill(os.getpid(), signal.SIGKILL)
    if fault == "stopped":
        os.kill(os.getpid(), signal.SIGSTOP)
    return [dataclasses.replace(RIGHT, **FAULTS.get(fault, {}))]


dmise.serve(look)
