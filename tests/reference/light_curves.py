#!/usr/bin/env python3
"""Light curves along streaks and their periods, in frames that GalSim draws photon by photon.

    light_curves.py DMISE                     four frames: the claims of `judge` hold
    light_curves.py DMISE --write             frames of other seeds: writes the tables of docs/detection.md
    light_curves.py DMISE --frames N --seed S [--keep DIR] [--each]

A frame has 1000 x 1000 pixels, a round PSF (Gaussian, Moffat or Kolmogorov) of FWHM 1.6 to 5 px, 60 stars and eight streaks of 40 to 400 px. Two in
seven are sines, two flash (from half a FWHM of the PSF to a seventh of the period long, above a floor), one is boxes above a floor, one blinks (dark between),
one is steady. A streak has 1, 2, 3, 5, 10 or 20 flashes, of which each is whole or cut by an end, or about as many periods of a sine; of a sine of one, 1 to
1.4. Photons of GalSim's PSF are moved along the line by a draw from the light curve, so that their noise is their own. `SNR` is that of a FWHM's length of
the mean light in the noise of sky and light.

Periods are compared along the line [px], as drawn: in time they also have the errors of the ends. `astropy` is the second opinion: its multi-term
Lomb-Scargle periodogram of the published light curve. Without GalSim this says so and exits 77, with DMISE_DATA set 1.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np
from astropy.io import fits
from astropy.timeseries import LombScargle

import referee

SIDE, BIAS, GAIN, READ_E, FULL_E, EXPOSURE_S = 1000, 300.0, 1.0, 5.0, 60000.0, 10.0
STREAKS, STARS, APART_PX, GATE_PX = 8, 60, 40.0, 4.0
KINDS = ("sine", "sine", "flash", "flash", "box", "blink", "steady")
COUNTS = (1, 2, 3, 5, 10, 20)  # flashes of a streak
SNR_BINS = (5, 8, 13, 20, 30.1)
MAX_PULL = 5.0  # of one streak in a mean of squares
DOCUMENT = referee.SOURCE / "docs/detection.md"
TABLE_SEED, TABLE_FRAMES = 13000, 60


def light(kind, cycles, phase, depth, duty, share):
    """Light at a share of the line, of mean about 1."""
    turn = cycles * share + phase
    if kind == "sine":
        return 1 + depth * np.sin(2 * np.pi * turn)
    if kind == "flash":
        off = (turn + 0.5) % 1 - 0.5
        flash = np.exp(-0.5 * (off / (duty / 2.355)) ** 2)
        return (1 - depth) + depth * flash / (duty * 1.0645)
    if kind in ("box", "blink"):
        return (1 - depth) + depth * np.where((turn + duty / 2) % 1 < duty, 1 / duty, 0.0)
    return np.ones_like(share)


def shape(galsim, random):
    fwhm = 1.6 * (5 / 1.6) ** random.uniform()
    return fwhm, random.choice([galsim.Gaussian(fwhm=fwhm), galsim.Moffat(beta=random.uniform(2.8, 4.5), fwhm=fwhm), galsim.Kolmogorov(fwhm=fwhm)])


def lines_apart(random, lengths):
    """Middles and directions of lines that keep a distance from each other."""
    out = []
    for length in lengths:
        while True:
            angle = random.uniform(0, np.pi)
            reach = np.abs([np.cos(angle), np.sin(angle)]) * length / 2 + 25
            middle = random.uniform(reach, SIDE - reach)
            share = np.linspace(-0.5, 0.5, 60)
            points = middle + np.outer(share * length, [np.cos(angle), np.sin(angle)])
            if all(np.min(np.hypot(*(points[:, None] - other[None]).transpose(2, 0, 1))) > APART_PX for _, _, other in out):
                out.append((middle, angle, points))
                break
    return out


def profile_of(galsim, psf):
    """Light of a px of a line of one e/px in pixels across it, at every tenth of a px: GalSim's PSF with the pixel."""
    stamp = galsim.Convolve(psf, galsim.Pixel(1.0)).drawImage(nx=400, ny=400, scale=0.1, method="no_pixel", dtype=float).array
    return stamp.sum(axis=0) / stamp.sum() / 0.1


