"""source-extractor's magnitudes of isolated stars are the catalogue's, after one zero point.

    source_extractor_magnitudes.py RUN

The first frame of every sensor: stars of launch/catalogues/stars.dat.gz through the header's WCS, unsaturated,
alone, well above the noise, within 12 deg of the middle of the frame (one zero point can't stand for
the extinction of a whole sky), and with B-V within 0.3 mag of the median of those (the frames are in
their own band, the catalogue in Johnson V). Tolerance: 0.05 mag rms, over all that were selected, up to
the 150 brightest. A frame with fewer than 20 such stars is passed over; one must have 100.
"""

import pathlib
import sys
import tempfile

import numpy as np
from scipy.spatial import cKDTree

import referee

TOLERANCE_MAG = 0.05
NEIGHBOUR_SHARE = 0.01  # light that neighbours in the aperture may add
REACH_DEG = 12.0


def select(frame, stars, aperture_px):
    """Indices of stars that stand alone near the middle, with their pixels."""
    inside, x, y = referee.stars_in(frame, stars)
    rows, columns = frame.counts.shape
    light = 10 ** (-0.4 * inside["v_mag"])
    places = np.column_stack([x, y])
    groups = cKDTree(places).query_ball_point(places, aperture_px / 2 + 4)
    others = np.array([light[group].sum() for group in groups]) - light
    away = np.hypot(x - columns / 2, y - rows / 2) * frame.scale_deg
    edge = np.minimum.reduce([x, y, columns - x, rows - y])
    good = (others < NEIGHBOUR_SHARE * light) & (away < REACH_DEG) & (edge > aperture_px + 24)
    good &= inside["bv_mag"] != 0  # zero stands for "not known"
    return inside[good], x[good], y[good]


def compare(frame, stars):
    """Differences [mag] measured - catalogue - zero point, brightest first."""
    aperture_px = 6 * frame.header["PSFFWHM"] + frame.trail_px
    alone, x, y = select(frame, stars, aperture_px)
    with tempfile.TemporaryDirectory() as directory:
        sources = referee.extract_sources(frame.counts, pathlib.Path(directory), aperture_px)
    distance, match = cKDTree(np.column_stack([sources["x"], sources["y"]])).query(
        np.column_stack([x, y]), distance_upper_bound=1.5 + frame.trail_px / 4)
    found = np.isfinite(distance)
    alone, match = alone[found], match[found]
    flux, peak = sources["flux"][match], sources["peak"][match]
    noise = 1.4826 * np.median(np.abs(np.diff(frame.counts))) / np.sqrt(2)  # whatever the sky's slope
    aperture_noise = noise * np.sqrt(np.pi) * aperture_px / 2
    bright = (flux > 50 * aperture_noise) & (peak < 0.8 * frame.header["SATURATE"])
    alone, flux = alone[bright], flux[bright]
    colour = np.abs(alone["bv_mag"] - np.median(alone["bv_mag"])) < 0.3 if len(alone) else []
    alone, flux = alone[colour], flux[colour]
    order = np.argsort(alone["v_mag"])[:150]
    difference = -2.5 * np.log10(flux[order]) - alone["v_mag"][order]
    return difference - np.median(difference) if len(difference) else difference


def judge(run):
    referee.need("source-extractor")
    stars = referee.read_stars()
    most = 0
    for frame in referee.first_frames(run):
        difference = compare(frame, stars)
        if len(difference) < 20:
            print(f"{frame.name}: passed over, {len(difference)} stars fit")
            continue
        rms = float(np.sqrt(np.mean(difference**2)))
        referee.check(rms <= TOLERANCE_MAG,
                      f"{frame.name}: {len(difference)} stars, {rms:.4f} mag rms (<= {TOLERANCE_MAG})")
        most = max(most, len(difference))
    referee.check(most >= 100, f"most stars in one frame: {most} (>= 100)")


if __name__ == "__main__":
    referee.main(judge, sys.argv[1])
