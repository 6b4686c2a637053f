"""Objects injected into frames: where astropy and ERFA put them in real frames, as bright as they are labelled, and found as
often as objects that are rendered.

    injection.py [NUMBER]      pairs of frames for the detection probability, by default 20
"""
import io
import os
import pathlib
import sys
import warnings

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "build/python"))

try:
    import astropy.coordinates
    import astropy.io.fits
    import astropy.time
    import astropy.units
    import astropy.wcs
    import erfa
    import numpy as np
    import yaml

    import dmise
    import dmise.engine
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

warnings.simplefilter("ignore")  # astropy warns about headers that it corrects
FRAMES = pathlib.Path(os.environ.get("DMISE_DATA", ROOT.parent / "shared/data")) / "validation/frames"
RANGE_M = 1e9
LIGHT_M_PER_S = 299_792_458.0
# File, HDU, latitude, longitude, height, facts that the header lacks: start, electrons of a unit, zero point, width of the PSF.
REAL = (("cutout_HSCA21787010", 0, (19.8255, -155.4760, 4139.0), "2020-05-28T14:30:00", 3.0, 27.9, None),
        ("cutout_frame-i-008108-5-0025", 0, (32.7803, -105.8203, 2788.0), "2009-10-17T05:00:00", 1200.0, 28.3, None),
        ("cutout_lbcb.20210407.120357", 1, (32.7013, -109.8891, 3221.0), "2021-04-07T12:03:57", None, 27.5, 4.0),
        ("cutout_lbcb.20210407.120357", 4, (32.7013, -109.8891, 3221.0), "2021-04-07T12:03:57", None, 27.5, 4.0),
        ("cutout_m20211212UT_image0110.new", 0, (32.7013, -109.8920, 3191.0), "2021-12-12T08:00:00", 1.9, 25.5, 3.0))
SCENARIO = """\
simulation: {{start: 2018-01-21T03:00:00Z, duration_s: 10, tick_s: 1, seed: 1}}
objects: [{objects}]
stars: {{catalogue: kstars}}
sensors:
  - name: eye
    site: {{latitude_deg: {site[0]}, longitude_deg: {site[1]}, height_m: {site[2]}}}
    camera:
      optics: {{columns: 160, rows: 120, pixel_pitch_m: 9e-6, focal_length_m: 0.2, aperture_m: 0.1, psf_fwhm_px: 2}}
      detector: {{quantum_efficiency: 0.6, read_noise_e: 5, full_well_e: 60000, gain_e_per_dn: 1, bias_dn: 100}}
      band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}
    pointing: {pointing}
    exposure_s: 8
    cadence_s: 10
"""
failures = []


def check(holds, text):
    print("ok:" if holds else "FAILED:", text)
    if not holds:
        failures.append(text)


def observer_m(site, time):
    """GCRS, with UT1 = UTC and no polar motion, by ERFA."""
    itrs = erfa.gd2gc(1, np.radians(site[1]), np.radians(site[0]), site[2])
    return erfa.c2t06a(time.tt.jd1, time.tt.jd2, time.utc.jd1, time.utc.jd2, 0.0, 0.0).T @ itrs


def place_m(wcs, pixel, site, time):
    """GCRS place from which light arrives at a pixel: the WCS is of stars, which the Earth's motion displaces."""
    ra, dec = np.radians(wcs.all_pix2world(*pixel, 0))
    star = erfa.s2c(float(ra), float(dec))
    velocity = astropy.coordinates.get_body_barycentric_posvel("earth", time)[1].xyz.to_value("m/s") / LIGHT_M_PER_S
    seen = erfa.ab(star, velocity, 1.0, np.sqrt(1.0 - velocity @ velocity))
    return observer_m(site, time) + RANGE_M * seen


def moving(wcs, ends, site, start, exposure_s, radius_m):
    """An object whose image moves from one pixel to another in the exposure."""
    end = start + exposure_s * astropy.units.s
    places = [place_m(wcs, pixel, site, time) for pixel, time in zip(ends, (start, end))]
    velocity = (places[1] - places[0]) / exposure_s
    begin = places[0] + velocity * (RANGE_M / LIGHT_M_PER_S)  # where it is when its light of before arrives
    utc = start.utc.isot + "Z"
    return {"name": "injected", "radius_m": radius_m,
            "motion": {"two_body": {"epoch": utc, "position_m": begin.tolist(), "velocity_m_per_s": velocity.tolist()}}}


def mapping_of(objects, site):
    return yaml.safe_load(SCENARIO.format(objects="", site=site, pointing="zenith")) | {"objects": objects}


