"""The engine in Python: the bytes of the command line, the facts of its arrays, and what bad input does.

    engine.py [DMISE [TEST..]]      TEST: as Frames.test_wcs_is_astropys
"""
import ast
import ctypes
import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest
import unittest.mock
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
SANITIZED = "DMISE_TEST_PACKAGE" in os.environ  # by tests/sanitizers/engine.sh, with a module of its own
PACKAGE = os.environ.get("DMISE_TEST_PACKAGE", str(ROOT / "build/python"))
sys.path[:0] = [str(ROOT / "tests/system"), PACKAGE]

try:
    import astropy.io.fits
    import numpy as np
    import pandas
    import yaml
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
sys.path += map(str, (ROOT / "build/venv/lib").glob("python3*/site-packages"))  # for sgp4 alone
import dmise  # noqa: E402

try:
    import dmise.engine
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

DMISE = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build/release/bin/dmise"
os.environ["PATH"] = f"{DMISE.parent}:{os.environ['PATH']}"  # where the module finds the program, as that of an installed package
SENSOR = """\
  - name: {name}
    site: {{latitude_deg: 33, longitude_deg: -100, height_m: 300}}
    camera:
      optics: {{columns: 160, rows: 120, pixel_pitch_m: 9e-6, focal_length_m: 0.2, aperture_m: 0.1, psf_fwhm_px: 2}}
      detector: {{quantum_efficiency: 0.6, read_noise_e: 5, full_well_e: 60000, gain_e_per_dn: 1, bias_dn: 100}}
      band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}
    pointing: {pointing}
    exposure_s: 8
    cadence_s: 10
"""
WEST, EAST = "{target: GOES 13, tracking: fixed}", "{target: GOES 14, tracking: sidereal}"
SCENARIO = """\
simulation: {start: 2018-01-21T03:00:00Z, duration_s: 30, tick_s: 5, seed: 7}
objects: [{catalogue: demo}]
stars: {catalogue: kstars}
output: {png: off}
sensors:
""" + SENSOR.format(name="west", pointing=WEST) + SENSOR.format(name="east", pointing=EAST)
LARGE = SCENARIO.replace("columns: 160, rows: 120", "columns: 6000, rows: 6000").replace("pixel_pitch_m: 9e-6", "pixel_pitch_m: 3e-6")


def resident_mb():
    """Without what has been freed and the allocator keeps, which threads that meet by chance make more or less."""
    ctypes.CDLL(None).malloc_trim(0)
    for line in pathlib.Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024


def header_of(frame):
    """What a camera of another make says of a frame."""
    return {"DATE-OBS": frame.header["DATE-OBS"], "EXPTIME": 8.0, "FOCALLEN": 200.0, "XPIXSZ": 9.0, "YPIXSZ": 9.0,
            "RA": np.degrees(frame.report.boresight_ra_rad), "DEC": np.degrees(frame.report.boresight_dec_rad),
            "SITELAT": 33.0, "SITELONG": -100.0, "GAIN": 1.0}


