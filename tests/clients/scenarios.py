"""Scenarios of small cameras that watch geostationary satellites, and a run of one."""
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import dmise
from package import DMISE

SENSOR = """\
  - name: {name}
    site: {{latitude_deg: {latitude_deg}, longitude_deg: -100, height_m: 300}}
    camera:
      optics: {{columns: {columns}, rows: {rows}, pixel_pitch_m: 9e-6, focal_length_m: 0.2, aperture_m: 0.1, psf_fwhm_px: 2}}
      detector: {{quantum_efficiency: 0.6, read_noise_e: {read_noise_e}, full_well_e: 60000, gain_e_per_dn: {gain_e_per_dn}, bias_dn: {bias_dn}}}
      band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}
    pointing: {pointing}
    exposure_s: {exposure_s}
    cadence_s: 10
"""
USUAL = {"latitude_deg": 33, "columns": 160, "rows": 120, "read_noise_e": 5, "gain_e_per_dn": 1, "bias_dn": 100, "exposure_s": 8}


def sensor(name, pointing, **values):
    """An item of `sensors`; values are numbers or distributions."""
    return SENSOR.format(name=name, pointing=pointing, **(USUAL | values))


WEST, EAST = "{target: GOES 13, tracking: fixed}", "{target: GOES 14, tracking: sidereal}"
NIGHT = """\
simulation: {start: 2018-01-21T03:00:00Z, duration_s: 30, tick_s: 5, seed: 7}
objects: [{catalogue: demo}]
stars: {catalogue: kstars}
output: {png: off}
sensors:
""" + sensor("west", WEST) + sensor("east", EAST)

DRAWN_HEAD = """\
simulation: {start: {uniform: [2018-01-21T03:00:00Z, 2018-01-21T09:00:00Z]}, duration_s: 20, tick_s: 10}
objects: [{catalogue: demo, only: [GOES 13, GOES 14, GOES 15], radius_m: {log_uniform: [1, 8]}}]
output: {fits: off}
sensors:
"""


def drawn_sensor(name, columns, rows):
    """An item of `sensors` with distributions."""
    return sensor(name, "{target: {one_of: [GOES 13, GOES 14]}, tracking: fixed}", columns=columns, rows=rows,
                  latitude_deg="{uniform: [25, 40]}", read_noise_e="{normal: {mean: 6, sigma: 1, min: 3}}",
                  bias_dn="{integers: [90, 110]}", exposure_s="{log_uniform: [1, 8]}")


def check_records(case, rows, records, name):
    """Rows of a table are these records of a run; `name`: of the table, for messages."""
    case.assertEqual(len(rows), len(records), name)
    for row, record in zip(rows, records):
        for field in rows.dtype.names:
            value = getattr(record, field)
            if np.size(value):
                np.testing.assert_array_equal(row[field], np.nan if value is None else value, err_msg=f"{name}.{field}")


class NightRun(unittest.TestCase):
    """Has what `dmise run` leaves of the night with seed 3."""

    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory(prefix="dmise-test-")
        base = pathlib.Path(cls.directory.name)
        cls.path = base / "night.yaml"
        cls.path.write_text(NIGHT)
        cls.run_directory = base / "run"
        subprocess.run([DMISE, "run", cls.path, "--out", cls.run_directory, "--seed", "3"], check=True, capture_output=True)
        cls.run_ = dmise.open_run(cls.run_directory)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()
