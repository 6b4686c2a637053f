#!/usr/bin/env python3
"""A column of a CCD read clock by clock by numpy, with traps: the figures of tests/detector/test_charge_transfer.cpp. At each
transfer every well leaves a share of its charge in its pixel's traps, which release a share of theirs into the next packet that
comes; with a release within the next transfer it is Janesick's binomial trail."""
import numpy as np


def read_out(column, cti, release_px):
    rows = len(column)
    wells, traps = column.astype(float), np.zeros(rows)
    freed = 1.0 - np.exp(-1.0 / release_px) if release_px else 1.0
    out = []
    for _ in range(rows):
        # Every packet moves on by one; what it leaves is trapped in the pixel that it leaves.
        left = cti * wells
        moved = wells - left
        out.append(moved[0])
        wells = np.append(moved[1:], 0.0)
        # The packet that has come takes what the traps release.
        traps += left
        wells += freed * traps
        traps *= 1.0 - freed
    return np.array(out), wells.sum() + traps.sum()


if __name__ == "__main__":
    rows = 512
    star = np.zeros(rows)
    star[400] = 10000
    block = np.zeros(rows)
    block[200:300] = 1000
    for name, column in [("star", star), ("block", block)]:
        for cti, release_px in [(1e-5, 0.0), (2e-4, 0.0), (5e-5, 3.0), (5e-5, 30.0)]:
            out, behind = read_out(column, cti, release_px)
            first = 400 if name == "star" else 299
            print(f"{name} {cti} {release_px}: {behind:.4f} | " + " ".join(f"{e:.3f}" for e in out[first:first + 7]))
