"""Detection and solution of images of any camera, and what bad input does.

    engine_cameras.py [DMISE [TEST..]]
"""
import unittest

import package

package.require("numpy", "dmise.engine")
import numpy as np  # noqa: E402

import dmise  # noqa: E402
from package import ROOT  # noqa: E402
from scenarios import NIGHT  # noqa: E402


def header_of(frame):
    """What a camera of another make says of a frame."""
    return {"DATE-OBS": frame.header["DATE-OBS"], "EXPTIME": 8.0, "FOCALLEN": 200.0, "XPIXSZ": 9.0, "YPIXSZ": 9.0,
            "RA": np.degrees(frame.report.boresight_ra_rad), "DEC": np.degrees(frame.report.boresight_dec_rad),
            "SITELAT": 33.0, "SITELONG": -100.0, "GAIN": 1.0}


class Images(unittest.TestCase):
    def test_detect_gives_the_detections_of_the_run(self):
        for frame in dmise.Simulation(NIGHT).frames("west"):
            found = dmise.detect(frame)
            self.assertGreater(len(found), 0)
            self.assertEqual(list(found["id"]), list(frame.detections["id"]))
            np.testing.assert_array_equal(found["x_px"], frame.detections["x_px"])
            self.assertEqual(found.report.psf_fwhm_px, frame.report.psf_fwhm_px)
            self.assertEqual(found[:1].report, found.report)
            stars = ROOT / "launch/catalogues/stars.dat.gz"
            np.testing.assert_array_equal(dmise.detect(frame, catalogue=stars)["x_px"], found["x_px"])

    def test_detect_and_solve_take_any_image(self):
        frame = next(dmise.Simulation(NIGHT).frames("east"))
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
        frame = next(dmise.Simulation(NIGHT).frames("east"))
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


if __name__ == "__main__":
    package.main()
