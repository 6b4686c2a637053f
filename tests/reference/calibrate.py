#!/usr/bin/env python3
"""`dmise calibrate` measures cameras whose frames numpy and GalSim drew.

    calibrate.py DMISE [--cameras N] [--first SEED] [--processes N] [--write] [--keep DIR]

Each camera has gain, read noise (of some its spread), bias, fixed pattern, column noise, dark current, hot pixels, PRNU, full well,
non-linearity, vignetting and, of a third, coupling by GalSim, drawn by a seed; and a lens with focal length, zero point, colour term and a
Gaussian or Moffat point spread by GalSim, half of them with distortion and a point spread that grows over the field. Its set has 16
biases, 16 darks of 30 to 300 s, 40 flats of ten levels, two that are full, and four of stars (drawn_stars.py), with cosmic rays. Of each
quantity the pull is (measured - drawn) / sigma. With N cameras
  rms of the pulls    0.8 to 1.2, wider by what N draws allow (2.6 deviations of it)
  beyond 2 sigma      no more than chance has once in 1000 (binomial of 4.55 %)
  transmission        within 1 % of what was drawn, by GalSim's spectrum of Vega, or 3 deviations where few stars show it
and the camera file passes `dmise check` in a scenario. --write writes the table of docs/howto/calibrate-a-camera.md. Without GalSim it
says so and exits 77, with DMISE_DATA set 1.
"""
import argparse
import concurrent.futures
import datetime
import functools
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

try:
    import galsim
    from astropy.io import fits

    import drawn_stars
except ImportError as error:
    print(f"{error} (./dmise setup --tests): cameras were not measured")
    sys.exit(1 if os.environ.get("DMISE_DATA") else 77)

PAGE = pathlib.Path(__file__).parents[2] / "docs/howto/calibrate-a-camera.md"
COLUMNS, ROWS = 512, 384
PITCH_M, STAR_FRAMES, STAR_EXPOSURE_S = 5.4e-6, 4, 30.0
SKY_JD, SKY_BEGINS = 2458139.5, "2018-01-20T23:59:45"  # the middle of the star frames, UTC, and their beginning
COSMIC_PER_PX_S, COSMIC_E = 1e-6, 1000.0
UNITS = {"gain_e_per_dn": "e-/DN", "bias_dn": "DN", "read_noise_e": "e-", "read_noise_spread": "", "column_noise_e": "e-", "pixel_offset_e": "e-",
         "column_offset_e": "e-", "dark_e_per_s": "e-/s", "hot_pixel_fraction": "", "hot_pixel_e_per_s": "e-/s", "prnu_rms": "", "full_well_e": "e-",
         "nonlinearity": "", "interpixel_coupling": "", "vignetting corner": "", "focal_length_m": "m", "distortion.k1": "", "psf_fwhm_px": "px", "psf_field middle": "px",
         "psf_field corner": "px", "zero_point_mag": "mag"}
ALWAYS_MEASURED = {"interpixel_coupling", "distortion.k1"}  # also where 0 was drawn
RELATIVE_OF_MAG = 0.4 * math.log(10)


