#!/usr/bin/env python3
"""Ends of streaks beside their bound, in frames that numpy draws.

    streak_ends.py DMISE                         some frames: the claims of `judge` hold
    streak_ends.py DMISE --frames N --seed S     prints the table of so many frames
    streak_ends.py DMISE --write                 100 frames of other seeds: writes the table of docs/detection.md

Even straight streaks of 20 to 1000 px with an SNR of 1 to 10 in a FWHM of their length lie in an empty sky, none on the line of another, blurred by a
Gaussian whose width the header states. Their image is exact: error functions along the line and across it, means over pixels by 3 x 3 places.

Bound of an end along the line: that of an ideal step in noise, blurred by a known PSF, whose height is known (Hinkley 1970, Biometrika 57, 1): the mean
square error of the mean of its posterior, which no estimate is below, by 4000 simulations. It is 16 zeta(3) / SNR^4 of a px where noise is strong, and
the Cramer-Rao bound where it is weak. What light, slope and bend add, which are not known, is that of the Cramer-Rao bounds with and without them.
Across the line, and for the centroid, it is the Cramer-Rao bound. NEES is the squared error by the published covariance over its dimensions.
"""

import argparse
import functools
import json
import pathlib
import subprocess
import tempfile

import numpy as np
from astropy.io import fits
from scipy.special import erf

import referee

BIAS, GAIN, READ_E, EXPOSURE_S, SCALE = 300.0, 1.0, 5.0, 10.0, 5.0  # arcsec/px
LENGTHS, SNRS = (20, 60, 200, 1000.1), (1, 2, 4, 10.1)
APART_PX, GATE_PX, FAR = 45.0, 5.0, 5.0
DOCUMENT = referee.SOURCE / "docs/detection.md"
TABLE_SEED, TABLE_FRAMES = 9000, 100


def step(x, sigma):
    return 0.5 * (1 + erf(x / (np.sqrt(2) * sigma)))


def normal(x, sigma):
    return np.exp(-0.5 * (x / sigma) ** 2) / (np.sqrt(2 * np.pi) * sigma)


