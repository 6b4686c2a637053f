"""The keywords by which archives find a frame are those that astropy works out from its times and place.

    archive_cards.py DMISE

Makes two short runs (plain and Rice-compressed): GOES 13 followed from the ground by raven and by
telescope-3m, a camera that moves in azimuth, and one in orbit that points at another object. Then, from the
FITS headers alone: fitsverify finds nothing; astropy reads BUNIT as a unit, MJD-OBS as DATE-OBS; RA and DEC
are the WCS's at the frame's centre; SUNALT and MOONALT are those of astropy's ephemeris within 0.01 deg;
AIRMASS is that of Pickering 2002 (another formula) at the elevation that RA and DEC have by astropy's
AltAz, within 0.2 %; what makes no sense is absent; a mount that follows an object looks where SGP4, light time,
eraAb and eraRefco have it, within 0.2 px.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import warnings

import erfa
import numpy as np
from astropy import units
from astropy.coordinates import AltAz, EarthLocation, SkyCoord, get_body
from astropy.io import fits
from astropy.time import Time
from astropy.utils import iers

import referee
from erfa_directions import Satellite, Site, apparent
from skyfield_directions import read_elements

iers.conf.auto_download = False
iers.conf.auto_max_age = None
warnings.simplefilter("ignore")

SCENARIO = """\
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5, seed: 1}
objects: [{catalogue: demo, only: [GOES 13, GOES 15, METOP-A], radius_m: 3}]
sensors:
  - {name: follow, site: atlanta, camera: raven, pointing: {target: GOES 13}, exposure_s: 4, cadence_s: 10}
  - {name: narrow, site: atlanta, camera: telescope-3m, pointing: {target: GOES 13}, exposure_s: 1, cadence_s: 10}
  - {name: sweep, site: atlanta, camera: raven, exposure_s: 0.5, cadence_s: 10,
     pointing: {azimuth_deg: 120, elevation_deg: 35, azimuth_rate_deg_per_s: 0.1}}
  - {name: space, platform: METOP-A, camera: wide-field-cmos, pointing: {target: GOES 15}, exposure_s: 1, cadence_s: 10}
