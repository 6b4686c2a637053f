"""The frames of a simulation: the bytes of a run, and the facts of their arrays.

    engine_frames.py [DMISE [TEST..]]
"""
import gc

import package

package.require("astropy", "numpy", "pandas", "dmise.engine")
import astropy.io.fits  # noqa: E402
import numpy as np  # noqa: E402
import pandas  # noqa: E402

import dmise  # noqa: E402
from scenarios import EAST, NIGHT, WEST, NightRun, check_records  # noqa: E402


class Frames(NightRun):
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
            check_records(self, ours, [record for record in of_run if record.sensor == "west"], name)
        self.assertGreater(sum(len(f.truth) for f in frames), 0)
        self.assertEqual(frames[0].report, next(r for r in self.run_.frames if r.sensor == "west"))

    def test_counts_are_the_memory_of_the_frame(self):
        frame = next(dmise.Simulation(NIGHT).frames("west"))
        counts = frame.counts
        self.assertEqual((counts.dtype, counts.shape, counts.flags.c_contiguous), (np.uint16, (120, 160), True))
        self.assertFalse(counts.flags.owndata or counts.flags.writeable)
        kept, total = counts[10:20, ::-3], int(counts.sum())
        del frame, counts
        gc.collect()
        self.assertTrue(0 < int(kept.sum()) < total)

    def test_layers_sum_to_what_the_counts_expect(self):
        """The mean count is the expected electrons over the gain, and the bias, within 5 sigma of its noise."""
        for frame in dmise.Simulation(NIGHT).frames("west", layers=True):
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
        frame = next(dmise.Simulation(NIGHT).frames("west"))
        for ask in (lambda: frame.layers("sky"), lambda: frame.mask):
            with self.assertRaisesRegex(dmise.InputError, "layers=True"):
                ask()
        with self.assertRaisesRegex(dmise.InputError, "must be of stars, objects, sky"):
            frame.layers("moon")

    def test_memory_that_is_not_theirs_cannot_be_written(self):
        frame = next(dmise.Simulation(NIGHT).frames("west", layers=True))
        for array in (frame.counts, frame.mask):
            with self.assertRaises(ValueError):
                array[0, 0] = 1
        with self.assertRaises(TypeError):
            frame.header["EXPTIME"] = 1

    def test_wcs_is_astropys(self):
        """Ends of streaks, whose directions our own code computes: pixels to 1e-3."""
        found = 0
        for frame in dmise.Simulation(NIGHT).frames():
            for row in frame.detections[frame.detections["kind"] == "streak"]:
                x, y = frame.wcs.all_world2pix(np.degrees(row["end1_ra_rad"]), np.degrees(row["end1_dec_rad"]), 0)
                self.assertLess(np.hypot(x - row["end1_x_px"], y - row["end1_y_px"]), 1e-3)
                found += 1
        self.assertGreater(found, 0)

    def test_stars_trail_as_the_earth_turns(self):
        """A camera at rest, against astropy's world coordinates: 0.03 px, for the pole precesses; behind one that
        follows the stars they stand still."""
        for sensor, turns in (("west", 1), ("east", 0)):
            frame = next(iter(dmise.Simulation(NIGHT).frames(sensor)))
            middle = np.array([frame.header["NAXIS1"] - 1, frame.header["NAXIS2"] - 1]) / 2
            ra_deg, dec_deg = frame.wcs.all_pix2world([middle], 0)[0]
            turned_deg = turns * 15.0410687 / 3600 * frame.header["EXPTIME"]
            moved = frame.wcs.all_world2pix([[ra_deg - turned_deg, dec_deg]], 0)[0] - middle
            trail = dmise.SensorFrame(sensor, 1, 0, frame.counts, dict(frame.header)).star_trail_px
            np.testing.assert_allclose(trail, moved, atol=0.03)
            self.assertEqual(np.hypot(*trail) > 5, turns == 1)

    def test_an_empty_table_has_all_fields(self):
        alone = NIGHT.replace("objects: [{catalogue: demo}]", "detection: off").replace(
            WEST, "zenith").replace(EAST, "zenith")
        frame = next(dmise.Simulation(alone).frames("west"))
        self.assertEqual((len(frame.truth), len(frame.detections)), (0, 0))
        self.assertEqual(frame.detections["covariance_rad2"].shape, (0, 3))
        self.assertEqual(len(frame.truth.to_pandas()), 0)

    def test_tables_of_pandas(self):
        truth = next(dmise.Simulation(NIGHT).frames("west")).truth
        table = truth.to_pandas()
        self.assertIsInstance(table, pandas.DataFrame)
        self.assertEqual(len(table), len(truth))
        np.testing.assert_array_equal(table["true_range_m"], truth["true_range_m"])


if __name__ == "__main__":
    package.main()
