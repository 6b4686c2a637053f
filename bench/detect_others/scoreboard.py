#!/usr/bin/env python3
"""A public scoreboard: `dmise detect`, sep, source-extractor and photutils on frames by GalSim and SatSim.

    scoreboard.py DMISE [--galsim 200] [--satsim 100 --satsim-python PYTHON] [--seed 20000] [--write] [--json FILE] [--misses]

Each program gets the same FITS files. `dmise` runs with its defaults and without a catalogue. The others are told the width of the
point spread and the gain, and their settings (threshold, width of the filter, elongation, length, order) are chosen with knowledge of
the truth so that they find the most at our number of false alarms, or at one in ten megapixels where that is more. Streaks and points
are chosen apart, which is to the others' favour. A source within 5 px of an object's line finds it; a false alarm is near none.
Theory: the share that noise leaves above an SNR of 6, nothing hidden. --write: the tables of docs/detection.md.
"""

import argparse
import hashlib
import itertools
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor

import numpy as np
from astropy.io import fits

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
sys.path.insert(0, str(SOURCE / "tests/reference"))
import galsim_frames  # noqa: E402
import peer_detectors  # noqa: E402
import peer_frames  # noqa: E402
import peer_scores  # noqa: E402
import referee  # noqa: E402

DOCUMENT = SOURCE / "docs/detection.md"
MARKS = "<!-- scoreboard -->\n", "<!-- end of scoreboard -->\n"
THRESHOLD = 6.0
FALSE_A_MEGAPIXEL = 0.1
SNR_BINS = (6, 8, 12, 20, 60)
SETTINGS = {
    "sep": [dict(threshold=t, wider=w, contrast=c) for t, w, c in itertools.product((1.7, 2.5), (1.0, 2.0), (0.005, 1.0))],
    "source-extractor": [dict(threshold=t, wider=w, contrast=c) for t, w, c in itertools.product((0.8, 1.3), (1.0, 2.0), (0.005, 1.0))],
    "photutils": [dict(threshold=t, wider=w) for t, w in itertools.product((1.7, 2.5), (1.0, 2.0))],
}
DETECTORS = ("dmise", *SETTINGS)


def satsim_frames(python, directory, seed, count, a_process=20):
    """Its memory grows with each frame, so that a process draws few."""
    script = HERE / "satsim_frames.py"
    drawn = directory / f"satsim-{seed}-{count}-{hashlib.sha256(script.read_bytes()).hexdigest()[:12]}.json"
    said = json.loads(drawn.read_text()) if drawn.exists() else []
    for first in range(seed, seed + count, a_process) if not said else ():
        number = min(a_process, seed + count - first)
        done = subprocess.run([python, script, directory, str(first), str(number)], capture_output=True, text=True,
                              env={**os.environ, "TF_CPP_MIN_LOG_LEVEL": "3"})
        if done.returncode:
            raise referee.Failure(f"satsim: {done.stderr.strip().splitlines()[-1]}")
        said += json.loads(done.stdout.splitlines()[-1])
    drawn.write_text(json.dumps(said))
    frames = []
    for one in said:
        objects = [galsim_frames.Object(**item) for item in one["objects"]]
        frames.append(galsim_frames.Frame(pathlib.Path(one["path"]), one["mount"], "", one["fwhm_px"], 1.0, 59000.0, 512 * 512 / 1e6,
                                          math.nan, objects))
    return frames


def even_counts(path):
    """Counts as others should have them: the colours of a mosaic brought to one level."""
    counts, header = fits.getdata(path).astype(np.float32), fits.getheader(path)
    if "BAYERPAT" not in header:
        return counts
    bias = header["BIASLVL"]
    levels = {at: np.median(counts[at[0]::2, at[1]::2] - bias) for at in itertools.product((0, 1), (0, 1))}
    for (row, column), level in levels.items():
        counts[row::2, column::2] = bias + (counts[row::2, column::2] - bias) * (max(levels.values()) / level)
    return counts


def with_photutils(counts, header, threshold, wider=1.0):
    from astropy.convolution import convolve_fft
    from photutils.background import Background2D, MedianBackground
    from photutils.segmentation import SourceCatalog, detect_sources
    background = Background2D(counts, 64, filter_size=3, bkg_estimator=MedianBackground())
    data, noise = counts - background.background, background.background_rms
    kernel = peer_detectors.kernel(wider * header["PSFFWHM"])
    smooth = convolve_fft(data, kernel, boundary="wrap", normalize_kernel=True)
    segments = detect_sources(smooth, threshold * noise * np.sqrt(np.sum(kernel**2)), npixels=peer_detectors.LEAST_PIXELS)
    if segments is None:
        return peer_detectors.catalogue({"x": np.zeros(0)})
    found = SourceCatalog(data, segments, convolved_data=smooth)
    x, y = np.nan_to_num(found.xcentroid), np.nan_to_num(found.ycentroid)
    local = noise[np.clip(np.rint(y), 0, None).astype(int), np.clip(np.rint(x), 0, None).astype(int)]
    axes = [np.sqrt(12) * np.nan_to_num(axis.value) for axis in (found.semimajor_sigma, found.semiminor_sigma)]
    return peer_detectors.catalogue({"x": x, "y": y, "length": axes[0], "width": axes[1],
                                     "snr": found.segment_flux / (local * np.sqrt(found.area.value))})


