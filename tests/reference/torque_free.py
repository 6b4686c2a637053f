#!/usr/bin/env python3
"""Rigid bodies without torque by scipy: Euler's equations and the quaternion by DOP853. Writes tests/reference/torque_free.inc.
torque_free.py [--check]"""
import pathlib
import sys

import numpy as np
from scipy.integrate import solve_ivp

TARGET = pathlib.Path(__file__).with_name("torque_free.inc")
TIMES_S = (-20.0, 10.0, 100.0, 300.0)
CASES = [  # what, moments of inertia, rate at time 0 [rad/s]
    ("about the axis of the greatest moment", (1.0, 2.0, 2.5), (0.1, 0.2, 0.3)),
    ("about the axis of the least moment", (1.0, 2.0, 2.5), (0.4, -0.1, 0.05)),
    ("moments in falling order", (3.0, 2.0, 1.5), (-0.1, 0.2, 0.3)),
    ("the middle moment first", (2.5, 3.0, 2.0), (0.02, -0.2, 0.1)),
    ("a rocket body", (900.0, 8000.0, 8000.0), (0.3, 0.2, -0.1)),
    ("a flat body", (2.0, 2.0, 4.0), (0.1, 0.2, 0.3)),
    ("nearly symmetric", (2.0, 2.000001, 1.0), (0.1, 0.2, 1e-4)),
    ("a plate, at the triangle's edge", (1.0, 2.0, 3.0), (0.2, 0.1, -0.1)),
    ("a rod", (1e-6, 1.0, 1.0), (0.5, 0.1, 0.0)),
    ("near the middle axis", (1.0, 2.0, 2.5), (1e-6, 0.2, -1e-6)),
    ("near the separatrix", (1.0, 2.0, 2.5), (0.1, 0.2, 0.0632455532)),
    ("about the middle axis", (1.0, 2.0, 2.5), (0.0, -0.2, 0.0)),
    ("across a symmetric body", (2.0, 1.0, 2.0), (0.1, 0.0, 0.2)),
    ("a sphere", (1.0, 1.0, 1.0), (0.1, 0.2, 0.3)),
    ("at rest", (1.0, 2.0, 2.5), (0.0, 0.0, 0.0)),
]


def slope(_, y, inertia):
    (a, b, c), (w, x, y_, z), (p, q, r) = inertia, y[:4], y[4:]
    return [(-x * p - y_ * q - z * r) / 2, (w * p + y_ * r - z * q) / 2, (w * q + z * p - x * r) / 2,
            (w * r + x * q - y_ * p) / 2, (b - c) * q * r / a, (c - a) * r * p / b, (a - b) * p * q / c]


def numbers(values):
    return "{" + ", ".join(f"{v:.15g}" for v in values) + "}"


def rows():
    for what, inertia, rate in CASES:
        states = []
        for t in TIMES_S:
            done = solve_ivp(slope, (0, t), [1, 0, 0, 0, *rate], args=(inertia,), method="DOP853", rtol=3e-14, atol=1e-16)
            q, w = done.y[:4, -1], done.y[4:, -1]
            q = q / np.linalg.norm(q)
            states.append(f"{{{t:g}, {numbers(q)}, {numbers(w)}}}")
        yield f'{{"{what}", {numbers(inertia)}, {numbers(rate)},\n{{' + ",\n".join(states) + "}},\n"


def main():
    head = ("// Made by tests/reference/torque_free.py: DOP853 of scipy. {case, moments of inertia, rate at 0 [rad/s],\n"
            "// {{time [s], first_from_now (w, x, y, z), rate [rad/s]}, ..}}\n")
    text = head + "".join(rows())
    if "--check" not in sys.argv:
        TARGET.write_text(text)
        return 0
    if text == TARGET.read_text():
        return 0
    print("torque_free.inc is not what this writes")
    return 1


if __name__ == "__main__":
    sys.exit(main())
