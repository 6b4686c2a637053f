#!/usr/bin/python3
"""Makes docs/gallery/sky.png: the whole sky through a fisheye over a city, under the Moon and at dawn, in natural
colours (R, V and B frames balanced to sunlight). Usage: sky.py DMISE [OUT.png]"""
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np
from astropy.io import fits

SIDE = 620
CAMERA = """
name: all-sky-{band}
optics: {{projection: equidistant, columns: 620, rows: 620, pixel_pitch_m: 10e-6, field_of_view_deg: 184,
         aperture_m: 0.004, equivalent_aperture: true, psf_fwhm_px: 1.5}}
detector: {{quantum_efficiency: 0.8, read_noise_e: 3, full_well_e: 1e7, gain_e_per_dn: {gain}, bias_dn: 100}}
band: {{filter: bessell-{band}}}
"""
SCENARIO = """
simulation: {{start: {start}, duration_s: 120, tick_s: 30, seed: 1}}
stars: {{catalogue: kstars, faintest_mag: 6.5}}
output: {{png: false}}
sensors:
"""
SENSOR = """  - {{name: {band}, site: {site}, camera: {band}.yaml, pointing: zenith, exposure_s: {exposure_s}, cadence_s: 120,
     sky: {sky}, atmosphere: {{extinction: {air}}}}}
"""
ATLANTA = "{latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}"
PARANAL = "{latitude_deg: -24.627, longitude_deg: -70.404, height_m: 2635}"
SCENES = [
    dict(start="2018-01-20T04:00:00Z", site=ATLANTA, exposure_s=30, gain=150, air=0.25,
         sky="{preset: urban, cities: [{azimuth_deg: 100, horizon_over_zenith: 8}]}"),
    dict(start="2018-01-29T02:30:00Z", site=PARANAL, exposure_s=90, gain=400, air="paranal", sky="dark"),
    dict(start="2018-02-13T09:33:00Z", site=PARANAL, exposure_s=15, gain=150, air="paranal", sky="dark"),
]
# Electrons a second of sunlight of one brightness in R, V and B, relative to V: the white of the picture.
WHITE = {"R": 1.74, "V": 1.0, "B": 0.83}


def frame(dmise, scene):
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        text = SCENARIO.format(**scene)
        for band in "RVB":
            (directory / f"{band}.yaml").write_text(CAMERA.format(band=band, gain=scene["gain"]))
            text += SENSOR.format(band=band, **scene)
        (directory / "scenario.yaml").write_text(text)
        subprocess.run([dmise, "run", "scenario.yaml", "--out", "out"], cwd=directory, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        planes = []
        for band in "RVB":
            hdus = fits.open(directory / "out" / band / "frame-000001.fits")
            data = next(h.data for h in hdus if h.data is not None).astype(float)
            planes.append(np.maximum(data - 100, 0) / WHITE[band])
        return np.stack(planes, axis=-1)


def picture(light):
    """Stretched by the arcsinh of its brightness, colours kept."""
    brightness = light.max(axis=-1)
    lit = brightness[brightness > 0]
    low, high = np.percentile(lit, 20), np.percentile(lit, 99.5)
    stretched = np.arcsinh(brightness / low * 2) / np.arcsinh(high / low * 2 + 1)
    scale = np.where(brightness > 0, stretched / np.maximum(brightness, 1e-9), 0)
    return (255 * np.clip(light * scale[..., None], 0, 1)).astype(np.uint8)


def write_png(path, pixels):
    rows, columns, _ = pixels.shape
    raw = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    pathlib.Path(path).write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def main():
    dmise = str(pathlib.Path(sys.argv[1]).resolve())
    out = sys.argv[2] if len(sys.argv) > 2 else pathlib.Path(__file__).with_suffix(".png")
    write_png(out, np.concatenate([picture(frame(dmise, scene)) for scene in SCENES], axis=1))


if __name__ == "__main__":
    main()
