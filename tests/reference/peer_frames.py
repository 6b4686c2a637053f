"""Frames with known streaks and points, by GalSim and by DMISE's own renderer.

A Scene is a FITS file that `dmise detect` reads, and what is truly in it. Pixels count from 0. A line is an array of
n x 2 pixels along a trail. GalSim draws photons (Poisson noise is theirs) on a sky of 1500 e-/px and adds read noise; the
header is that of an exposure of the same camera by DMISE.
"""

import dataclasses
import json
import pathlib
import subprocess

import numpy as np
from astropy.io import fits

import referee

SKY_E = 1500.0
SIDE_PX = 1000
PITCH_M, FOCAL_M = 9e-6, 0.015  # 1667 px: in 20 s stars trail by up to 2.4 px where the mount is fixed

CAMERA = f"""
name: peers
optics: {{projection: gnomonic, columns: {SIDE_PX}, rows: {SIDE_PX}, pixel_pitch_m: {PITCH_M}, focal_length_m: {FOCAL_M},
         aperture_m: 0.01, transmission: 0.8, psf_fwhm_px: 1.7}}
detector: {{quantum_efficiency: 0.5, read_noise_e: 9.3, full_well_e: 32000, gain_e_per_dn: 0.5, bias_dn: 100, adc_bits: 16}}
band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}
"""
EMPTY = """
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5, seed: 1}
objects: [{catalogue: demo, only: [GOES 13]}]
output: {png: false}
sensors:
  - {name: tracked, site: atlanta, camera: peers.yaml, pointing: {ra_deg: 60, dec_deg: 34}, exposure_s: 20, cadence_s: 20}
  - {name: fixed, site: atlanta, camera: peers.yaml, pointing: {azimuth_deg: 180, elevation_deg: 80}, exposure_s: 20,
     cadence_s: 20}
"""
NIGHT = """
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 5, seed: 1}}
objects: [{{catalogue: population.tle, radius_m: {radius_m}}}]
stars: {{catalogue: kstars}}
detection: off
output: {{png: false, truth: true}}
sensors:
"""
NIGHT_SENSOR = """  - {{name: {site}, site: {site}, camera: omnissa, pointing: zenith, exposure_s: 20, cadence_s: 30, sky: dark}}
"""


@dataclasses.dataclass
class Streak:
    line_px: np.ndarray  # n x 2
    signal_e: float
    snr: float  # by the ideal matched filter

    @property
    def length_px(self):
        return float(np.sum(np.hypot(*np.diff(self.line_px, axis=0).T)))


@dataclasses.dataclass
class Scene:
    path: pathlib.Path
    streaks: list = dataclasses.field(default_factory=list)
    others: list = dataclasses.field(default_factory=list)  # lines of true objects that are no streaks to be found
    points: np.ndarray = None  # n x 3: x, y [px], signal [e-]

    def counts(self):
        with fits.open(self.path) as hdus:
            return np.asarray(next(h for h in hdus if h.data is not None).data, dtype=np.float64)

    def header(self):
        with fits.open(self.path) as hdus:
            return next(h for h in hdus if h.data is not None).header


def sigma_px(fwhm_px):
    """Gaussian width of the point spread with the pixel."""
    return float(np.sqrt(fwhm_px**2 / (8 * np.log(2)) + 1 / 12))


def ideal_snr(signal_e, length_px, noise_e, sigma):
    """SNR of the matched filter in white noise: a line of evenly spread light, blurred."""
    length_px = max(length_px, 2 * np.sqrt(np.pi) * sigma)
    return signal_e / (noise_e * np.sqrt(2 * np.sqrt(np.pi) * sigma * length_px))


def noise_dn(counts):
    """Noise of a pixel, whatever the sky's slope: by differences of neighbours."""
    return 1.4826 * float(np.median(np.abs(np.diff(counts)))) / np.sqrt(2)


def run_scenario(dmise, directory, text, files=()):
    """Runs a scenario in `directory`; returns the directory of its products."""
    directory.mkdir(parents=True, exist_ok=True)
    for name, content in (("scenario.yaml", text), *files):
        (directory / name).write_text(content)
    done = subprocess.run([dmise, "run", "scenario.yaml", "--out", "out", "--force"], cwd=directory, text=True,
                          capture_output=True)
    if done.returncode != 0:
        raise referee.Failure(f"dmise run: {done.stderr.strip()[-300:]}")
    return directory / "out"


def templates(dmise, directory):
    """{mount: FITS file} of exposures whose headers GalSim's frames take."""
    products = run_scenario(dmise, directory, EMPTY, [("peers.yaml", CAMERA)])
    return {mount: products / mount / "frame-000001.fits" for mount in ("tracked", "fixed")}


def star_trail(header, places):
    """n x 2: from start to end of a star's trail [px] at n x 2 places; the projection is gnomonic."""
    def attitude(key):
        w, x, y, z = (header[f"{key}{i}"] for i in range(4))
        return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    middle = (SIDE_PX - 1) / 2
    focal = header["FOCALPX"]
    camera = np.column_stack([(places - middle) / focal, np.ones(len(places))])
    sky = camera @ attitude("QAVG")
    ends = [sky @ attitude(key).T for key in ("QBEG", "QEND")]
    pixels = [focal * end[:, :2] / end[:, 2:] for end in ends]
    return pixels[1] - pixels[0]


