#!/usr/bin/env python3
"""Writes launch/survey/coastlines.inc from Natural Earth's land at 1:110 million (public domain, naturalearthdata.com), in the form
of the npm package world-atlas: coastlines.py LAND_110M_JSON. Lines are simplified to 0.35 deg; islands below 1.5 deg and the edges
of the map are left out."""
import json
import pathlib
import sys

TOLERANCE_DEG, LEAST_DEG = 0.35, 1.5


def simplified(points):
    """Ramer, Douglas and Peucker's: no point that is left out is further than the tolerance from the line."""
    if len(points) < 3:
        return points
    (x0, y0), (x1, y1) = points[0], points[-1]
    dx, dy = x1 - x0, y1 - y0
    length = (dx * dx + dy * dy) ** 0.5

    def off(p):
        if length == 0:
            return ((p[0] - x0) ** 2 + (p[1] - y0) ** 2) ** 0.5
        return abs(dx * (p[1] - y0) - dy * (p[0] - x0)) / length

    at = max(range(1, len(points) - 1), key=lambda k: off(points[k]))
    if off(points[at]) < TOLERANCE_DEG:
        return [points[0], points[-1]]
    return simplified(points[:at + 1])[:-1] + simplified(points[at:])


def is_edge(a, b):
    """Whether a side lies on the edge of the map, where land goes on beyond it."""
    return min(a[1], b[1]) < -85.5 or abs(a[0]) > 179.9 and abs(b[0]) > 179.9 or abs(a[0] - b[0]) > 180


def lines_of(topology):
    (sx, sy), (tx, ty) = topology["transform"]["scale"], topology["transform"]["translate"]
    for arc in topology["arcs"]:
        x = y = 0
        line = [[]]
        for dx, dy in arc:
            x, y = x + dx, y + dy
            point = (x * sx + tx, y * sy + ty)
            if line[-1] and is_edge(line[-1][-1], point):
                line.append([])
            line[-1].append(point)
        yield from (piece for piece in line if len(piece) > 1)


def main(source):
    text = ["// Natural Earth, land at 1:110 million (public domain, naturalearthdata.com), by launch/survey/coastlines.py:",
            "// lines of longitude and latitude [0.1 deg]."]
    for line in lines_of(json.loads(pathlib.Path(source).read_text())):
        xs, ys = zip(*line)
        if max(max(xs) - min(xs), max(ys) - min(ys)) < LEAST_DEG:
            continue
        row = "{"
        points = [f"{{{round(10 * x)}, {round(10 * y)}}}" for x, y in simplified(line)]
        for k, point in enumerate(points):
            word = point + (", " if k + 1 < len(points) else "},")
            if len(row) + len(word) > 99:
                text.append(row.rstrip())
                row = ""
            row += word
        text.append(row)
    pathlib.Path(__file__).with_name("coastlines.inc").write_text("\n".join(text) + "\n")


main(sys.argv[1])
