#!/usr/bin/env python3
"""`dmise detect --sequence` on sequences that GalSim drew with ordinary cards, without a catalogue.

    sequences.py DMISE                     some sequences of each kind: the claims of CLAIMS hold
    sequences.py DMISE --write             12 to 40 sequences of each kind, of other seeds: writes the table of docs/detection.md
    sequences.py DMISE --sequences N --seed S [--kind KIND] [--keep DIR] [--each]

A sequence is 10 frames of 512 x 512 pixels of 5 arcsec, with a Moffat PSF of 2.2 to 3.6 px, as many stars as the sky has (50 to 180
above SNR 6, and all fainter ones), 25 pixels that are hot by 3 to 30 sigma and 3 cosmic rays a frame. Kinds, with three objects each:
  faint     the mount follows the stars, and is moved by some px between frames; objects of SNR 3 in each frame move by 1 to 5 px a frame
  geo       the mount follows the stars; points of SNR 10 move at 15 arcsec/s
  fixed     the mount stands still, stars trail by 6 px and drift; points of SNR 10 stay, or drift slowly
  target    the mount follows a target in any direction, stars trail by 4 to 10 px; points of SNR 10 drift slowly
SNR is that of the ideal filter in the noise of the sky. In half of the sequences the WCS is wrong by a pixel or two, a different one in each
frame; the others have none. An object is found if a track is within 3 px of it in most frames; other tracks are false.
NEES is the squared error by the track's own covariance over its 2 dimensions.
Without GalSim it says so and exits 77, with DMISE_DATA set 1.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np
from astropy.io import fits
from astropy.wcs import WCS

import referee

SIDE, FRAMES, OBJECTS, SCALE = 512, 10, 3, 5.0  # arcsec/px
BIAS, GAIN, READ_E, FULL_E = 300.0, 1.0, 8.0, 60000.0
SIDEREAL = 15.041067  # arcsec/s
PHASES = 8
DOCUMENT = referee.SOURCE / "docs/detection.md"
KINDS = {"faint": "SNR 3, below the limit of a frame", "geo": "SNR 10, among stars that rest",
         "fixed": "SNR 10, among stars that drift", "target": "SNR 10, mount on a target"}
TABLE_SEED, TABLE_SEQUENCES = 9000, {"faint": 12, "geo": 40, "fixed": 12, "target": 12}
# Least share found; false tracks a sequence are at most 0.1, NEES is 0.8 to 1.2.
CLAIMS = {"faint": 0.9, "geo": 0.99, "fixed": 0.99, "target": 0.99}


class Shape:
    """GalSim's image of one shape of unit light, between whose places within a pixel light is linear."""

    def __init__(self, galsim, psf, dx, dy):
        length = np.hypot(dx, dy)
        self.profile = psf
        if length > 0.01:
            self.profile = galsim.Convolve(psf, galsim.Box(length, 0.01).rotate(np.arctan2(dy, dx) * galsim.radians))
        self.reach, self.drawn = int(length / 2 + 20) + 1, {}

    def phase(self, i, j):
        if (i, j) not in self.drawn:
            n = 2 * self.reach + 1
            self.drawn[i, j] = self.profile.drawImage(nx=n, ny=n, scale=1.0, dtype=float, offset=(i / PHASES, j / PHASES)).array
        return self.drawn[i, j]

    def image(self, fx, fy):
        u, v = fx * PHASES, fy * PHASES
        i, j = int(u), int(v)
        u, v = u - i, v - j
        return ((1 - u) * ((1 - v) * self.phase(i, j) + v * self.phase(i, j + 1)) +
                u * ((1 - v) * self.phase(i + 1, j) + v * self.phase(i + 1, j + 1)))

    def add(self, image, x, y, flux):
        ix, iy = int(np.floor(x)), int(np.floor(y))
        x0, y0, n = ix - self.reach, iy - self.reach, 2 * self.reach + 1
        left, top, right, bottom = max(0, x0), max(0, y0), min(SIDE, x0 + n), min(SIDE, y0 + n)
        if left < right and top < bottom:
            stamp = self.image(x - ix, y - iy)
            image[top:bottom, left:right] += flux * stamp[top - y0:bottom - y0, left - x0:right - x0]

    def sum_square(self):
        return float(np.mean([np.sum(self.image(x, y) ** 2) for x in (0.1, 0.4, 0.7) for y in (0.2, 0.5, 0.8)]))