class GalSimSky:
    """Photons of one frame."""

    def __init__(self, header, seed):
        import galsim
        self.galsim, self.header = galsim, header
        self.photons = galsim.BaseDeviate(seed)
        self.random = np.random.default_rng(seed)
        self.image = galsim.ImageF(SIDE_PX, SIDE_PX, scale=1)
        self.psf = galsim.Gaussian(fwhm=header["PSFFWHM"])

    def add(self, x, y, dx, dy, signal_e):
        """A line of light from (x, y) - (dx, dy) / 2 to (x, y) + (dx, dy) / 2, or a point."""
        galsim = self.galsim
        length = float(np.hypot(dx, dy))
        profile = self.psf
        if length > 0:
            box = galsim.Box(length, 1e-6).rotate(float(np.arctan2(dy, dx)) * galsim.radians)
            profile = galsim.Convolve(self.psf, box)
        reach = int(length / 2 + 6 * self.header["PSFFWHM"]) + 1
        around = galsim.BoundsI(int(x) + 1 - reach, int(x) + 2 + reach, int(y) + 1 - reach, int(y) + 2 + reach)
        around = around & self.image.bounds
        if around.isDefined():
            profile.withFlux(signal_e).drawImage(image=self.image[around], method="phot", rng=self.photons,
                                                 add_to_image=True, center=galsim.PositionD(x + 1, y + 1))

    def counts(self):
        header = self.header
        electrons = self.image.array + self.random.poisson(SKY_E, self.image.array.shape)
        electrons = np.minimum(electrons, header["FULLWELL"]) + self.random.normal(0, header["RDNOISE"], electrons.shape)
        return np.clip(np.rint(electrons / header["GAIN"] + header["BIASLVL"]), 0, 65535).astype(np.uint16)


def write_scene(template, path, counts):
    """A frame with the header of `template` and other counts."""
    with fits.open(template) as hdus:
        at = next(i for i, hdu in enumerate(hdus) if hdu.data is not None)
        hdus[at].data = counts
        hdus.writeto(path, overwrite=True)


def draw_streaks(template, path, seed, stars=600, streaks=9):
    """`stars` from 300 to 2e5 e-, streaks of 20 to 400 px and an ideal SNR of 7 to 100 on a grid."""
    header = fits.getheader(template)
    sky = GalSimSky(header, seed)
    random = sky.random
    places = random.uniform(-5, SIDE_PX + 5, (stars, 2))
    light = 300 * (1 - random.uniform(0, 1, stars) * (1 - (2e5 / 300) ** -1.1)) ** (-1 / 1.1)
    trails = star_trail(header, places)
    if header["MOUNT"] == "sidereal":
        trails[:] = 0
    for (x, y), (dx, dy), signal_e in zip(places, trails, light):
        sky.add(x, y, dx, dy, signal_e)
    sigma, noise_e = sigma_px(header["PSFFWHM"]), np.hypot(np.sqrt(SKY_E), header["RDNOISE"])
    truth, side = [], int(np.sqrt(streaks))
    for i in range(streaks):
        cell = SIDE_PX / side
        x, y = (i % side + 0.5) * cell + random.uniform(-9, 9), (i // side + 0.5) * cell + random.uniform(-9, 9)
        length, angle = 20 * 20 ** random.uniform(0, 1), random.uniform(0, np.pi)
        snr = 7 * (100 / 7) ** random.uniform(0, 1)
        signal_e = snr / ideal_snr(1.0, length, noise_e, sigma)
        dx, dy = length * np.cos(angle), length * np.sin(angle)
        sky.add(x, y, dx, dy, signal_e)
        line = np.array([[x - dx / 2, y - dy / 2], [x + dx / 2, y + dy / 2]])
        truth.append(Streak(line, signal_e, snr))
    write_scene(template, path, sky.counts())
    return Scene(path, truth)


def draw_points(template, path, seed, side=15):
    """Points of 10^3.2 to 10^4.8 e-, no stars: nothing stands beside another."""
    header = fits.getheader(template)
    sky = GalSimSky(header, seed)
    cell = SIDE_PX / side
    grid = (np.indices((side, side)).reshape(2, -1).T + 0.5) * cell + sky.random.uniform(-3, 3, (side * side, 2))
    signal_e = 10 ** sky.random.uniform(3.2, 4.8, side * side)
    for (x, y), e in zip(grid, signal_e):
        sky.add(x, y, 0.0, 0.0, e)
    write_scene(template, path, sky.counts())
    return Scene(path, points=np.column_stack([grid, signal_e]))


def night(dmise, directory, sites, frames, objects=18470, radius_m=0.3):
    """All-sky frames of a synthetic population and of real stars by DMISE's renderer; a streak has at least 8 px and an
    ideal SNR of 7."""
    population = subprocess.run([dmise, "catalogue", "synth", "--objects", str(objects)], capture_output=True, text=True,
                                check=True).stdout
    text = NIGHT.format(duration_s=30 * frames, radius_m=radius_m)
    products = run_scenario(dmise, directory, text + "".join(NIGHT_SENSOR.format(site=site) for site in sites),
                            [("population.tle", population)])
    keys = [(site, frame) for site in sites for frame in range(1, frames + 1)]
    scenes = {key: Scene(products / key[0] / f"frame-{key[1]:06d}.fits") for key in keys}
    noise_e = {key: noise_dn(scene.counts()) * scene.header()["GAIN"] for key, scene in scenes.items()}
    widths = {key: sigma_px(scene.header()["PSFFWHM"]) for key, scene in scenes.items()}
    for truth in map(json.loads, open(products / "truth.jsonl")):
        key, signal_e = (truth["sensor"], truth["frame"]), truth["rendered_signal_e"]
        if signal_e <= 0:
            continue
        line = np.array([truth[f"{when}_px"] for when in ("start", "middle", "end")])
        length = float(np.sum(np.hypot(*np.diff(line, axis=0).T)))
        snr = ideal_snr(signal_e, length, noise_e[key], widths[key])
        if truth["whole"] and length >= 8 and snr >= 7:
            scenes[key].streaks.append(Streak(line, signal_e, snr))
        else:
            scenes[key].others.append(line)
    return list(scenes.values())
