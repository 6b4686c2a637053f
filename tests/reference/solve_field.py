"""astrometry.net, told nothing but the rough scale, agrees with the WCS that the frames carry.

    solve_field.py RUN

The first frame of every sensor. A field wider than 20 deg is solved in crops: the middle and two
opposite corners. Tolerance: 0.3 px rms over a grid of the crop, systematic shift included.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from astropy.io import fits
from astropy.wcs import WCS

import referee

TOLERANCE_PX = 0.3
WIDEST_DEG = 20.0
DEADLINE_S = 120


def crops(frame):
    """[(name, row slice, column slice)] that astrometry.net can take whole."""
    rows, columns = frame.counts.shape
    widest = int(WIDEST_DEG / frame.scale_deg)
    if max(rows, columns) <= widest:
        return [("whole", slice(0, rows), slice(0, columns))]
    high, wide = min(rows, widest), min(columns, widest)
    top, left = (rows - high) // 2, (columns - wide) // 2
    return [("middle", slice(top, top + high), slice(left, left + wide)),
            ("first corner", slice(0, high), slice(0, wide)),
            ("last corner", slice(rows - high, rows), slice(columns - wide, columns))]


def scale_deg(frame, x, y):
    """Smallest and largest scale around a pixel: a gnomonic field's grows outwards."""
    points = frame.wcs.all_pix2world([[x, y], [x + 10, y], [x, y + 10]], 0)
    away = np.radians(points[1:] - points[0])
    away[:, 0] = (away[:, 0] + np.pi) % (2 * np.pi) - np.pi
    away[:, 0] *= np.cos(np.radians(points[0][1]))
    return np.degrees(np.hypot(*away.T)) / 10


def solve(frame, rows, columns, directory):
    """WCS by astrometry.net of a crop; None where it finds none."""
    counts = frame.counts[rows, columns]
    sources = referee.extract_sources(counts, directory, aperture_px=6 + frame.trail_px)
    brightest = np.argsort(-sources["flux"])[:200]
    fits.BinTableHDU.from_columns([
        fits.Column("X", "D", array=sources["x"][brightest] + 1),
        fits.Column("Y", "D", array=sources["y"][brightest] + 1),
        fits.Column("FLUX", "D", array=sources["flux"][brightest]),
    ]).writeto(directory / "field.xyls", overwrite=True)
    height, width = counts.shape
    corners = [(x, y) for x in (columns.start, columns.stop - 1) for y in (rows.start, rows.stop - 1)]
    scales = np.concatenate([scale_deg(frame, x, y) for x, y in corners]) * 3600
    subprocess.run([
        referee.need("solve-field"), "field.xyls", "--width", str(width), "--height", str(height),
        "--x-column", "X", "--y-column", "Y", "--sort-column", "FLUX", "--scale-units", "arcsecperpix",
        "--scale-low", f"{scales.min() * 0.7:.4f}", "--scale-high", f"{scales.max() * 1.3:.4f}",
        "--no-plots", "--overwrite", "--no-verify", "--crpix-center", "--tweak-order", "3",
        "--cpulimit", str(DEADLINE_S), "--pixel-error", "0.5",
    ], cwd=directory, capture_output=True, text=True, timeout=4 * DEADLINE_S, check=False)
    solved = directory / "field.wcs"
    return WCS(fits.getheader(solved)) if solved.exists() else None, len(brightest)


def disagreement_px(frame, rows, columns, solved):
    """rms distance [px] over a grid of the crop between our pixel and theirs of the same direction."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(columns.start, columns.stop - 1, 15),
                                           np.linspace(rows.start, rows.stop - 1, 15)))
    ra, dec = frame.wcs.all_pix2world(x, y, 0)
    their_x, their_y = solved.all_world2pix(ra, dec, 0)
    return float(np.sqrt(np.mean((their_x + columns.start - x) ** 2 + (their_y + rows.start - y) ** 2)))


def judge(run):
    referee.need("solve-field")
    for frame in referee.first_frames(run):
        for name, rows, columns in crops(frame):
            with tempfile.TemporaryDirectory() as directory:
                solved, sources = solve(frame, rows, columns, pathlib.Path(directory))
            referee.check(solved is not None,
                          f"{frame.name} ({name}): astrometry.net solves it from {sources} sources")
            error = disagreement_px(frame, rows, columns, solved)
            referee.check(error <= TOLERANCE_PX,
                          f"{frame.name} ({name}): {error:.3f} px rms from astrometry.net (<= {TOLERANCE_PX})")


if __name__ == "__main__":
    referee.main(judge, sys.argv[1])