def kept(path, name, find):
    """What another detector finds in a frame with each of its settings; it is kept beside the frame, for the same bytes, settings and versions."""
    digest = hashlib.sha256(f"{name} {SETTINGS[name]} {versions()}".encode() + path.read_bytes()).hexdigest()[:12]
    file = path.with_name(f"{path.stem}-{name}-{digest}.npz")
    if not file.exists():
        found = [find(**setting) for setting in SETTINGS[name]]
        np.savez(file.with_suffix(".part.npz"), *found)
        file.with_suffix(".part.npz").rename(file)
    with np.load(file) as arrays:
        return [arrays[f"arr_{i}"] for i in range(len(SETTINGS[name]))]


def found_in(job):
    """{detector: [catalogue of each setting]} of a frame."""
    dmise, frame, detectors = job
    header, counts = frame.header(), even_counts(frame.path)
    with tempfile.TemporaryDirectory() as name:
        even = pathlib.Path(name) / "even.fits"
        fits.writeto(even, counts)
        by = {"sep": lambda **s: peer_detectors.with_sep(counts, header, light=False, **s)[0],
              "source-extractor": lambda **s: peer_detectors.with_source_extractor(even, header, **s)[0],
              "photutils": lambda **s: with_photutils(counts, header, **s)}
        out = {name: kept(frame.path, name, by[name]) for name in detectors if name != "dmise"}
    return {"dmise": [peer_detectors.dmise(dmise, frame.path, "--catalogue", "none")], **out}


def line_of(item):
    half = item.length_px / 2 * np.array([np.cos(item.angle_rad), np.sin(item.angle_rad)])
    middle = np.array([item.x_px, item.y_px])
    return np.array([middle - half, middle + half])


def scene_of(frame, streaks):
    """The frame's streaks, or points, as what is to be found."""
    scene = peer_frames.Scene(frame.path)
    for item in frame.objects:
        if (item.length_px > 0) == streaks and item.snr >= SNR_BINS[0]:
            scene.streaks.append(peer_frames.Streak(line_of(item), 1.0, item.snr))
        else:
            scene.others.append(line_of(item))
    return scene


class Group:
    """Frames of one row of the tables."""

    def __init__(self, name, frames, found):
        self.name, self.frames, self.found = name, frames, found
        self.megapixels = sum(frame.megapixels for frame in frames)
        self.scenes = {streaks: [scene_of(frame, streaks) for frame in frames] for streaks in (True, False)}
        self.false_alarms = self.candidates("dmise", 0, True).false_alarms()

    def candidates(self, detector, setting, streaks):
        return peer_scores.Candidates([found[detector][setting] for found in self.found], self.scenes[streaks])

    def snr(self, streaks):
        return np.array([s.snr for scene in self.scenes[streaks] for s in scene.streaks])

    def hits(self, detector, streaks):
        """Whether each object is found, at equal false alarms."""
        allowed = max(self.false_alarms, int(FALSE_A_MEGAPIXEL * self.megapixels))
        if detector == "dmise":
            best = self.candidates(detector, 0, streaks).best(allowed)
        else:
            sets = []
            for setting in range(len(SETTINGS[detector])):
                candidates = self.candidates(detector, setting, streaks)
                sets.append((candidates.best_of_cuts if streaks else candidates.best_of_points)(allowed))
            best = max(sets, key=len)
        return np.isin(np.arange(len(self.snr(streaks))), list(best))


def groups_of(frames, found):
    """By renderer and mount, and GalSim's by stars and width of the point spread."""
    where = {}
    for i, frame in enumerate(frames):
        by_galsim = "galsim" in frame.path.name
        names = [f"{'GalSim' if by_galsim else 'SatSim'}, mount {'on the stars' if frame.mount == 'sidereal' else 'on a target' if frame.mount == 'target' else 'at rest'}"]
        if by_galsim:
            names.append("few stars (20 to 200 a Mpx)" if frame.stars < 200 else "many (200 to 1000)" if frame.stars < 1000 else "crowded (1000 to 3000)")
            names.append("sharp (FWHM below 2 px)" if frame.fwhm_px < 1.9 else "broad (above 3.5 px)" if frame.fwhm_px > 3.5 else "FWHM of 2 to 3.5 px")
            if "BAYERPAT" in fits.getheader(frame.path):
                names.append("colour mosaic")
        for name in names:
            where.setdefault(name, []).append(i)
    return [Group(name, [frames[i] for i in at], [found[i] for i in at]) for name, at in sorted(where.items())]