class Scene:
    """What a kind of sequence is like: times, where each frame points, where objects go."""

    def __init__(self, kind, random):
        self.kind, self.random = kind, random
        self.exposure, cadence = {"faint": (4.0, 10.0), "geo": (0.4, 3.0), "fixed": (2.0, 5.0), "target": (2.0, 5.0)}[kind]
        self.times = cadence * np.arange(FRAMES) + random.uniform(0, 0.3, FRAMES)
        self.reference = FRAMES // 2
        self.turn = random.uniform(0, 2 * np.pi)
        self.ra, self.dec = random.uniform(0, 360), random.uniform(-40, 50)
        self.drift = np.zeros(2)  # motion of the pointing in RA cos dec and Dec [arcsec/s]
        if kind == "fixed":
            self.drift[0] = SIDEREAL * np.cos(np.radians(self.dec))
        if kind == "target":
            self.drift = random.uniform(10, 25) * np.array([np.cos(self.turn * 7), np.sin(self.turn * 7)])
        jitter = 3.0 if kind in ("faint", "geo") else 0.05
        self.offsets = random.normal(0, jitter, (FRAMES, 2))
        self.wcs = [self.pointing(t, o) for t, o in zip(self.times, self.offsets)]
        here = self.wcs[self.reference]
        later = self.pointing(self.times[self.reference] + 1, self.offsets[self.reference])
        middle = here.all_pix2world([[SIDE / 2, SIDE / 2]], 0)
        self.star_rate = (later.all_world2pix(middle, 0) - SIDE / 2)[0]  # px/s

    def pointing(self, time, offset):
        wcs = WCS(naxis=2)
        wcs.wcs.ctype = ["RA---TAN", "DEC--TAN"]
        after = time - self.times[0]
        wcs.wcs.crval = [self.ra + self.drift[0] * after / 3600 / np.cos(np.radians(self.dec)), self.dec + self.drift[1] * after / 3600]
        wcs.wcs.crpix = SIDE / 2 + 0.5 + offset
        c, s = np.cos(self.turn), np.sin(self.turn)
        wcs.wcs.cd = SCALE / 3600 * np.array([[-c, s], [s, c]])
        return wcs

    def path(self, place, rate):
        """Places of an object in all frames: even in the sky of the reference frame, or on the detector of a moving mount."""
        after = self.times - self.times[self.reference]
        even = place + after[:, None] * rate
        if self.kind in ("fixed", "target"):
            return even + self.offsets - self.offsets[self.reference]
        sky = self.wcs[self.reference].all_pix2world(even, 0)
        return np.array([w.all_world2pix([s], 0)[0] for w, s in zip(self.wcs, sky)])

    def rate(self):
        angle = self.random.uniform(0, 2 * np.pi)
        pace = {"faint": self.random.uniform(1, 5) / 10, "geo": SIDEREAL / SCALE, "fixed": self.random.uniform(0, 0.1),
                "target": self.random.uniform(0, 0.1)}[self.kind]
        return pace * np.array([np.cos(angle), np.sin(angle)])


def stars_of(scene, random, noise_e, sum_square):
    """Places on the sky and light of the stars: 0.45 dex a magnitude, down to an SNR of 0.3."""
    reach = 60 + np.hypot(*scene.star_rate) * (scene.times[-1] - scene.times[0])
    seen = random.uniform(50, 180) * ((SIDE + 2 * reach) / SIDE) ** 2
    faintest = 0.3
    count = random.poisson(seen * (6 / faintest) ** (0.45 / 0.4))
    snr = faintest * random.uniform(0, 1, count) ** (-0.4 / 0.45)
    places = random.uniform(-reach, SIDE + reach, (count, 2))
    return scene.wcs[scene.reference].all_pix2world(places, 0), snr * noise_e / np.sqrt(sum_square)


