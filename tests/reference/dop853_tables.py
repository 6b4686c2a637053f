#!/usr/bin/env python3
"""Writes core/forces/dop853_tables.inc: the coefficients of DOP853 (Hairer, Norsett & Wanner 1993, Solving Ordinary Differential
Equations I, 2nd edition), as scipy has them. dop853_tables.py [--check]; it needs scipy."""
import pathlib
import sys

from scipy.integrate._ivp import dop853_coefficients as dop

TARGET = pathlib.Path(__file__).resolve().parents[2] / "core/forces/dop853_tables.inc"


def row(numbers):
    return "{" + ", ".join(repr(float(x)) for x in numbers) + "}"


def text():
    assert dop.E3[-1] == 0 and dop.E5[-1] == 0
    lines = ["// Made by tests/reference/dop853_tables.py.",
             "constexpr double nodes[12] = " + row(dop.C[:12]) + ";",
             "constexpr double weights[12][12] = {"]
    lines += [row(dop.A[k, :12]) + "," for k in range(12)]
    lines += ["};", "constexpr double sum_weights[12] = " + row(dop.B) + ";",
              "constexpr double error5[12] = " + row(dop.E5[:12]) + ";",
              "constexpr double error3[12] = " + row(dop.E3[:12]) + ";"]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    if "--check" in sys.argv[1:]:
        sys.exit(0 if TARGET.read_text() == text() else f"{TARGET} is not what this script writes")
    TARGET.write_text(text())