def information(e_per_px, profile, sky_e2):
    """Fisher information of the light of a px of line [1/e^2], by its profile across: sky's noise and its own photons'."""
    return np.sum(profile**2 / (sky_e2 + e_per_px * profile)) * 0.1


def level_of(snr, fwhm, profile, sky_e2):
    """Electrons a px of line for an SNR of a FWHM of it."""
    low, high = 1e-3, 1e7
    for _ in range(80):
        level = np.sqrt(low * high)
        low, high = (level, high) if level * np.sqrt(information(level, profile, sky_e2) * fwhm) < snr else (low, level)
    return level


def widths_of(random, kind, count):
    """Length of a flash over the period, and the shortest period [FWHM]."""
    if kind == "flash":
        return None, 4.0
    duty = random.uniform(0.2, 0.6)
    return duty, {"sine": 2.0, "box": 1.5 / min(duty, 1 - duty), "blink": 3 / min(duty, 1 - duty), "steady": 0.0}[kind]


def streak_of(random, fwhm, profile, sky_e2):
    while True:
        kind, count, length = random.choice(KINDS), int(random.choice(COUNTS)), 40 * 10 ** random.uniform()
        duty, shortest = widths_of(random, kind, count)
        left = random.uniform(0.1, 0.95)  # of a period, beside the last flash and the first one
        cycles = count - 1 + left if kind != "sine" else count + (0.4 * left if count == 1 else 0.6 * (left - 0.5))
        if length / cycles > shortest * fwhm:
            break
    period = length / cycles
    if duty is None:
        duty = 0.5 * fwhm / period * (0.15 / (0.5 * fwhm / period)) ** random.uniform()
    phase = random.uniform() if kind == "sine" else -random.uniform(0, left)
    snr = SNR_BINS[0] * (SNR_BINS[-1] / SNR_BINS[0]) ** random.uniform()
    depth = random.uniform(0.25, 0.9) if kind != "blink" else 1.0
    return {"kind": str(kind), "count": count, "length": float(length), "cycles": float(cycles), "phase": float(phase), "depth": float(depth),
            "duty": float(duty), "snr": float(snr), "level": float(level_of(snr, fwhm, profile, sky_e2)), "fwhm": float(fwhm), "sky_e2": float(sky_e2),
            "profile": profile}


def add_photons(galsim, psf, generator, random, streak, image):
    """Photons of the PSF, each moved to where the object was when it came."""
    share = (np.arange(20000) + 0.5) / 20000
    curve = light(streak["kind"], streak["cycles"], streak["phase"], streak["depth"], streak["duty"], share)
    streak["mean"] = streak["level"] * float(np.mean(curve))
    whole = light(streak["kind"], 1.0, 0.0, streak["depth"], streak["duty"], share)
    streak["amplitude"] = float(np.ptp(whole) / 2 / np.mean(whole))
    count = int(random.poisson(streak["mean"] * streak["length"]))
    photons = psf.shoot(count, generator)
    at = (np.interp(random.uniform(size=count), np.cumsum(curve) / np.sum(curve), share + 0.5 / 20000) - 0.5) * streak["length"]
    c, s = np.cos(streak["angle"]), np.sin(streak["angle"])
    x, y = np.rint(photons.x + streak["x"] + at * c).astype(int), np.rint(photons.y + streak["y"] + at * s).astype(int)
    inside = (x >= 0) & (y >= 0) & (x < SIDE) & (y < SIDE)
    np.add.at(image, (y[inside], x[inside]), 1.0)


