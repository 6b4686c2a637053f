"""Puts the frames of docs/gallery/psf.yaml side by side: psf.py RUN_DIRECTORY OUT.png.

Each panel is scaled by its own peak, as the fourth root.
"""
import pathlib
import sys

import numpy as np
from PIL import Image, ImageDraw

names = ["limit", "spiders", "defocus", "coma", "short", "between", "long", "jitter"]
captions = ["diffraction limit", "four vanes", "1.5 mm out of focus", "coma 110 nm", "4 ms, r0 6 cm",
            "0.2 s", "10 s", "jitter 0.4 arcsec"]


def counts(path):
    data = path.read_bytes()
    end = data.index(b"END" + b" " * 77)
    start = (end // 2880 + 1) * 2880
    pixels = np.frombuffer(data, ">i2", 128 * 128, start).astype(float) + 32768
    return pixels.reshape(128, 128)


run, out = pathlib.Path(sys.argv[1]), sys.argv[2]
side, scale = 96, 3
sheet = Image.new("L", (4 * (side * scale + 4), 2 * (side * scale + 22)))
draw = ImageDraw.Draw(sheet)
for i, name in enumerate(names):
    image = counts(run / name / "frame-000001.fits")[16:112, 16:112]
    image = (np.clip(image / image.max(), 0, 1) ** 0.25 * 255).astype(np.uint8)
    panel = Image.fromarray(image).resize((side * scale, side * scale), Image.NEAREST)
    x, y = i % 4 * (side * scale + 4), i // 4 * (side * scale + 22)
    sheet.paste(panel, (x, y + 18))
    draw.text((x + 4, y + 3), captions[i], fill=255)
sheet.save(out, optimize=True)
