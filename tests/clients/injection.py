"""Objects in frames that are given: type, saturation, pixels without a value, mirrored frames, and bad input.

    injection.py [DMISE [TEST..]]
"""
import io
import unittest

import package

package.require("astropy", "numpy", "dmise.engine")
import astropy.io.fits  # noqa: E402
import numpy as np  # noqa: E402

import dmise  # noqa: E402
from scenarios import sensor  # noqa: E402


def night(radius_m):
    return ("simulation: {start: 2018-01-21T03:00:00Z, duration_s: 10, tick_s: 5, seed: 7}\n"
            f"objects: [{{catalogue: demo, only: [GOES 13], radius_m: {radius_m}}}]\nstars: {{catalogue: kstars}}\nsensors:\n" +
            sensor("west", "{target: GOES 13, tracking: sidereal, roll_deg: 20, offset_deg: [0.02, -0.03]}", columns=96, rows=64,
                   gain_e_per_dn=2, exposure_s=5))


WITH, WITHOUT = night(2), night(1e-4)
STATED = {"zero_point_mag": 20.0, "gain_e_per_dn": 2.0, "psf_fwhm_px": 2.0, "tracking": "sidereal", "catalogue": "none"}


def wcs_cards(frame):
    """What another camera's header would say of a simulated frame."""
    header = astropy.io.fits.getheader(io.BytesIO(frame.to_fits()))
    names = ("CTYPE", "CRPIX", "CRVAL", "CD1_", "CD2_", "A_", "B_", "AP_", "BP_", "LONPOLE", "RADESYS", "DATE-OBS", "EXPTIME")
    return {key: header[key] for key in header if key.startswith(names)}


