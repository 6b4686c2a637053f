#!/usr/bin/env python3
"""A night as arrays: frames of a scenario, what is in them and what was found, without a file.

    frames_in_python.py [SCENARIO [SENSOR]]
"""
import sys

import dmise

NIGHT = """\
simulation: {start: 2018-01-21T03:00:00Z, duration_s: 60, tick_s: 5}
objects: [{catalogue: demo}]
stars: {catalogue: kstars}
sensors:
  - name: west
    site: {latitude_deg: 33, longitude_deg: -100, height_m: 300}
    camera:
      optics: {columns: 512, rows: 512, pixel_pitch_m: 9e-6, focal_length_m: 0.2, aperture_m: 0.1, psf_fwhm_px: 2}
      detector: {quantum_efficiency: 0.6, read_noise_e: 5, full_well_e: 60000, gain_e_per_dn: 1, bias_dn: 100}
      band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}
    pointing: {target: GOES 13, tracking: fixed}
    exposure_s: 4
    cadence_s: 10
"""

simulation = dmise.Simulation(sys.argv[1] if len(sys.argv) > 1 else NIGHT, seed=3)
for frame in simulation.frames(*sys.argv[2:], layers=True):
    stars, objects, sky = frame.layers()
    print(f"{frame.sensor} {frame.number}: {frame.counts.shape[0]} x {frame.counts.shape[1]}, sky {sky.mean():.1f} e-, "
          f"stars {stars.sum():.0f} e-, objects {objects.sum():.0f} e-, {len(frame.truth)} objects, "
          f"{len(frame.detections)} detections")
