"""Frames of all kinds that telescopes take, drawn by GalSim from seeds, as FITS files with ordinary cards.

A frame is drawn from its seed alone: mount (on the stars, on a target, at rest), 16 kinds of point spread, 0.2 to 90 deg
across (4 deg where stars trail),
20 to 3000 stars above SNR 6 a megapixel, 12, 14 or 16 bits, every eighth one with a colour mosaic. Pixels count from 0.
"""

import dataclasses
import pathlib

import numpy as np
from astropy.io import fits

import galsim

MOUNTS = ("sidereal", "target", "rest")
READ_E, FULL_E, BIAS_DN = 7.0, 50000.0, 200.0
PHASES = 6  # places within a pixel, of either axis, at which GalSim draws
EDGE_PX = 40  # objects keep so far from the frame's edge
SLOPE = 0.45  # growth of the logarithm of star counts, per magnitude
FAINTER_MAG = 2.5  # stars are drawn to so far below SNR 6
BAYER_SHARES = ((0.55, 0.9), (0.9, 0.5))  # parts of the light that colours pass: red, green; green, blue
PRECISE = galsim.GSParams(maximum_fft_size=16384)


def optical(fwhm, **aberrations):
    return galsim.OpticalPSF(lam_over_diam=fwhm / 1.029, gsparams=PRECISE, **aberrations)


PSFS = {
    "Gaussian 1.3": lambda: galsim.Gaussian(fwhm=1.3), "Gaussian 2": lambda: galsim.Gaussian(fwhm=2),
    "Gaussian 4": lambda: galsim.Gaussian(fwhm=4), "Airy 1.5": lambda: galsim.Airy(lam_over_diam=1.46, gsparams=PRECISE),
    "Airy 3": lambda: galsim.Airy(lam_over_diam=2.92, gsparams=PRECISE),
    "obscured Airy 2": lambda: galsim.Airy(lam_over_diam=2.04, obscuration=0.3, gsparams=PRECISE),
    "Moffat 2.5, 2": lambda: galsim.Moffat(beta=2.5, fwhm=2), "Moffat 2.5, 4": lambda: galsim.Moffat(beta=2.5, fwhm=4),
    "Moffat 4.5, 3": lambda: galsim.Moffat(beta=4.5, fwhm=3), "Kolmogorov 2": lambda: galsim.Kolmogorov(fwhm=2),
    "Kolmogorov 5": lambda: galsim.Kolmogorov(fwhm=5),
    "elongated 0.8": lambda: galsim.Moffat(beta=3, fwhm=2.5).shear(q=0.8, beta=0.6 * galsim.radians),
    "elongated 0.65": lambda: galsim.Gaussian(fwhm=3).shear(q=0.65, beta=2.0 * galsim.radians),
    "coma": lambda: galsim.Convolve(optical(2, coma1=0.12), galsim.Gaussian(fwhm=1.2)),
    "astigmatism": lambda: galsim.Convolve(optical(2, defocus=0.1, astig1=0.12), galsim.Gaussian(fwhm=1.2)),
    "with a halo": lambda: 0.85 * galsim.Gaussian(fwhm=2) + 0.15 * galsim.Gaussian(fwhm=9),
}


@dataclasses.dataclass
class Object:
    x_px: float
    y_px: float
    length_px: float  # 0: a point
    angle_rad: float
    snr: float  # after the ideal filter, in the noise of sky, stars and read-out

    def distance_px(self, x, y):
        """From its line, of places in arrays."""
        c, s = np.cos(self.angle_rad), np.sin(self.angle_rad)
        along = np.clip((x - self.x_px) * c + (y - self.y_px) * s, -self.length_px / 2, self.length_px / 2)
        return np.hypot(x - self.x_px - along * c, y - self.y_px - along * s)


@dataclasses.dataclass
class Frame:
    path: pathlib.Path
    mount: str
    psf: str
    fwhm_px: float
    gain_e_per_dn: float
    saturation_dn: float
    megapixels: float
    stars: float  # above SNR 6, a megapixel
    objects: list

    def header(self):
        """What other programs are told of the frame."""
        return {"PSFFWHM": self.fwhm_px, "GAIN": self.gain_e_per_dn, "SATURATE": self.saturation_dn}


class Shape:
    """GalSim's images of one shape of unit light, drawn once for each place within a pixel."""

    def __init__(self, psf, length_px, angle_rad):
        self.profile, self.drawn = psf, {}
        if length_px > 0:
            line = galsim.Box(length_px, 0.01, gsparams=PRECISE).rotate(angle_rad * galsim.radians)
            self.profile = galsim.Convolve(psf, line, gsparams=PRECISE)
        self.reach = int(length_px / 2 + 25) + 1

    def stamp(self, x, y):
        """Image of a source at the nearest of the phases, and its corner."""
        ix, iy = int(np.floor(x)), int(np.floor(y))
        phase = int((x - ix) * PHASES), int((y - iy) * PHASES)
        if phase not in self.drawn:
            n = 2 * self.reach + 1
            offset = tuple((p + 0.5) / PHASES for p in phase)
            self.drawn[phase] = self.profile.drawImage(nx=n, ny=n, scale=1.0, dtype=float, offset=offset).array
        return self.drawn[phase], ix - self.reach, iy - self.reach

    def cut(self, side, x, y):
        """(slices of a frame, the stamp on them)."""
        stamp, x0, y0 = self.stamp(x, y)
        n = stamp.shape[0]
        left, top = max(0, x0), max(0, y0)
        right, bottom = max(left, min(side, x0 + n)), max(top, min(side, y0 + n))
        return (slice(top, bottom), slice(left, right)), stamp[top - y0:bottom - y0, left - x0:right - x0]

    def add(self, image, x, y, light_e):
        at, stamp = self.cut(image.shape[0], x, y)
        if stamp.size:
            image[at] += light_e * stamp

    def peak_norm(self):
        """SNR of unit light in unit noise."""
        return float(np.sqrt(np.sum(self.stamp(0.5, 0.5)[0] ** 2)))

    @staticmethod
    def placed(value):
        """A coordinate moved to its phase."""
        return float(np.floor(value) + (np.floor((value - np.floor(value)) * PHASES) + 0.5) / PHASES)


