"""What the referees share: runs on disk, frames, stars, and how a test says skip, pass or fail.

A referee is a program of somebody else (astrometry.net, fitsverify, source-extractor, skyfield) that
judges the products of a run. It exits 0, 1, or 77 when what it needs is not there; with DMISE_DATA
set that is a failure.
"""

import dataclasses
import datetime
import gzip
import json
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import warnings

import numpy as np
from astropy.io import fits
from astropy.time import Time
from astropy.utils.exceptions import AstropyWarning
from astropy.wcs import WCS

warnings.simplefilter("ignore", AstropyWarning)  # stale leap-second file, OBSGEO-L from -X

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CATALOGUES = SOURCE / "launch/catalogues"


class Failure(Exception):
    """A claim that does not hold; str() names it with its figure."""


class Missing(Exception):
    """Something the referee needs is not there."""


def main(judge, *arguments):
    """Runs judge(*arguments) and ends the process with the code that ctest understands."""
    try:
        judge(*arguments)
    except Missing as missing:
        if "DMISE_DATA" in os.environ:
            sys.exit(f"FAIL: DMISE_DATA is set but {missing}")
        print(f"skipped: {missing}")
        sys.exit(77)
    except Failure as failure:
        sys.exit(f"FAIL: {failure}")


def occasion():
    """Processor and day of a measurement."""
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.machine())
    return f"{' '.join(model.split()[:2])}, {datetime.date.today()}"


def need(program):
    """Path of a program; Missing where it is not installed."""
    path = shutil.which(program)
    if not path:
        raise Missing(f"{program} is not installed (./dmise setup --tests)")
    return path


def need_file(path):
    if not pathlib.Path(path).exists():
        raise Missing(f"there is no {path}")
    return pathlib.Path(path)


def check_silently(holds, claim):
    if not holds:
        raise Failure(claim)


def check(holds, claim):
    """Prints the claim when it holds; Failure when not."""
    check_silently(holds, claim)
    print(f"ok: {claim}")


def lines(path):
    """The objects of a .jsonl file."""
    with open(path) as file:
        return [json.loads(line) for line in file]


@dataclasses.dataclass
class Frame:
    path: pathlib.Path
    counts: np.ndarray  # rows x columns [DN]
    header: fits.Header
    wcs: WCS

    @property
    def name(self):
        return f"{self.path.parent.name}/{self.path.stem}"

    @property
    def middle(self):
        return Time(self.header["DATE-AVG"], scale="utc")

    @property
    def scale_deg(self):
        """Degrees per pixel at the reference pixel."""
        return float(np.sqrt(abs(np.linalg.det(self.wcs.pixel_scale_matrix))))

    @property
    def trail_px(self):
        """Upper bound of the length of a star's trail."""
        turn = _rotation(self.header, "QEND") @ _rotation(self.header, "QBEG").T
        angle = np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1))
        half_field = np.hypot(*self.counts.shape) / 2 / self.header["FOCALPX"]
        return float(angle * self.header["FOCALPX"] * (1 + half_field**2))


def _rotation(header, key):
    w, x, y, z = (header.get(f"{key}{i}", float(i == 0)) for i in range(4))
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def read_frame(path):
    with fits.open(path) as hdus:
        hdu = next(h for h in hdus if h.data is not None)
        header = hdu.header
        return Frame(pathlib.Path(path), np.asarray(hdu.data, dtype=np.float64), header,
                     WCS(header, hdus))


def first_frames(run):
    """The first frame of every sensor of a run."""
    paths = sorted(need_file(run).glob("*/frame-000001.fits"))
    if not paths:
        raise Failure(f"{run} holds no frame")
    return [read_frame(path) for path in paths]


def read_stars(path=CATALOGUES / "stars.dat.gz"):
    """The shipped stars: J2000 places and motions, V and B-V as a structured array."""
    rows = []
    with gzip.open(need_file(path), "rt") as file:
        for line in file:
            if line.startswith("#") or len(line) < 56:
                continue
            ra = 15 * (int(line[0:2]) + int(line[2:4]) / 60 + float(line[4:9]) / 3600)
            dec = int(line[11:13]) + int(line[13:15]) / 60 + float(line[15:19]) / 3600
            rows.append((ra, -dec if line[10] == "-" else dec, float(line[20:29]),
                         float(line[29:38]), float(line[46:51]), float(line[51:56])))
    return np.array(rows, dtype=[(name, float) for name in (
        "ra_deg", "dec_deg", "pm_ra_cosdec_mas_per_yr", "pm_dec_mas_per_yr", "v_mag", "bv_mag")])