class Camera:
    """A drawn camera; `truth` by the keys of the camera file."""

    def __init__(self, seed):
        self.rng = rng = np.random.default_rng([seed, 253])
        self.by_galsim = seed % 3 == 0

        def log_uniform(low, high):
            return math.exp(rng.uniform(math.log(low), math.log(high)))
        bits = int(rng.choice([12, 14, 16]))
        highest = 2**bits - 1
        bias = rng.uniform(0.01, 0.05) * highest + 50
        well_dn = rng.uniform(0.5, 0.85) * (highest - bias)
        gain = log_uniform(2e4, 1.2e5) / well_dn
        read = max(log_uniform(1.5, 12), 0.8 * gain)
        self.truth = {
            "gain_e_per_dn": gain, "bias_dn": bias, "read_noise_e": read,
            "read_noise_spread": rng.uniform(0.2, 0.4) if seed % 4 == 1 and read > 2 * gain else 0.0,
            "column_noise_e": rng.uniform(0.3, 1.0) * read if seed % 2 else 0.0,
            "pixel_offset_e": rng.uniform(0.5, 2.0) * read if seed % 3 == 1 else 0.0,
            "column_offset_e": rng.uniform(0.5, 1.0) * read if seed % 3 == 1 else 0.0,
            "dark_e_per_s": log_uniform(0.02, 2.0), "hot_pixel_fraction": log_uniform(1e-3, 5e-3), "hot_pixel_e_per_s": log_uniform(3, 30),
            "prnu_rms": rng.uniform(0.003, 0.02), "full_well_e": well_dn * gain, "nonlinearity": rng.uniform(0.0, 0.03),
            "interpixel_coupling": rng.uniform(0.003, 0.015) if self.by_galsim else 0.0, "vignetting corner": rng.uniform(0.6, 0.95)}
        self.bits = bits
        t = self.truth
        shape = (ROWS, COLUMNS)
        self.response = 1 + t["prnu_rms"] * rng.standard_normal(shape)
        self.hot = np.where(rng.random(shape) < t["hot_pixel_fraction"], rng.exponential(t["hot_pixel_e_per_s"], shape), 0.0)
        self.offset = t["pixel_offset_e"] * rng.standard_normal(shape) + t["column_offset_e"] * rng.standard_normal(COLUMNS)
        spread = t["read_noise_spread"]
        self.read = read * np.exp(-spread**2 + spread * rng.standard_normal(shape))
        y, x = np.mgrid[0:ROWS, 0:COLUMNS]
        self.vignetting = self.vignetting_at(x, y)
        self.lens = drawn_stars.Lens(rng, COLUMNS, ROWS, PITCH_M, moffat=seed % 2 == 0, distorted=seed % 4 >= 2)
        t.update(self.lens.truth())

    def vignetting_at(self, x, y):
        r2 = ((x - (COLUMNS - 1) / 2)**2 + (y - (ROWS - 1) / 2)**2) / (((COLUMNS - 1) / 2)**2 + ((ROWS - 1) / 2)**2)
        return 1 - (1 - self.truth["vignetting corner"]) * r2

    def frame(self, light_e, exposure_s):
        """Counts of one exposure to what the lens lets pass."""
        t, rng = self.truth, self.rng
        e = rng.poisson(light_e * self.response + (t["dark_e_per_s"] + self.hot) * exposure_s).astype(float)
        for _ in range(rng.poisson(COSMIC_PER_PX_S * exposure_s * ROWS * COLUMNS)):
            row, column, length = rng.integers(ROWS), rng.integers(COLUMNS), rng.integers(1, 5)
            e[row, column:column + length] += rng.exponential(COSMIC_E)
        e = np.minimum(e, t["full_well_e"])
        bend = t["nonlinearity"] / t["full_well_e"]
        if self.by_galsim:
            # GalSim lets charge leave at the edges; a camera file's coupling conserves it: a missing neighbour is the pixel itself.
            image, a = galsim.Image(np.pad(e, 1, mode="edge")), t["interpixel_coupling"]
            image.applyNonlinearity(lambda x: x * (1 - bend * x))
            image.applyIPC(galsim.Image(np.array([[0, a, 0], [a, 1 - 4 * a, a], [0, a, 0]])))
            e = image.array[1:-1, 1:-1]
        else:
            e = e * (1 - bend * e)
        e = e + t["column_noise_e"] * rng.standard_normal(COLUMNS) + self.read * rng.standard_normal(e.shape) + self.offset
        return np.clip(np.rint(e / t["gain_e_per_dn"] + t["bias_dn"]), 0, 2**self.bits - 1).astype(np.uint16)

    def write(self, directory):
        well = self.truth["full_well_e"]
        plan = [("Bias Frame", 0.0, 0.0)] * 16 + [("Dark Frame", 0.0, s) for s in (30, 100, 300, 300) for _ in range(4)]
        plan += [("Flat Field", share * well, share * 10) for share in np.geomspace(0.02, 0.8, 10) for _ in range(4)]
        plan += [("Flat Field", 2.5 * well, 25.0)] * 2
        for number, (kind, light, exposure) in enumerate(plan):
            self.write_frame(directory / f"{number:03}.fits", kind, light * self.vignetting, exposure, {})
        sky = drawn_stars.Sky(SKY_JD)
        for number in range(STAR_FRAMES):
            camera = drawn_stars.random_camera(self.rng)
            light = self.lens.frame(sky, camera, STAR_EXPOSURE_S, self.vignetting_at) + self.rng.uniform(50, 300) * self.vignetting
            ra, dec = math.degrees(math.atan2(camera[2][1], camera[2][0])) % 360, math.degrees(math.asin(camera[2][2]))
            self.write_frame(directory / f"stars{number}.fits", "Light Frame", light, STAR_EXPOSURE_S, {"RA": ra + 0.3, "DEC": dec, "DATE-OBS": SKY_BEGINS})

    def write_frame(self, path, kind, light, exposure_s, more):
        """The header's focal length is 2 % wrong."""
        hdu = fits.PrimaryHDU(self.frame(light, exposure_s))
        hdu.header.update({"IMAGETYP": kind, "EXPTIME": exposure_s, "CCD-TEMP": -10.0, "XPIXSZ": 1e6 * PITCH_M, "FOCALLEN": 1020 * self.lens.focal_m,
                           "APTDIA": 1000 * self.lens.aperture_m, **more})
        hdu.writeto(path)


