"""Scenarios whose nodes are models of one's own (own_models.py), and the runs of them as programs."""
import itertools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import dmise
import own_models
from package import DMISE, ROOT
from scenarios import check_records

PATIENCE_S = 300.0  # on a loaded machine
CAMERA = """\
name: small
optics: {projection: gnomonic, columns: 128, rows: 96, pixel_pitch_m: 5.4e-6, field_of_view_deg: 3, aperture_m: 0.02}
detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
"""
ORBIT = "semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0"
MOTION = f"{{two_body: {{{ORBIT}, true_anomaly_deg: 0.15}}}}"  # orbit of the probe, where no model moves it
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 1, seed: 1}}
nodes:
{nodes}
objects:
  - {{catalogue: demo, only: [GOES 14, GOES 16], radius_m: 3}}
  - {{name: watcher, motion: {{two_body: {{{orbit}, true_anomaly_deg: 0}}}}}}
  - {{name: probe, motion: {motion}, radius_m: 0.3{more}}}
stars: {{catalogue: kstars}}
sensors:
  - {{name: eye, platform: watcher, camera: small.yaml, pointing: {{target: probe}}, exposure_s: 0.02, cadence_s: {cadence_s}, sky: space, detection: {eye}}}
  - {{name: aboard, platform: probe, camera: small.yaml, pointing: {{ra_deg: 10, dec_deg: 5}}, exposure_s: 0.5, cadence_s: {cadence_s}, sky: space, detection: {aboard}}}
network: {{{network}}}
output: {{png: false}}
{end}
"""


def without_digest(fits):
    """The bytes of a frame without the digest of its scenario, and the sum of the header that it is in."""
    return re.sub(rb"(?s)(SCENARIO|CHECKSUM)= .{70}", b"", fits)


class OwnModelCase(unittest.TestCase):
    """Has a directory with a camera, and writes scenarios with nodes of one's own there."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="dmise-test-")
        cls.base = pathlib.Path(cls.temporary.name)
        cls.number = itertools.count()
        (cls.base / "small.yaml").write_text(CAMERA)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def setUp(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.base)

    def write(self, *nodes, motion="{node: gnc}", more="", eye="on", aboard="off", duration_s=20, cadence_s=10, network="", end=""):
        path = self.base / f"night-{next(self.number)}.yaml"
        path.write_text(SCENARIO.format(nodes="\n".join(f"  - {{{node}}}" for node in nodes), motion=motion, more=more, eye=eye,
                                        aboard=aboard, duration_s=duration_s, cadence_s=cadence_s, network=network, end=end,
                                        orbit=ORBIT))
        return path

    @staticmethod
    def node(model, name="gnc", more="", **options):
        return f"name: {name}, run: [{sys.executable}, {own_models.__file__}, {model}], options: {json.dumps(options)}{more}"

    def run_of(self, path, code=0):
        """The directory of a run with the models as programs; of one that fails what it says."""
        out = path.with_suffix("")
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "build/python")}
        done = subprocess.run([DMISE, "run", path, "--out", out, "--allow-programs"], capture_output=True, text=True,
                              timeout=PATIENCE_S, env=environment)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr if code else dmise.open_run(out)

    def check_same_as_run(self, simulation, run):
        frames = list(simulation.frames())
        self.assertGreater(len(frames), 0)
        for sensor in simulation.sensors:
            ours = [frame for frame in frames if frame.sensor == sensor]
            for frame, (number, path) in zip(ours, run.images(sensor), strict=True):
                self.assertEqual(frame.number, number)
                self.assertEqual(without_digest(frame.to_fits()), without_digest(path.read_bytes()))
            for name, tables, theirs in (("truth", [f.truth for f in ours], run.truth),
                                         ("detections", [f.detections for f in ours], run.detections)):
                check_records(self, np.concatenate(tables), [record for record in theirs if record.sensor == sensor], name)
            self.assertEqual([f.report for f in ours], [r for r in run.frames if r.sensor == sensor])
        return frames
