"""A telescope that follows a geostationary satellite, in SatSim's own API: 512 x 512 pixels, 8 frames of 1 s, Gaussian blur."""
from satsim import image_generator
from satsim.config import transform

MAGNITUDES = [1.0, 0.0, 0.019, 0, 0.0056, 0.017, 0.036, 0.039, 0.097, 0.67, 2.5, 5.0, 10.3, 24.3, 35.2]  # stars of a square degree
SCENE = {
    "version": 1,
    "sim": {"mode": "fftconv2p", "spacial_osf": 3, "temporal_osf": 100, "padding": 100, "samples": 1},
    "fpa": {
        "height": 512, "width": 512, "y_fov": 1.32, "x_fov": 1.32, "dark_current": 0.1, "gain": 1, "bias": 100, "zeropoint": 19.06,
        "a2d": {"response": "linear", "fwc": 60000, "gain": 1, "bias": 100, "dtype": "uint16"},
        "noise": {"read": 5, "electronic": 0}, "psf": {"mode": "gaussian", "eod": 0.5},
        "time": {"exposure": 1.0, "gap": 4.0}, "num_frames": 8},
    "background": {"stray": {"mode": "none"}, "galactic": 20.6},
    "geometry": {
        "time": [2018, 1, 21, 3, 0, 0],
        "site": {
            "mode": "topo", "lat": "33 N", "lon": "100 W", "alt": 0.3, "gimbal": {"mode": "wcs", "rotation": 0},
            "track": {"mode": "rate", "tle1": TLE[0], "tle2": TLE[1]}},
        "stars": {"mode": "bins", "mv": {"bins": [*range(-1, 15)], "density": MAGNITUDES},
                  "motion": {"mode": "affine", "rotation": 0, "translation": [0, -8]}},
        "obs": {"mode": "list", "list": [{"mode": "tle", "tle1": TLE[0], "tle2": TLE[1], "mv": 11.0}]}}}

for image, number, *_ in image_generator(transform(SCENE, "."), ".", with_meta=True, num_sets=1):
    if image is not None:
        made(image)
