"""Fits the effective surfaces of launch/materials/effective.yaml to the fitted half of what was measured.

    dmise validate brightness --csv points.csv && fit_surfaces.py points.csv

Each line of the CSV has the directions of Sun and observer in the body's axes. The fit is of magnitudes, with a loss that forgives outliers; then all
surfaces are scaled so that the median difference of the fitted half is 0, of a model whose small parts have their share of the light: where none of
them glints, which is most often, it is fainter than on the mean. Shapes are those of launch/models without their own
shadows, and arrays of OneWeb and Iridium NEXT are held at the least reflectance, which is where the fit drives them. `dmise validate` judges the result,
with shadows and by the other half. Those of Starlink were fitted to the first 294 rows of the file, which are among the 299 of the fitted half: of all
299 each number is within a tenth of them.
"""
import argparse
import csv

import numpy as np
from scipy.optimize import least_squares

SUN_V_MAG = -26.76
AB_LESS_V_MAG = -0.02  # colour of sunlight in V; the scale by the median takes up what is left
DARK = 0.004
SIDES = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0), "-z": (0, 0, -1)}


def lambert(normal, sun, viewer):
    return np.maximum(0, sun @ normal) * np.maximum(0, viewer @ normal) / np.pi


def phong(normal, sun, viewer, exponent):
    cosines = (sun @ normal), (viewer @ normal)
    mirrored = 2 * cosines[0] * cosines[1] - np.sum(sun * viewer, axis=1)
    lobe = (exponent + 2) / (2 * np.pi) * np.maximum(0, mirrored) ** exponent * cosines[0] * cosines[1]
    return np.where((cosines[0] > 0) & (cosines[1] > 0), lobe, 0)


def box_wing(body, wings_m2):
    """[(name, start, low, high)] and the light [m2/sr] of a box with an Earth side of its own and wings that face the Sun."""
    x, y, z = body
    areas = {"+x": y * z, "-x": y * z, "+y": x * z, "-y": x * z, "-z": x * y}

    def light(p, sun, viewer):
        body_reflectance, diffuse, specular, exponent = p
        total = sum(body_reflectance * areas[side] * lambert(np.array(normal), sun, viewer) for side, normal in SIDES.items())
        earth = np.array([0, 0, 1.0])
        total = total + x * y * (diffuse * lambert(earth, sun, viewer) + specular * phong(earth, sun, viewer, exponent))
        facing = sun * [1, 0, 1]
        facing /= np.linalg.norm(facing, axis=1)[:, None]
        return total + DARK * wings_m2 * np.maximum(0, np.sum(facing * sun, axis=1)) * np.maximum(0, np.sum(facing * viewer, axis=1)) / np.pi

    return [("body reflectance", 0.1, 0.005, 0.9), ("earth-side diffuse", 0.2, 0.005, 0.6), ("earth-side specular", 0.3, 0.0, 0.4),
            ("earth-side exponent", 8.0, 1.0, 60.0)], light


def starlink():
    """A chassis that faces z and an array that faces x, the Sun's side."""
    def light(p, sun, viewer):
        chassis, array = np.array([0, 0, 1.0]), np.array([1.0, 0, 0])
        return (3.65 * (p[0] * lambert(chassis, sun, viewer) + p[1] * phong(chassis, sun, viewer, p[2])) +
                22.0 * (p[3] * lambert(array, sun, viewer) + p[4] * phong(array, sun, viewer, 0.26)))

    return [("chassis diffuse", 0.1, 0.001, 0.9), ("chassis specular", 0.1, 0.0, 0.9), ("chassis exponent", 9.0, 1.0, 60.0),
            ("array diffuse", 0.02, 0.0, 0.9), ("array specular", 0.01, 0.0, 0.9)], light


MODELS = {"starlink-v1.5": starlink(), "oneweb": box_wing((1, 1, 1.3), 5.5), "iridium-next": box_wing((3.1, 2.4, 1.5), 8.84)}
# Glints of launch/models: parts in view, shares of the narrowest and the widest of six widths. fit_glints.py fits them.
GLINTS = {"oneweb": (0.04, 0.010, 0.03), "iridium-next": (0.07, 0.0065, 0.018)}


def median_of_glints_mag(parts_in_view, least, most, widths=6, objects=400_000):
    """What glints add to the smooth magnitude in half of all directions: lobes of (1 - v)^3 at random (core/facets/glints.h)."""
    random = np.random.default_rng(1)
    shares = np.geomspace(least, most, widths)
    light = np.full(objects, 1 - shares.sum())
    for share in shares:
        count = random.poisson(parts_in_view, objects)
        for part in range(count.max()):
            light += np.where(count > part, 4 * share / parts_in_view * (1 - random.random(objects)) ** 3, 0)
    return -2.5 * np.log10(np.median(light))


def fit(rows, parameters, light, less_v_mag, glints_mag):
    measured, range_m = rows[:, 0] - less_v_mag, rows[:, 1]
    sun, viewer = rows[:, 2:5], rows[:, 5:8]
    wanted = measured - SUN_V_MAG - 5 * np.log10(range_m)

    def difference(p):
        return wanted + 2.5 * np.log10(light(p, sun, viewer) + 1e-4)

    found = least_squares(difference, [p[1] for p in parameters], bounds=([p[2] for p in parameters], [p[3] for p in parameters]), loss="soft_l1").x
    scale = 10 ** (-0.4 * (np.median(difference(found)) - glints_mag))
    return [value if "exponent" in name else value * scale for (name, *_), value in zip(parameters, found)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("points")
    rows = {}
    with open(parser.parse_args().points) as file:
        for row in csv.DictReader(file):
            if row["held_out"] == "0":
                columns = ("measured_mag", "range_m", "sun_x", "sun_y", "sun_z", "viewer_x", "viewer_y", "viewer_z")
                rows.setdefault(row["model"], []).append([float(row[column]) for column in columns])
    for name, (parameters, light) in MODELS.items():
        points = np.array(rows[name])[:: max(1, len(rows[name]) // 3000)]
        glints_mag = median_of_glints_mag(*GLINTS[name]) if name in GLINTS else 0.0
        values = fit(points, parameters, light, AB_LESS_V_MAG if name.startswith("starlink") else 0.0, glints_mag)
        print(name, ", ".join(f"{parameter[0]} {value:.4f}" for parameter, value in zip(parameters, values)))


if __name__ == "__main__":
    main()
