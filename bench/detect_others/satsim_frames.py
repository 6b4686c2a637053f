"""Frames by SatSim from seeds: FITS files with ordinary cards, and the truth of all as JSON on stdout. Runs under SatSim's Python.

    satsim_frames.py DIRECTORY FIRST_SEED COUNT

512 x 512 pixels, 1.3 deg: even seeds follow the stars, odd ones a target (stars trail by 8 to 60 px). Four streaks, and
four points where stars trail, of V = 12 to 15.5 (longer ones brighter) on a sky of 20 to 21.5 mag/arcsec2.
"""

import json
import pathlib
import sys

import numpy as np
from astropy.io import fits
from satsim import image_generator
from satsim.config import transform

SIDE, FIELD_DEG, EXPOSURE_S, ZERO_POINT, READ_E, BIAS_DN, FULL_E = 512, 1.32, 2.0, 21.0, 6.0, 100, 60000
MAGNITUDES = [1.0, 0.0, 0.019, 0, 0.0056, 0.017, 0.036, 0.039, 0.097, 0.67, 2.5, 5.0, 10.3, 24.3, 35.2, 90.0]  # a square degree


def scene(random, objects, stars_px_per_s):
    return {
        "version": 1,
        "sim": {"mode": "fftconv2p", "spacial_osf": 3, "temporal_osf": 100, "padding": 100, "samples": 1},
        "fpa": {
            "height": SIDE, "width": SIDE, "y_fov": FIELD_DEG, "x_fov": FIELD_DEG, "dark_current": 0.3, "gain": 1, "bias": 0,
            "zeropoint": ZERO_POINT, "a2d": {"response": "linear", "fwc": FULL_E, "gain": 1, "bias": BIAS_DN, "dtype": "uint16"},
            "noise": {"read": READ_E, "electronic": 0}, "psf": {"mode": "gaussian", "eod": float(random.uniform(0.2, 0.6))},
            "time": {"exposure": EXPOSURE_S, "gap": 1.0}, "num_frames": 1},
        "background": {"stray": {"mode": "none"}, "galactic": float(random.uniform(20, 21.5))},
        "geometry": {
            "stars": {"mode": "bins", "mv": {"bins": list(range(-1, 16)), "density": MAGNITUDES},
                      "motion": {"mode": "affine", "rotation": 0, "translation": list(stars_px_per_s)}},
            "obs": {"mode": "list", "list": objects}}}


def drawn_objects(random, with_points, star_angle):
    """SatSim's list, and each with its line in pixels: rows and columns of the start are shares of the frame."""
    listed, truth = [], []
    for i in range(8 if with_points else 4):
        length = 0.0 if i >= 4 else float(12 * 15 ** random.uniform(0, 1))
        angle = float(star_angle + random.uniform(0.3, np.pi - 0.3))
        middle = random.uniform(60 + length / 2, SIDE - 60 - length / 2, 2)  # row, column
        along = np.array([np.sin(angle), np.cos(angle)])
        start = (middle - along * length / 2) / SIDE
        listed.append({"mode": "line", "origin": start.tolist(), "velocity": (along * length / EXPOSURE_S).tolist(),
                       "mv": float(random.uniform(12, 15.5) - 2.5 * np.log10(max(length, 4) / 30) * 0.5)})
        truth.append({"x_px": float(middle[1]), "y_px": float(middle[0]), "length_px": length, "angle_rad": angle})
    return listed, truth


def psf_noise(target, image_noise_e2):
    """SNR of the ideal filter: of the noiseless light of an object in the noise of the rest."""
    return float(np.sqrt(np.sum(target**2 / image_noise_e2)))


def draw(directory, seed):
    random = np.random.default_rng([seed, 78])
    np.random.seed(seed)
    follows_target = seed % 2 == 1
    angle = float(random.uniform(0, np.pi))
    length = float(8 * 7.5 ** random.uniform(0, 1)) if follows_target else 0.0
    speed = np.array([np.sin(angle), np.cos(angle)]) * length / EXPOSURE_S
    listed, truth = drawn_objects(random, follows_target, angle)
    said = transform(scene(random, listed, speed), ".")
    image, _, _, _, stars, targets, *rest = next(image_generator(said, ".", with_meta=True, num_sets=1))
    image, stars, targets = (np.asarray(part) for part in (image, stars, targets))
    noise_e2 = stars + sky_e(rest[0]) + READ_E**2
    for item in truth:
        item["snr"] = psf_noise(light_near(targets, item), noise_e2)
    path = pathlib.Path(directory) / f"satsim-{seed}.fits"
    fits.PrimaryHDU(image.astype(np.uint16), cards()).writeto(path, overwrite=True)
    return {"path": str(path), "mount": "target" if follows_target else "sidereal", "objects": truth,
            "trail_px": length, "fwhm_px": width_px(targets, truth)}


def sky_e(background):
    return float(np.median(np.asarray(background)))


def light_near(targets, item, reach=9):
    """The light of an object alone: what is within `reach` of its line."""
    y, x = np.indices(targets.shape)
    c, s = np.cos(item["angle_rad"]), np.sin(item["angle_rad"])
    along = np.clip((x - item["x_px"]) * c + (y - item["y_px"]) * s, -item["length_px"] / 2, item["length_px"] / 2)
    near = np.hypot(x - item["x_px"] - along * c, y - item["y_px"] - along * s) < reach
    return np.where(near, targets, 0.0)


def width_px(targets, truth):
    """FWHM by the width across the brightest streak."""
    item = max((t for t in truth if t["length_px"] > 0), key=lambda t: t["snr"])
    light = light_near(targets, item)
    y, x = np.indices(light.shape)
    across = -(x - item["x_px"]) * np.sin(item["angle_rad"]) + (y - item["y_px"]) * np.cos(item["angle_rad"])
    return float(2.355 * np.sqrt(np.sum(light * across**2) / np.sum(light)))


def cards():
    header = fits.Header()
    header["EXPTIME"], header["DATE-OBS"] = EXPOSURE_S, "2024-03-05T20:15:30.000"
    header["EGAIN"], header["BIASLVL"], header["SATURATE"] = 1.0, float(BIAS_DN), FULL_E
    header["XPIXSZ"], header["FOCALLEN"] = 9.0, 9e-3 / np.radians(FIELD_DEG / SIDE)
    header["RA"], header["DEC"], header["FILTER"] = 120.0, 30.0, "V"
    return header


if __name__ == "__main__":
    out, first, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    print(json.dumps([draw(out, seed) for seed in range(first, first + count)]))
