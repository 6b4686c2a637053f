"""The light of a tumbling body, as a run's truth has it, has the two periods of its rotation: peaks of astropy's Lomb-Scargle, and a
Fourier series in both.

    tumbling_light.py DMISE

A box with the inertia of a symmetric top: its long axis goes round the momentum at L / It, and it turns about that axis at
(1 - Ia / It) wa (Landau & Lifshitz, Mechanics, sections 33 and 36). Its sides are alike after half a turn.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from astropy.timeseries import LombScargle
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

INERTIA, RATE_DEG_PER_S, DURATION_S = (6000.0, 40000.0, 40000.0), (2.5, 5.0, 0.0), 1200
SCENARIO = f"""
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {DURATION_S}, tick_s: 2, seed: 1}}
objects:
  - {{name: eye, motion: {{two_body: {{semi_major_axis_m: 42164000, eccentricity: 0, inclination_deg: 5}}}}}}
  - name: stage
    motion: {{two_body: {{semi_major_axis_m: 42164000, eccentricity: 0, inclination_deg: 5, true_anomaly_deg: 2}}}}
    attitude: {{tumbling: {{inertia_kg_m2: {list(INERTIA)}, rate_deg_per_s: {list(RATE_DEG_PER_S)}}}}}
    geometry: {{model: box, size_m: [10, 3, 1.5]}}
sensors:
  - name: s
    platform: eye
    camera:
      optics: {{columns: 16, rows: 16, pixel_pitch_m: 1.0e-5, focal_length_m: 0.02, aperture_m: 0.002}}
      detector: {{full_well_e: 30000, gain_e_per_dn: 0.5, read_noise_e: 10}}
      band: bessell-V
    pointing: {{target: stage}}
    exposure_s: 0.1
    cadence_s: 2
    sky: space
detection: off
output: {{fits: off, png: off, truth: on}}
"""


def light(dmise):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "s.yaml").write_text(SCENARIO)
        subprocess.run([dmise, "run", folder / "s.yaml", "--out", folder / "out"], check=True, capture_output=True)
        rows = [json.loads(line) for line in open(folder / "out/truth.jsonl")]
    flux = np.array([10 ** (-0.4 * row["true_magnitude"]) for row in rows])
    return np.array([row["middle_ns"] * 1e-9 for row in rows]), flux / flux.mean() - 1


def left_over(t, y, frequencies):
    terms = [np.ones_like(t)] + [f(2 * np.pi * hz * t) for hz in frequencies for f in (np.cos, np.sin)]
    design = np.column_stack(terms)
    return y - design @ np.linalg.lstsq(design, y, rcond=None)[0]


def peaks(t, y, count):
    grid = np.arange(0.1 / DURATION_S, 0.09, 0.05 / DURATION_S)
    found = []
    for _ in range(count):
        found.append(grid[LombScargle(t, y).power(grid).argmax()])
        y = left_over(t, y, found[-1:])
    return found


def series(precession_hz, spin_hz):
    return [f for f in {abs(a * precession_hz + 2 * b * spin_hz) for a in range(-4, 5) for b in range(3)} if f > 0]


def main():
    t, y = light(sys.argv[1])
    rate = np.radians(RATE_DEG_PER_S)
    precession_hz = np.linalg.norm(INERTIA * rate) / INERTIA[1] / (2 * np.pi)
    spin_hz = (1 - INERTIA[0] / INERTIA[1]) * rate[0] / (2 * np.pi)
    expected = np.array(series(precession_hz, spin_hz))
    failures = 0
    found = peaks(t, y, 6)
    for hz in found:
        off = np.abs(expected - hz).min() * DURATION_S
        print(f"peak at {hz:.6f} Hz, {off:.2f} of a resolution from the nearest line")
        failures += off > 0.2
    for name, hz in (("precession", precession_hz), ("twice the spin", 2 * spin_hz)):
        off = np.abs(np.array(found) - hz).min() * DURATION_S
        print(f"{name}: {hz:.6f} Hz, the nearest peak is {off:.2f} of a resolution away")
        failures += off > 0.2
    right = left_over(t, y, series(precession_hz, spin_hz)).std() / y.std()
    wrong = [left_over(t, y, series(precession_hz + a / DURATION_S, spin_hz + b / DURATION_S)).std() / y.std()
             for a, b in ((2, 0), (-2, 0), (0, 2), (0, -2))]
    print(f"left of the light's variation: {right:.3f}; with a period off by two resolutions {min(wrong):.3f} at least")
    failures += not (right < 0.15 and min(wrong) > 2 * right)
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())
