#!/usr/bin/env python3
"""`dmise detect` measures frames that GalSim drew: places, fluxes and their errors, for PSFs that it was not told.

    galsim_detect.py DMISE [--frames N] [--seed N] [--only NAME] [--table]

Frames of 20 s through a fixed camera, so that stars trail by 10 px and points do not, with 150 stars, 130 points and 110
streaks of 16 to 48 px, SNR 20 to 150, whose header states the PSF's width 10 % too small: Gaussian, Airy, Moffat,
Kolmogorov, an obscured Airy, ones with axes of 0.8 to 1, and a Moffat that grows by two thirds to the corners as an all-sky lens does. For points and streaks of
each PSF:
  position  rms error of the centroid over the Cramer-Rao bound, from derivatives of the noiseless image of GalSim's PSF by
            all that the detector fits (place, flux, background; of streaks also length, angle, slope and bend): <= 1.15
  NEES      squared error by the detection's own covariance, over its 2 dimensions: 1 within 0.05 and 3 of its
            standard errors
  flux      mean bias: <= 1 % or 0.2 of its standard deviation
--table prints these as a row of docs/detection.md for each. Without GalSim it says so and exits 77, with DMISE_DATA set 1.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

try:
    import galsim
    from astropy.io import fits
except ImportError as error:
    print(f"{error} (./dmise setup --tests): frames by GalSim were not measured")
    sys.exit(1 if os.environ.get("DMISE_DATA") else 77)

SIDE, CELL = 1280, 64
SKY_E, READ_E, GAIN, BIAS = 1500.0, 9.0, 0.5, 100.0
VARIANCE_E2 = SKY_E + READ_E**2 + GAIN**2 / 12
STARS, POINTS, STREAKS = 150, 130, 110
CENTROID_BOUND, BIAS_SHARE, BIAS_SIGMAS, NEES_BAND = 1.15, 0.01, 0.2, 0.05
LEAST_FOUND = {"point": 0.9, "streak": 0.5}  # short faint streaks may be a row of stars
# Eight round Gaussians do not follow the rings of an obscured aperture: a fifth of the points, the brightest, are missed.
LESS_FOUND = {("obscured Airy 2 px", "point"): 0.7}
PRECISE = galsim.GSParams(maximum_fft_size=16384)  # what is folded back is far from a source

CAMERA = """
name: test
optics: {projection: gnomonic, columns: %d, rows: %d, pixel_pitch_m: 1e-5, focal_length_m: 0.08, aperture_m: 0.02,
         psf_fwhm_px: 2}
detector: {quantum_efficiency: 0.5, full_well_e: 32000, read_noise_e: %g, gain_e_per_dn: %g, bias_dn: %g, adc_bits: 16}
band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}
""" % (SIDE, SIDE, READ_E, GAIN, BIAS)
SCENARIO = """
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 10, seed: 1}
objects: [{catalogue: one.tle, radius_m: 1}]
output: {png: false}
sensors:
  - {name: test, site: atlanta, camera: test.yaml, pointing: zenith, exposure_s: 20, cadence_s: 20, detection: off}
