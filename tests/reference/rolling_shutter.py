#!/usr/bin/env python3
"""A point that moves straight before a camera whose rows are exposed one after another, rendered by numpy row by row: the
figures of tests/pipeline/test_rolling_shutter.cpp. Prints, for row times of 0 and more, the times at which the point's own row
opens and closes, the centroid and rms size of the light, its sum over that of row time 0, and where rows have their light."""
import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtr

COLUMNS, ROWS, FOCAL_PX, RANGE_M = 200, 160, 1e4, 1e5
START_S, EXPOSURE_S, FWHM_PX = 1.0, 0.1, 2.0
DIFFRACTION_PX = 1.029 * 0.55e-6 / 0.02 / 1e-4  # full width of the Airy disc
SIGMA_PX = np.hypot(FWHM_PX, DIFFRACTION_PX) / 2.354820045


def render(row_time_s, at_start_m, speed, samples=20000):
    east, up = speed

    def pixel(t):
        x = (COLUMNS - 1) / 2 + FOCAL_PX / RANGE_M * (at_start_m[0] + east * (t - START_S))
        y = (ROWS - 1) / 2 - FOCAL_PX / RANGE_M * (at_start_m[1] + up * (t - START_S))
        return x, y

    image = np.zeros((ROWS, COLUMNS))
    edges = np.arange(COLUMNS + 1) - 0.5
    for row in range(ROWS):
        t = START_S + row * row_time_s + EXPOSURE_S * (np.arange(samples) + 0.5) / samples
        x, y = pixel(t)
        share = ndtr((row + 0.5 - y) / SIGMA_PX) - ndtr((row - 0.5 - y) / SIGMA_PX)
        seen = share > 1e-12
        if seen.any():
            image[row] = (share[seen, None] * np.diff(ndtr((edges[None] - x[seen, None]) / SIGMA_PX), axis=1)).sum(0) / samples

    def opens(first):
        meets = lambda t: t - first - row_time_s * np.clip(pixel(t)[1], 0, ROWS - 1)
        return brentq(meets, first, first + row_time_s * (ROWS - 1), xtol=1e-13) if row_time_s and row_time_s * -up * FOCAL_PX / RANGE_M < 1 else first

    return image, sorted((opens(START_S), opens(START_S + EXPOSURE_S)))


if __name__ == "__main__":
    y, x = np.mgrid[:ROWS, :COLUMNS]
    # Down the image; up; down, with all rows taking longer than the exposure; faster than the shutter.
    for name, row_time_us, at_start_m, speed in [("down", 500, (-595, 595), (5000, -3000)), ("up", 500, (-595, 195), (5000, 3000)),
                                                 ("slow", 2000, (-595, 595), (2000, -1000)), ("fast", 500, (-595, 995), (3000, -25000))]:
        at_once, _ = render(0.0, at_start_m, speed)
        image, (start, end) = render(row_time_us * 1e-6, at_start_m, speed)
        total = image.sum()
        cx, cy = (image * x).sum() / total, (image * y).sum() / total
        print(f"{name}: start {start:.9f} end {end:.9f} sum {total / at_once.sum():.5f} centroid {cx:.4f} {cy:.4f} "
              f"rms {np.sqrt((image * (x - cx) ** 2).sum() / total):.4f} {np.sqrt((image * (y - cy) ** 2).sum() / total):.4f}")
        for row in range(ROWS):
            light = image[row].sum()
            if (row % 7 == 0 or row == 31) and light > 0.3 * image.sum(1).max():
                print(f"  row {row}: {(image[row] * x[row]).sum() / light:.4f}")