class Injections(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rendered = next(dmise.Simulation(WITH).frames(layers=True))
        cls.empty = next(dmise.Simulation(WITHOUT).frames())
        cls.cards = wcs_cards(cls.empty)

    def test_the_light_is_that_of_a_rendered_object(self):
        """The engine's own drawing by another way: places to 0.002 px, light to 0.1 %, pixels to 1 % of the brightest."""
        made = dmise.inject(self.empty, None, WITH, seed=7)  # scintillation is drawn by the scenario's seed
        row, truth = made.labels[0], self.rendered.truth[self.rendered.truth["in_frame"]][0]
        for ours, theirs in (("start_x_px", "start_x_px"), ("end_y_px", "end_y_px"), ("x_px", "rendered_x_px")):
            self.assertAlmostEqual(row[ours], truth[theirs], delta=0.002)
        self.assertAlmostEqual(row["signal_e"] / truth["rendered_signal_e"], 1.0, delta=1e-3)
        self.assertAlmostEqual(row["magnitude"], truth["true_magnitude"], delta=1e-6)
        objects = self.rendered.layers("objects")
        self.assertLess(np.abs(made.light - objects).max(), 0.01 * objects.max())
        self.assertLess(made.facts["geometry_px"], 0.01)
        np.testing.assert_array_equal(made.mask > 0, self.rendered.mask > 0)
        added = made.image.astype(int) - self.empty.counts
        self.assertLess(abs(2.0 * added.sum() / row["signal_e"] - 1.0), 5.0 / np.sqrt(row["signal_e"]) + 0.002)

    def test_the_seed_decides(self):
        images = [dmise.inject(self.empty, None, WITH, seed=seed).image for seed in (1, 1, 2)]
        np.testing.assert_array_equal(images[0], images[1])
        self.assertTrue((images[0] != images[2]).any())

    def test_types_are_kept(self):
        for kind in ("u2", ">i4", "f4", ">f8"):
            image = self.empty.counts.astype(kind)
            kept = image.copy()
            made = dmise.inject(image, self.cards, WITH, **STATED)
            self.assertEqual((made.image.dtype, made.image.shape), (image.dtype, image.shape))
            np.testing.assert_array_equal(image, kept)
            lit = made.light > 0.0
            self.assertTrue(lit.any() and (made.image != image).any())
            np.testing.assert_array_equal(made.image[~lit], image[~lit])

    def test_pixels_saturate(self):
        image = self.empty.counts.copy()
        image[0, 0] = 5000
        made = dmise.inject(image, self.cards, night(200), saturation_dn=1000.0, **STATED)
        self.assertEqual((made.image[made.mask > 0].max(), made.image[0, 0]), (1000, 5000))
        bright = dmise.inject(image.astype("u1"), self.cards, night(200), **STATED)
        self.assertEqual(bright.image.max(), 255)

    def test_pixels_without_a_value_stay(self):
        image = self.empty.counts.astype("f4")
        image[20:40, 40:50] = np.nan
        made = dmise.inject(image, self.cards, WITH, **STATED)
        np.testing.assert_array_equal(np.isnan(made.image), np.isnan(image))

    def test_masked_pixels_stay(self):
        """Those where the light would be."""
        lit = dmise.inject(self.empty.counts, self.cards, WITH, **STATED).light > 0.0
        image = np.ma.masked_array(self.empty.counts.copy(), lit)
        made = dmise.inject(image, self.cards, WITH, **STATED)
        np.testing.assert_array_equal(made.image.mask, lit)
        np.testing.assert_array_equal(made.image.data, image.data)

    def test_numbers_that_their_type_does_not_hold(self):
        image = self.empty.counts.astype("f2")
        made = dmise.inject(image, self.cards, WITH, **(STATED | {"gain_e_per_dn": 1e-10}))
        self.assertEqual(made.image[made.mask > 0].max(), np.finfo("f2").max)

    def test_large_numbers_stay_large(self):
        """The largest of 64 bits are those that a float does not hold."""
        image = self.empty.counts.astype("i8")
        image[self.rendered.mask > 0] = np.iinfo("i8").max
        made = dmise.inject(image, self.cards, night(200), **STATED)
        self.assertGreater(made.image[self.rendered.mask > 0].min(), 2**62)

    def test_mirrored_frames(self):
        """Rows from the bottom up: the same light in the other order."""
        cards = dict(self.cards)
        cards["CRPIX2"] = 65.0 - cards["CRPIX2"]
        for key in ("CD1_2", "CD2_2"):
            cards[key] = -cards[key]
        for key in [key for key in cards if key[0] in "AB" and "_" in key]:
            del cards[key]
        cards |= {"CTYPE1": "RA---TAN", "CTYPE2": "DEC--TAN"}
        plain = {key: value for key, value in self.cards.items() if not (key[0] in "AB" and "_" in key)}
        plain |= {"CTYPE1": "RA---TAN", "CTYPE2": "DEC--TAN"}
        straight = dmise.inject(self.empty.counts, plain, WITH, **STATED)
        mirrored = dmise.inject(self.empty.counts[::-1], cards, WITH, **STATED)
        self.assertLess(np.abs(mirrored.light[::-1] - straight.light).max(), 0.01 * straight.light.max())
        self.assertAlmostEqual(mirrored.labels["start_y_px"][0], 63.0 - straight.labels["start_y_px"][0], delta=0.01)

    def test_the_frames_stars_tell_the_zero_point(self):
        """A frame whose header tells no zero point: light as of the rendered object to 3 %, at the place by the solved plate."""
        wide = WITH.replace("columns: 96, rows: 64", "columns: 400, rows: 300").replace("focal_length_m: 0.2", "focal_length_m: 0.05")
        rendered = next(dmise.Simulation(wide).frames())
        empty = next(dmise.Simulation(wide.replace("radius_m: 2", "radius_m: 1e-4")).frames())
        truth = rendered.truth[rendered.truth["in_frame"]][0]
        header = {key: value for key, value in wcs_cards(empty).items() if not key.startswith(("A_", "B_", "AP_", "BP_"))}
        header |= {"CTYPE1": "RA---TAN", "CTYPE2": "DEC--TAN", "GAIN": 2.0}
        made = dmise.inject(empty.counts, header, wide, seed=7)
        self.assertAlmostEqual(made.labels["signal_e"][0] / truth["rendered_signal_e"], 1.0, delta=0.03)
        self.assertAlmostEqual(made.labels["x_px"][0], truth["rendered_x_px"], delta=0.1)
        self.assertAlmostEqual(made.labels["y_px"][0], truth["rendered_y_px"], delta=0.1)
        self.assertAlmostEqual(made.facts["psf_fwhm_px"], 2.0, delta=0.2)

    def test_light_follows_the_zero_point(self):
        bright, faint = (dmise.inject(self.empty.counts, self.cards, WITH, **(STATED | {"zero_point_mag": zero_point}))
                         for zero_point in (21.0, 18.5))
        self.assertAlmostEqual(bright.labels["signal_e"][0] / faint.labels["signal_e"][0], 10.0, delta=1e-3)

    def test_distributions_are_drawn(self):
        scenario = WITH.replace("radius_m: 2", "radius_m: {uniform: [1, 4]}")
        signals = {float(dmise.inject(self.empty, None, scenario, seed=seed).labels["signal_e"][0]) for seed in range(3)}
        self.assertEqual(len(signals), 3)

    def test_bad_input_is_one_line(self):
        image, cards = self.empty.counts, self.cards
        def without(*names):
            return {key: value for key, value in cards.items() if not key.startswith(names)}
        for header, scenario, stated, reason in (
                (without("DATE"), WITH, {}, "the time is not known; DATE-OBS"), (without("EXPTIME"), WITH, {}, "EXPTIME tells it"),
                (without("C", "A_", "B_"), WITH, {}, "the pointing is not known"),
                (cards, WITH, {"zero_point_mag": None}, "zero_point_mag: is not known"),
                (cards, WITH, {"psf_fwhm_px": -1.0}, "psf_fwhm_px: must be a number > 0, got -1.0"),
                (cards, WITH, {"zero_point_mag": float("nan")}, "zero_point_mag: must be a number, got nan"),
                (cards, WITH, {"zero_point_mag": 1e300}, "zero_point_mag: must be in -100..100"),
                (cards, WITH, {"zero_point_mag": 90.0}, "zero_point_mag: gives a pixel more than 1e[+]15 electrons"),
                (cards, WITH, {"gain_e_per_dn": 1e300}, "gain_e_per_dn: must be in 1e-30..1e30"),
                (cards, WITH, {"tracking": "comet"}, 'must be "sidereal" or "fixed"'),
                (cards, WITH, {"sensor": "est"}, "no sensor is named est"),
                (cards, WITH.replace("radius_m: 2", "radius_m: -2"), {}, "radius_m: must be > 0"),
                (cards, WITH + WITH[WITH.index("  - name"):].replace("west", "east"), {}, "sensor: must name one of the 2")):
            with self.assertRaisesRegex(dmise.InputError, reason) as caught:
                dmise.inject(image, header, scenario, **(STATED | stated))
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(dmise.InputError, "two rows and two columns or more"):
            dmise.inject(image[:1, :1], cards, WITH, **STATED)


if __name__ == "__main__":
    package.main()
