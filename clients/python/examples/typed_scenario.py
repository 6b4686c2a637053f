#!/usr/bin/env python3
"""What longer exposures find: a scenario as typed mappings, which editors complete and `mypy --strict` checks."""
import dmise
from dmise.scenario import Camera, Scenario, Sensor

camera: Camera = {
    "optics": {"columns": 512, "rows": 512, "pixel_pitch_m": 9e-6, "focal_length_m": 0.2, "aperture_m": 0.1, "psf_fwhm_px": 2},
    "detector": {"quantum_efficiency": 0.6, "read_noise_e": 5, "full_well_e": 60000, "gain_e_per_dn": 1, "bias_dn": 100},
    "band": {"name": "V", "centre_m": 0.55e-6, "width_m": 0.128e-6},
}


def night(exposure_s: float) -> Scenario:
    west: Sensor = {
        "name": "west",
        "site": {"latitude_deg": 33, "longitude_deg": -100, "height_m": 300},
        "camera": camera,
        "pointing": {"target": "GOES 13", "tracking": "fixed"},
        "exposure_s": exposure_s,
        "cadence_s": 10,
    }
    return {
        "simulation": {"start": "2018-01-21T03:00:00Z", "duration_s": 20, "tick_s": 5},
        "objects": [{"catalogue": "demo"}],
        "stars": {"catalogue": "kstars"},
        "sensors": [west],
    }


for exposure_s in (1.0, 2.0, 4.0, 8.0):
    simulation = dmise.Simulation(night(exposure_s), seed=3)
    found = [len(frame.detections) for frame in simulation.frames()]
    print(f"{exposure_s:.0f} s: {found} detections")