class Frames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory(prefix="dmise-test-")
        base = pathlib.Path(cls.directory.name)
        cls.path = base / "night.yaml"
        cls.path.write_text(SCENARIO)
        cls.run_directory = base / "run"
        subprocess.run([DMISE, "run", cls.path, "--out", cls.run_directory, "--seed", "3"], check=True, capture_output=True)
        cls.run_ = dmise.open_run(cls.run_directory)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def test_frames_are_the_bytes_of_a_run(self):
        for threads in (1, 3):
            for sensor in ("west", "east"):
                frames = list(dmise.Simulation(self.path, seed=3).frames(sensor, threads=threads))
                self.assertEqual(len(frames), 3)
                for frame, (number, path) in zip(frames, self.run_.images(sensor), strict=True):
                    self.assertEqual((frame.sensor, frame.number), (sensor, number))
                    self.assertEqual(frame.to_fits(), path.read_bytes())
                    with astropy.io.fits.open(path) as hdus:
                        np.testing.assert_array_equal(frame.counts, hdus[0].data)
                        self.assertEqual(frame.header["EXPTIME"], hdus[0].header["EXPTIME"])
                        self.assertEqual(frame.header["INSTRUME"], sensor)

    def test_frames_of_all_sensors_and_a_sensor_alone_are_the_same(self):
        together = [f.to_fits() for f in dmise.Simulation(self.path, seed=3).frames() if f.sensor == "east"]
        for sensors in (["east"], ["east", "east"]):
            self.assertEqual(together, [f.to_fits() for f in dmise.Simulation(self.path, seed=3).frames(*sensors)])

    def test_layers_do_not_change_the_frame(self):
        plain = [f.to_fits() for f in dmise.Simulation(self.path, seed=3).frames("west")]
        self.assertEqual(plain, [f.to_fits() for f in dmise.Simulation(self.path, seed=3).frames("west", layers=True)])

    def test_records_are_those_of_the_run(self):
        frames = list(dmise.Simulation(self.path, seed=3).frames("west"))
        for name, of_frame, of_run in (("truth", lambda f: f.truth, self.run_.truth),
                                       ("detections", lambda f: f.detections, self.run_.detections)):
            ours = np.concatenate([of_frame(f) for f in frames])
            theirs = [record for record in of_run if record.sensor == "west"]
            self.assertEqual(len(ours), len(theirs), name)
            for row, record in zip(ours, theirs):
                for field in ours.dtype.names:
                    value = getattr(record, field)
                    if np.size(value):
                        np.testing.assert_array_equal(row[field], np.nan if value is None else value, err_msg=f"{name}.{field}")
        self.assertGreater(sum(len(f.truth) for f in frames), 0)
        self.assertEqual(frames[0].report, next(r for r in self.run_.frames if r.sensor == "west"))

    def test_scenarios_as_path_text_and_mapping_are_the_same(self):
        mapping = yaml.safe_load(SCENARIO)
        mapping["sensors"][0]["exposure_s"] = np.float32(8.0)
        reference = next(dmise.Simulation(self.path).frames("west"))
        for scenario in (str(self.path), SCENARIO, mapping):
            np.testing.assert_array_equal(next(dmise.Simulation(scenario).frames("west")).counts, reference.counts)

    def test_counts_are_the_memory_of_the_frame(self):
        frame = next(dmise.Simulation(SCENARIO).frames("west"))
        counts = frame.counts
        self.assertEqual((counts.dtype, counts.shape, counts.flags.c_contiguous), (np.uint16, (120, 160), True))
        self.assertFalse(counts.flags.owndata or counts.flags.writeable)
        kept, total = counts[10:20, ::-3], int(counts.sum())
        del frame, counts
        gc.collect()
        self.assertTrue(0 < int(kept.sum()) < total)

    def test_layers_sum_to_what_the_counts_expect(self):
        """The mean count is the expected electrons over the gain, and the bias, within 5 sigma of its noise."""
        for frame in dmise.Simulation(SCENARIO).frames("west", layers=True):
            stars, objects, sky = frame.layers()
            self.assertEqual((sky.dtype, sky.shape), (np.float32, (120, 160)))
            expected = stars + objects + sky
            noise = np.sqrt(np.mean(expected) + 25.0 + 1.0 / 12.0)
            self.assertLess(abs(np.mean(frame.counts - 100.0) - np.mean(expected)), 5.0 * noise / np.sqrt(expected.size) + 0.5)
            lit = frame.truth[frame.truth["in_frame"]]
            self.assertAlmostEqual(float(np.sum(objects, dtype=float)) / float(lit["rendered_signal_e"].sum()), 1.0, places=3)
            self.assertEqual(set(np.unique(frame.mask)) - {0}, set(np.flatnonzero(frame.truth["in_frame"]) + 1))
            self.assertGreater(objects[frame.mask > 0].sum(), 0.9 * objects.sum())
            np.testing.assert_array_equal(frame.layers("sky"), sky)

    def test_layers_that_were_not_made_are_refused(self):
        frame = next(dmise.Simulation(SCENARIO).frames("west"))
        for ask in (lambda: frame.layers("sky"), lambda: frame.mask):
            with self.assertRaisesRegex(dmise.InputError, "layers=True"):
                ask()
        with self.assertRaisesRegex(dmise.InputError, "must be of stars, objects, sky"):
            frame.layers("moon")

    def test_wcs_is_astropys(self):
        """Ends of streaks, whose directions our own code computes: pixels to 1e-3."""
        found = 0
        for frame in dmise.Simulation(SCENARIO).frames():
            for row in frame.detections[frame.detections["kind"] == "streak"]:
                x, y = frame.wcs.all_world2pix(np.degrees(row["end1_ra_rad"]), np.degrees(row["end1_dec_rad"]), 0)
                self.assertLess(np.hypot(x - row["end1_x_px"], y - row["end1_y_px"]), 1e-3)
                found += 1
        self.assertGreater(found, 0)

    def test_a_picture_is_that_of_a_run(self):
        """One that writes pictures."""
        frame = next(dmise.Simulation(self.path, seed=3).frames("west"))
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            pictured = pathlib.Path(directory) / "night.yaml"
            pictured.write_text(SCENARIO.replace("png: off", "png: on"))
            subprocess.run([DMISE, "run", pictured, "--out", f"{directory}/run", "--seed", "3"], check=True, capture_output=True)
            self.assertEqual(frame.to_png(), (pathlib.Path(directory) / "run/west/frame-000001.png").read_bytes())
        self.assertEqual(frame._repr_png_(), frame.to_png())

    def test_notebooks_show_tables_and_runs(self):
        frame = next(dmise.Simulation(self.path, seed=3).frames("west"))
        shown = xml.etree.ElementTree.fromstring(f"<body>{frame.detections._repr_html_()}</body>")
        head = [cell.text for cell in shown.iter("th")]
        self.assertEqual(head, list(frame.detections.dtype.names))
        row = [cell.text for cell in shown.find(".//tbody/tr")]
        self.assertEqual(row[head.index("sensor")], "west")
        self.assertAlmostEqual(float(row[head.index("x_px")]), frame.detections["x_px"][0], places=3)
        self.assertIn(f"{len(frame.detections)} rows", shown.find("p").text)
        self.assertIn("0 rows", frame.detections[:0]._repr_html_())
        rows = [[cell.text for cell in line] for line in
                xml.etree.ElementTree.fromstring(f"<body>{self.run_._repr_html_()}</body>").iter("tr")]
        for sensor in ("west", "east"):
            counts = [str(sum(record.sensor == sensor for record in records))
                      for records in (self.run_.frames, self.run_.truth, self.run_.detections)]
            self.assertIn([sensor, *counts], rows)

    def test_texts_in_a_page_are_escaped(self):
        link = self.run_directory.with_name("a<b>&c")
        link.symlink_to(self.run_directory)
        self.assertIn("a&lt;b&gt;&amp;c", dmise.open_run(link)._repr_html_())

    def test_progress_counts_frames(self):
        bars = []

        class Bar:
            def __init__(self, total, unit):
                bars.append([total, 0, False])

            def __enter__(self):
                return self

            def __exit__(self, *error):
                bars[-1][2] = True

            def update(self):
                bars[-1][1] += 1

        with unittest.mock.patch.dict(sys.modules, {"tqdm": types.ModuleType("tqdm"), "tqdm.auto": types.SimpleNamespace(tqdm=Bar)}):
            simulation = dmise.Simulation(SCENARIO)
            self.assertEqual([f.number for f in simulation.frames("west", progress=True)], [1, 2, 3])
            next(simulation.frames(progress=True))
        self.assertEqual(bars, [[3, 3, True], [6, 1, True]])
        with unittest.mock.patch.dict(sys.modules, {"tqdm": None, "tqdm.auto": None}), self.assertRaisesRegex(ImportError, "tqdm"):
            dmise.Simulation(SCENARIO).frames(progress=True)

    def test_a_scenario_as_yaml_is_the_same(self):
        """Read by PyYAML, and by the engine."""
        mapping = yaml.safe_load(SCENARIO)
        mapping["sensors"][0] |= {"exposure_s": np.float64(8.0), "name": "on"}
        text = dmise.to_yaml(mapping)
        self.assertEqual(yaml.safe_load(text), json.loads(dmise.Simulation(mapping).yaml))
        self.assertEqual(dmise.Simulation(text).digest, dmise.Simulation(mapping).digest)
        self.assertEqual(dmise.Simulation(self.path).yaml, SCENARIO)
        for value in (1e-7, 1.5e20, "", "a: b", "#", "- x", "ü", "no", "1", None, True, [], {}, [[1, {"a": []}], []], "a\nb", "'"):
            self.assertEqual(yaml.safe_load(dmise.to_yaml({"k": value, "l": [{"m": value}]})), {"k": value, "l": [{"m": value}]})
        for wrong, error in (("text\n", TypeError), ({"a": float("nan")}, dmise.ScenarioError), ({"a": {1}}, dmise.ScenarioError)):
            with self.assertRaises(error):
                dmise.to_yaml(wrong)

    def test_tables_of_pandas(self):
        truth = next(dmise.Simulation(SCENARIO).frames("west")).truth
        table = truth.to_pandas()
        self.assertIsInstance(table, pandas.DataFrame)
        self.assertEqual(len(table), len(truth))
        np.testing.assert_array_equal(table["true_range_m"], truth["true_range_m"])

    def test_stars_trail_as_the_earth_turns(self):
        """Of a camera at rest, against astropy's world coordinates: 0.03 px, for the pole precesses; of one that
        follows the stars not at all."""
        for sensor, turns in (("west", 1), ("east", 0)):
            frame = next(iter(dmise.Simulation(SCENARIO).frames(sensor)))
            middle = np.array([frame.header["NAXIS1"] - 1, frame.header["NAXIS2"] - 1]) / 2
            ra_deg, dec_deg = frame.wcs.all_pix2world([middle], 0)[0]
            turned_deg = turns * 15.0410687 / 3600 * frame.header["EXPTIME"]
            moved = frame.wcs.all_world2pix([[ra_deg - turned_deg, dec_deg]], 0)[0] - middle
            trail = dmise.SensorFrame(sensor, 1, 0, frame.counts, dict(frame.header)).star_trail_px
            np.testing.assert_allclose(trail, moved, atol=0.03)
            self.assertEqual(np.hypot(*trail) > 5, turns == 1)

    def test_an_empty_table_has_all_fields(self):
        alone = SCENARIO.replace("objects: [{catalogue: demo}]", "detection: off").replace(
            WEST, "zenith").replace(EAST, "zenith")
        frame = next(dmise.Simulation(alone).frames("west"))
        self.assertEqual((len(frame.truth), len(frame.detections)), (0, 0))
        self.assertEqual(frame.detections["covariance_rad2"].shape, (0, 3))
        self.assertEqual(len(frame.truth.to_pandas()), 0)

    def test_detect_gives_the_detections_of_the_run(self):
        for frame in dmise.Simulation(SCENARIO).frames("west"):
            found = dmise.detect(frame)
            self.assertGreater(len(found), 0)
            self.assertEqual(list(found["id"]), list(frame.detections["id"]))
            np.testing.assert_array_equal(found["x_px"], frame.detections["x_px"])
            self.assertEqual(found.report.psf_fwhm_px, frame.report.psf_fwhm_px)
            self.assertEqual(found[:1].report, found.report)
            stars = ROOT / "launch/catalogues/stars.dat.gz"
            np.testing.assert_array_equal(dmise.detect(frame, catalogue=stars)["x_px"], found["x_px"])

    def test_detect_and_solve_take_any_image(self):
        frame = next(dmise.Simulation(SCENARIO).frames("east"))
        header = header_of(frame)
        wide = np.zeros((240, 320), np.float32)
        wide[::2, ::2] = frame.counts
        read_only = wide[::2, ::2]
        read_only.flags.writeable = False
        usual = dmise.detect(frame.counts, header)
        for image in (frame.counts.astype(np.int32), frame.counts.astype(">u2"), read_only, np.asfortranarray(frame.counts)):
            np.testing.assert_allclose(dmise.detect(image, header)["x_px"], usual["x_px"], atol=0.01)
        with_nan = frame.counts.astype(float)
        with_nan[40:50, 40:50] = np.nan
        self.assertTrue(np.isfinite(dmise.detect(with_nan, header)["x_px"]).all())

    def test_images_of_all_numbers(self):
        frame = next(dmise.Simulation(SCENARIO).frames("east"))
        header = header_of(frame)
        usual = dmise.detect(frame.counts, header)
        self.assertGreater(len(usual), 0)
        for kind in (np.uint64, np.int64, np.float32, np.longdouble):
            np.testing.assert_allclose(dmise.detect(frame.counts.astype(kind), header)["x_px"], usual["x_px"], atol=0.01)
        self.assertEqual(len(dmise.detect(frame.counts[::-1, ::-1][::-1, ::-1], header)), len(usual))
        hidden = np.zeros(frame.counts.shape, bool)
        x, y = int(usual["x_px"][0]), int(usual["y_px"][0])
        hidden[max(0, y - 20):y + 20, max(0, x - 20):x + 20] = True
        masked, with_nan = np.ma.masked_array(frame.counts, hidden), np.where(hidden, np.nan, frame.counts)
        np.testing.assert_array_equal(dmise.detect(masked, header)["x_px"], dmise.detect(with_nan, header)["x_px"])
        infinite = frame.counts.astype(float)
        infinite[3, 3:6] = np.inf, -np.inf, 1e308
        self.assertTrue(np.isfinite(dmise.detect(infinite, header)["x_px"]).all())

    def test_memory_that_is_not_theirs_cannot_be_written(self):
        frame = next(dmise.Simulation(SCENARIO).frames("west", layers=True))
        for array in (frame.counts, frame.mask):
            with self.assertRaises(ValueError):
                array[0, 0] = 1
        with self.assertRaises(TypeError):
            frame.header["EXPTIME"] = 1

    def test_images_that_are_none(self):
        for image in (np.zeros((0, 5)), np.zeros(5), np.zeros((2, 3, 4)), np.zeros((4, 4), complex), np.array([["a"]]),
                      np.zeros((4, 4), bool), np.zeros((4, 4), object), np.zeros((4, 4), "M8[s]"), np.zeros((4, 4), "i4,i4"),
                      np.broadcast_to(np.uint8(0), (10**6, 10**6)), None, [[1, 2], [3]]):
            with self.assertRaises((dmise.InputError, ValueError)):
                dmise.detect(image, {})
        for header in ({"EXPTIME": float("nan")}, {"TOO-LONG-A-KEY": 1}, 5, {"OBJECT": "é"}, {"EXPTIME": "x" * 100}):
            with self.assertRaises(dmise.InputError):
                dmise.detect(np.zeros((64, 64), np.uint16), header)
        for image in (np.full((64, 64), np.nan), np.full((64, 64), np.inf), np.zeros((1, 1)), np.zeros((1, 5000), np.uint8)):
            with self.assertRaises((dmise.InputError, dmise.EngineError)):
                dmise.solve(image, {})

    def test_errors_are_those_of_the_command_line(self):
        path = self.path.with_name("bad.yaml")
        path.write_text(SCENARIO.replace("exposure_s: 8", "exposure_s: -8"))
        line = subprocess.run([DMISE, "run", path], capture_output=True, text=True).stderr.strip()
        with self.assertRaises(dmise.ScenarioError) as caught:
            dmise.Simulation(path)
        self.assertEqual(f"dmise: {caught.exception}", line)
        error = caught.exception
        self.assertEqual((error.file, error.line, error.key), (str(path), 13, "sensors[0].exposure_s"))
        for scenario, reason in ((SCENARIO.replace("exposure_s", "exposur_s"), "did you mean exposure_s"), ("{\n", "scenario:"),
                                 ({}, "simulation"), ({"simulation": {"start": float("inf")}}, "simulation.start: must be finite"),
                                 ({"simulation": {"start": object()}}, "got object"), ("/nonexistent/night.yaml", "nonexistent"),
                                 (SCENARIO.replace("GOES 13", "GOES 99"), "GOES 99"), ("\n" * 10, "mapping")):
            with self.assertRaisesRegex(dmise.ScenarioError, reason):
                next(dmise.Simulation(scenario).frames("west"))
        for argument in (5, None, [1]):
            with self.assertRaises(TypeError):
                dmise.Simulation(argument)
        with self.assertRaisesRegex(dmise.ScenarioError, "no sensor is named wst.*west"):
            dmise.Simulation(SCENARIO).frames("wst")
        for seed in (-1, 2**63):
            with self.assertRaisesRegex(dmise.ScenarioError, "seed"):
                dmise.Simulation(SCENARIO, seed=seed)
        with self.assertRaises(dmise.InputError):
            dmise.Simulation(SCENARIO).frames("west", threads=0)

    def test_check_is_the_commands(self):
        text = subprocess.run([DMISE, "check", self.path, "--json"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(dmise.check(self.path), json.loads(text))
        self.assertEqual(dmise.check(SCENARIO), {**json.loads(text), "scenario": "scenario"})
        with self.assertRaisesRegex(dmise.ScenarioError, "^scenario:2:16: simulation.start: is missing"):
            dmise.check({"simulation": {}})
        with self.assertRaisesRegex(dmise.ScenarioError, "--help: No such file"):
            dmise.check("--help")

    def test_survey_is_the_command(self):
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            text = subprocess.run([DMISE, "survey", self.path, "--json", "--out", directory, "--shells", "600,900"],
                                  check=True, capture_output=True, text=True).stdout
        self.assertEqual(dmise.survey(self.path, shells=[600, 900]), json.loads(text))
        self.assertEqual(dmise.survey(SCENARIO, shells=[600, 900]), {**json.loads(text), "scenario": "scenario"})

    def test_tradeoff_is_the_command(self):
        small = SCENARIO.replace("columns: 160, rows: 120", "columns: 48, rows: 32").replace(
            "catalogue: demo", "catalogue: demo, only: [GOES 13, GOES 14]")
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            found = dmise.tradeoff(small, repeats=1, sensor="east", out=directory)
            written = json.loads((pathlib.Path(directory) / "tradeoff.json").read_text())
        self.assertEqual(found, written)
        self.assertEqual(found["digest"], dmise.Simulation(small).digest)
        self.assertTrue({("sky", "off"), ("budget", "draft")} <= {(row["effect"], row["level"]) for row in found["rows"]})

    def test_visible_and_score_are_the_commands(self):
        before = sorted(os.listdir())
        passes = dmise.visible(self.path)
        self.assertEqual(sorted(os.listdir()), before, "nothing is left in the directory that one is in")
        self.assertTrue(passes and all("sensor" in one for one in passes))
        self.assertIn("sensors", dmise.score(self.run_directory))

    def test_an_iteration_may_end_early(self):
        for _ in range(20):
            frames = dmise.Simulation(SCENARIO).frames("west")
            next(frames)
            frames.close()
        dmise.Simulation(SCENARIO).frames("west")  # never asked
        self.assertTrue(dmise.engine.core.wait_for_detached(20.0))

    def test_threads_make_frames_at_once(self):
        expected = [f.to_fits() for f in dmise.Simulation(SCENARIO).frames("west")]
        simulation, found = dmise.Simulation(SCENARIO), []
        threads = [threading.Thread(target=lambda: found.append([f.to_fits() for f in simulation.frames("west")]))
                   for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [expected] * 4)

    def test_a_forked_process_makes_frames_of_its_own(self):
        simulation = dmise.Simulation(SCENARIO)
        begun = simulation.frames("west")
        first = next(begun)
        read, write = os.pipe()
        child = os.fork()
        if child == 0:
            said = b"error"
            try:
                try:
                    next(begun)
                except dmise.EngineError as error:
                    said = b"refused" if "forked" in str(error) else said
                if next(simulation.frames("west")).to_fits() == first.to_fits():
                    said += b", same"
            finally:
                os.write(write, said)
                os._exit(0)
        os.close(write)
        with os.fdopen(read, "rb") as answers:
            self.assertEqual(answers.read(), b"refused, same")
        os.waitpid(child, 0)
        self.assertEqual(next(begun).number, 2)

    def test_ctrl_c_ends_a_large_frame_within_a_second(self):
        simulation = dmise.Simulation(LARGE)
        frames = simulation.frames("west")
        sent = []

        def interrupt():
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(0.7, interrupt)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            list(frames)
        self.assertLess(time.monotonic() - sent[0], 1.0)
        self.assertTrue(dmise.engine.core.wait_for_detached(20.0))
        self.assertEqual(next(dmise.Simulation(SCENARIO).frames("west")).number, 1)

    def test_ctrl_c_ends_other_calls_within_a_second(self):
        times = np.datetime64("2018-01-21") + np.arange(4000).astype("timedelta64[m]")
        image = np.random.default_rng(1).normal(1000, 10, (5000, 5000)).astype(np.float32)
        header = {"DATE-OBS": "2018-01-21T03:00:00", "EXPTIME": 8.0, "FOCALLEN": 200.0, "XPIXSZ": 3.0, "YPIXSZ": 3.0, "RA": 100.0,
                  "DEC": 10.0, "SITELAT": 33.0, "SITELONG": -100.0}
        for work in (lambda: dmise.propagate(ROOT / "launch/catalogues/demo.tle", times), lambda: dmise.detect(image, header)):
            sent = []
            timer = threading.Timer(0.5, lambda: (sent.append(time.monotonic()), os.kill(os.getpid(), signal.SIGINT)))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                while not sent or time.monotonic() < sent[0] + 60:  # a quick machine needs several calls
                    work()
            self.assertLess(time.monotonic() - sent[0], 1.0)
            self.assertTrue(dmise.engine.core.wait_for_detached(60.0))

    def test_a_catalogue_that_changes_is_read_anew(self):
        def frame_of(stars):
            text = "ra_deg,dec_deg,mag_v\n" + "".join(f"{ra:.4f},{dec:.4f},5\n" for ra, dec in stars)
            path.write_text(text)
            sim = dmise.Simulation(SCENARIO.replace("kstars", str(path)).replace("duration_s: 30", "duration_s: 10"))
            return sim.digest, next(sim.frames("west")).counts.astype(float).max()

        path = pathlib.Path(self.directory.name) / "stars.csv"
        report = next(dmise.Simulation(SCENARIO).frames("west")).report
        middle = np.degrees([report.boresight_ra_rad, report.boresight_dec_rad])
        middle[0] %= 360.0
        in_frame, out_of_it = frame_of([middle]), frame_of([((middle[0] + 90.0) % 360.0, middle[1])])
        self.assertNotEqual(in_frame[0], out_of_it[0])
        self.assertGreater(in_frame[1], 10 * out_of_it[1])
        self.assertEqual(frame_of([middle]), in_frame)

    @unittest.skipIf(SANITIZED, "what is freed is kept")
    def test_memory_is_flat_over_seeds(self):
        def make(seeds):
            for seed in seeds:
                for frame in dmise.Simulation(tiny, seed=seed).frames("west"):
                    frame.counts, frame.truth, frame.detections
            gc.collect()
            self.assertTrue(dmise.engine.core.wait_for_detached(20.0))
            return resident_mb()

        tiny = SCENARIO.replace("duration_s: 30", "duration_s: 10").replace("catalogue: demo", "catalogue: demo, only: [GOES 13, GOES 14]")
        count = int(os.environ.get("DMISE_TEST_SEEDS", "300"))
        before = make(range(100))
        self.assertLess(make(range(100, 100 + count)) - before, 5.0)


class Catalogues(unittest.TestCase):
    TLE = ("VANGUARD 1\n"
           "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753\n"
           "2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667\n")

    def test_states_are_those_of_the_sgp4_package(self):
        """Reference: sgp4 of PyPI, Vallado's code; 1e-8 km."""
        from sgp4.api import Satrec, jday

        times = np.datetime64("2000-06-27T18:50:19.733571") + np.arange(0, 4320, 360).astype("timedelta64[m]")
        states = dmise.propagate(self.TLE, times, axes="teme")
        self.assertEqual((states.positions_m.shape, states.codes.shape), ((1, 12, 3), (1, 12)))
        satellite = Satrec.twoline2rv(*self.TLE.splitlines()[1:])
        for k, time_ in enumerate(times.tolist()):
            seconds = time_.second + time_.microsecond * 1e-6
            code, r, v = satellite.sgp4(*jday(time_.year, time_.month, time_.day, time_.hour, time_.minute, seconds))
            self.assertEqual((code, states.codes[0, k]), (0, 0))
            np.testing.assert_allclose(states.positions_m[0, k], np.array(r) * 1e3, atol=2e-3)
            np.testing.assert_allclose(states.velocities_m_per_s[0, k], np.array(v) * 1e3, atol=2e-6)

    def test_states_are_those_of_the_command(self):
        path = ROOT / "launch/catalogues/demo.tle"
        for axes in ("teme", "gcrs", "itrs"):
            printed = subprocess.run([DMISE, "catalogue", "states", path, "--at", "2018-01-21T00:30:00Z", "--frame", axes],
                                     check=True, capture_output=True, text=True).stdout.splitlines()[1:]
            states = dmise.propagate(path, "2018-01-21T00:30:00Z", axes=axes, threads=2)
            self.assertEqual(len(printed), len(states.numbers))
            for i in (0, 100, len(printed) - 1):
                number, code, *state = printed[i].split(",")
                self.assertEqual((int(number), int(code)), (states.numbers[i], states.codes[i, 0]))
                np.testing.assert_array_equal(np.array(state[:3], float), states.positions_m[i, 0] / 1e3)

    def test_times_are_of_any_unit_and_byte_order(self):
        """A time beyond 2262 has no nanoseconds of 64 bits."""
        for time_, text in ((np.datetime64("2300-01-01"), "2300-01-01T00:00:00Z"), (np.datetime64("2018-01"), "2018-01-01T00:00:00Z"),
                            (np.array("2018-01-01T00:00:00.5", ">M8[ms]"), "2018-01-01T00:00:00.5Z")):
            ours, theirs = (dmise.propagate(ROOT / "launch/catalogues/demo.tle", t, axes="teme") for t in (time_, text))
            np.testing.assert_array_equal(ours.codes, theirs.codes)
            np.testing.assert_array_equal(ours.positions_m, theirs.positions_m)

    def test_bad_input(self):
        for what, times, axes, reason in ((self.TLE, "2000-13-01", "gcrs", "2000-13-01"), (self.TLE, "2001-01-01", "xyz", "axes"),
                                          ("a\nb\n", "2001-01-01", "gcrs", "catalogue"), (self.TLE, [5], "gcrs", "times"),
                                          (self.TLE, np.array(["NaT"], "datetime64[s]"), "gcrs", "NaT"), (self.TLE, 5, "gcrs", "times"),
                                          ("/nonexistent.tle", "2001-01-01", "gcrs", "nonexistent")):
            with self.assertRaisesRegex(dmise.InputError, reason):
                dmise.propagate(what, times, axes=axes)
        self.assertEqual(dmise.propagate(self.TLE, []).positions_m.shape, (1, 0, 3))
        for threads in (0, 10**6, 1.5):
            with self.assertRaises((dmise.InputError, TypeError)):
                dmise.propagate(self.TLE, "2001-01-01", threads=threads)

    def test_times_in_any_memory(self):
        times = np.datetime64("2000-06-28") + np.arange(12).astype("timedelta64[h]")
        read_only = times[::-3]
        read_only.flags.writeable = False
        usual = dmise.propagate(self.TLE, times.tolist())
        np.testing.assert_array_equal(dmise.propagate(self.TLE, read_only).positions_m, usual.positions_m[:, ::-3])
        np.testing.assert_array_equal(dmise.propagate(self.TLE, times.reshape(3, 4)).positions_m, usual.positions_m)


class Package(unittest.TestCase):
    def test_a_program_may_end_in_the_middle_of_an_iteration(self):
        begin = time.monotonic()
        self.assertEqual(self.run_python(f"import dmise; sim = dmise.Simulation({SCENARIO!r}); frames = sim.frames('west');"
                                         "never = sim.frames('east'); print(next(frames).number)"), ["1"])
        self.assertLess(time.monotonic() - begin, 30.0)

    def test_a_forked_process_may_end_in_the_middle_of_an_iteration(self):
        """Neither the parent's threads are waited for nor is its own left running."""
        begin = time.monotonic()
        self.assertEqual(self.run_python(
            f"import dmise, os; sim = dmise.Simulation({SCENARIO!r}); frames = sim.frames('west'); next(frames)\n"
            "if os.fork() == 0:\n    mine = sim.frames('east'); next(mine)\n"
            "else:\n    print(os.waitstatus_to_exitcode(os.wait()[1]))"), ["0"])
        self.assertLess(time.monotonic() - begin, 30.0)

    def run_python(self, code):
        return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                              env={**os.environ, "PYTHONPATH": PACKAGE}).stdout.split()

    @unittest.skipIf(SANITIZED, "the sanitizer itself is large")
    def test_importing_is_quick_and_small(self):
        """0.3 s and 60 MB, with the engine."""
        seconds, mb = map(float, self.run_python(
            "import time; t = time.process_time(); import dmise; dmise.Simulation; print(time.process_time() - t);"
            "print(next(int(l.split()[1]) for l in open('/proc/self/status') if l.startswith('VmHWM')) / 1024)"))
        self.assertLess(seconds, 0.3)
        self.assertLess(mb, 60.0)

    def test_simulating_needs_no_wire(self):
        self.assertEqual(self.run_python("import sys, dmise; dmise.Simulation, dmise.detect, dmise.check;"
                                         "print(*[m for m in ('zmq', 'google.protobuf') if m in sys.modules])"), [])

    def test_type_checkers_see_the_same_names(self):
        stub = ast.parse(pathlib.Path(dmise.__file__).with_suffix(".pyi").read_text())
        names = {(name.asname, line.module) for line in stub.body if isinstance(line, ast.ImportFrom) for name in line.names}
        self.assertEqual(names, {*dmise._MODULE_OF.items(), *((name, None) for name in dmise._MODULES)})

    def test_all_names_are_there(self):
        for name in dmise.__all__:
            self.assertIsNotNone(getattr(dmise, name))
        self.assertRaises(AttributeError, lambda: dmise.nothing)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
