"""astrometry.net, told nothing of scale or place, solves a telescope's frames of Tycho-2, alone and with synthetic stars, and agrees with their WCS.

    tycho2_frame.py DMISE

The catalogue is made here of deepstars.dat (`./dmise setup --tests`, or $DMISE_DATA/stars). A telescope of 0.4 m sees
2 deg near the galactic pole; source-extractor finds the stars. Debian's index is of
Tycho-2 too, at J2000.0 without motions, so that each source is moved back by its star's (see solve_field.py). Tolerance: 0.1 px
rms over the frame. Stars that were drawn are counted by magnitude: those of the catalogue against the file, the synthetic ones against
Bahcall & Soneira 1980 within 20 % and three deviations.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from astropy.coordinates import SkyCoord
from astropy.io import fits
from astropy.wcs import WCS
from scipy.spatial import cKDTree

import referee
import solve_field
import star_counts

TOLERANCE_PX = 0.1
MOST_SOURCES = 400
PAIR_PX = 8.0
DEADLINE_S = 120
FIELDS = {"pole": (185.0, 30.0, ""), "faint": (185.0, 30.0, ", synthetic_to: 18")}  # RA and Dec [deg], more of the stars

SCENARIO = """simulation: {start: 2018-01-21T%s, duration_s: 10, tick_s: 5}
stars: {catalogue: tycho2, faintest_mag: 14%s}
output: {star_truth: on}
detection: off
sensors:
  - name: %s
    site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}
    camera: camera.yaml
    pointing: {ra_deg: %g, dec_deg: %g}
    exposure_s: 4
    cadence_s: 10
"""
START = "09:00:00Z"  # near the meridian

CAMERA = """name: telescope-0.4m
optics: {projection: gnomonic, columns: 2048, rows: 2048, pixel_pitch_m: 15e-6, focal_length_m: 0.88, aperture_m: 0.4, obscuration: 0.4,
         transmission: 0.7, psf_fwhm_px: 2.0}
detector: {quantum_efficiency: 0.8, dark_e_per_s: 0.02, read_noise_e: 5, full_well_e: 100000, gain_e_per_dn: 1.6, bias_dn: 100, adc_bits: 16}
band: {name: V, centre_m: 0.55e-6, width_m: 0.09e-6}
"""


def deep_stars():
    places = [referee.SOURCE / "build/data/deepstars.dat", pathlib.Path(os.environ.get("DMISE_DATA", referee.SOURCE.parent / "shared/data")) / "stars/deepstars.dat"]
    for path in places:
        if path.exists():
            return path
    print("skipped: there is no deepstars.dat (./dmise setup --tests)")
    sys.exit(77)


def read_deep_stars(path):
    """J2000 places and motions of deepstars.dat, as `referee.read_stars` has them."""
    at, records = 309 + 512 * 12 + 5, np.dtype([(name, "<i4") for name in ("ra", "dec", "pm_ra", "pm_dec", "plx", "hd")] +
                                               [("mag", "<i2"), ("bv", "<i2"), ("rest", "V4")])
    deep = np.fromfile(path, records, offset=at)
    bright = referee.read_stars()
    stars = np.zeros(len(deep), bright.dtype)
    stars["ra_deg"], stars["dec_deg"] = deep["ra"] * 15e-6, deep["dec"] * 1e-5
    stars["pm_ra_cosdec_mas_per_yr"], stars["pm_dec_mas_per_yr"] = 0.1 * deep["pm_ra"], 0.1 * deep["pm_dec"]
    return np.concatenate([bright, stars])


def blind_wcs(frame, stars, directory):
    """WCS by astrometry.net from source-extractor's brightest clean sources."""
    sources = referee.extract_sources(frame.counts, directory, aperture_px=8)
    _, star_x, star_y = referee.stars_in(frame, stars)  # a pair that is one image has no place of its own
    near = cKDTree(np.column_stack([star_x, star_y])).query_ball_point(np.column_stack([sources["x"], sources["y"]]), PAIR_PX,
                                                                       return_length=True)
    clean = (near <= 1) & (sources["flags"] & 3 == 0) & (sources["peak"] < 0.9 * frame.header["SATURATE"])
    best = np.flatnonzero(clean)[np.argsort(-sources["flux"][clean])[:MOST_SOURCES]]
    x, y = sources["x"][best], sources["y"][best]
    dx, dy = solve_field.motion_since_2000(frame, stars, x, y)
    fits.BinTableHDU.from_columns([
        fits.Column("X", "D", array=x - dx + 1), fits.Column("Y", "D", array=y - dy + 1),
        fits.Column("FLUX", "D", array=sources["flux"][best]),
    ]).writeto(directory / "field.xyls", overwrite=True)
    rows, columns = frame.counts.shape
    command = ["timeout", "--kill-after=5", str(2 * DEADLINE_S), referee.need("solve-field"), "field.xyls", "--width", str(columns),
               "--height", str(rows), "--x-column", "X", "--y-column", "Y", "--sort-column", "FLUX", "--no-plots", "--overwrite",
               "--crpix-center", "--tweak-order", "2", "--cpulimit", str(DEADLINE_S)]
    subprocess.run(command, cwd=directory, capture_output=True, check=False)
    solved = directory / "field.wcs"
    return WCS(fits.getheader(solved)) if solved.exists() else None, len(best)