def draw(directory, seed, kind):
    """Writes a sequence; returns its paths and objects."""
    import galsim
    random = np.random.default_rng([seed, sorted(KINDS).index(kind)])
    scene = Scene(kind, random)
    psf = galsim.Moffat(beta=random.uniform(2.8, 4.5), fwhm=random.uniform(2.2, 3.6))
    sky_e = 10 ** random.uniform(2.3, 3.2)
    noise_e = np.sqrt(sky_e + READ_E**2)
    stars = Shape(galsim, psf, *(scene.star_rate * scene.exposure))
    sky, flux = stars_of(scene, random, noise_e, Shape(galsim, psf, 0, 0).sum_square())
    objects = []
    for _ in range(OBJECTS):
        while True:
            rate = scene.rate()
            path = scene.path(random.uniform(30, SIDE - 30, 2), rate)
            apart = all(np.min(np.hypot(*(path - o["path"]).T)) > 15 for o in objects)
            if path.min() > 12 and path.max() < SIDE - 12 and apart:
                break
        over_detector = (path[scene.reference + 1] - path[scene.reference]) - (scene.offsets[scene.reference + 1] - scene.offsets[scene.reference])
        trail = over_detector / (scene.times[scene.reference + 1] - scene.times[scene.reference]) * scene.exposure
        shape = Shape(galsim, psf, *trail)
        snr = 3.0 if kind == "faint" else 10.0
        objects.append({"path": path, "rate": rate, "shape": shape, "flux": snr * noise_e / np.sqrt(shape.sum_square())})
    hot = random.integers(2, SIDE - 2, (25, 2)), noise_e * 10 ** random.uniform(0.5, 1.5, 25)
    said = seed % 2 == 1
    paths = []
    for i in range(FRAMES):
        image = np.full((SIDE, SIDE), sky_e)
        for (x, y), f in zip(scene.wcs[i].all_world2pix(sky, 0), flux):
            if -30 < x < SIDE + 30 and -30 < y < SIDE + 30:
                stars.add(image, x, y, f)
        for o in objects:
            o["shape"].add(image, *o["path"][i], o["flux"])
        image[hot[0][:, 1], hot[0][:, 0]] += hot[1]
        electrons = random.poisson(image) + READ_E * random.standard_normal(image.shape)
        rays = random.integers(2, SIDE - 2, (3, 2))
        electrons[rays[:, 1], rays[:, 0]] += noise_e * 10 ** random.uniform(1, 2.5, 3)
        counts = np.clip(np.rint(np.minimum(electrons, FULL_E) / GAIN + BIAS), 0, 65535).astype(np.uint16)
        header = fits.Header()
        header["EXPTIME"] = scene.exposure
        start = np.datetime64("2024-03-05T20:15:30.000000") + np.timedelta64(int(round(1e6 * (scene.times[i] - scene.exposure / 2))), "us")
        header["DATE-OBS"] = str(start)
        header["EGAIN"], header["BIASLVL"], header["SATURATE"], header["FILTER"] = GAIN, BIAS, FULL_E / GAIN + BIAS - 200, "V"
        if said:
            wcs = scene.wcs[i].deepcopy()
            wcs.wcs.crpix += random.normal(0, 1.5, 2)
            header.update(wcs.to_header())
        paths.append(directory / f"{kind}-{seed}-{i}.fits")
        fits.PrimaryHDU(counts, header).writeto(paths[-1], overwrite=True)
    return {"paths": paths, "objects": objects, "scene": scene, "said": said, "seed": seed}


