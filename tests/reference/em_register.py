#!/usr/bin/env python3
"""The exact distribution of a gain register's output by its generating function, stage by stage (a Galton-Watson process of
binary splitting), inverted by FFT in numpy: the figures of tests/detector/test_em_gain.cpp. Prints the mean, the excess noise
factor squared beside that of Robbins & Hadwen 2003, and values of the distribution function."""
import numpy as np


def distribution(gain, stages, electrons, most):
    p = gain ** (1.0 / stages) - 1.0
    z = np.exp(-2j * np.pi * np.arange(most) / most)
    for _ in range(stages):
        z = (1.0 - p) * z + p * z * z
    return np.fft.ifft(z**electrons).real


if __name__ == "__main__":
    for gain, stages, electrons in [(2.0, 100, 3), (30.0, 536, 1), (300.0, 536, 1), (300.0, 536, 4), (100.0, 64, 20)]:
        most = 1 << int(np.ceil(np.log2(electrons * gain * 40)))
        share = distribution(gain, stages, electrons, most)
        count = np.arange(most)
        mean = (share * count).sum()
        excess = 1.0 + ((share * count**2).sum() - mean**2) / electrons / gain**2
        closed = 2.0 * (gain - 1.0) * gain ** (-(stages + 1.0) / stages) + 1.0 / gain
        at = [int(electrons * gain * part) for part in (0.25, 0.5, 1.0, 1.5, 2.0)]
        print(f"{{{gain}, {stages}, {electrons}, {excess:.6f}, {{" + ", ".join(f"{{{a}, {share[:a + 1].sum():.5f}}}" for a in at) + f"}}}},  // {mean:.3f}, {closed:.6f}")