"""
TLE = """COSMOS 2519
1 42798U 17037A   18020.70641250  .00017609  00000-0  22673-3 0  9990
2 42798  97.8163  89.4740 0205466 259.0467  98.7601 15.37950093136849
"""


def all_sky(fwhm):
    """A Moffat whose FWHM grows by two thirds towards the corners."""
    return lambda x, y: galsim.Moffat(beta=3.5, gsparams=PRECISE, fwhm=fwhm * (
        1 + 2 / 3 * ((x / SIDE - 0.5)**2 + (y / SIDE - 0.5)**2) / 0.5))


def same(profile):
    return lambda x, y: profile


def elongated(profile):
    """With axes of 0.8 to 1, as astigmatism or a mount that shakes."""
    return profile.shear(q=0.8, beta=0.6 * galsim.radians)


# Name: (FWHM of the header over 0.9, PSF at a place).
PSFS = {f"{name} {fwhm:g} px": (fwhm, make(fwhm)) for name, make, widths in (
    ("Gaussian", lambda w: same(galsim.Gaussian(fwhm=w, gsparams=PRECISE)), (1.2, 2, 6)),
    ("Airy", lambda w: same(galsim.Airy(lam_over_diam=w / 1.029, gsparams=PRECISE)), (1.5, 3)),
    ("Moffat 2.5", lambda w: same(galsim.Moffat(beta=2.5, fwhm=w, gsparams=PRECISE)), (2,)),
    ("Kolmogorov", lambda w: same(galsim.Kolmogorov(fwhm=w, gsparams=PRECISE)), (1.5, 3, 6)),
    ("obscured Airy", lambda w: same(galsim.Airy(lam_over_diam=w / 0.98, obscuration=0.3, gsparams=PRECISE)), (2,)),
    ("elongated Gaussian", lambda w: same(elongated(galsim.Gaussian(fwhm=w, gsparams=PRECISE))), (2, 4)),
    ("elongated Moffat 3", lambda w: same(elongated(galsim.Moffat(beta=3, fwhm=w, gsparams=PRECISE))), (2.5,)),
    ("all-sky Moffat", all_sky, (1.8,)),
) for fwhm in widths}


class Sky:
    """How the fixed camera of a header moves over the stars."""

    def __init__(self, header):
        self.focal = header["FOCALPX"]
        start, middle, end = (self.rotation([header[f"{key}{i}"] for i in range(4)]) for key in ("QBEG", "QAVG", "QEND"))
        self.turns = (start @ middle.T, end @ middle.T)

    @staticmethod
    def rotation(q):
        w, x, y, z = q
        return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])

    def trail(self, x, y):
        """Length and angle of a star's trail with its middle at a pixel."""
        centre = (SIDE - 1) / 2
        direction = np.array([(x - centre) / self.focal, (y - centre) / self.focal, 1.0])
        ends = [turn @ direction for turn in self.turns]
        dx, dy = (self.focal * (ends[1][i] / ends[1][2] - ends[0][i] / ends[0][2]) for i in (0, 1))
        return float(np.hypot(dx, dy)), float(np.arctan2(dy, dx))


def program(command, directory):
    """What a program prints; ends where it fails."""
    done = subprocess.run(command, cwd=directory, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"FAIL: dmise {command[1]}: {done.stderr.strip()}")
    return done.stdout


def template(dmise, directory):
    """The header of a frame of such a camera, as the program writes it."""
    (directory / "test.yaml").write_text(CAMERA)
    (directory / "scenario.yaml").write_text(SCENARIO)
    (directory / "one.tle").write_text(TLE)
    program([dmise, "run", "scenario.yaml", "--out", "out", "--force"], directory)
    with fits.open(next((directory / "out/test").glob("*.fits"))) as hdus:
        return hdus[0].header.copy()


def line(length, angle, slope=0.0, sagitta=0.0):
    """A line of light 1 whose brightness is 1 + slope r and whose offset is sagitta (1/3 - r^2), r = -1 to 1."""
    pieces = 1 if slope == 0 and sagitta == 0 else 32
    parts = []
    for i in range(pieces):
        r = (2 * i + 1) / pieces - 1
        part = galsim.Box(length / pieces, 0.01, flux=(1 + slope * r) / pieces, gsparams=PRECISE)
        parts.append(part.shift(r * length / 2, sagitta * (1 / 3 - r * r)))
    return galsim.Sum(parts).rotate(angle * galsim.radians) if pieces > 1 else parts[0].rotate(angle * galsim.radians)


def draw(psf, source, **changed):
    """Noiseless image of a source [e-] in a stamp around it, and the stamp's corner."""
    s = {**source, "slope": 0.0, "sagitta": 0.0}
    corner = [round(s[k]) - s["reach"] for k in "xy"]
    s.update({key: s[key] + value for key, value in changed.items()})
    profile = psf(source["x"], source["y"])
    if s["length"] > 0:
        profile = galsim.Convolve(profile, line(s["length"], s["angle"], s["slope"], s["sagitta"]), gsparams=PRECISE)
    side = 2 * s["reach"] + 1
    image = (profile * s["flux"]).drawImage(
        nx=side, ny=side, scale=1.0, dtype=float,
        offset=(s["x"] - corner[0] - s["reach"], s["y"] - corner[1] - s["reach"])).array
    return image, corner