def draw(directory, seed):
    """Writes a frame; returns its path and the streaks in it."""
    import galsim
    random, generator = np.random.default_rng(seed), galsim.BaseDeviate(seed + 1)
    fwhm, psf = shape(galsim, random)
    sky_e = 10 ** random.uniform(1.8, 3.0)
    image = random.poisson(sky_e, (SIDE, SIDE)).astype(float)
    profile = profile_of(galsim, psf)
    streaks = [streak_of(random, fwhm, profile, sky_e + READ_E**2) for _ in range(STREAKS)]
    places = lines_apart(random, [s["length"] for s in streaks])
    for streak, (middle, angle, _) in zip(streaks, places):
        streak.update(x=float(middle[0]), y=float(middle[1]), angle=float(angle))
        add_photons(galsim, psf, generator, random, streak, image)
    points = np.concatenate([p for _, _, p in places])
    for _ in range(STARS):
        while True:
            x, y = random.uniform(20, SIDE - 20, 2)
            if np.min(np.hypot(points[:, 0] - x, points[:, 1] - y)) > 20:
                break
        photons = psf.shoot(int(300 * fwhm * np.sqrt(sky_e) * 10 ** random.uniform(-0.9, 0.6)), generator)
        px, py = np.rint(photons.x + x).astype(int), np.rint(photons.y + y).astype(int)
        inside = (px >= 0) & (py >= 0) & (px < SIDE) & (py < SIDE)
        np.add.at(image, (py[inside], px[inside]), 1.0)
    electrons = np.minimum(image, FULL_E) + READ_E * random.standard_normal(image.shape)
    counts = np.clip(np.rint(electrons / GAIN + BIAS), 0, 65535).astype(np.uint16)
    header = fits.Header()
    header["EXPTIME"], header["DATE-OBS"], header["MOUNT"] = EXPOSURE_S, "2024-03-05T20:15:30.000", "sidereal"
    header["EGAIN"], header["BIASLVL"], header["SATURATE"], header["FILTER"] = GAIN, BIAS, FULL_E / GAIN + BIAS - 200, "V"
    header["PSFFWHM"] = round(0.95 * fwhm, 2)
    path = directory / f"curves-{seed}.fits"
    fits.PrimaryHDU(counts, header).writeto(path, overwrite=True)
    return {"path": path, "streaks": streaks, "seed": seed}


