#!/usr/bin/env python3
"""`dmise.possible_periods`: the period of a body whose streaks show one flash each, or none, in light curves that numpy draws. Seeds were not tuned on."""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "clients/python/src"))
import dmise  # noqa: E402

EXPOSURE_S, BINS, LENGTH_PX = 4.0, 60, 240.0


def streak(random, start_s, period_s, kind, goes_back, snr):
    """A detection of an exposure from `start_s` on, of light with an error of 1 / snr of the mean in each bin."""
    time_s = start_s + (np.arange(BINS) + 0.5) / BINS * EXPOSURE_S
    turn = time_s / period_s
    off = (turn + 0.5) % 1 - 0.5
    light = 1 + 0.5 * np.sin(2 * np.pi * turn) if kind == "sine" else 0.6 + 5 * np.exp(-0.5 * (off * period_s / 0.12) ** 2)
    light = 1000 * light * (1 + 0.1 * random.normal())
    light = light + 1000 / snr * random.normal(size=BINS)
    curve = dmise.LightCurve(bin_px=LENGTH_PX / BINS, along_px=(np.arange(BINS) + 0.5) * LENGTH_PX / BINS,
                             light_e=light[::-1].copy() if goes_back else light, sigma_e=np.full(BINS, 1000 / snr), correlation=np.zeros(BINS))
    ra = [0.001 * start_s, 0.001 * (start_s + EXPOSURE_S)]
    first, last = ra[::-1] if goes_back else ra
    return dmise.Detection(kind="streak", length_px=LENGTH_PX, end1_time_ns=int(start_s * 1e9), end2_time_ns=int((start_s + EXPOSURE_S) * 1e9),
                           ra_rad=np.mean(ra), end1_ra_rad=first, end2_ra_rad=last, light_curve=curve)


def trial(seed, kind, count):
    """True period, and the possible ones."""
    random = np.random.default_rng(seed)
    period_s = random.uniform(4.2, 7.9)  # one streak has less than one
    starts = 40 + 6.3 * np.arange(count) + random.uniform(0, 0.8, count)
    streaks = [streak(random, t, period_s, kind, random.uniform() < 0.5, 20.0) for t in starts]
    return period_s, dmise.possible_periods(streaks, shortest_s=2.0)


def two_flashes():
    """The same of two streaks, each with a flash in its middle, five periods apart."""
    random, period_s = np.random.default_rng(600), 6.1
    return period_s, dmise.possible_periods([streak(random, t - EXPOSURE_S / 2, period_s, "flash", False, 20.0) for t in (7 * period_s, 12 * period_s)])


def main():
    wrong = []
    for kind in ("sine", "flash"):
        found = [trial(seed, kind, 8) for seed in range(500, 506)]
        first = [(p[0].period_s - true) / true for true, p in found]
        among = [any(abs(one.period_s - true) < max(0.01 * true, 4 * one.sigma_s) for one in p) for true, p in found]
        pulls = [first[k] * true / p[0].sigma_s for k, (true, p) in enumerate(found) if abs(first[k]) < 0.05]
        said = f"{kind}: the likeliest of 8 streaks is within 1 % in {sum(abs(f) < 0.01 for f in first)} of {len(first)}, the true one is possible in " \
               f"{sum(among)}; NEES {np.mean(np.square(pulls)):.2f}"
        print(said)
        if sum(abs(f) < 0.01 for f in first) < 6 or sum(among) < 6 or np.mean(np.square(pulls)) > 1.2 + 3 * np.sqrt(2 / len(pulls)):
            wrong.append(said)
    true, some = two_flashes()
    print(f"two flashes {5 * true:.1f} s apart: {some}")
    fractions = [min(abs(5 * true / n / p.period_s - 1) for n in range(1, 16)) for p in some]
    if len(some) < 3 or max(fractions) > 0.01:
        wrong.append("two flashes leave other periods than fractions of their distance")
    steady = [streak(np.random.default_rng(700 + k), 40 + 9.0 * k, 1e9, "sine", False, 20.0) for k in range(5)]
    if sum(p.probability for p in dmise.possible_periods(steady, shortest_s=2.0)) > 0.5:
        wrong.append("steady light has a period")
    try:
        dmise.possible_periods([dmise.Detection()])
        wrong.append("no light curve is accepted")
    except ValueError as error:
        print(error)
    sys.exit("\n".join(wrong) if wrong else 0)


if __name__ == "__main__":
    main()