def star_lights(random, count_seen, at_limit_e):
    """Light of all stars down to FAINTER_MAG below the limit, of which so many are above it."""
    count = random.poisson(count_seen * 10 ** (SLOPE * FAINTER_MAG))
    magnitudes = FAINTER_MAG + np.log10(np.maximum(random.uniform(0, 1, count), 1e-9)) / SLOPE  # 0: at the limit
    return at_limit_e * 10 ** (-0.4 * magnitudes)


def add_object(image, starlight, noise_e, psf, random, line):
    side = image.shape[0]
    shape = Shape(psf, *line)
    reach = EDGE_PX + line[0] / 2
    x, y = (Shape.placed(v) for v in random.uniform(min(reach, side / 2 - 1), max(side - reach, side / 2 + 1), 2))
    signal_e = 6 * 10 ** random.uniform(0, 1) * noise_e / shape.peak_norm()
    at, stamp = shape.cut(side, x, y)
    snr = signal_e * np.sqrt(np.sum(stamp**2 / (noise_e**2 + starlight[at])))
    image[at] += signal_e * stamp
    return Object(x, y, *line, float(snr))


def star_trail(random, mount):
    """(length [px], angle [rad]) of the trails of stars."""
    lengths = {"sidereal": (0, 0), "target": (10, 120), "rest": (2, 15)}[mount]
    length = np.exp(random.uniform(*np.log(lengths))) if lengths[0] else 0.0
    return float(length), float(random.uniform(0, np.pi))


def draw(directory, seed):
    """Writes the frame of a seed."""
    random = np.random.default_rng([seed, 77])
    mount, side = MOUNTS[seed % 3], int(random.choice([512, 768, 1024]))
    psf_name = list(PSFS)[random.integers(len(PSFS))]
    psf, trail = PSFS[psf_name](), star_trail(random, mount)
    # In wide fields trails differ from place to place, which these frames do not draw.
    sky_e, wide_deg = 10 ** random.uniform(1.7, 3.3), 0.2 * (450 if mount == "sidereal" else 20) ** random.uniform(0, 1)
    noise_e, megapixels = float(np.hypot(np.sqrt(sky_e), READ_E)), side * side / 1e6
    stars_per_mpx = 20 * 150 ** random.uniform(0, 1)
    starlight, star = np.zeros((side, side)), Shape(psf, *trail)
    reach = 30 + trail[0] / 2
    for light_e in star_lights(random, stars_per_mpx * (side + 2 * reach) ** 2 / 1e6, 6 * noise_e / star.peak_norm()):
        star.add(starlight, *random.uniform(-reach, side + reach, 2), light_e)
    image, objects = starlight + sky_e, []
    for _ in range(4):
        line = (15 * 20 ** random.uniform(0, 1), trail[1] + random.uniform(0.3, np.pi - 0.3))
        objects.append(add_object(image, starlight, noise_e, psf, random, (float(line[0]), float(line[1]))))
    for _ in range(4 if trail[0] >= 8 else 0):  # where stars are points an exposure does not tell an object from one
        objects.append(add_object(image, starlight, noise_e, psf, random, (0.0, 0.0)))
    bits, mosaic = int(random.choice([12, 14, 16])), seed % 8 == 7
    if mosaic:
        image *= np.tile(BAYER_SHARES, (side // 2, side // 2))
    gain = FULL_E / (2**bits - 1 - BIAS_DN)
    electrons = np.minimum(random.poisson(image), FULL_E) + READ_E * random.standard_normal(image.shape)
    counts = np.clip(np.rint(electrons / gain + BIAS_DN), 0, 2**bits - 1).astype(np.uint16)
    path = pathlib.Path(directory) / f"galsim-{seed}.fits"
    fits.PrimaryHDU(counts, cards(random, wide_deg / side, gain, 2**bits - 1, mosaic)).writeto(path, overwrite=True)
    fwhm_px = float(psf.drawImage(nx=81, ny=81, scale=0.5).calculateFWHM())
    return Frame(path, mount, psf_name, fwhm_px, gain, 0.98 * (2**bits - 1), megapixels, stars_per_mpx, objects)


def cards(random, deg_per_px, gain, most_dn, mosaic):
    """What a camera's program writes."""
    header = fits.Header()
    header["EXPTIME"], header["DATE-OBS"] = 5.0, "2024-03-05T20:15:30.000"
    header["EGAIN"], header["BIASLVL"], header["SATURATE"] = gain, BIAS_DN, most_dn
    header["XPIXSZ"], header["YPIXSZ"] = 6.0, 6.0
    header["FOCALLEN"] = 6e-3 / np.radians(deg_per_px)
    header["RA"], header["DEC"] = random.uniform(0, 360), random.uniform(-60, 80)
    header["FILTER"] = "V"
    if mosaic:
        header["BAYERPAT"] = "RGGB"
    return header
