#!/usr/bin/env python3
"""`dmise detect` in frames whose mount follows a target, so that stars trail: GalSim's frames with ordinary cards.

    trailed_stars.py DMISE                    ten frames: the claims of CLAIMS hold
    trailed_stars.py DMISE --write            40 frames of other seeds: writes the table of docs/detection.md
    trailed_stars.py DMISE --frames N --seed S [--keep DIR] [--each]

A frame has 768 x 768 pixels, a Moffat PSF of 2.2 to 3.6 px, and stars that all trail by the same 10 to 100 px. Its 2.5 to 5 deg show the
stars of the default catalogue at their places and fainter ones at random, as many as the sky has: 100 to 400 above SNR 6. Six
points and two streaks of 20 to 60 px in other directions are the objects, of SNR 8 to 40. Every other frame has a WCS that is wrong by
15 px, and the others RA, DEC, FOCALLEN and XPIXSZ. SNR is that of the ideal filter in the noise of sky and stars' light: `in light`.
`sep` finds an object if it has a source within 4 px, and is given the cut of elongation that finds the most at our false alarms.
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

SIDE, BIAS, GAIN, READ_E, FULL_E = 768, 300.0, 1.0, 8.0, 60000.0
PHASES = 8  # places within a pixel, of either axis, at which GalSim draws
SNR_BINS = (8, 12, 20, 30, 40.1)
DOCUMENT = referee.SOURCE / "docs/detection.md"
TABLE_SEED, TABLE_FRAMES = 5000, 40
CLAIMS = {"none": (0.9, 0.5), "kstars": (0.9, 0.5)}  # least share found from SNR 12 on, most false alarms a frame


class Shape:
    """GalSim's images of one shape of unit light, drawn once for each place within a pixel."""

    def __init__(self, galsim, psf, length, angle):
        profile = psf
        if length > 0:
            profile = galsim.Convolve(psf, galsim.Box(length, 0.01).rotate(angle * galsim.radians))
        self.profile, self.drawn = profile, {}
        self.reach = int(length / 2 + 25) + 1

    def image(self, x, y):
        """Image and the corner of a source at the nearest of the phases."""
        ix, iy = int(np.floor(x)), int(np.floor(y))
        phase = int((x - ix) * PHASES), int((y - iy) * PHASES)
        if phase not in self.drawn:
            n = 2 * self.reach + 1
            self.drawn[phase] = self.profile.drawImage(
                nx=n, ny=n, scale=1.0, dtype=float, offset=((phase[0] + 0.5) / PHASES, (phase[1] + 0.5) / PHASES)).array
        return self.drawn[phase], ix - self.reach, iy - self.reach

    def add(self, image, x, y, flux):
        stamp, x0, y0 = self.image(x, y)
        n = stamp.shape[0]
        left, top, right, bottom = max(0, x0), max(0, y0), min(SIDE, x0 + n), min(SIDE, y0 + n)
        if left < right and top < bottom:
            image[top:bottom, left:right] += flux * stamp[top - y0:bottom - y0, left - x0:right - x0]

    @staticmethod
    def placed(value):
        """A coordinate moved to its phase."""
        return np.floor(value) + (np.floor((value - np.floor(value)) * PHASES) + 0.5) / PHASES

    def sum_square(self):
        return float(np.sum(self.image(0.5, 0.5)[0] ** 2))


def catalogue_stars(random, stars, wide_deg):
    """A field with at least 12 stars of the catalogue: its WCS, and places and magnitudes."""
    while True:
        ra, dec = random.uniform(0, 360), np.degrees(np.arcsin(random.uniform(-0.8, 0.9)))
        wcs = WCS(naxis=2)
        turn, scale = random.uniform(0, 2 * np.pi), wide_deg / SIDE
        wcs.wcs.ctype = ["RA---TAN", "DEC--TAN"]
        wcs.wcs.crval, wcs.wcs.crpix = [ra, dec], [SIDE / 2 + 0.5] * 2
        c, s = np.cos(turn), np.sin(turn)
        wcs.wcs.cd = scale * np.array([[-c, s], [s, c]])
        near = np.flatnonzero((np.abs(stars["dec_deg"] - dec) < wide_deg) &
                              (np.abs((stars["ra_deg"] - ra + 180) % 360 - 180) * np.cos(np.radians(dec)) < wide_deg))
        x, y = wcs.all_world2pix(stars["ra_deg"][near], stars["dec_deg"][near], 0)
        inside = (x > -60) & (y > -60) & (x < SIDE + 60) & (y < SIDE + 60)
        if inside.sum() >= 12:
            return wcs, x[inside], y[inside], stars["v_mag"][near][inside]