def detections(dmise, path):
    done = subprocess.run([dmise, "detect", path, "--catalogue", "none", "--light-curves"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise referee.Failure(f"dmise detect {path}: {done.stderr.strip()[-300:]}")
    return [json.loads(text) for text in done.stdout.splitlines()]


def on_streak(streak, found):
    """Detections with their middle on a streak."""
    c, s = np.cos(streak["angle"]), np.sin(streak["angle"])
    out = []
    for d in found:
        x, y = d["x_px"] - streak["x"], d["y_px"] - streak["y"]
        if abs(x * c + y * s) < streak["length"] / 2 + GATE_PX and abs(y * c - x * s) < GATE_PX:
            out.append(d)
    return out


def amplitude_sigma(streak):
    """Sigma of a sine's amplitude over the mean light, by hand: the information of the line's light, of which the PSF leaves a part, and the error of
    the mean."""
    profile, frequency = streak["profile"], streak["cycles"] / streak["length"]
    left = np.sum(profile * np.cos(2 * np.pi * frequency * 0.1 * (np.arange(len(profile)) - (len(profile) - 1) / 2))) * 0.1
    fisher = information(streak["mean"], profile, streak["sky_e2"]) * streak["length"]
    return np.sqrt(2 / fisher / left**2 + streak["depth"] ** 2 / fisher) / streak["mean"]


def second_opinion(curve):
    """The period [px] of astropy's periodogram of a published light curve, with as many harmonics as its bins can show."""
    along, e, sigma = (np.array(curve[k]) for k in ("along_px", "light_e", "sigma_e"))
    length, period = len(along) * curve["bin_px"], curve["period"]
    highest, near = 1 / (2 * curve["bin_px"]), 1 / period["period_px"]
    terms = int(np.clip(0.7 * highest / near, 1, min(period["harmonics"], 4)))
    frequency = np.arange(max(1 / length, near / 3), min(highest / terms, 2.5 * near), 0.002 * near)
    try:
        power = LombScargle(along, e, sigma, nterms=terms).power(frequency)
    except np.linalg.LinAlgError:
        return np.nan
    return 1 / frequency[np.argmax(power)] if len(power) else np.nan


def compare(dmise, frame):
    """A row for each streak: its truth, what was found on it, and the period."""
    rows, found = [], detections(dmise, frame["path"])
    for streak in frame["streaks"]:
        mine = on_streak(streak, found)
        row = dict(streak, seed=frame["seed"], pieces=len(mine), curve=None, period=None, other=None)
        whole = [d for d in mine if d["length_px"] > 0.5 * streak["length"] * (0.8 if streak["kind"] == "blink" else 1.6) and "light_curve" in d]
        if whole:
            row["detection"], row["curve"] = whole[0], whole[0]["light_curve"]
            row["period"] = row["curve"].get("period")
        truth = streak["length"] / streak["cycles"]
        if row["curve"] and streak["kind"] != "steady":
            row["bound"] = row["curve"].get("min_period_px")
            row["bound"] = row["bound"] / truth if row["bound"] else None
        if row["period"] and streak["kind"] != "steady":
            row["error"] = row["period"]["period_px"] / truth - 1
            row["pull"] = (row["period"]["period_px"] - truth) / row["period"]["period_sigma_px"]
            row["error_s"] = row["period"]["period_s"] * streak["cycles"] / EXPOSURE_S - 1
            row["pull_s"] = row["error_s"] * row["period"]["period_s"] / row["period"]["period_sigma_s"]
            row["pull_a"] = (row["period"]["amplitude"] - streak["amplitude"]) / row["period"]["amplitude_sigma"]
            row["other"] = second_opinion(row["curve"]) / truth - 1
        rows.append(row)
    return rows


def share(good, of):
    return f"{sum(good)} of {len(list(of))}"


def mean_square(pulls):
    return f"{np.mean(np.minimum(np.abs(pulls), MAX_PULL) ** 2):.2f}" if len(pulls) else "-"


def shows_amplitude(row):
    """Whether the PSF leaves what is to be measured: sines, and flashes wider than it."""
    wide = row["duty"] * row["length"] / row["cycles"] / row["fwhm"]
    return row["kind"] == "sine" or (row["kind"] == "flash" and wide > 2)


def period_cells(rows):
    """See HEAD."""
    curves = [r for r in rows if r["curve"]]
    periods = [r for r in curves if r["period"]]
    right = [r for r in periods if abs(r["error"]) < 0.2]
    bounds = [r for r in curves if r["bound"]]
    errors = [abs(r["error"]) for r in right]
    return [f"{len(rows)}", f"{len(curves)}", f"{len(periods)}", f"{sum(abs(r['error']) < 0.01 for r in periods)}",
            f"{100 * np.median(errors):.2f} %" if errors else "-", mean_square([r["pull"] for r in right]), f"{len(periods) - len(right)}",
            f"{sum(abs(r['other']) < 0.01 for r in periods)}", mean_square([r["pull_a"] for r in right if shows_amplitude(r)]),
            f"{100 * np.median([abs(r['error_s']) for r in right]):.2f} %" if right else "-", mean_square([r["pull_s"] for r in right]),
            f"{sum(r['bound'] < 1.01 for r in bounds)} of {len(bounds)}", f"{np.median([r['bound'] for r in bounds]):.2f}" if bounds else "-"]


HEAD = ["streaks", "curves", "periods", "within 1 %", "median error", "NEES", "wrong by 20 %", "astropy within 1 %", "NEES of amplitude",
        "median error of seconds", "NEES", "bounds that hold", "over the period"]


def bins_of(rows, key, edges):
    return [(f"{low:g} to {high:.0f}", [r for r in rows if low <= r[key] < high]) for low, high in zip(edges, edges[1:])]


def tables(rows):
    lines = ["| light | " + " | ".join(HEAD) + " |", "|---" * (len(HEAD) + 1) + "|"]
    for kind in ("sine", "flash", "box"):
        some = [r for r in rows if r["kind"] == kind]
        for count in COUNTS:
            lines.append(f"| {kind}, {count} | " + " | ".join(period_cells([r for r in some if r["count"] == count])) + " |")
    lines.append("| blink | " + " | ".join(period_cells([r for r in rows if r["kind"] == "blink"])) + " |")
    moving = [r for r in rows if r["kind"] in ("sine", "flash", "box") and (r["count"] > 1 or r["kind"] == "sine")]
    for name, part in bins_of(moving, "snr", SNR_BINS):
        lines.append(f"| all but blinks and one flash, SNR {name} | " + " | ".join(period_cells(part)) + " |")
    lines.append("| all of them | " + " | ".join(period_cells(moving)) + " |")
    steady = [r for r in rows if r["kind"] == "steady" and r["curve"]]
    lines += ["", f"Steady streaks with a period: {share([bool(r['period']) for r in steady], steady)}.", ""]
    lines += amplitude_lines(rows)
    split = [r for r in rows if r["kind"] == "blink"]
    lines.append(f"Blinking streaks that are one detection: {share([r['pieces'] == 1 for r in split], split)}, several: "
                 f"{sum(r['pieces'] > 1 for r in split)}, none: {sum(r['pieces'] == 0 for r in split)}.")
    return "\n".join(lines) + "\n"


def amplitude_rows(rows):
    return [r for r in rows if r["kind"] == "sine" and r["period"] and r["period"]["harmonics"] == 1 and abs(r["error"]) < 0.2 and r["cycles"] >= 2]


def amplitude_lines(rows):
    some = amplitude_rows(rows)
    if not some:
        return []
    off = np.array([r["period"]["amplitude"] - r["depth"] for r in some])
    said, hand = np.array([r["period"]["amplitude_sigma"] for r in some]), np.array([amplitude_sigma(r) for r in some])
    return [f"Amplitudes of {len(some)} sines of two periods and more: error over the published sigma {np.sqrt(np.mean((off / said) ** 2)):.2f} rms, over noise "
            f"theory {np.sqrt(np.mean((off / hand) ** 2)):.2f} rms; the published sigma is {np.median(said / hand):.2f} of theory's (median).", ""]


def steady_pulls(rows):
    """Light of bins of steady streaks less the light drawn, in units of their sigma; without the bins of both ends."""
    out = []
    for r in rows:
        if r["kind"] == "steady" and r["curve"]:
            e, sigma = np.array(r["curve"]["light_e"]), np.array(r["curve"]["sigma_e"])
            out.extend(((e - r["mean"] * r["curve"]["bin_px"]) / sigma)[2:-2])
    return np.array(out)


def judge(dmise, directory):
    rows = [row for seed in (11, 12, 13, 14) for row in compare(dmise, draw(directory, seed))]
    some = [r for r in rows if r["kind"] in ("sine", "flash", "box") and r["count"] > 2 and r["curve"]]
    published = [r for r in rows if r["period"] and r["kind"] != "steady"]
    referee.check(sum(bool(r["period"]) for r in some) >= 0.8 * len(some), f"{sum(bool(r['period']) for r in some)} of {len(some)} streaks of three flashes and more have a period")
    right = [r for r in published if abs(r["error"]) < max(0.01, 4 * r["period"]["period_sigma_px"] * r["cycles"] / r["length"])]
    referee.check(len(right) >= 0.95 * len(published), f"{len(right)} of {len(published)} periods within 1 % or four sigmas")
    bounds = [r for r in rows if r.get("bound")]
    referee.check(all(r["bound"] < 1.01 for r in bounds), f"{sum(r['bound'] < 1.01 for r in bounds)} of {len(bounds)} bounds hold")
    for what, pulls in (("periods", [r["pull"] for r in published]), ("amplitudes", [r["pull_a"] for r in published if shows_amplitude(r)])):
        nees, error = np.mean(np.minimum(np.abs(pulls), MAX_PULL) ** 2), np.sqrt(2 / len(pulls))
        referee.check(nees < 1.2 + 3 * error, f"NEES of {len(pulls)} {what} {nees:.2f}")
    steady = [r for r in rows if r["kind"] == "steady" and r["curve"]]
    referee.check(not any(r["period"] for r in steady), f"no period in {len(steady)} steady streaks")
    pulls = steady_pulls(rows)
    referee.check(0.85 < np.std(pulls) < 1.2, f"light of {len(pulls)} steady bins scatters by {np.std(pulls):.2f} of its sigma")
    off = [(r["period"]["amplitude"] - r["depth"]) / amplitude_sigma(r) for r in amplitude_rows(rows)]
    referee.check(np.sqrt(np.mean(np.square(off))) < 2, f"{len(off)} amplitudes within {np.sqrt(np.mean(np.square(off))):.2f} of noise theory")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dmise", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="write the tables of docs/detection.md")
    parser.add_argument("--frames", type=int, help="print the tables of so many frames")
    parser.add_argument("--seed", type=int, default=1, help="of the first of them (%(default)s)")
    parser.add_argument("--keep", type=pathlib.Path, help="directory for the frames")
    parser.add_argument("--each", action="store_true", help="print a line for each streak")
    options = parser.parse_args()
    dmise = options.dmise.resolve()
    try:
        __import__("galsim")
    except ImportError as error:
        raise referee.Missing("galsim is not installed (./dmise setup --tests)") from error
    with tempfile.TemporaryDirectory() as name:
        directory = options.keep or pathlib.Path(name)
        directory.mkdir(parents=True, exist_ok=True)
        if not (options.write or options.frames):
            return judge(dmise, directory)
        first, count = (TABLE_SEED, TABLE_FRAMES) if options.write else (options.seed, options.frames)
        rows = [row for seed in range(first, first + count) for row in compare(dmise, draw(directory, seed))]
        if options.each:
            for r in rows:
                said = r["period"]
                print(f"{r['seed']} {r['kind']:6} L {r['length']:.0f} fwhm {r['fwhm']:.1f} {r['count']} n {r['cycles']:.2f} duty {r['duty']:.2f} snr {r['snr']:.1f} depth {r['depth']:.2f} "
                      f"pieces {r['pieces']} {'curve' if r['curve'] else 'none'} " +
                      (f"P {said['period_px']:.2f} H {said['harmonics']} fap {said['false_alarm']:.1g}" if said else "") +
                      (f" error {100 * r['error']:.2f} % pull {r['pull']:.1f} pull_a {r['pull_a']:.1f} astropy {100 * r['other']:.1f} %" if "error" in r else "") +
                      (f" over {r['bound']:.2f}" if r.get("bound") else ""))
            pulls = steady_pulls(rows)
            print(f"bins of steady streaks: {np.mean(pulls):.3f} +- {np.std(pulls):.3f}" if len(pulls) else "no steady bins")
        if options.write:
            begin, end = "<!-- curves -->\n", "<!-- end of curves -->\n"
            before, _, rest = DOCUMENT.read_text().partition(begin)
            DOCUMENT.write_text(before + begin + tables(rows) + end + rest.partition(end)[2])
        else:
            print(tables(rows))


if __name__ == "__main__":
    referee.main(main)