def real_frame(name, hdu, site, start, gain, zero_point, fwhm):
    path = FRAMES / f"{name}.fits.gz"
    with astropy.io.fits.open(path) as hdus:
        image, header = hdus[hdu].data, hdus[0].header.copy()
        header.extend(hdus[hdu].header, update=True, strip=True)
    exposure_s = float(header["EXPTIME"])
    facts = {key: header[key] for key in header if key.startswith(("CTYPE", "CRPIX", "CRVAL", "CD1_", "CD2_", "A_", "B_", "AP_", "BP_"))}
    facts |= {"DATE-OBS": start, "EXPTIME": exposure_s, "RADESYS": "ICRS"} | ({"GAIN": header["GAIN"]} if gain is None else {})
    wcs = astropy.wcs.WCS(astropy.io.fits.Header(facts.items()))
    rows, columns = image.shape
    ends = [(0.4 * columns, 0.45 * rows), (0.4 * columns + 9.0, 0.45 * rows + 12.0)]
    time = astropy.time.Time(start, scale="utc")
    stated = {"zero_point_mag": zero_point, "gain_e_per_dn": gain, "psf_fwhm_px": fwhm, "tracking": "sidereal", "catalogue": "none"}

    def make(radius_m):
        return dmise.inject(image, facts, mapping_of([moving(wcs, ends, site, time, exposure_s, radius_m)], site), **stated)

    # So bright that the chance of its electrons moves the centroid by 0.004 px.
    radius_m = 10.0 * np.sqrt(1e6 / make(10.0).labels["signal_e"][0])
    made = make(radius_m)
    label = made.labels[0]
    added = (made.image.astype(float) - image.astype(float)) * made.facts["gain_e_per_dn"]
    lit = np.isfinite(added) & (made.mask > 0)
    y, x = np.indices(added.shape)
    light = made.light.astype(float) * np.isfinite(added)
    seen = np.where(np.isfinite(added), added, 0.0)
    centroid = np.array([np.sum(x * seen), np.sum(y * seen)]) / seen.sum()
    off_px = float(np.hypot(*(centroid - [label["x_px"], label["y_px"]])))
    labelled = np.array([[label["start_x_px"], label["start_y_px"]], [label["end_x_px"], label["end_y_px"]]])
    wanted_px = float(np.hypot(*(labelled - ends).T).max())
    ratio = seen.sum() / label["signal_e"]
    check(made.image.dtype == image.dtype and lit.any() and light.sum() > 0, f"{name}[{hdu}]: type {image.dtype} is kept")
    check(off_px < 0.02, f"{name}[{hdu}]: centroid within {off_px:.4f} px of its label")
    check(abs(ratio - 1.0) < 0.01, f"{name}[{hdu}]: light {ratio:.4f} of its label")
    # Deflection by the Sun (4 mas), which is left out of the reference, is 0.024 px of Hyper Suprime-Cam.
    check(wanted_px < 0.05, f"{name}[{hdu}]: ends within {wanted_px:.4f} px of where astropy and ERFA put them; "
          f"geometry {made.facts['geometry_px']:.4f} px")


def is_found(detections, x, y):
    return any(np.hypot(row["x_px"] - x, row["y_px"] - y) < 3.0 for row in detections)


def probabilities(number):
    """Streaks of 13 px at two brightnesses: they are found as often rendered as injected into frames without them, with the same skies."""
    site = (33.0, -100.0, 300.0)
    pointing = "{target: GOES 14, tracking: sidereal}"
    only = "{{catalogue: demo, only: [GOES 14], radius_m: {}}}"
    for radius_m in (0.95, 1.2):
        scenario = SCENARIO.format(objects=only.format(radius_m), site=site, pointing=pointing)
        without = SCENARIO.format(objects=only.format(1e-4), site=site, pointing=pointing)
        rendered = injected = 0
        snr = []
        for seed in range(1, number + 1):
            frame = next(dmise.Simulation(scenario, seed=seed).frames())
            row = frame.truth[frame.truth["in_frame"]][0]
            rendered += is_found(frame.detections, row["rendered_x_px"], row["rendered_y_px"])
            empty = next(dmise.Simulation(without, seed=seed).frames())
            made = dmise.inject(empty, None, scenario, seed=seed)
            label = made.labels[0]
            snr.append(float(label["snr"]))
            injected += is_found(dmise.detect(made.image, fits_header(empty)), label["x_px"], label["y_px"])
        points = 100.0 * (injected - rendered) / number
        # Three sigmas of a difference of shares, or 2 points, which 500 pairs show.
        share = max(0.05, min(0.95, (injected + rendered) / (2 * number)))
        limit = 2.0 if number >= 500 else 300.0 * np.sqrt(2.0 * share * (1.0 - share) / number)
        check(abs(points) <= limit, f"SNR {np.mean(snr):.1f}: {100 * rendered / number:.1f} % rendered and {100 * injected / number:.1f} % "
              f"injected of {number} are found")


def fits_header(frame):
    return astropy.io.fits.getheader(io.BytesIO(frame.to_fits()))


if __name__ == "__main__":
    if FRAMES.is_dir():
        for each in REAL:
            real_frame(*each)
    else:
        print(f"skipped: no real frames in {FRAMES}")
    probabilities(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
    sys.exit(bool(failures))