def draw(directory, seed, stars):
    """Writes a frame; returns its path and the objects in it."""
    import galsim
    random = np.random.default_rng(seed)
    fwhm, length, angle = random.uniform(2.2, 3.6), 10 ** random.uniform(1, 2), random.uniform(0, np.pi)
    psf = galsim.Moffat(beta=random.uniform(2.8, 4.5), fwhm=fwhm)
    sky_e, wide_deg = 10 ** random.uniform(2.3, 3.2), random.uniform(2.5, 5)
    noise_e = np.sqrt(sky_e + READ_E**2)
    trail = Shape(galsim, psf, length, angle)
    wcs, x, y, v = catalogue_stars(random, stars, wide_deg)
    seen, area = random.uniform(100, 400), (wide_deg * (SIDE + 120) / SIDE) ** 2
    faintest = max(9.5, 9 + np.log10(seen / (3 * area)) / 0.45)  # 3 a square degree above V = 9, 0.45 dex a magnitude
    count = random.poisson(3 * area * (10 ** (0.45 * (faintest + 2 - 9)) - 1))
    faint = 9 + np.log10(1 + random.uniform(0, 1, count) * (10 ** (0.45 * (faintest + 2 - 9)) - 1)) / 0.45
    x, y = np.append(x, random.uniform(-60, SIDE + 60, count)), np.append(y, random.uniform(-60, SIDE + 60, count))
    flux = 6 * noise_e / np.sqrt(trail.sum_square()) * 10 ** (-0.4 * (np.append(v, faint) - faintest))
    starlight = np.zeros((SIDE, SIDE))
    for one in zip(x, y, flux):
        trail.add(starlight, *one)
    image, objects = starlight + sky_e, []
    point = Shape(galsim, psf, 0, 0)
    for i in range(8):
        streak = i >= 6
        line = (random.uniform(20, 60), angle + random.uniform(0.35, np.pi - 0.35)) if streak else (0.0, 0.0)
        shape = Shape(galsim, psf, *line) if streak else point
        at = [float(Shape.placed(value)) for value in random.uniform(50, SIDE - 50, 2)]
        snr = 8 * 5 ** random.uniform(0, 1)
        signal_e = snr * noise_e / np.sqrt(shape.sum_square())
        stamp, x0, y0 = shape.image(*at)
        n = stamp.shape[0]
        around = np.zeros((n, n)) + noise_e**2
        left, top, right, bottom = max(0, x0), max(0, y0), min(SIDE, x0 + n), min(SIDE, y0 + n)
        around[top - y0:bottom - y0, left - x0:right - x0] += starlight[top:bottom, left:right]
        in_light = signal_e * np.sqrt(np.sum(stamp**2 / around))
        shape.add(image, *at, signal_e)
        objects.append({"x": at[0], "y": at[1], "length": line[0], "angle": line[1], "snr": snr, "in_light": float(in_light)})
    electrons = np.minimum(random.poisson(image), FULL_E) + READ_E * random.standard_normal(image.shape)
    counts = np.clip(np.rint(electrons / GAIN + BIAS), 0, 65535).astype(np.uint16)
    header = fits.Header()
    header["EXPTIME"], header["DATE-OBS"] = 5.0, "2024-03-05T20:15:30.000"
    header["EGAIN"], header["BIASLVL"], header["SATURATE"], header["FILTER"] = GAIN, BIAS, FULL_E / GAIN + BIAS - 200, "V"
    header["XPIXSZ"] = 9.0
    header["FOCALLEN"] = 9e-3 / np.radians(wide_deg / SIDE) * (1 + random.uniform(-0.01, 0.01))
    if seed % 2:
        said = wcs.deepcopy()
        said.wcs.crpix += random.normal(0, 10, 2)
        header.update(said.to_header())
    else:
        header["RA"], header["DEC"] = wcs.wcs.crval + random.uniform(-0.3, 0.3, 2)
    path = directory / f"trails-{seed}.fits"
    fits.PrimaryHDU(counts, header).writeto(path, overwrite=True)
    return {"path": path, "objects": objects, "length": length, "angle": angle, "fwhm": fwhm, "wcs": wcs, "seed": seed}