def count_stars(frame, csv, deep, is_synthetic):
    """Stars of each magnitude within the frame as they were drawn, beside those of the file and the counts."""
    rows, columns = frame.counts.shape
    drawn = [line.split(",") for line in csv.read_text().splitlines()[1:]]
    inside = [row for row in drawn if 0 < float(row[3]) < columns - 1 and 0 < float(row[4]) < rows - 1]
    catalogue = np.array([float(row[1]) for row in inside if row[0][0] != "S"])
    synthetic = np.array([float(row[1]) for row in inside if row[0][0] == "S"])
    records = np.fromfile(deep, np.dtype([(name, "<i4") for name in ("ra", "dec", "pm_ra", "pm_dec", "plx", "hd")] +
                                         [("mag", "<i2"), ("bv", "<i2"), ("rest", "V4")]), offset=309 + 512 * 12 + 5)
    v_mag = 0.01 * records["mag"] - 0.09 * 0.01 * records["bv"]
    ra_deg, dec_deg = records["ra"] * 15e-6, records["dec"] * 1e-5
    near = np.hypot((ra_deg - frame.wcs.wcs.crval[0]) * np.cos(np.radians(dec_deg)), dec_deg - frame.wcs.wcs.crval[1]) < 3
    x, y = frame.wcs.all_world2pix(ra_deg[near], dec_deg[near], 0)
    there = v_mag[near][(x > 0) & (x < columns - 1) & (y > 0) & (y < rows - 1)]
    for faint in (11, 12, 13):
        ours, theirs = (int(np.sum((m >= faint - 1) & (m < faint))) for m in (catalogue, there))
        close = abs(ours - theirs) <= max(2, 0.03 * theirs)  # at the rim, of another magnitude in `kstars`, twice in the file
        referee.check(close, f"{frame.name}: {ours} stars of Tycho-2 of V {faint - 1} to {faint}, the file has {theirs}")
    if not is_synthetic:
        referee.check(len(synthetic) == 0, f"{frame.name}: no synthetic star")
        return
    area_deg2 = rows * columns * frame.scale_deg**2
    centre = SkyCoord(*frame.wcs.all_pix2world(columns / 2, rows / 2, 0), unit="deg").galactic
    for faint in (15, 16, 17, 18):
        count = int(np.sum((synthetic >= faint - 1) & (synthetic < faint)))
        theirs = area_deg2 * float(np.diff(star_counts.bahcall_soneira(np.array([faint - 1.0, faint]), centre.l.deg, centre.b.deg))[0])
        referee.check(abs(count - theirs) <= 0.2 * theirs + 3 * np.sqrt(theirs),
                      f"{frame.name}: {count} synthetic stars of V {faint - 1} to {faint}, Bahcall & Soneira {theirs:.0f}")


def judge(dmise):
    deep = deep_stars()
    stars = read_deep_stars(deep)
    referee.need("solve-field")
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        environment = dict(os.environ, XDG_DATA_HOME=name, XDG_CACHE_HOME=name)
        made = subprocess.run([dmise, "catalogue", "fetch", "tycho2", "--from", deep, "--to", directory / "dmise"],
                              env=environment, capture_output=True, text=True, check=False)
        referee.check(made.returncode == 0, f"dmise catalogue fetch tycho2 {made.stderr.strip()[-300:]}")
        (directory / "camera.yaml").write_text(CAMERA)
        for field, (ra_deg, dec_deg, more) in FIELDS.items():
            scenario = directory / f"{field}.yaml"
            scenario.write_text(SCENARIO % (START, more, field, ra_deg, dec_deg))
            ran = subprocess.run([dmise, "run", scenario, "--out", directory / f"run-{field}"], env=environment, capture_output=True,
                                 text=True, check=False)
            referee.check(ran.returncode == 0, f"dmise run of {field}{': ' + ran.stderr.strip() if ran.returncode else ''}")
            frame = referee.read_frame(directory / f"run-{field}/{field}/frame-000001.fits")
            with tempfile.TemporaryDirectory() as scratch:
                solved, sources = blind_wcs(frame, stars, pathlib.Path(scratch))
            referee.check(solved is not None, f"{field}: astrometry.net solves it blind from {sources} sources")
            rows, columns = frame.counts.shape
            x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, columns - 1, 15), np.linspace(0, rows - 1, 15)))
            ra, dec = frame.wcs.all_pix2world(x, y, 0)
            there = np.array(solved.all_world2pix(ra, dec, 0))
            error = float(np.sqrt(np.mean(np.sum((there - [x, y]) ** 2, axis=0))))
            referee.check(error <= TOLERANCE_PX, f"{field}: {error:.3f} px rms from astrometry.net (<= {TOLERANCE_PX})")
            count_stars(frame, directory / f"run-{field}/{field}/frame-000001.stars.csv", deep, bool(more))


if __name__ == "__main__":
    referee.main(judge, sys.argv[1])
