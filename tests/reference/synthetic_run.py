"""Makes run directories that the referees must pass, or must not, by astropy, ERFA and sgp4 alone.

One camera of 2048 x 2048 pixels, 19.5 deg, TAN, on the ground. Stars of launch/catalogues/stars.dat.gz as
Gaussians integrated over pixels, sky and noise; truth of some satellites of launch/catalogues/demo.tle.
"""

import json
import pathlib

import erfa
import numpy as np
from astropy.io import fits
from astropy.time import Time
from astropy.wcs import WCS
from scipy.special import erf
from sgp4.api import Satrec

import referee
import skyfield_directions

SIZE = 2048
FOCAL_PX = SIZE / 2 / np.tan(np.radians(9.75))
FWHM_PX = 1.8
SITE_M = -524870.0, -5280980.0, 3526040.0  # ITRS, near Atlanta
START, MIDDLE = "2018-01-21T00:15:00", "2018-01-21T00:15:05"


def header(shift_px=0.0):
    wcs = WCS(naxis=2)
    wcs.wcs.ctype = "RA---TAN", "DEC--TAN"
    wcs.wcs.crval = 45.0, 20.0
    wcs.wcs.crpix = SIZE / 2 + 0.5 + shift_px, SIZE / 2 + 0.5
    scale, roll = np.degrees(1 / FOCAL_PX), np.radians(25.0)
    wcs.wcs.cd = scale * np.array([[-np.cos(roll), np.sin(roll)], [np.sin(roll), np.cos(roll)]])
    cards = wcs.to_header()
    for i in (1, 2):  # astropy writes PC; CD as in our own frames
        for j in (1, 2):
            cards.pop(f"PC{i}_{j}", None)
            cards[f"CD{i}_{j}"] = wcs.wcs.cd[i - 1, j - 1]
        cards.pop(f"CDELT{i}", None)
    cards["RADESYS"] = "ICRS"
    cards["DATE-OBS"], cards["DATE-AVG"] = START, MIDDLE
    cards["EXPTIME"], cards["GAIN"], cards["SATURATE"] = 10.0, 1.0, 60000.0
    cards["FOCALPX"], cards["PSFFWHM"] = FOCAL_PX, FWHM_PX
    for axis, value in zip("XYZ", SITE_M):
        cards[f"OBSGEO-{axis}"] = value
    return cards


def draw(stars, magnitude_error, rng):
    sky = referee.Frame(pathlib.Path("x/x"), np.zeros((SIZE, SIZE)), header(), WCS(header()))
    inside, xs, ys = referee.stars_in(sky, stars)
    image = np.full((SIZE, SIZE), 300.0)
    sigma = FWHM_PX / 2.3548
    magnitudes = inside["v_mag"] + rng.normal(0, magnitude_error, len(inside))
    for x, y, flux in zip(xs, ys, 4e7 * 10 ** (-0.4 * magnitudes)):
        i, j = int(round(x)), int(round(y))
        columns = np.arange(max(i - 8, 0), min(i + 9, SIZE))
        rows = np.arange(max(j - 8, 0), min(j + 9, SIZE))
        across = [0.5 * (erf((p + 0.5 - c) / sigma / np.sqrt(2)) - erf((p - 0.5 - c) / sigma / np.sqrt(2)))
                  for p, c in ((columns, x), (rows, y))]
        image[np.ix_(rows, columns)] += flux * np.outer(across[1], across[0])
    return np.clip(rng.poisson(image) + rng.normal(100, 5, image.shape), 0, 65535).round()


def satellite_truth(number, two_lines, time):
    """A line of truth.jsonl by python-sgp4 and ERFA, UT1 = UTC; None where SGP4 gives a code."""
    satellite = Satrec.twoline2rv(*two_lines)
    bpn, era = erfa.c2i06a(time.tt.jd1, time.tt.jd2), erfa.era00(time.jd1, time.jd2)
    itrs_from_gcrs = erfa.c2tcio(bpn, era, np.eye(3))

    def gcrs_m(seconds_ago):
        jd2 = time.jd2 - seconds_ago / 86400
        code, position_km, _ = satellite.sgp4(time.jd1, jd2)
        gmst = erfa.gmst82(time.jd1, jd2)
        era_then = erfa.era00(time.jd1, jd2)
        itrs = erfa.rz(gmst, np.eye(3)) @ np.array(position_km) * 1e3
        return code, erfa.c2tcio(bpn, era_then, np.eye(3)).T @ itrs

    here = itrs_from_gcrs.T @ np.array(SITE_M)
    code, there = gcrs_m(0.0)
    if code != 0:
        return None
    range_m = float(np.linalg.norm(there - here))
    away = gcrs_m(range_m / skyfield_directions.LIGHT_M_PER_S)[1] - here
    return {"sensor": "camera", "frame": 1, "catalogue_number": number, "true_range_m": range_m,
            "true_ra_deg": float(np.degrees(np.arctan2(away[1], away[0]))),
            "true_dec_deg": float(np.degrees(np.arcsin(away[2] / np.linalg.norm(away))))}


def write(directory, shift_px=0.0, magnitude_error=0.0, clock_error_s=0.0):
    """Writes one frame and its truth: the WCS moved against the stars by `shift_px`, magnitudes off by
    `magnitude_error` (rms), the satellites where they are `clock_error_s` later."""
    folder = pathlib.Path(directory) / "camera"
    folder.mkdir(parents=True, exist_ok=True)
    counts = draw(referee.read_stars(), magnitude_error, np.random.default_rng(1)).astype(np.uint16)
    fits.writeto(folder / "frame-000001.fits", counts, header(shift_px), overwrite=True)
    elements = skyfield_directions.read_elements(referee.CATALOGUES / "demo.tle")
    time = Time(MIDDLE, scale="utc")
    time = Time(time.jd1, time.jd2 + clock_error_s / 86400, format="jd", scale="utc")
    truths = (satellite_truth(*item, time) for item in sorted(elements.items())[::5])
    with open(folder / "truth.jsonl", "w") as file:
        for truth in filter(None, truths):
            file.write(json.dumps(truth) + "\n")