def detections(dmise, path, catalogue):
    done = subprocess.run([dmise, "detect", path, "--catalogue", catalogue], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise referee.Failure(f"dmise detect {path}: {done.stderr.strip()[-300:]}")
    found = [json.loads(text) for text in done.stdout.splitlines()]
    return [(d["x_px"], d["y_px"]) for d in found], "solved:" in done.stderr, done.stderr


def sep_sources(path, fwhm):
    import sep
    data = fits.getdata(path).astype(np.float32)
    background = sep.Background(data, bw=64, bh=64)
    half = int(np.ceil(1.5 * fwhm))
    axis = np.exp(-4 * np.log(2) * (np.arange(-half, half + 1) / fwhm) ** 2)
    kernel = np.outer(axis, axis)
    found = sep.extract(data - background.back(), 2.5, err=background.rms(), minarea=5, filter_kernel=kernel / kernel.sum())
    return np.column_stack([found["x"], found["y"], found["a"] / np.maximum(found["b"], 1e-3), found["flux"]])


def distance(objects, x, y):
    """From each object's line."""
    out = []
    for o in objects:
        c, s = np.cos(o["angle"]), np.sin(o["angle"])
        along = np.clip((x - o["x"]) * c + (y - o["y"]) * s, -o["length"] / 2, o["length"] / 2)
        out.append(np.hypot(x - o["x"] - along * c, y - o["y"] - along * s))
    return np.array(out)


def matched(objects, places, gate=4.0):
    """Whether each object is found, and how many places are none."""
    found, false = np.zeros(len(objects), bool), []
    for x, y in places:
        off = distance(objects, x, y)
        if off.min() < gate:
            found[np.argmin(off)] = True
        else:
            false.append((x, y))
    return found, false


def found_by_bins(objects, found):
    snr = np.array([o["in_light"] for o in objects])
    return [(int(np.sum(found[(snr >= low) & (snr < high)])), int(np.sum((snr >= low) & (snr < high))))
            for low, high in zip(SNR_BINS, SNR_BINS[1:])]


def theory(objects, threshold=6.0):
    """Mean probability that noise leaves an object above the threshold, of each bin."""
    from math import erf
    snr = np.array([o["in_light"] for o in objects])
    chance = np.array([0.5 * (1 + erf((s - threshold) / np.sqrt(2))) for s in snr])
    return [float(np.mean(chance[(snr >= low) & (snr < high)])) if np.any((snr >= low) & (snr < high)) else 1.0
            for low, high in zip(SNR_BINS, SNR_BINS[1:])]


def sep_at(frames, false_alarms):
    """Objects that sep finds at so many false alarms in all frames, by its best cut of elongation, the brightest first."""
    best = None
    sources = [sep_sources(f["path"], f["fwhm"]) for f in frames]
    for cut in (1.2, 1.5, 2.0, 3.0, 1e9):
        rows = [(s[3], i, s[0], s[1]) for i, some in enumerate(sources) for s in some if s[2] < cut]
        found, false = [np.zeros(len(f["objects"]), bool) for f in frames], 0
        for _, i, x, y in sorted(rows, reverse=True):
            off = distance(frames[i]["objects"], x, y)
            if off.min() < 4:
                found[i][np.argmin(off)] = True
            else:
                false += 1
                if false > false_alarms:
                    break
        if best is None or sum(map(np.sum, found)) > sum(map(np.sum, best)):
            best = found
    return np.concatenate(best)


def measure(dmise, frames, catalogue, each=False):
    """(objects found by bins, false alarms, frames solved)."""
    found, false, solved = [], 0, 0
    for f in frames:
        places, is_solved, notes = detections(dmise, f["path"], catalogue)
        hit, wrong = matched(f["objects"], places)
        found.append(hit)
        false += len(wrong)
        solved += is_solved
        if each:
            missed = [f"{o['in_light']:.0f}@{o['x']:.0f},{o['y']:.0f}" + ("s" if o["length"] else "") for o, h in zip(f["objects"], hit) if not h]
            note = next((line.split("mount: ")[1] for line in notes.splitlines() if "mount: " in line), "no mount")
            print(f"{f['seed']} L {f['length']:.1f} at {np.degrees(f['angle']):.1f} fwhm {f['fwhm']:.1f}: {hit.sum()} of {len(hit)}, "
                  f"solved {is_solved}, missed {' '.join(missed)}; false {' '.join(f'{x:.0f},{y:.0f}' for x, y in wrong)}; {note}", flush=True)
    return np.concatenate(found), false, solved


def row(name, objects, found, false, solved, frames):
    cells = [f"{a} of {b}" for a, b in found_by_bins(objects, found)]
    return f"| {name} | " + " | ".join(cells) + f" | {false / frames:.2f} | {solved} |"


def table(dmise, frames, each=False):
    objects = [o for f in frames for o in f["objects"]]
    head = [f"SNR {low:g} to {high:.0f}" for low, high in zip(SNR_BINS, SNR_BINS[1:])]
    lines = ["| detector | " + " | ".join(head) + " | false alarms a frame | solved |", "|---" * (len(head) + 3) + "|",
             "| theory, threshold 6 | " + " | ".join(f"{p:.3f}" for p in theory(objects)) + " | | |"]
    for catalogue in ("none", "kstars"):
        found, false, solved = measure(dmise, frames, catalogue, each)
        said = f"{solved} of {len(frames)}" if catalogue != "none" else ""
        lines.append(row(f"dmise, catalogue {catalogue}", objects, found, false, said, len(frames)))
        if catalogue == "none":
            lines.append(row("sep, at as many false alarms", objects, sep_at(frames, false), false, "", len(frames)))
    return "\n".join(lines) + "\n"


def drawn(directory, first, count):
    stars = referee.read_stars()
    return [draw(directory, seed, stars) for seed in range(first, first + count)]


def judge(dmise, directory):
    frames = drawn(directory, 100, 10)
    objects = [o for f in frames for o in f["objects"]]
    bright = np.array([o["in_light"] >= 12 for o in objects])
    for catalogue, (least, most) in CLAIMS.items():
        found, false, solved = measure(dmise, frames, catalogue)
        share = found[bright].mean()
        referee.check(share >= least, f"catalogue {catalogue}: {share:.2f} of {bright.sum()} objects above SNR 12 found among trails")
        referee.check(false <= most * len(frames), f"catalogue {catalogue}: {false} false alarms in {len(frames)} frames")
    referee.check(solved == len(frames), f"{solved} of {len(frames)} frames solved")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dmise", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="write the table of docs/detection.md")
    parser.add_argument("--frames", type=int, help="print the table of so many frames")
    parser.add_argument("--seed", type=int, default=1, help="of the first of them (%(default)s)")
    parser.add_argument("--keep", type=pathlib.Path, help="directory for the frames")
    parser.add_argument("--each", action="store_true", help="print a line for each frame")
    options = parser.parse_args()
    dmise = options.dmise.resolve()
    for module in ("galsim", "sep"):
        try:
            __import__(module)
        except ImportError as error:
            raise referee.Missing(f"{module} is not installed (./dmise setup --tests)") from error
    with tempfile.TemporaryDirectory() as name:
        directory = options.keep or pathlib.Path(name)
        directory.mkdir(parents=True, exist_ok=True)
        if options.write:
            text = table(dmise, drawn(directory, TABLE_SEED, TABLE_FRAMES))
            begin, end = "<!-- trails -->\n", "<!-- end of trails -->\n"
            before, _, rest = DOCUMENT.read_text().partition(begin)
            DOCUMENT.write_text(before + begin + text + end + rest.partition(end)[2])
        elif options.frames:
            print(table(dmise, drawn(directory, options.seed, options.frames), options.each))
        else:
            judge(dmise, directory)


if __name__ == "__main__":
    referee.main(main)
