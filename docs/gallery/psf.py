"""Puts the frames of docs/gallery/psf.yaml side by side: psf.py RUN_DIRECTORY OUT.png.

Each panel is scaled by its own peak, as the fourth root.
"""
import pathlib
import sys

import cv2
import numpy as np

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
sheet = np.zeros((2 * (side * scale + 22), 4 * (side * scale + 4)), np.uint8)
for i, name in enumerate(names):
    image = counts(run / name / "frame-000001.fits")[16:112, 16:112]
    image = (np.clip(image / image.max(), 0, 1) ** 0.25 * 255).astype(np.uint8)
    x, y = i % 4 * (side * scale + 4), i // 4 * (side * scale + 22)
    sheet[y + 18:y + 18 + side * scale, x:x + side * scale] = np.kron(image, np.ones((scale, scale), np.uint8))
    cv2.putText(sheet, captions[i], (x + 4, y + 13), cv2.FONT_HERSHEY_SIMPLEX, 0.42, 255, 1, cv2.LINE_AA)
cv2.imwrite(out, sheet, [cv2.IMWRITE_PNG_COMPRESSION, 9])
