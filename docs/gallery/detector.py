"""Draws detector.png: one star field through a detector in which one effect at a time is strong.

    detector.py DMISE       (python3-numpy, python3-astropy)
"""

import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy
from astropy.io import fits

# Row by row, three panels each: what docs/models/detector.md says below the picture.
PANELS = {
    "plain": "",
    "prnu": "prnu_rms: 0.15",
    "hot-pixels": "hot_pixel_fraction: 0.004, hot_pixel_e_per_s: 150",
    "cosmic-rays": "cosmic_rays_per_px_s: 8e-5, cosmic_ray_e_per_px: 300, cosmic_ray_depth_px: 3",
    "blooming": "blooming: on",
    "coupling": "interpixel_coupling: 0.08",
    "persistence": "persistence_fraction: 0.3, persistence_s: 60",
    "column-noise": "column_noise_e: 25, reference_px: 8",
    "everything": "prnu_rms: 0.15, hot_pixel_fraction: 0.004, hot_pixel_e_per_s: 150, blooming: on,"
                  " cosmic_rays_per_px_s: 8e-5, cosmic_ray_e_per_px: 300, cosmic_ray_depth_px: 3,"
                  " interpixel_coupling: 0.08, persistence_fraction: 0.3, persistence_s: 60,"
                  " column_noise_e: 25, reference_px: 8",
}
COLUMNS, ROWS, ZOOM, GAP = 150, 120, 2, 6

SENSOR = """\
  - name: {name}
    site: atlanta
    pointing: {{azimuth_deg: 168.5, elevation_deg: 80.2}}
    exposure_s: 8
    cadence_s: 40
    camera:
      name: {name}
      optics: {{columns: {columns}, rows: {rows}, pixel_pitch_m: 9e-6, focal_length_m: 0.025,
               aperture_m: 0.018}}
      detector: {{full_well_e: 9000, gain_e_per_dn: 0.5, bias_dn: 200, read_noise_e: 6,
                 dark_e_per_s: 1{more}}}
      band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}
"""


def write_png(path, grey):
    rows = b"".join(b"\0" + row.tobytes() for row in grey)
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", grey.shape[1], grey.shape[0], 8, 0, 0, 0, 0)),
              (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b"")]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks))


def main():
    with tempfile.TemporaryDirectory() as directory:
        work = pathlib.Path(directory)
        text = ("simulation: {start: 2018-01-21T01:15:00Z, duration_s: 110, tick_s: 10, seed: 2}\n"
                "stars: {catalogue: kstars}\nobjects: [{catalogue: demo}]\n"
                "output: {png: false}\nsensors:\n")
        for name, more in PANELS.items():
            text += SENSOR.format(name=name, columns=COLUMNS, rows=ROWS,
                                  more=", " + more if more else "")
        (work / "s.yaml").write_text(text)
        subprocess.run([sys.argv[1], "run", work / "s.yaml", "--out", work / "out"], check=True,
                       stdout=subprocess.DEVNULL)
        side = len(PANELS) // 3
        picture = numpy.full((side * (ROWS * ZOOM + GAP) - GAP, 3 * (COLUMNS * ZOOM + GAP) - GAP), 90,
                             numpy.uint8)
        for i, name in enumerate(PANELS):
            dn = fits.getdata(work / "out" / name / "frame-000003.fits").astype(float)
            light = numpy.arcsinh((dn - 180) / 60) / numpy.arcsinh(18000 / 60)
            panel = (255 * numpy.clip(light, 0, 1)).astype(numpy.uint8)
            panel = panel.repeat(ZOOM, 0).repeat(ZOOM, 1)
            y, x = i // 3 * (ROWS * ZOOM + GAP), i % 3 * (COLUMNS * ZOOM + GAP)
            picture[y:y + panel.shape[0], x:x + panel.shape[1]] = panel
        write_png(pathlib.Path(__file__).with_name("detector.png"), picture)


if __name__ == "__main__":
    main()
