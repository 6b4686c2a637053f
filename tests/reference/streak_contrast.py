#!/usr/bin/python3
"""Figure 7 of the DMISE-GHOST paper (AMOS 2021): a streak of COSMOS 2519 (42798) at V = 4 over a city's sky through the
OMNISSA camera in blue, green and red: (streak + sky) / sky. Usage: streak_contrast.py DMISE [--bands bessell|kaf8300]
[--lamps LPS,HPS,LED] [--json]

The element set is of 19 December 2019; on these dates the object crosses Atlanta's sky in the Earth's shadow only, so
the shadow is off and its size is chosen so that it has V = 4 in the middle of the exposure. Three figures a band:
  rate     1 + the object's rate over the sky's in one pixel, were it to stand still in its centre
  20 s     the streak's ridge in the expected image of the paper's exposure (no noise, no saturation)
  2 s      the same in counts of a 2 s exposure with the real gain
and what the 20 s sky fills of the full well.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from astropy.io import fits

TLE = """COSMOS 2519
1 42798U 17037A   19353.70641250  .00017609  00000-0  22673-3 0  9990
2 42798  97.8163  89.4740 0205466 259.0467  98.7601 15.37950093136849
"""
PAPER = {"B": 2.03, "G": 1.12, "R": None}
FULL_WELL_E = 25500.0
PSF_FWHM_PX = 1.5

CAMERA = """
name: omnissa-{name}
optics: {{projection: gnomonic, columns: 3326, rows: 2504, pixel_pitch_m: 5.4e-6, field_of_view_deg: 90,
         aperture_m: 0.0375, transmission: 0.80, psf_fwhm_px: 1.5, equivalent_aperture: true}}
detector: {{quantum_efficiency: {efficiency}, full_well_e: 1e9, gain_e_per_dn: {gain}, bias_dn: 0, adc_bits: 16}}
band: {{filter: {filter}}}
"""
SCENARIO = """
simulation: {{start: 2019-12-15T05:20:20Z, duration_s: 20, tick_s: 2, seed: 1}}
objects: [{{catalogue: cosmos-2519.tle, radius_m: {radius_m!r}}}]
effects: {{shadow: off, scintillation: off, photon_noise: off, dark_current: off, read_noise: off, full_well: off}}
detection: off
output: {{png: false}}
sensors:
"""
SENSOR = """  - {{name: {name}, site: {{latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}}, camera: {camera}.yaml,
     pointing: zenith, exposure_s: {exposure_s}, first_exposure_s: {first_s}, cadence_s: 20,
     sky: {{preset: urban{lamps}}}}}
"""


def write_bands(directory, bands):
    """Filter and efficiency of each band: Bessell's B, V, R, or the colour planes of a KAF-8300."""
    if bands == "bessell":
        return {"B": ("bessell-B", 0.54), "G": ("bessell-V", 0.54), "R": ("bessell-R", 0.54)}
    table = pathlib.Path(os.environ.get("DMISE_DATA", "../shared/data")) / "detector/QE_Kodak_KAF8300_color.tsv"
    rows = [line.split("\t")[:4] for line in table.read_text().splitlines()[1:]]
    result = {}
    for column, band in enumerate("BGR", start=1):
        curve = "wavelength_nm,efficiency_percent\n"
        curve += "".join(f"{row[0]},{row[column]}\n" for row in rows if row[column])
        (directory / f"{band}.csv").write_text(curve)
        result[band] = (f"{band}.csv", 1.0)
    return result


