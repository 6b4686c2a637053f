"""`dmise solve` finds the plates of frames whose headers point elsewhere, and agrees with astrometry.net.

    plate_solution.py DMISE RUN

The first frame of every sensor, its attitudes turned by 2 deg and its roll by 5, or blind. The solved WCS is
read by astropy: within 0.03 px rms of the mapping with which the frame was made (astropy reads that from the
run's frame), with a residual of at most 0.03 px where 200 stars and more are matched, and within 0.1 px rms of
astrometry.net's solution of source-extractor's sources in the whole frame or its middle (see solve_field.py).
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from astropy.io import fits

import referee
import solve_field

TRUTH_PX = 0.03
RESIDUAL_PX = 0.03
SOLVE_FIELD_PX = 0.1
ENOUGH_STARS = 200


def product(a, b):
    """Product of quaternions, scalar first."""
    return np.array([a[0] * b[0] - a[1:] @ b[1:], *(a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:]))])


def point_elsewhere(frame, path):
    """Writes the frame with attitudes that are wrong by 2 deg and 5 deg of roll, and no zero point."""
    tilt, roll = np.radians(2.0) / 2, np.radians(5.0) / 2
    wrong = product(np.array([np.cos(roll), 0, 0, np.sin(roll)]),
                    np.array([np.cos(tilt), 0.6 * np.sin(tilt), 0.8 * np.sin(tilt), 0]))
    with fits.open(frame.path, do_not_scale_image_data=True) as hdus:
        header = hdus[0].header
        for key in ("QBEG", "QAVG", "QEND"):
            turned = product(wrong, np.array([header[f"{key}{i}"] for i in range(4)]))
            for i in range(4):
                header[f"{key}{i}"] = float(turned[i])
        header["PHOTZP"] = 0.0
        header["CRVAL1"], header["CRVAL2"] = 12.0, 34.0
        hdus.writeto(path)


def solve(dmise, path, solved, *options):
    done = subprocess.run([dmise, "solve", path, "--json", "--out", solved, *options],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise referee.Failure(f"dmise solve: {done.stderr.strip()}")
    return json.loads(done.stdout), referee.read_frame(solved)


def difference_px(true, solved):
    """rms distance [px] over the frame between pixels of the same direction."""
    rows, columns = true.counts.shape
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, columns - 1, 21), np.linspace(0, rows - 1, 21)))
    ra, dec = true.wcs.all_pix2world(x, y, 0)
    there = np.array(solved.wcs.all_world2pix(ra, dec, 0, quiet=True))
    return float(np.sqrt(np.mean(np.sum((there - [x, y]) ** 2, axis=0))))


def judge(dmise, run):
    referee.need("solve-field")
    stars = referee.read_stars()
    for frame in referee.first_frames(run):
        with tempfile.TemporaryDirectory() as name:
            directory = pathlib.Path(name)
            point_elsewhere(frame, directory / "elsewhere.fits")
            for way, options in (("pointing wrong by 2 deg, roll by 5", ()), ("blind", ("--blind",))):
                report, solved = solve(dmise, directory / "elsewhere.fits", directory / f"{len(options)}.fits",
                                       *options)
                error = difference_px(frame, solved)
                referee.check(error <= TRUTH_PX, f"{frame.name}, {way}: {report['matched']} stars, "
                              f"{error:.4f} px rms from the true mapping (<= {TRUTH_PX})")
                if report["matched"] >= ENOUGH_STARS:
                    referee.check(report["rms_px"] <= RESIDUAL_PX, f"{frame.name}, {way}: "
                                  f"residual of {report['rms_px']:.4f} px rms (<= {RESIDUAL_PX})")
                zero, sigma = (report["zero_point"][k] for k in ("zero_point_mag", "zero_point_sigma"))
                referee.check(abs(zero - frame.header["PHOTZP"]) <= 0.05,
                              f"{frame.name}, {way}: zero point {zero:.3f} +- {sigma:.3f} mag "
                              f"(<= 0.05 from {frame.header['PHOTZP']:.3f})")
            # Its linear solution of a corner of 20 deg is not good to this: reference.solve_field.
            for crop, rows, columns in solve_field.crops(frame)[:1]:
                with tempfile.TemporaryDirectory() as scratch:
                    theirs, _ = solve_field.solve(frame, stars, rows, columns, pathlib.Path(scratch))
                referee.check(theirs is not None, f"{frame.name} ({crop}): astrometry.net solves it")
                error = solve_field.disagreement_px(solved, rows, columns, theirs)
                referee.check(error <= SOLVE_FIELD_PX, f"{frame.name} ({crop}): "
                              f"{error:.3f} px rms from astrometry.net (<= {SOLVE_FIELD_PX})")


if __name__ == "__main__":
    referee.main(judge, sys.argv[1], sys.argv[2])
