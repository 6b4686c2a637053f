#!/usr/bin/env python3
"""Planets in frames, measured: planets_end_to_end.py DMISE. Each case is a telescope in whose field a planet is; the centroid of its
light, read through the frame's WCS, is within 1 arcsec of the planet's astrometric place by JPL's ephemeris, and its light within
0.1 mag of the magnitude that skyfield has.

The places are rows as `planets_end_to_end.py --places DE421.BSP` prints them: by skyfield with DE421 (PyPI's skyfield-data),
topocentric with light time. A WCS is for catalogue stars, so it takes annual aberration and refraction from a planet as from a star;
a satellite's correction for the Earth's motion is not for it. The light of a planet lies where its lit part is: up to 3 arcsec from
the middle of Mercury's disc. Here that is by a sum over the lit disc, of the law of Lommel and Seeliger."""
import math
import pathlib
import subprocess
import sys
import tempfile
import warnings

import numpy as np

SITE = (40.0, -105.0, 1600.0)
ORBIT_M, INCLINATION_RAD = 7178137.0, math.radians(98.6)
# Name, target of skyfield, UTC of mid exposure, radius [km], whether from the orbit.
CASES = [("Mercury", "mercury", "2021-05-17T02:50:00", 2440.53, False), ("Venus", "venus", "2020-05-20T02:45:00", 6051.8, False),
         ("Mars", "mars", "2018-07-27T07:00:00", 3396.19, False), ("Jupiter", "jupiter barycenter", "2022-09-26T07:00:00", 71492.0, False),
         ("Saturn", "saturn barycenter", "2017-06-15T07:00:00", 60268.0, True),
         ("Uranus", "uranus barycenter", "2019-10-28T06:00:00", 25559.0, True),
         ("Neptune", "neptune barycenter", "2019-09-10T06:30:00", 24764.0, False)]


def print_places(path):
    from skyfield.api import load, load_file, wgs84
    from skyfield.magnitudelib import planetary_magnitude
    timescale, bodies = load.timescale(builtin=True), load_file(path)
    for name, target, utc, _, in_orbit in CASES:
        day, clock = utc.split("T")
        t = timescale.utc(*map(int, day.split("-")), *map(int, clock.split(":")))
        here = bodies["earth"] if in_orbit else bodies["earth"] + wgs84.latlon(*SITE[:2], elevation_m=SITE[2])
        observed = here.at(t).observe(bodies[target])
        line, to_sun = observed.xyz.km, bodies["sun"].at(t).xyz.km - bodies["earth"].at(t).xyz.km
        print(f'    "{name}": (({", ".join(f"{x:.0f}" for x in line)}), ({", ".join(f"{x:.0f}" for x in to_sun)}), '
              f'{float(planetary_magnitude(observed)):.3f}),')


# The lines to the planet, from the site or the Earth's centre, and from there to the Sun [km, ICRS axes]; V. By --places.
PLACES = {
    "Mercury": ((25889699, 110175298, 53295008), (84272229, 115279237, 49973237), 0.401),
    "Venus": ((7785536, 42136788, 21391055), (77333109, 119413360, 51764852), -4.463),
    "Mars": ((31978742, -41130639, -24935007), (-84880108, 115601786, 50114056), -2.842),
    "Jupiter": ((589986759, 39235602, -1227024), (-149817553, -6898500, -2989282), -2.939),
    "Saturn": ((-135037270, -1247320510, -505899156), (15516362, 138690686, 60122841), -0.061),
    "Uranus": ((2326344770, 1468031468, 608671088), (-122882750, -76762268, -33275625), 5.712),
    "Neptune": ((4216488292, -858846652, -459427971), (-146804111, 31073342, 13470484), 7.687),
}

SCENARIO = """simulation: {{start: {start}, duration_s: 3, tick_s: 1}}
{objects}effects: {{sky: off, extinction: off, light_pollution: off}}
detection: off
sensors:
  - name: telescope
    {place}
    camera: camera.yaml
    pointing: {{ra_deg: {ra:.6f}, dec_deg: {dec:.6f}}}
    exposure_s: 1
    cadence_s: 2
"""
CAMERA = """name: telescope
optics: {{projection: gnomonic, columns: 900, rows: 900, pixel_pitch_m: 5e-6, focal_length_m: {focal_m}, aperture_m: {aperture_m:.6g},
         transmission: 1, psf_fwhm_px: 2.5}}
detector: {{quantum_efficiency: 1, dark_e_per_s: 0, read_noise_e: 5, full_well_e: 60000000, gain_e_per_dn: 20, bias_dn: 500, adc_bits: 16}}
band: {{name: V, centre_m: 0.55e-6, width_m: 0.09e-6}}
"""
ORBIT = """objects:
  - name: carrier
    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}}
"""