def stars_in(frame, stars, margin_px=0):
    """(stars, x, y): those whose place of date falls in the frame; pixels from 0."""
    years = frame.middle.jyear - 2000.0
    dec = stars["dec_deg"] + stars["pm_dec_mas_per_yr"] / 3.6e6 * years
    ra = stars["ra_deg"] + stars["pm_ra_cosdec_mas_per_yr"] / 3.6e6 * years / np.cos(np.radians(dec))
    rows, columns = frame.counts.shape
    centre = np.radians(frame.wcs.all_pix2world([[columns / 2, rows / 2]], 0)[0])
    cosine = (np.sin(np.radians(dec)) * np.sin(centre[1]) + np.cos(np.radians(dec)) *
              np.cos(centre[1]) * np.cos(np.radians(ra) - centre[0]))
    corner = np.radians(frame.wcs.all_pix2world([[0, 0], [columns, 0], [0, rows], [columns, rows]], 0))
    reach = np.min(np.sin(corner[:, 1]) * np.sin(centre[1]) + np.cos(corner[:, 1]) *
                   np.cos(centre[1]) * np.cos(corner[:, 0] - centre[0]))
    near = np.flatnonzero(cosine > max(0.1, np.cos(1.05 * np.arccos(reach))))
    x, y = frame.wcs.all_world2pix(ra[near], dec[near], 0, quiet=True)
    inside = ((x > -0.5 + margin_px) & (x < columns - 0.5 - margin_px) &
              (y > -0.5 + margin_px) & (y < rows - 0.5 - margin_px))
    return stars[near][inside], x[inside], y[inside]


def extract_sources(counts, directory, aperture_px, threshold_sigma=5.0):
    """source-extractor's list of an image: x, y (from 0), flux in the aperture, peak, flags."""
    directory = pathlib.Path(directory)
    image = directory / "image.fits"
    fits.writeto(image, counts.astype(np.float32), overwrite=True)
    (directory / "columns").write_text("\n".join(
        ["XWIN_IMAGE", "YWIN_IMAGE", "FLUX_APER(1)", "FLUX_MAX", "BACKGROUND", "FLAGS"]) + "\n")
    # An exposure's point spread is about two pixels wide; a Gaussian of that width, 5 x 5.
    grid = np.exp(-4 * np.log(2) * np.add.outer(np.arange(-2, 3) ** 2, np.arange(-2, 3) ** 2) / 4.0)
    (directory / "filter").write_text("CONV NORM\n" + "\n".join(
        " ".join(f"{v:.6f}" for v in row) for row in grid) + "\n")
    settings = {
        "CATALOG_NAME": "sources.fits", "CATALOG_TYPE": "FITS_1.0", "PARAMETERS_NAME": "columns",
        "FILTER_NAME": "filter", "FILTER": "Y", "DETECT_MINAREA": "4",
        "DETECT_THRESH": str(threshold_sigma), "ANALYSIS_THRESH": str(threshold_sigma),
        "PHOT_APERTURES": f"{aperture_px:.2f}", "BACK_SIZE": "64", "BACKPHOTO_TYPE": "LOCAL",
        "BACKPHOTO_THICK": "24", "SATUR_LEVEL": "1e9", "WEIGHT_TYPE": "NONE", "VERBOSE_TYPE": "QUIET",
    }
    arguments = [need("source-extractor"), image.name, "-c", "/dev/null"]
    for key, value in settings.items():
        arguments += [f"-{key}", value]
    done = subprocess.run(arguments, cwd=directory, capture_output=True, text=True)
    if done.returncode != 0:
        raise Failure(f"source-extractor: {done.stderr.strip()}")
    table = fits.getdata(directory / "sources.fits", 1)
    return {
        "x": table["XWIN_IMAGE"] - 1.0, "y": table["YWIN_IMAGE"] - 1.0,
        "flux": np.ravel(table["FLUX_APER"]), "peak": table["FLUX_MAX"] + table["BACKGROUND"],
        "flags": table["FLAGS"],
    }
