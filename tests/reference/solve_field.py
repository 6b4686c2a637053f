"""astrometry.net, told nothing but the rough scale, agrees with the WCS that the frames carry.

    solve_field.py RUN

The first frame of every sensor. A field wider than 20 deg is solved in crops: the middle and two
opposite corners. astrometry.net knows tangent planes only, so each source that source-extractor found in
a crop is first moved from the lens's projection to the plane that touches the sky at the crop's middle;
the WCS is not used for that. Its index is of J2000 without proper motions, so each source is moved back by
the motion that launch/catalogues/stars.dat.gz gives the star there. Tolerance: 0.3 px rms over a grid of the crop, any common shift included.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from astropy.io import fits
from astropy.wcs import WCS
from scipy.spatial import cKDTree

import referee

TOLERANCE_PX = 0.3
WIDEST_DEG = 20.0
MOST_SOURCES = 500
DEADLINE_S = 60  # processor time: by the clock it may take long beside others
NEIGHBOURS = 3  # source-extractor's flags for a blend

# Image height over focal length at an angle from the boresight, and back.
LENSES = {
    "gnomonic": (np.tan, np.arctan),
    "equidistant": (lambda t: t, lambda r: r),
    "equisolid": (lambda t: 2 * np.sin(t / 2), lambda r: 2 * np.arcsin(r / 2)),
    "stereographic": (lambda t: 2 * np.tan(t / 2), lambda r: 2 * np.arctan(r / 2)),
}


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


class TangentPlane:
    """The plane that touches the sky at the middle of a crop, with pixels of the focal length."""

    def __init__(self, frame, rows, columns):
        self.focal_px = frame.header["FOCALPX"]
        self.lens = LENSES[frame.header.get("PROJNAME", "gnomonic")]
        self.centre = (np.array(frame.counts.shape[::-1]) - 1) / 2
        z = self._directions(np.array([(columns.start + columns.stop - 1) / 2]),
                             np.array([(rows.start + rows.stop - 1) / 2]))[0]
        x = np.array([1.0, 0.0, 0.0]) - z[0] * z
        x /= np.linalg.norm(x)
        self.axes = np.array([x, np.cross(z, x), z])
        corner = np.array([(x, y) for x in (columns.start, columns.stop) for y in (rows.start, rows.stop)])
        self.half = np.ceil(np.abs(self.from_pixels(*corner.T, origin=0.0)).max(axis=1))

    def _directions(self, x, y):
        off = np.column_stack([x, y]) - self.centre
        height = np.hypot(*off.T) / self.focal_px
        angle = self.lens[1](height)
        across = off / self.focal_px * (np.sin(angle) / np.maximum(height, 1e-300))[:, None]
        return np.column_stack([across, np.cos(angle)])

    def from_pixels(self, x, y, origin=None):
        """Plane pixels, 0 at the first, of frame pixels."""
        u, v, w = self.axes @ self._directions(x, y).T
        return self.focal_px * np.array([u / w, v / w]) + (self.half[:, None] if origin is None else origin)

    def to_pixels(self, plane):
        """Frame pixels of plane pixels."""
        u, v = (plane - self.half[:, None]) / self.focal_px
        direction = self.axes.T @ np.array([u, v, np.ones_like(u)])
        direction /= np.linalg.norm(direction, axis=0)
        angle = np.arctan2(np.hypot(*direction[:2]), direction[2])
        stretch = self.lens[0](angle) / np.maximum(np.sin(angle), 1e-300) * self.focal_px
        return direction[:2] * stretch + self.centre[:, None]


def motion_since_2000(frame, stars, x, y):
    """How far [px] the star within 3 px of each place has moved since J2000; 0 without one."""
    moved, star_x, star_y = referee.stars_in(frame, stars)
    then_x, then_y = frame.wcs.all_world2pix(moved["ra_deg"], moved["dec_deg"], 0, quiet=True)
    distance, nearest = cKDTree(np.column_stack([star_x, star_y])).query(np.column_stack([x, y]))
    nearest, known = np.minimum(nearest, len(moved) - 1), distance < 3
    return known * (star_x - then_x)[nearest], known * (star_y - then_y)[nearest]


def solve(frame, stars, rows, columns, directory):
    """(WCS by astrometry.net or None, number of sources), in the crop's tangent plane."""
    sources = referee.extract_sources(frame.counts[rows, columns], directory,
                                      aperture_px=6 + frame.trail_px)
    clean = (sources["flags"] & NEIGHBOURS == 0) & (sources["peak"] < 0.95 * frame.header["SATURATE"])
    best = np.flatnonzero(clean)[np.argsort(-sources["flux"][clean])[:MOST_SOURCES]]
    plane = TangentPlane(frame, rows, columns)
    x, y = sources["x"][best] + columns.start, sources["y"][best] + rows.start
    dx, dy = motion_since_2000(frame, stars, x, y)
    x, y = plane.from_pixels(x - dx, y - dy)
    fits.BinTableHDU.from_columns([
        fits.Column("X", "D", array=x + 1), fits.Column("Y", "D", array=y + 1),
        fits.Column("FLUX", "D", array=sources["flux"][best]),
    ]).writeto(directory / "field.xyls", overwrite=True)
    width, height = (str(int(2 * half + 1)) for half in plane.half)
    scale_arcsec = np.degrees(1 / plane.focal_px) * 3600
    command = [
        referee.need("solve-field"), "field.xyls", "--width", width, "--height", height,
        "--x-column", "X", "--y-column", "Y", "--sort-column", "FLUX", "--scale-units", "arcsecperpix",
        "--scale-low", f"{scale_arcsec * 0.8:.4f}", "--scale-high", f"{scale_arcsec * 1.25:.4f}",
        "--no-plots", "--overwrite", "--crpix-center", "--tweak-order", "1", "--cpulimit", str(DEADLINE_S),
    ]
    done = subprocess.run(command, cwd=directory, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    (directory / "solve-field.log").write_text(done.stdout)
    solved = directory / "field.wcs"
    return WCS(fits.getheader(solved)) if solved.exists() else None, len(best)


def disagreement_px(frame, rows, columns, solved):
    """rms distance [px] over a grid of the crop between our pixel and theirs of the same direction."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(columns.start, columns.stop - 1, 15),
                                           np.linspace(rows.start, rows.stop - 1, 15)))
    ra, dec = frame.wcs.all_pix2world(x, y, 0)
    theirs = TangentPlane(frame, rows, columns).to_pixels(np.array(solved.all_world2pix(ra, dec, 0)))
    return float(np.sqrt(np.mean(np.sum((theirs - [x, y]) ** 2, axis=0))))


def judge(run):
    referee.need("solve-field")
    stars = referee.read_stars()
    for frame in referee.first_frames(run):
        for name, rows, columns in crops(frame):
            with tempfile.TemporaryDirectory() as directory:
                solved, sources = solve(frame, stars, rows, columns, pathlib.Path(directory))
            referee.check(solved is not None,
                          f"{frame.name} ({name}): astrometry.net solves it from {sources} sources")
            error = disagreement_px(frame, rows, columns, solved)
            referee.check(error <= TOLERANCE_PX,
                          f"{frame.name} ({name}): {error:.3f} px rms from astrometry.net (<= {TOLERANCE_PX})")


if __name__ == "__main__":
    referee.main(judge, sys.argv[1])
