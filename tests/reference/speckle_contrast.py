#!/usr/bin/python3
"""Speckle of a point behind the air has the contrast of theory, and that of means of N exposures is smaller by sqrt(N).

    speckle_contrast.py DMISE

Figure 8 of docs/paper/make.py. Theory: the intensity of fully developed speckle is exponential, contrast 1 (Goodman, Statistical
Optics), which a pixel of half lambda / D averages to 0.899. 40 exposures of some 100 speckles each in the core.
"""

import pathlib
import sys
import tempfile

import referee

sys.path.insert(0, str(referee.SOURCE / "docs/paper"))
import make  # noqa: E402


def judge(dmise):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        found = make.figure8(make.Maker(dmise, folder, folder))
    contrast, theory = found["contrast"], found["theory"]
    referee.check(abs(contrast["1"] / theory - 1) < 0.03, f"contrast {contrast['1']:.3f}, theory {theory:.3f}")
    for n in (2, 4, 8):
        got = contrast[str(n)] * n**0.5 / theory
        referee.check(abs(got - 1) < 0.05, f"mean of {n}: {contrast[str(n)]:.3f}, {got:.3f} of theory over sqrt({n})")


if __name__ == "__main__":
    referee.main(judge, *sys.argv[1:])