def run(dmise, directory, bands, lamps, radius_m):
    """Frames and truth of all bands, at 20 s and 2 s."""
    text = SCENARIO.format(radius_m=radius_m)
    for band, (band_filter, efficiency) in bands.items():
        for exposure_s, first_s, gain in ((20, 0, 8.0), (2, 9, 0.35)):
            name = f"{band}-{exposure_s}s"
            (directory / f"{name}.yaml").write_text(
                CAMERA.format(name=band, filter=band_filter, efficiency=efficiency, gain=gain))
            text += SENSOR.format(name=name, camera=name, exposure_s=exposure_s, first_s=first_s, lamps=lamps)
    (directory / "scenario.yaml").write_text(text)
    (directory / "cosmos-2519.tle").write_text(TLE)
    subprocess.run([dmise, "run", "scenario.yaml", "--out", "out", "--force"], cwd=directory, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    truth = {}
    for line in (directory / "out/truth.jsonl").read_text().splitlines():
        one = json.loads(line)
        truth[one["sensor"]] = one
    return truth


def pixels(directory, sensor):
    for hdu in fits.open(next((directory / "out" / sensor).glob("*.fits"))):
        if hdu.data is not None:
            return hdu.data.astype(float), hdu.header
    raise SystemExit(f"{sensor}: no image")


def ridge(image, truth):
    """(streak + sky, sky) in counts: the mean of the brightest pixel across the streak along its middle half, and of
    the pixels 12 to 20 px beside it."""
    start, end = np.array(truth["start_px"]), np.array(truth["end_px"])
    along = (end - start) / np.hypot(*(end - start))
    across = np.array([-along[1], along[0]])
    peaks, skies = [], []
    for t in np.linspace(0.3, 0.7, 81):
        at = start + t * (end - start)
        offsets = np.arange(-3, 3.01, 0.25)
        line = np.rint(at + offsets[:, None] * across).astype(int)
        peaks.append(image[line[:, 1], line[:, 0]].max())
        far = np.concatenate([np.arange(-20, -11), np.arange(12, 21)])
        line = np.rint(at + far[:, None] * across).astype(int)
        skies.append(np.median(image[line[:, 1], line[:, 0]]))
    return np.mean(peaks), np.mean(skies)


def peak_share(fwhm_px):
    """Share of a Gaussian's light in the pixel that it is centred on."""
    from math import erf, log, sqrt
    sigma = fwhm_px / (2 * sqrt(2 * log(2)))
    return erf(0.5 / sigma / sqrt(2)) ** 2


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("dmise")
    arguments.add_argument("--bands", choices=("bessell", "kaf8300"), default="bessell")
    arguments.add_argument("--lamps", help="shares in V of low- and high-pressure sodium and LED lamps")
    arguments.add_argument("--json", action="store_true")
    options = arguments.parse_args()
    dmise = str(pathlib.Path(options.dmise).resolve())
    lamps = ""
    if options.lamps:
        lps, hps, led = (float(x) for x in options.lamps.split(","))
        lamps = f", lamps: {{lps: {lps}, hps: {hps}, led: {led}}}"
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        bands = write_bands(directory, options.bands)
        found = run(dmise, directory, bands, lamps, 1.0)
        magnitude = found["B-20s"]["true_magnitude"]
        truth = run(dmise, directory, bands, lamps, 10 ** (0.2 * (magnitude - 4.0)))
        result = {}
        for band in "BGR":
            long_name, short_name = f"{band}-20s", f"{band}-2s"
            image, header = pixels(directory, long_name)
            lit, sky = ridge(image, truth[long_name])
            gain = header["GAIN"]
            image, header = pixels(directory, short_name)
            lit_2, sky_2 = ridge(image, truth[short_name])
            signal_e_per_s = truth[short_name]["rendered_signal_e"] / 2.0
            result[band] = {"rate": 1 + signal_e_per_s * peak_share(PSF_FWHM_PX) / (sky * gain / 20.0),
                            "20 s": lit / sky, "2 s": lit_2 / sky_2, "paper": PAPER[band],
                            "sky_e_per_s": sky * gain / 20.0, "well": sky * gain / FULL_WELL_E}
    if options.json:
        print(json.dumps(result))
    else:
        print(f"V = {truth['B-20s']['true_magnitude']:.3f}; (streak + sky) / sky")
        for band, row in result.items():
            print(band, "  ".join(f"{key} {value:.3f}" for key, value in row.items() if value is not None))
    rate = {band: row["rate"] for band, row in result.items()}
    if not rate["B"] > rate["R"] > rate["G"]:
        raise SystemExit("order is " + " > ".join(sorted(rate, key=rate.get, reverse=True)))


if __name__ == "__main__":
    main()