SCENARIO = """
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 2, tick_s: 1, seed: 1}
output: {png: false}
sensors:
  - {name: test, site: atlanta, camera: camera.yaml, pointing: zenith, exposure_s: 1, cadence_s: 2}
"""


def measured(dmise, directory):
    """The camera's JSON, after its file has passed `dmise check`."""
    frames = sorted(str(p) for p in directory.glob("*.fits"))
    result = subprocess.run([dmise, "calibrate", *frames, "--json", "--out", directory / "camera.yaml"], capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"FAIL: {result.stderr}")
    (directory / "scenario.yaml").write_text(SCENARIO)
    check = subprocess.run([dmise, "check", directory / "scenario.yaml"], capture_output=True, text=True)
    if check.returncode:
        sys.exit(f"FAIL: dmise check: {check.stderr}\n{(directory / 'camera.yaml').read_text()}")
    return json.loads(result.stdout)


def found_of(found, key):
    """Value, deviation and whether the file has it, of a quantity; None if it was not measured."""
    column = {"vignetting corner": ("vignetting", "relative_illumination", -1), "psf_field middle": ("psf_field", "fwhm_radial_px", 0),
              "psf_field corner": ("psf_field", "fwhm_radial_px", -1)}.get(key)
    if column:
        table = found["tables"].get("optics." + column[0])
        return table and (table[column[1]][column[2]], table[column[1] + "_sigma"][column[2]], True)
    for group in ("detector.", "optics.", ""):
        if row := found["quantities"].get(group + key):
            return row["value"], row["sigma"], row["origin"] != "insignificant"
    return None


def pulls_of(camera, found, pulls, errors):
    for key, drawn in camera.truth.items():
        row = found_of(found, key)
        if drawn == 0 and key not in ALWAYS_MEASURED:
            if row and row[2]:
                print(f"false: {key}: {row[0]} +- {row[1]}, drawn 0")
                errors[key] = errors.get(key, 0) + 1
            continue
        if row is None:
            print(f"missing: {key}")
            errors[key] = errors.get(key, 0) + 1
            continue
        value, sigma, _ = row
        pulls.setdefault(key, []).append((value - drawn) / sigma)
        pulls.setdefault(key + " sigma", []).append(math.nan if not drawn else sigma * RELATIVE_OF_MAG if key.endswith("_mag") else sigma / abs(drawn))
    passes, sigma, _ = found_of(found, "transmission")
    passes, sigma = passes / camera.lens.transmission, sigma / camera.lens.transmission
    if not abs(passes - 1) < max(0.01, 3 * sigma):
        print(f"false: transmission: {passes} +- {sigma} of what was drawn")
        errors["zero_point_mag"] = errors.get("zero_point_mag", 0) + 1