def theory(snr):
    return float(np.mean([0.5 * (1 + math.erf((s - THRESHOLD) / math.sqrt(2))) for s in snr])) if len(snr) else math.nan


def cells(hits):
    """Counts of the detectors, the best in bold."""
    counts = [int(h.sum()) for h in hits]
    return [f"**{n}**" if n == max(counts) else str(n) for n in counts]


def groups_table(groups, detectors):
    rows = [["frames", "objects", "theory", *detectors, "dmise's false alarms a Mpx"]]
    for group in groups:
        for streaks, what in ((True, "streaks"), (False, "points among trails")):
            snr = group.snr(streaks)
            if len(snr) >= 10:
                rate = group.false_alarms / group.megapixels
                rows.append([group.name, f"{len(snr)} {what}", f"{theory(snr) * len(snr):.0f}",
                             *cells([group.hits(d, streaks) for d in detectors]), f"{rate:.2f}"])
    return rows


def snr_table(groups, detectors):
    rows = [["frames", "objects", "SNR", "of", "theory", *detectors]]
    for group in (g for g in groups if "mount" in g.name):
        for streaks, what in ((True, "streaks"), (False, "points")):
            snr, hits = group.snr(streaks), [group.hits(d, streaks) for d in detectors]
            for low, high in zip(SNR_BINS, SNR_BINS[1:]):
                within = (snr >= low) & (snr < high)
                if within.sum() >= 5:
                    rows.append([group.name, what, f"{low} to {high}", str(within.sum()), f"{theory(snr[within]) * within.sum():.0f}",
                                 *cells([h[within] for h in hits])])
    return rows


def text_of(rows):
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|---" * len(rows[0]) + "|", *lines[1:]]) + "\n"


def versions():
    import photutils
    return f"{peer_detectors.versions()}, satsim 0.27.1, photutils {photutils.__version__}"


def misses(groups):
    """Our bright misses and false alarms, to look at."""
    for group in (g for g in groups if "mount" in g.name):
        for frame, found in zip(group.frames, group.found):
            ours = found["dmise"][0]
            for item in frame.objects:
                if item.snr > 12 and not np.any(item.distance_px(ours["x"], ours["y"]) < peer_scores.GATE_PX):
                    print(f"missed {frame.path.name} {frame.mount} {frame.psf} {item.length_px:.0f} px, SNR {item.snr:.0f} at {item.x_px:.0f},{item.y_px:.0f}")
            for one in ours:
                if not any(item.distance_px(one["x"], one["y"]) < peer_scores.GATE_PX for item in frame.objects):
                    print(f"false {frame.path.name} {frame.mount} {frame.psf} {one['length']:.0f} px, SNR {one['snr']:.1f} at {one['x']:.0f},{one['y']:.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dmise", type=pathlib.Path)
    parser.add_argument("--galsim", type=int, default=200, help="frames (%(default)s)")
    parser.add_argument("--satsim", type=int, default=100, help="frames (%(default)s)")
    parser.add_argument("--satsim-python", help="a Python with satsim 0.27.1; without it no frames are by SatSim")
    parser.add_argument("--seed", type=int, default=20000, help="of the first frame of each kind (%(default)s)")
    parser.add_argument("--detectors", nargs="*", choices=DETECTORS, default=DETECTORS, help="beside dmise; all unless given")
    parser.add_argument("--jobs", type=int, default=2, help="processes (%(default)s)")
    parser.add_argument("--keep", type=pathlib.Path, help="directory for the frames and what others find in them, which is used again")
    parser.add_argument("--write", action="store_true", help="write the tables of docs/detection.md")
    parser.add_argument("--misses", action="store_true", help="list our bright misses and false alarms")
    options = parser.parse_args()
    dmise, detectors = options.dmise.resolve(), tuple(dict.fromkeys(["dmise", *options.detectors]))
    with tempfile.TemporaryDirectory() as name, ProcessPoolExecutor(options.jobs) as pool:
        directory = options.keep or pathlib.Path(name)
        directory.mkdir(parents=True, exist_ok=True)
        seeds = range(options.seed, options.seed + options.galsim)
        frames = list(pool.map(galsim_frames.draw, itertools.repeat(directory), seeds))
        if options.satsim_python and options.satsim:
            frames += satsim_frames(options.satsim_python, directory, options.seed, options.satsim)
        found = list(pool.map(found_in, [(dmise, frame, detectors) for frame in frames]))
        groups = groups_of(frames, found)
        text = (text_of(groups_table(groups, detectors)) + "\n" + text_of(snr_table(groups, detectors)) +
                f"\n{len(frames)} frames, seeds from {options.seed} on. Measured on {referee.occasion()}; {versions()}.\n")
        if options.misses:
            misses(groups)
        if options.write:
            before, _, rest = DOCUMENT.read_text().partition(MARKS[0])
            DOCUMENT.write_text(before + MARKS[0] + text + MARKS[1] + rest.partition(MARKS[1])[2])
        else:
            print(text)


if __name__ == "__main__":
    referee.main(main)