output: {png: false, fits: %s, saturation: %s}
"""
ATLANTA = EarthLocation.from_geodetic(-84.398, 33.777, 300.0)


def boresight(header, key):
    w, x, y, z = (header[f"{key}{i}"] for i in range(4))
    # The third row of camera from GCRS.
    return np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])


def apart_arcsec(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)) * 3600


def airmass_of(elevation_deg):
    """Pickering 2002, of the apparent elevation."""
    return 1 / np.sin(np.radians(elevation_deg + 244 / (165 + 47 * elevation_deg**1.1)))


def refracted(direction, utc, band_um):
    """Lifted by ERFA's constants in the air of 300 m in the standard atmosphere."""
    turn = erfa.c2t06a(*erfa.taitt(*erfa.utctai(*utc)), *erfa.utcut1(*utc, 0.0), 0.0, 0.0)
    lon, lat = np.radians([-84.398, 33.777])
    up = turn.T @ np.array([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
    temperature = 15 - 0.0065 * 300
    pressure = 1013.25 * ((temperature + 273.15) / 288.15) ** 5.2559
    a, b = erfa.refco(pressure, temperature, 0.5, band_um)
    level = direction - up * (direction @ up)
    level /= np.linalg.norm(level)
    z = zenith = np.arccos(direction @ up)
    for _ in range(10):
        z = zenith - a * np.tan(z) - b * np.tan(z) ** 3
    return up * np.cos(z) + level * np.sin(z)


def judge_frame(frame, elements):
    header, name = frame.header, frame.name
    sensor = header["INSTRUME"]
    referee.check_silently(str(units.Unit(header["BUNIT"])) == "adu", f"{name}: BUNIT is adu")
    begin, middle = Time(header["DATE-OBS"], scale="utc"), frame.middle
    referee.check_silently(abs(header["MJD-OBS"] - begin.mjd) < 1e-9, f"{name}: MJD-OBS is DATE-OBS")
    rows, columns = frame.counts.shape
    centre = SkyCoord(header["RA"], header["DEC"], unit="deg")
    by_wcs = SkyCoord(*frame.wcs.all_pix2world([[(columns - 1) / 2, (rows - 1) / 2]], 0)[0], unit="deg")
    off_px = centre.separation(by_wcs).deg / frame.scale_deg
    referee.check_silently(off_px < 0.05, f"{name}: RA and DEC are {off_px:.3f} px from the WCS's centre")
    expected = {"follow": "GOES 13", "narrow": "GOES 13", "space": "GOES 15"}.get(sensor)
    referee.check_silently(header.get("OBJECT") == expected, f"{name}: OBJECT {header.get('OBJECT')} is {expected}")
    camera = {"narrow": "telescope-3m", "space": "wide-field-cmos"}.get(sensor, "raven")
    referee.check_silently(header["TELESCOP"] == camera, f"{name}: TELESCOP is {camera}")
    mount = "moving" if sensor == "sweep" else "target"
    referee.check_silently(header["MOUNT"] == mount, f"{name}: MOUNT {header['MOUNT']} is {mount}")
    if sensor == "space":
        for key in ("AIRMASS", "SUNALT", "MOONALT"):
            referee.check_silently(key not in header, f"{name}: no {key} in space")
    else:
        sky = AltAz(obstime=middle, location=ATLANTA)
        # Astropy's Sun and Moon, and the stars behind the centre, without air.
        for key, body in (("SUNALT", "sun"), ("MOONALT", "moon")):
            theirs = get_body(body, middle, ATLANTA).transform_to(sky).alt.deg
            referee.check_silently(abs(header[key] - theirs) < 0.01, f"{name}: {key} {header[key]} is {theirs:.4f}")
        elevation = centre.transform_to(AltAz(obstime=middle, location=ATLANTA, pressure=980 * units.hPa,
                                              temperature=13 * units.deg_C, relative_humidity=0.5,
                                              obswl=0.55 * units.micron)).alt.deg
        ratio = header["AIRMASS"] / airmass_of(elevation)
        referee.check_silently(abs(ratio - 1) < 2e-3, f"{name}: AIRMASS is {ratio:.5f} of Pickering's")
    if expected:
        number = {"GOES 13": 29155, "GOES 15": 36411}[expected]
        observer = Satellite(elements[29499]) if sensor == "space" else Site(referee.SOURCE / "launch/sites/atlanta.yaml")
        utc = header["DATE-AVG"]
        seen, _ = apparent(Satellite(elements[number]), observer, utc)
        if sensor != "space":
            seen = refracted(seen, (middle.jd1, middle.jd2), header["BANDCEN"] * 1e6)
        off_arcsec = apart_arcsec(boresight(header, "QAVG"), seen)
        # ERFA's refraction of a star: the parallactic part of a geostationary object is 5 mas.
        limit_arcsec = 0.2 * frame.scale_deg * 3600 + 0.05
        referee.check(off_arcsec < limit_arcsec, f"{name}: looks {off_arcsec:.3f} arcsec from where ERFA sees "
                                                 f"{expected} (< {limit_arcsec:.3f})")


def judge(dmise):
    elements = read_elements(referee.CATALOGUES / "demo.tle")
    with tempfile.TemporaryDirectory() as directory:
        for compression, flags in (("true", "false"), ("{compression: rice}", "true")):
            scenario = pathlib.Path(directory) / "scenario.yaml"
            scenario.write_text(SCENARIO % (compression, flags))
            run = pathlib.Path(directory) / ("plain" if flags == "false" else "rice")
            done = subprocess.run([dmise, "run", scenario, "--out", run], capture_output=True, text=True, check=False)
            referee.check_silently(done.returncode == 0, f"dmise run ends well: {done.stderr[-400:]}")
            frames = sorted(run.glob("*/frame-000001.fits"))
            referee.check_silently(len(frames) == 4, f"{len(frames)} frames")
            judged = subprocess.run([referee.need("fitsverify"), "-q", *map(str, frames)], capture_output=True,
                                    text=True, check=False)
            bad = [line for line in judged.stdout.splitlines() if not re.match(r"verification OK: ", line)]
            referee.check(not bad and judged.returncode == 0, f"fitsverify finds nothing in {len(frames)} frames {bad[:3]}")
            for path in frames:
                with fits.open(path) as hdus:
                    hdus.verify("exception")
                judge_frame(referee.read_frame(path), elements)
    print("ok: OBJECT, TELESCOP, RA, DEC, AIRMASS, MJD-OBS, BUNIT, SUNALT, MOONALT, MOUNT")


if __name__ == "__main__":
    referee.main(judge, sys.argv[1])