def tracks_of(dmise, sequence, options=()):
    done = subprocess.run([dmise, "detect", "--sequence", *sequence["paths"], "--catalogue", "none", *options], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise referee.Failure(f"dmise detect --sequence {sequence['paths'][0]}: {done.stderr.strip()[-300:]}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def index_of(sequence, position):
    return [str(p) for p in sequence["paths"]].index(position["file"])


def is_of(sequence, track, path):
    off = [np.hypot(p["x_px"] - path[index_of(sequence, p)][0], p["y_px"] - path[index_of(sequence, p)][1]) for p in track["sequence"]["positions"]]
    return np.mean(np.array(off) < 3) > 0.6


def nees_of(sequence, track, path):
    """NEES of the position in the detection's frame, and of the rate over the sky, where there is a WCS (else None)."""
    scene, positions = sequence["scene"], track["sequence"]["positions"]
    home = index_of(sequence, min(positions, key=lambda p: abs(p["after_s"])))
    off = np.array([track["x_px"], track["y_px"]]) - path[home]
    xx, xy, yy = track["covariance_px2"]
    place = off @ np.linalg.solve([[xx, xy], [xy, yy]], off) / 2
    if not sequence["said"]:
        return place, None
    sky = np.radians([w.all_pix2world([p], 0)[0] for w, p in zip(scene.wcs, path)])
    away = (sky - sky[home]) * [np.cos(sky[home, 1]), 1] / np.radians(1 / 3600)
    true = [np.polyfit(scene.times - scene.times[home], a, 2)[1] for a in away.T]
    c = track["sequence"]["covariance_arcsec"]
    off = np.array([track["sequence"]["rate_ra_arcsec_per_s"], track["sequence"]["rate_dec_arcsec_per_s"]]) - true
    return place, off @ np.linalg.solve([[c[5], c[8]], [c[8], c[9]]], off) / 2


def measure(dmise, directory, kind, first, count, each=False):
    """Objects, found ones, false tracks, and NEES of positions and rates."""
    found, false, places, rates = 0, 0, [], []
    for seed in range(first, first + count):
        sequence = draw(directory, seed, kind)
        tracks = tracks_of(dmise, sequence)
        hits = []
        for o in sequence["objects"]:
            mine = [t for t in tracks if is_of(sequence, t, o["path"])]
            hits.append(bool(mine))
            if mine:
                place, rate = nees_of(sequence, mine[0], o["path"])
                places.append(place)
                rates += [] if rate is None else [rate]
        wrong = [t for t in tracks if not any(is_of(sequence, t, o["path"]) for o in sequence["objects"])]
        found, false = found + sum(hits), false + len(wrong)
        if each:
            said = " ".join(f"{t['snr']:.1f}{t['sequence']['found_by'][0]}@{t['x_px']:.0f},{t['y_px']:.0f}:{t['sequence']['rate_px_per_s']}" for t in wrong)
            print(f"{kind} {seed}: {hits} snr {[round(t['snr'], 1) for t in tracks]} false {said} nees {[round(float(p), 1) for p in places[-sum(hits):]]}", flush=True)
        for path in sequence["paths"]:
            path.unlink()
    return {"objects": count * OBJECTS, "sequences": count, "found": found, "false": false, "place": np.array(places), "rate": np.array(rates)}


def nees_text(values):
    return f"{values.mean():.2f} +- {values.std() / np.sqrt(len(values)):.2f}"


def table(dmise, directory, first, count, each=False, kinds=tuple(KINDS)):
    lines = ["| objects, 10 frames | found | false tracks a sequence | NEES of position | of rate |", "|---|---|---|---|---|"]
    for kind in kinds:
        m = measure(dmise, directory, kind, first, count[kind] if isinstance(count, dict) else count, each)
        lines.append(f"| {KINDS[kind]} | {m['found']} of {m['objects']} | {m['false'] / m['sequences']:.2f} | {nees_text(m['place'])} | {nees_text(m['rate'])} |")
    return "\n".join(lines) + "\n"


def judge(dmise, directory):
    for kind, count in (("faint", 6), ("geo", 2), ("fixed", 2), ("target", 2)):
        m = measure(dmise, directory, kind, 100, count)
        share = m["found"] / m["objects"]
        referee.check(share >= CLAIMS[kind] - 1 / m["objects"], f"{KINDS[kind]}: {m['found']} of {m['objects']} found")
        referee.check(m["false"] <= max(1, 0.1 * count), f"{KINDS[kind]}: {m['false']} false tracks in {count} sequences")
        for what in ("place", "rate"):
            error = 1 / np.sqrt(len(m[what]))
            referee.check(0.8 - 3 * error < m[what].mean() < 1.2 + 3 * error, f"{KINDS[kind]}: NEES of {what} {m[what].mean():.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dmise", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="write the table of docs/detection.md")
    parser.add_argument("--sequences", type=int, help="print the table of so many sequences of each kind")
    parser.add_argument("--seed", type=int, default=1, help="of the first of them (%(default)s)")
    parser.add_argument("--kind", choices=tuple(KINDS), action="append", help="only these")
    parser.add_argument("--keep", type=pathlib.Path, help="directory of the frames while they are searched")
    parser.add_argument("--each", action="store_true", help="print a line for each sequence")
    options = parser.parse_args()
    dmise = options.dmise.resolve()
    try:
        import galsim  # noqa: F401
    except ImportError as error:
        raise referee.Missing("galsim is not installed (./dmise setup --tests)") from error
    with tempfile.TemporaryDirectory() as name:
        directory = options.keep or pathlib.Path(name)
        directory.mkdir(parents=True, exist_ok=True)
        if options.write:
            text = table(dmise, directory, TABLE_SEED, TABLE_SEQUENCES, options.each) + f"\nMeasured on {referee.occasion()}.\n"
            begin, end = "<!-- sequences -->\n", "<!-- end of sequences -->\n"
            before, _, rest = DOCUMENT.read_text().partition(begin)
            DOCUMENT.write_text(before + begin + text + end + rest.partition(end)[2])
        elif options.sequences:
            print(table(dmise, directory, options.seed, options.sequences, options.each, tuple(options.kind or KINDS)))
        else:
            judge(dmise, directory)


if __name__ == "__main__":
    referee.main(main)