@functools.cache
def excess_table():
    """By how much the mean square error of the best estimate of a step is above the Cramer-Rao bound, for SNR^2 of a sigma of the PSF."""
    random, rho, out = np.random.default_rng(1), np.geomspace(0.1, 100, 13), []
    for r in rho:
        reach, dx = 12 + 80 / r, min(0.2, 1 / r)
        x = np.arange(-reach, reach, dx)
        square, count = 0.0, 4000
        kernel = np.fft.rfft(np.fft.ifftshift(normal(x - x[len(x) // 2], 1.0))) * dx
        for _ in range(count // 200):
            y = np.sqrt(r) * step(x, 1.0) + random.standard_normal((200, len(x))) / np.sqrt(dx)
            smooth = np.fft.irfft(np.fft.rfft(y - np.sqrt(r) * (x > 0)) * kernel, n=len(x)) + np.sqrt(r) * step(x, 1.0)
            log = np.cumsum(r / 2 - np.sqrt(r) * smooth, axis=1) * dx
            p = np.exp(log - log.max(axis=1, keepdims=True))
            square += np.sum((p @ x / p.sum(axis=1)) ** 2)
        out.append(max(square / count / (2 * np.sqrt(np.pi) / r), 1.0))
    return rho, np.array(out)


def excess(rho):
    table = excess_table()
    return float(np.exp(np.interp(np.log(rho), np.log(table[0]), np.log(table[1]))))


def bounds(length, level, sigma, sky_e2):
    """Bounds of an end along and across, and of the centroid along and across [px^2]; sigma with the pixel's width."""
    reach = int(5 * sigma) + 2
    along = np.arange(-int(length / 2) - reach, int(length / 2) + reach + 1)[:, None] + 0.3
    across, half = np.arange(-reach, reach + 1)[None, :] + 0.2, length / 2
    body = step(along + half, sigma) - step(along - half, sigma)
    first, last = normal(along + half, sigma), normal(along - half, sigma)
    r = along / half
    light = level * body * normal(across, sigma)
    slope_across = level * body * normal(across, sigma) * across / sigma**2
    # By both ends along, offset, turn of the ends, bend, light per px, slope of light and background.
    g = [level * first * normal(across, sigma) + 0 * light, level * last * normal(across, sigma) + 0 * light, slope_across, slope_across * r,
         slope_across * (1 / 3 - r**2), light / level, light * r, np.ones_like(light)]
    g = np.array([x.ravel() for x in g])
    information = (g / (sky_e2 + light.ravel())) @ g.T
    information[-1, -1] += 1 / (0.01 * sky_e2)
    c = np.linalg.inv(information)
    rho = level**2 * np.sum(normal(across, sigma)**2 / (sky_e2 + level * normal(across, sigma))) * sigma
    end, more = (c[0, 0] + c[1, 1]) / 2, excess(rho)
    end_across = np.array([0, 0, 1, 1, -2 / 3, 0, 0, 0])
    centroid = np.array([0.5, 0.5, 0, 0, 0, 0, length / 6, 0])
    return {"end": end * more, "end_across": end_across @ c @ end_across, "middle": (c[0, 0] + c[1, 1] + 2 * c[0, 1]) / 4 * more,
            "centroid": centroid @ c @ centroid + (more - 1) * end / 2, "across": c[2, 2]}


def level_of(snr, fwhm, sigma, sky_e2):
    """Electrons per px of line for an SNR in a FWHM of it."""
    across = np.arange(-12, 12.01, 0.1)
    profile, low, high = normal(across, sigma), 1e-3, 1e6
    for _ in range(60):
        level = np.sqrt(low * high)
        found = level * np.sqrt(np.sum(profile**2 / (sky_e2 + level * profile)) * 0.1 * fwhm)
        low, high = (level, high) if found < snr else (low, level)
    return level


def add_streak(image, s, sigma):
    c, n = np.cos(s["angle"]), np.sin(s["angle"])
    reach = 6 * sigma + 2
    for y in range(max(0, int(s["y"] - abs(n) * s["length"] / 2 - reach)), min(image.shape[0], int(s["y"] + abs(n) * s["length"] / 2 + reach) + 1)):
        # Columns near the line in this row.
        middle = s["x"] + (y - s["y"]) * c / n if abs(n) > 1e-3 else s["x"]
        wide = reach / max(abs(n), 1e-3)
        x0, x1 = max(0, int(middle - wide), int(s["x"] - abs(c) * s["length"] / 2 - reach)), min(image.shape[1], int(middle + wide) + 1, int(s["x"] + abs(c) * s["length"] / 2 + reach) + 1)
        if x0 >= x1:
            continue
        x, light = np.arange(x0, x1), 0.0
        for u in (-1 / 3, 0, 1 / 3):
            for v in (-1 / 3, 0, 1 / 3):
                along, across = (x + u - s["x"]) * c + (y + v - s["y"]) * n, (y + v - s["y"]) * c - (x + u - s["x"]) * n
                light = light + (step(along + s["length"] / 2, sigma) - step(along - s["length"] / 2, sigma)) * normal(across, sigma) / 9
        image[y, x0:x1] += s["level"] * light


def draw(directory, seed):
    """Writes a frame; returns its path, streaks and PSF."""
    random = np.random.default_rng(seed)
    fwhm, sky_e = 1.8 * (4.5 / 1.8) ** random.uniform(), 10 ** random.uniform(2, 3)
    sigma = fwhm / 2.3548
    wide, sky_e2 = np.sqrt(sigma**2 + 1 / 12), sky_e + READ_E**2
    longest = LENGTHS[0] * (LENGTHS[-1] / LENGTHS[0]) ** random.uniform()
    side = int(max(400, 1.25 * longest + 150))
    streaks = []
    for _ in range(200):
        if len(streaks) == 8:
            break
        length, angle = min(longest * random.uniform(0.6, 1.0), 1000.0), random.uniform(0, np.pi)
        if length < LENGTHS[0]:
            continue
        way = np.array([np.cos(angle), np.sin(angle)])
        room = np.abs(way) * length / 2 + 30
        x, y = random.uniform(room, side - room)
        points = np.array([x, y]) + np.linspace(-0.7, 0.7, int(length / 4) + 2)[:, None] * length * way
        if any(np.min(np.hypot(*(points[:, None] - s["points"][None]).transpose(2, 0, 1))) < APART_PX for s in streaks):
            continue
        least = max(SNRS[0], 7.5 / np.sqrt(length / fwhm))
        snr = least * (SNRS[-1] / least) ** random.uniform()
        streaks.append({"x": x, "y": y, "length": length, "angle": angle, "points": points, "snr": snr, "level": level_of(snr, fwhm, wide, sky_e2)})
    image = np.full((side, side), sky_e)
    for s in streaks:
        add_streak(image, s, sigma)
        s["bounds"] = bounds(s["length"], s["level"], wide, sky_e2)
    electrons = random.poisson(image) + READ_E * random.standard_normal(image.shape)
    header = fits.Header()
    header["EXPTIME"], header["DATE-OBS"], header["MOUNT"] = EXPOSURE_S, "2024-03-05T20:15:30.000", "sidereal"
    header["EGAIN"], header["BIASLVL"], header["SATURATE"], header["FILTER"], header["PSFFWHM"] = GAIN, BIAS, 60000.0, "V", fwhm
    header["CTYPE1"], header["CTYPE2"], header["CRVAL1"], header["CRVAL2"] = "RA---TAN", "DEC--TAN", 150.0, 2.0
    header["CRPIX1"], header["CRPIX2"], header["CD1_1"], header["CD2_2"] = side / 2, side / 2, -SCALE / 3600, SCALE / 3600
    header["CD1_2"] = header["CD2_1"] = 0.0
    path = directory / f"ends-{seed}.fits"
    fits.PrimaryHDU(np.clip(np.rint(electrons / GAIN + BIAS), 0, 65535).astype(np.uint16), header).writeto(path, overwrite=True)
    return {"path": path, "streaks": streaks, "seed": seed, "fwhm": fwhm}


def detections(dmise, path):
    done = subprocess.run([dmise, "detect", path, "--catalogue", "none"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise referee.Failure(f"dmise detect {path}: {done.stderr.strip()[-300:]}")
    return [json.loads(text) for text in done.stdout.splitlines()]


def on_line(s, x, y):
    """Place along and across a streak from its middle."""
    c, n = np.cos(s["angle"]), np.sin(s["angle"])
    return (x - s["x"]) * c + (y - s["y"]) * n, (y - s["y"]) * c - (x - s["x"]) * n


def turned(s, covariance):
    """Variance along, covariance, variance across of one in x and y."""
    c, n = np.cos(s["angle"]), np.sin(s["angle"])
    xx, xy, yy = covariance
    return c * c * xx + 2 * c * n * xy + n * n * yy, c * n * (yy - xx) + (c * c - n * n) * xy, n * n * xx - 2 * c * n * xy + c * c * yy


def nees(error, covariance):
    aa, ab, bb = covariance
    return float(np.array(error) @ np.linalg.solve([[aa, ab], [ab, bb]], error) / 2)


def sky_to_px(covariance):
    """East is -x and north is y."""
    ee, en, nn = np.array(covariance) / SCALE**2
    return ee, -en, nn


def compare(dmise, frame):
    """A row for each streak: what is published of it in units of the bounds and of its errors."""
    rows, found = [], detections(dmise, frame["path"])
    for s in frame["streaks"]:
        mine = []
        for d in found:
            along, across = on_line(s, d["x_px"], d["y_px"])
            if abs(along) < s["length"] / 2 + GATE_PX and abs(across) < GATE_PX and d["kind"] == "streak":
                mine.append(d)
        row = dict(s, seed=frame["seed"], fwhm=frame["fwhm"], pieces=len(mine), found=bool(mine))
        rows.append(row)
        if not mine:
            continue
        d, b = max(mine, key=lambda one: one["length_px"]), s["bounds"]
        row["detection"] = d
        ends = [(on_line(s, *d[f"end{k}_px"]), turned(s, sky_to_px(d[f"end{k}_covariance_arcsec2"]))) for k in (1, 2)]
        ends.sort(key=lambda end: end[0][0])
        errors = [(ends[0][0][0] + s["length"] / 2, ends[0][0][1]), (ends[1][0][0] - s["length"] / 2, ends[1][0][1])]
        row["end"] = [e[0] / np.sqrt(b["end"]) for e in errors]
        row["end_across"] = [e[1] / np.sqrt(b["end_across"]) for e in errors]
        row["end_pull"] = [e[0] / np.sqrt(c[0]) for e, (_, c) in zip(errors, ends)]
        row["across_pull"] = [e[1] / np.sqrt(c[2]) for e, (_, c) in zip(errors, ends)]
        row["end_nees"] = [nees(e, c) for e, (_, c) in zip(errors, ends)]
        off = on_line(s, d["x_px"], d["y_px"])
        row["centroid"], row["centroid_across"] = off[0] / np.sqrt(b["centroid"]), off[1] / np.sqrt(b["across"])
        row["centroid_nees"] = nees(off, turned(s, d["covariance_px2"]))
        row["middle"] = (errors[0][0] + errors[1][0]) / 2 / np.sqrt(b["middle"])
    return rows


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


def cells(rows):
    found = [r for r in rows if r["found"]]
    flat = lambda key: np.ravel([r[key] for r in found])
    if not found:
        return [f"0 of {len(rows)}"] + 8 * ["-"]
    error = np.std(flat("end_nees")) / np.sqrt(len(flat("end_nees")))
    near = np.abs(flat("end")) < FAR
    return [f"{len(found)} of {len(rows)}", f"{rms(flat('end')):.2f}", f"{np.sum(~near)} of {len(near)}", f"{rms(flat('end')[near]):.2f}", f"{rms(flat('end_across')):.2f}", f"{np.mean(flat('end_nees')):.2f} +- {error:.2f}",
            f"{rms(flat('centroid')):.2f}", f"{rms(flat('centroid_across')):.2f}",
            f"{np.mean(flat('centroid_nees')):.2f} +- {np.std(flat('centroid_nees')) / np.sqrt(len(found)):.2f}"]


def bins(rows):
    for low, high in zip(LENGTHS, LENGTHS[1:]):
        for weak, strong in zip(SNRS, SNRS[1:]):
            part = [r for r in rows if low <= r["length"] < high and weak <= r["snr"] < strong]
            if part:
                yield f"{low:g} to {high:.0f} px, {weak:g} to {strong:.0f}", part
    yield "all", rows


def table(rows):
    head = ["length, SNR of a FWHM", "found", "ends, along", f"off by {FAR:g} bounds", "the others", "across", "NEES", "centroid, along", "across", "NEES"]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    lines += [f"| {name} | " + " | ".join(cells(part)) + " |" for name, part in bins(rows)]
    return "\n".join(lines) + "\n"


def rows_of(dmise, directory, seeds, each=False):
    rows = []
    for seed in seeds:
        path = directory / f"ends-{seed}.fits"
        frame = draw(directory, seed)
        rows += compare(dmise, frame)
        path.unlink()
    if each:
        for r in rows:
            said = " ".join(f"{k} {np.round(r[k], 2)}" for k in ("end", "end_pull", "end_across", "across_pull", "centroid_nees") if k in r)
            print(f"{r['seed']} L {r['length']:.0f} fwhm {r['fwhm']:.1f} snr {r['snr']:.2f} pieces {r['pieces']} {said}")
    return rows


def judge(dmise, directory):
    found = [r for r in rows_of(dmise, directory, range(21, 41)) if r["found"]]
    ends, across = np.ravel([r["end"] for r in found]), np.ravel([r["end_across"] for r in found])
    squares = np.ravel([r["end_nees"] for r in found])
    near = np.abs(ends) < FAR
    referee.check(np.mean(~near) < 0.05, f"{np.sum(~near)} of {len(ends)} ends are off by {FAR:g} bounds")
    slack = 3 * np.std(squares) / np.sqrt(len(squares))
    referee.check(rms(ends[near]) < 1.2 * (1 + 3 / np.sqrt(2 * len(ends))), f"the others along the line: {rms(ends[near]):.2f} of the bound")
    referee.check(rms(across) < 1.2 * (1 + 3 / np.sqrt(2 * len(across))), f"across: {rms(across):.2f} of the bound")
    referee.check(0.9 - slack < np.mean(squares) < 1.1 + slack, f"NEES of ends {np.mean(squares):.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dmise", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="write the table of docs/detection.md")
    parser.add_argument("--frames", type=int, help="print the table of so many frames")
    parser.add_argument("--seed", type=int, default=1, help="of the first of them (%(default)s)")
    parser.add_argument("--each", action="store_true", help="print a line for each streak")
    options = parser.parse_args()
    dmise = options.dmise.resolve()
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        if not (options.write or options.frames):
            return judge(dmise, directory)
        first, count = (TABLE_SEED, TABLE_FRAMES) if options.write else (options.seed, options.frames)
        text = table(rows_of(dmise, directory, range(first, first + count), options.each))
        if options.write:
            begin, end = "<!-- ends -->\n", "<!-- end of ends -->\n"
            before, _, rest = DOCUMENT.read_text().partition(begin)
            DOCUMENT.write_text(before + begin + text + f"\nMeasured on {referee.occasion()}.\n" + end + rest.partition(end)[2])
        else:
            print(text)


if __name__ == "__main__":
    referee.main(main)