def chance_limit(n, share=0.0455, rare=1e-3):
    """The least number of draws beyond 2 sigma that chance exceeds less often than `rare`."""
    total = 0.0
    for k in range(n + 1):
        total += math.comb(n, k) * share**k * (1 - share)**(n - k)
        if 1 - total < rare:
            return k
    return n


def judged(pulls, errors):
    """The row of each quantity, and whether it is as it must be."""
    for key in UNITS:
        p = np.array(pulls.get(key, []))
        if not len(p):
            continue
        rms, beyond = math.sqrt(np.mean(p**2)), int(np.sum(np.abs(p) > 2))
        known = [s for s in pulls[key + " sigma"] if s == s]
        sigma = f"{100 * np.median(known):.2g} %" if known else ""
        wide = 2.6 / math.sqrt(2 * len(p))
        ok = 0.8 * (1 - wide) <= rms <= 1.2 * (1 + wide) and beyond <= chance_limit(len(p)) and not errors.get(key)
        yield key, p, sigma, rms, beyond, ok


def document(rows, cameras, first):
    """The table of the page."""
    out = [f"Cameras {first} to {first + cameras - 1} by their seeds, on {datetime.date.today()}, numpy {np.__version__}, GalSim {galsim.__version__}.", "",
           "| value | cameras | median sigma | rms of the pulls | their mean | beyond 2 sigma |", "|---|---|---|---|---|---|"]
    out += [f"| `{key}` | {len(p)} | {sigma} | {rms:.2f} | {p.mean():+.2f} | {beyond} |" for key, p, sigma, rms, beyond, _ in rows]
    begin, end = "<!-- pulls -->\n", "<!-- end of pulls -->"
    text = PAGE.read_text(encoding="utf-8")
    head, rest = text.split(begin)
    return head + begin + "\n".join(out) + "\n" + end + rest.split(end)[1]


def one_camera(dmise, keep, seed):
    pulls, errors, camera = {}, {}, Camera(seed)
    with tempfile.TemporaryDirectory() as directory:
        if keep:
            directory = keep / str(seed)
            directory.mkdir(parents=True)
        camera.write(pathlib.Path(directory))
        pulls_of(camera, measured(dmise, pathlib.Path(directory)), pulls, errors)
    return pulls, errors


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise")
    parser.add_argument("--cameras", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path)
    o = parser.parse_args()
    pulls, errors = {}, {}
    task = functools.partial(one_camera, os.path.abspath(o.dmise), o.keep)
    with concurrent.futures.ProcessPoolExecutor(o.processes) as pool:
        for seed, (own, own_errors) in zip(range(o.first, o.first + o.cameras), pool.map(task, range(o.first, o.first + o.cameras))):
            for key, values in own.items():
                pulls.setdefault(key, []).extend(values)
            for key, count in own_errors.items():
                errors[key] = errors.get(key, 0) + count
            print(f"camera {seed}: " + " ".join(f"{k} {v[0]:+.1f}" for k, v in own.items() if not k.endswith(" sigma")), file=sys.stderr, flush=True)
    rows = list(judged(pulls, errors))
    for key, p, sigma, rms, beyond, ok in rows:
        print(f"{'ok' if ok else 'FAIL'}: {key}: {len(p)} cameras, sigma {sigma}, pulls {rms:.2f} rms, {p.mean():+.2f} mean, {beyond} beyond 2: "
              + " ".join(f"{x:+.1f}" for x in p))
    if o.write:
        PAGE.write_text(document(rows, o.cameras, o.first), encoding="utf-8")
    if bad := [key for key, *_, ok in rows if not ok] + [key for key in errors if key not in pulls]:
        sys.exit("FAIL: " + ", ".join(bad))


main()