class Bounds:
    """Cramer-Rao bounds of the centroid's two coordinates together, by exact derivatives in Fourier space of the image of a
    line through GalSim's PSF and pixels."""

    def __init__(self, psf, fwhm):
        self.psf, self.folds = psf, 4 if fwhm < 1.5 else 2  # frequencies of which there is light, over a pixel's
        self.known = {}  # by the stamp's side, of a PSF that is the same everywhere

    def waves(self, side, source):
        """Frequencies, and the transform of a point's image."""
        varies = self.psf(0, 0) != self.psf(SIDE - 1, SIDE // 3)
        if side not in self.known or varies:
            n = side * self.folds
            image = self.psf(source["x"], source["y"]).drawKImage(nx=n, ny=n, scale=2 * np.pi / side)
            k = 2 * np.pi / side * (np.arange(n) - n // 2)
            kx, ky = np.meshgrid(k, k)
            pixels = np.sinc(kx / (2 * np.pi)) * np.sinc(ky / (2 * np.pi))
            self.known[side] = kx, ky, image.array * pixels
        return self.known[side]

    def image(self, transform, side):
        """Values in pixels: frequencies that a pixel grid does not tell apart are added, from 0 on as there is an even number."""
        folded = transform.reshape(self.folds, side, self.folds, side).sum(axis=(0, 2))
        return np.fft.fftshift(np.fft.ifft2(folded)).real

    def px2(self, source):
        side = 2 * source["reach"] + 2
        kx, ky, point = self.waves(side, source)
        off = [source[key] - round(source[key]) for key in "xy"]
        point = source["flux"] * point * np.exp(-1j * (kx * off[0] + ky * off[1]))
        length, c, s = source["length"], np.cos(source["angle"]), np.sin(source["angle"])
        if length > 0:
            along, across = kx * c + ky * s, ky * c - kx * s
            u = along * length / 2
            u = np.where(np.abs(u) < 1e-3, 1e-3, u)
            # Means over the line, r = -1 to 1, of exp(-i u r) times 1, r, r^2.
            mean, first = np.sin(u) / u, -1j * (np.sin(u) - u * np.cos(u)) / u**2
            second = mean + 2 * np.cos(u) / u**2 - 2 * np.sin(u) / u**3
            turned = -1j * first  # derivative of `mean` by u
            line = point * mean
            transforms = [-1j * kx * line, -1j * ky * line, line / source["flux"], point * turned * along / 2,
                          point * turned * across * length / 2, point * first, -1j * across * point * (mean / 3 - second)]
        else:
            line = point
            transforms = [-1j * kx * line, -1j * ky * line, line / source["flux"]]
        gradients = [self.image(one, side).ravel() for one in transforms]
        light = gradients[2] * source["flux"]
        g = np.array(gradients + [np.ones_like(light)])
        information = (g / (VARIANCE_E2 + np.maximum(light, 0.0))) @ g.T
        information[-1, -1] += 1 / (0.01 * VARIANCE_E2)
        covariance = np.linalg.inv(information)
        jacobian = np.zeros((2, len(g)))  # derivatives of the centroid, which a slope moves along the line
        jacobian[0, 0] = jacobian[1, 1] = 1.0
        if length > 0:
            jacobian[:, 5] = length / 6 * np.array([c, s])
        return float(np.trace(jacobian @ covariance @ jacobian.T))


def flux_of_snr(psf, source, snr):
    """Flux whose matched filter has an SNR, also by the source's own photons."""
    shape, _ = draw(psf, {**source, "flux": 1.0})
    flux = 1000.0
    for _ in range(30):
        flux = snr / np.sqrt(np.sum(shape**2 / (VARIANCE_E2 + flux * shape)))
    return float(flux)


def make_frame(psf, fwhm, header, sky, random, path):
    """Writes a frame; returns its points and streaks."""
    image = np.full((SIDE, SIDE), SKY_E)
    cells = random.permutation((SIDE // CELL)**2)[:STARS + POINTS + STREAKS]
    sources = []
    for i, cell in enumerate(cells):
        x, y = ((k + 0.5) * CELL + random.uniform(-4, 4) for k in (cell % (SIDE // CELL), cell // (SIDE // CELL)))
        kind = "star" if i < STARS else "point" if i < STARS + POINTS else "streak"
        length, angle = (sky.trail(x, y) if kind == "star" else (0.0, 0.0) if kind == "point" else
                         (random.uniform(16, 48), random.uniform(0, np.pi)))
        source = {"kind": kind, "x": x, "y": y, "length": length, "angle": angle, "flux": 1.0,
                  "reach": int(length / 2 + 8 + 5 * fwhm) * (2 if kind == "star" else 1)}
        if kind == "star":
            peak = draw(psf, source)[0].max()
            source["flux"] = random.uniform(0.02, 0.6)**2 * 32000 / peak
        else:
            source["flux"] = flux_of_snr(psf, source, np.exp(random.uniform(np.log(20), np.log(150))))
        stamp, (x0, y0) = draw(psf, source)
        x1, y1 = x0 + stamp.shape[1], y0 + stamp.shape[0]
        cut = stamp[max(0, -y0):stamp.shape[0] - max(0, y1 - SIDE), max(0, -x0):stamp.shape[1] - max(0, x1 - SIDE)]
        image[max(0, y0):y1, max(0, x0):x1] += cut
        sources += [source] if kind != "star" else []
    electrons = np.minimum(random.poisson(np.maximum(image, 0.0)), 32000) + READ_E * random.standard_normal(image.shape)
    counts = np.clip(np.rint(electrons / GAIN + BIAS), 0, 65535).astype(np.uint16)
    header["PSFFWHM"] = 0.9 * fwhm
    fits.PrimaryHDU(counts, header).writeto(path, overwrite=True)
    return sources


class Outcome:
    def __init__(self, kind):
        self.kind = kind
        self.placed, self.squares, self.bounds, self.nees, self.flux_share, self.flux_sigmas = 0, [], [], [], [], []

    def add(self, source, detections, bounds):
        self.placed += 1
        near = [d for d in detections if d["kind"] == source["kind"] and
                np.hypot(d["x_px"] - source["x"], d["y_px"] - source["y"]) < 6]
        if not near:
            return
        d = min(near, key=lambda one: np.hypot(one["x_px"] - source["x"], one["y_px"] - source["y"]))
        error = np.array([d["x_px"] - source["x"], d["y_px"] - source["y"]])
        xx, xy, yy = d["covariance_px2"]
        self.nees.append(error @ np.linalg.inv([[xx, xy], [xy, yy]]) @ error / 2)
        self.flux_share.append(d["signal_e"] / source["flux"] - 1)
        self.flux_sigmas.append((d["signal_e"] - source["flux"]) / (d["signal_e"] / d["snr"]))
        self.squares.append(error @ error)
        self.bounds.append(bounds.px2(source))

    def figures(self):
        # Normalised one by one: faint sources would dominate a sum.
        ratio = np.sqrt(np.mean(np.array(self.squares) / np.array(self.bounds)))
        return len(self.nees) / self.placed, ratio, np.mean(self.nees), np.mean(self.flux_share), np.mean(self.flux_sigmas)

    def faults(self, psf_name):
        found, ratio, nees, share, sigmas = self.figures()
        n, bounded, out = len(self.nees), len(self.bounds), []
        if found < LESS_FOUND.get((psf_name, self.kind), LEAST_FOUND[self.kind]):
            out.append(f"only {found:.0%} found")
        if ratio > CENTROID_BOUND * (1 + 3 / np.sqrt(4 * bounded)):
            out.append(f"position {ratio:.3f} of the bound")
        if abs(nees - 1) > NEES_BAND + 3 / np.sqrt(n):
            out.append(f"NEES {nees:.3f}")
        slack = 3 / np.sqrt(n)
        if abs(share) > BIAS_SHARE + slack * np.std(self.flux_share) and abs(sigmas) > BIAS_SIGMAS + slack:
            out.append(f"flux {share:+.2%}, {sigmas:+.2f} sigma")
        return out


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("dmise")
    arguments.add_argument("--frames", type=int, default=1, help="frames for each PSF")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--only", help="part of a PSF's name")
    arguments.add_argument("--table", action="store_true")
    options = arguments.parse_args()
    dmise = str(pathlib.Path(options.dmise).resolve())
    faults, row = [], "| {} | {} | {} | {} | {} | {} |"
    if options.table:
        print(row.format("PSF, FWHM", "source", "found", "position / bound", "NEES", "flux") + "\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        header = template(dmise, directory)
        sky = Sky(header)
        for psf_name, (fwhm, psf) in PSFS.items():
            if options.only and options.only not in psf_name:
                continue
            random = np.random.default_rng([options.seed, *psf_name.encode()])
            outcomes = {kind: Outcome(kind) for kind in LEAST_FOUND}
            bounds = Bounds(psf, fwhm)
            for _ in range(options.frames):
                sources = make_frame(psf, fwhm, header, sky, random, directory / "frame.fits")
                lines = program([dmise, "detect", "frame.fits"], directory).splitlines()
                detections = [json.loads(text) for text in lines]
                for source in sources:
                    outcomes[source["kind"]].add(source, detections, bounds)
            for kind, outcome in outcomes.items():
                found, ratio, nees, share, sigmas = outcome.figures()
                missed = [f"{psf_name}, {kind}s: {fault}" for fault in outcome.faults(psf_name)]
                faults += missed
                cells = (f"{found:.1%}", f"{ratio:.3f}", f"{nees:.3f}", f"{share:+.2%}, {sigmas:+.2f} sigma")
                print(row.format(psf_name, kind, *cells) if options.table else
                      "{}, {}s: {} found, position {} of the bound, NEES {}, flux {}".format(psf_name, kind, *cells),
                      flush=True)
    if faults:
        sys.exit("FAIL: " + "; ".join(faults))


if __name__ == "__main__":
    main()