def unit(v):
    return np.asarray(v) / np.linalg.norm(v)


def orbit_km():
    """Half a second and the light's start after the node, for which the tolerance is wide."""
    angle = math.sqrt(3.986004418e14 / ORBIT_M**3) * 0.5
    return ORBIT_M / 1e3 * np.array([math.cos(angle), math.sin(angle) * math.cos(INCLINATION_RAD), math.sin(angle) * math.sin(INCLINATION_RAD)])


def lit_middle(line, from_sun, radius_km):
    """The direction of the middle of the light of a sphere."""
    sun, back = -unit(from_sun), -unit(line)
    across = unit(sun - back * (sun @ back))
    y, z = np.meshgrid(*[(np.arange(600) + 0.5) / 300 - 1] * 2)
    on = y**2 + z**2 < 1
    mu = np.sqrt(np.where(on, 1 - y**2 - z**2, 0))
    mu0 = np.maximum(0, y * (sun @ across) + mu * (sun @ back))
    light = np.where(on & (mu0 > 0), mu0 / (mu0 + mu + 1e-12), 0)
    return unit(unit(line) + across * (light * y).sum() / light.sum() * radius_km / np.linalg.norm(line))


def measured(dmise, name, utc, line, v_mag, in_orbit, directory):
    """The direction of the middle of a planet's light in a frame, and its magnitude."""
    from astropy.io import fits
    from astropy.wcs import WCS, FITSFixedWarning
    warnings.simplefilter("ignore", FITSFixedWarning)
    ra, dec = math.degrees(math.atan2(line[1], line[0])), math.degrees(math.asin(unit(line)[2]))
    hours, minutes, _ = utc.split("T")[1].split(":")
    start = f"{utc[:10]}T{int(hours) - (minutes == '00'):02d}:{(int(minutes) - 1) % 60:02d}:59.5Z"
    place = "platform: carrier" if in_orbit else f"site: {{latitude_deg: {SITE[0]}, longitude_deg: {SITE[1]}, height_m: {SITE[2]}}}"
    (directory / "scenario.yaml").write_text(SCENARIO.format(start=start, objects=ORBIT if in_orbit else "", place=place, ra=ra, dec=dec))
    light = 8.75e9 * 10**(-0.4 * v_mag)
    (directory / "camera.yaml").write_text(CAMERA.format(focal_m=1.0, aperture_m=2 * math.sqrt(3e6 / light / math.pi)))
    subprocess.run([dmise, "run", directory / "scenario.yaml", "--out", directory / "out"], check=True, capture_output=True, timeout=300)
    with fits.open(next((directory / "out").rglob("frame-000001.fits"))) as file:
        header, counts = file[0].header, file[0].data.astype(float)
        wcs = WCS(header)
    electrons = (counts - np.median(counts)) * 20.0
    y, x = np.indices(counts.shape)
    # The camera's axis is not refracted: near the horizon the planet stands minutes of arc above it.
    top, left = np.unravel_index(np.argmax(electrons), counts.shape)
    near = np.hypot(x - left, y - top) < 60
    total = electrons[near].sum()
    at = [(electrons * c)[near].sum() / total for c in (x, y)]
    ra, dec = np.radians(wcs.all_pix2world(*at, 0))
    return np.array([math.cos(ra) * math.cos(dec), math.sin(ra) * math.cos(dec), math.sin(dec)]), header["PHOTZP"] - 2.5 * math.log10(total)


def main():
    if sys.argv[1] == "--places":
        return print_places(sys.argv[2])
    bad = 0
    for name, _, utc, radius_km, in_orbit in CASES:
        line, to_sun, v_mag = PLACES[name]
        line = np.array(line, float) - (orbit_km() if in_orbit else 0.0)
        with tempfile.TemporaryDirectory() as directory:
            seen, magnitude = measured(sys.argv[1], name, utc, line, v_mag, in_orbit, pathlib.Path(directory))
        expected = lit_middle(line, line - to_sun, radius_km)
        off = math.degrees(np.linalg.norm(np.cross(seen, expected))) * 3600
        from_middle = math.degrees(np.linalg.norm(np.cross(seen, unit(line)))) * 3600
        good = off < 1.0 and abs(magnitude - v_mag) < 0.1
        bad += not good
        print(f"{name:8} {'orbit ' if in_orbit else 'ground'} {off:6.2f} arcsec (from the disc's middle {from_middle:.2f}), "
              f"{magnitude - v_mag:+.3f} mag{'' if good else '  WRONG'}", flush=True)
    return bad


if __name__ == "__main__":
    sys.exit(main())
