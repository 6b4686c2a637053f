"""The period of an object's light by its streaks in several frames, where one streak shows too few flashes."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .records import Detection, Floats
from .sight import direction_of

_SEARCHED_HARMONICS, _MAX_HARMONICS, _STEPS, _PEAKS = 16, 40, 4.0, 16
_MIN_PROBABILITY = 1e-4
_SHARE_UNEVEN = 0.05  # share of the gain by harmonics that need not repeat: frames differ in air and distance
_PRIORS = [(depth, sharpness) for depth in (0.3, 1.0, 3.0) for sharpness in (0.1, 1.0, 4.0, 16.0)]
_MAX_CORRELATION = 0.49  # of neighbours: more has no covariance, without those of bins farther apart


@dataclass
class PossiblePeriod:
    """A period and its probability, against the others and even light."""
    period_s: float
    sigma_s: float
    probability: float


@dataclass
class _Streak:
    time_s: Floats  # of the middle of each bin
    bin_s: float
    light: Floats
    covariance: Floats

    @property
    def length_s(self) -> float:
        return float(np.ptp(self.time_s)) + self.bin_s


def possible_periods(detections: Sequence[Detection], shortest_s: float | None = None, longest_s: float | None = None) -> list[PossiblePeriod]:
    """Periods that explain the light curves of one object's streaks together, by falling probability; those below 0.0001 are left out.

    Flashes of different frames have a period in common, and any whole fraction of the time between them explains two of them; the shortest are
    preferred, for they say most of the light that is seen. More frames leave fewer possible periods. Light of each frame may have a level and a slope of its own. Tried are periods from `shortest_s` (two bins; `min_period_s` of the
    frames, where they have one) to `longest_s` (the time from the first to the last frame).
    """
    ordered = sorted((d for d in detections if d.light_curve is not None and d.light_curve.light_e.size > 2), key=lambda d: d.end1_time_ns)
    if not ordered:
        raise ValueError("no detection has a light curve")
    drawn = [_streak(d, goes_back) for d, goes_back in zip(ordered, _goes_back(ordered))]
    streaks = [s for s in drawn if s is not None]
    if not streaks:
        raise ValueError("no light curve has light, and the times of its ends")
    first = streaks[0].time_s[0]
    span_s = max(float(s.time_s[-1] - first) for s in streaks)
    bounds = [d.light_curve.min_period_s for d in ordered if d.light_curve.min_period_s]  # type: ignore[union-attr]
    shortest_s = shortest_s or max([2 * max(s.bin_s for s in streaks), *bounds])
    return _Search(streaks, shortest_s, longest_s or span_s, span_s).periods()


def _goes_back(detections: Sequence[Detection]) -> list[bool]:
    """Whether the object went from end 2 to end 1, by the way from frame to frame."""
    middles = [direction_of(d.ra_rad, d.dec_rad) for d in detections]
    out = []
    for k, d in enumerate(detections):
        way = middles[min(k + 1, len(middles) - 1)] - middles[max(k - 1, 0)]
        along = direction_of(d.end2_ra_rad, d.end2_dec_rad) - direction_of(d.end1_ra_rad, d.end1_dec_rad)
        out.append(not d.direction_known and float(way @ along) < 0)
    return out


def _streak(d: Detection, goes_back: bool) -> _Streak | None:
    curve = d.light_curve
    moving_s = (d.end2_time_ns - d.end1_time_ns) * 1e-9
    if curve is None or not moving_s > 0 or not np.mean(curve.light_e) > 0:
        return None
    share = curve.along_px / d.length_px
    time_s = d.end1_time_ns * 1e-9 + moving_s * (1 - share if goes_back else share)
    correlation = np.clip(curve.correlation[:-1], -_MAX_CORRELATION, _MAX_CORRELATION)
    both = correlation * curve.sigma_e[:-1] * curve.sigma_e[1:]
    covariance = np.diag(curve.sigma_e ** 2) + np.diag(both, 1) + np.diag(both, -1)
    order = np.argsort(time_s)
    return _Streak(time_s[order], curve.bin_px / d.length_px * moving_s, curve.light_e[order], covariance[np.ix_(order, order)])


class _Search:
    """Evidence of frequencies: harmonics of any amplitudes of a normal prior, beside each streak's level and slope."""

    def __init__(self, streaks: list[_Streak], shortest_s: float, longest_s: float, span_s: float) -> None:
        self.streaks, self.span_s = streaks, span_s
        self.frequencies = (1 / longest_s, 1 / shortest_s)
        self.time = np.concatenate([s.time_s for s in streaks]) - streaks[0].time_s[0]
        self.bin = np.concatenate([np.full(s.time_s.size, s.bin_s) for s in streaks])
        self.whitener = [np.linalg.inv(np.linalg.cholesky(s.covariance)) for s in streaks]
        others = np.zeros((self.time.size, 2 * len(streaks)))
        at = 0
        for k, s in enumerate(streaks):
            rows = slice(at, at := at + s.time_s.size)
            others[rows, 2 * k], others[rows, 2 * k + 1] = 1.0, (s.time_s - s.time_s.mean()) / s.length_s
        self.level = np.ones(self.time.size)  # of each frame's light, by air and distance
        self.basis = np.linalg.qr(self.white(others))[0]
        light = np.concatenate([s.light for s in streaks])
        self.mean = float(np.mean(light))
        self.light = self.beside(self.white(light[:, None]))[:, 0]
        self.misfit = 1 + _SHARE_UNEVEN * max(float(self.light @ self.light) / light.size - 1, 0.0)

    def white(self, columns: Floats) -> Floats:
        parts = np.split(columns, np.cumsum([s.time_s.size for s in self.streaks])[:-1])
        return np.concatenate([w @ part for w, part in zip(self.whitener, parts)])

    def beside(self, columns: Floats) -> Floats:
        return columns - self.basis @ (self.basis.T @ columns)

    def harmonics(self, frequency: float, most: int = _SEARCHED_HARMONICS) -> int:
        return int(np.clip(0.5 / (frequency * float(np.max(self.bin))), 1, most))

    def step(self, frequency: float) -> float:
        return 1 / (_STEPS * self.harmonics(frequency) * self.span_s)

    def log_evidence(self, frequency: float, harmonics: int) -> float:
        logs, _ = self.fits(frequency, harmonics)
        return float(np.logaddexp.reduce(logs) - np.log(len(logs)))

    def fits(self, frequency: float, harmonics: int) -> tuple[Floats, Floats]:
        """For each prior the logarithm of the evidence, and for the best the light of the wave in all bins."""
        h = np.arange(1, harmonics + 1)
        turn = 2 * np.pi * frequency * np.outer(self.time, h)
        left = np.sinc(frequency * np.outer(self.bin, h)) * self.level[:, None]
        drawn = np.concatenate([left * np.cos(turn), left * np.sin(turn)], axis=1)
        waves = self.beside(self.white(drawn))
        depth, sharpness = np.array(_PRIORS).T[:, :, None]
        power = np.exp(-h / sharpness)
        sigma = self.mean * depth * np.sqrt(np.tile(power / power.sum(axis=1, keepdims=True), 2))
        grown = np.eye(2 * h.size) + sigma[:, :, None] * (waves.T @ waves / self.misfit) * sigma[:, None, :]
        right = sigma * (waves.T @ self.light / self.misfit)
        solved = np.linalg.solve(grown, right[:, :, None])[:, :, 0]
        logs = 0.5 * np.sum(right * solved, axis=1) - 0.5 * np.linalg.slogdet(grown)[1]
        best = int(np.argmax(logs))
        return logs, drawn @ (sigma[best] * solved[best])

    def set_levels(self, frequency: float, harmonics: int) -> None:
        """Scales each frame's light to the periodic one, which is the wave and what is even beside it."""
        self.level = np.ones(self.time.size)
        for _ in range(3):
            shape = self.mean + self.fits(frequency, harmonics)[1] / self.level
            at = 0
            for s in self.streaks:
                rows = slice(at, at := at + s.time_s.size)
                self.level[rows] = np.clip(s.light @ shape[rows] / (shape[rows] @ shape[rows]), 0.5, 2.0)

    def mode(self, frequency: float) -> tuple[float, float, float]:
        """Mean, standard deviation and logarithm of the integral of the evidence around a frequency, over the logarithm of the frequency."""
        harmonics = self.harmonics(frequency, _MAX_HARMONICS)
        self.set_levels(frequency, harmonics)
        middle, reach = frequency, self.step(frequency)
        for _ in range(8):
            f = np.linspace(middle - reach, middle + reach, 21)
            f = f[f > 0]
            logs = np.array([self.log_evidence(x, harmonics) for x in f])
            weight = np.exp(logs - logs.max())
            middle = float(weight @ f / weight.sum())
            sigma = float(np.sqrt(weight @ (f - middle) ** 2 / weight.sum()))
            if sigma > 0.7 * (f[1] - f[0]):
                break
            reach = max(5 * sigma, 2 * float(f[1] - f[0]))
        return middle, sigma, float(logs.max() + np.log(weight.sum() * (f[1] - f[0]) / middle))

    def periods(self) -> list[PossiblePeriod]:
        scanned = [self.frequencies[0]]
        while scanned[-1] < self.frequencies[1]:
            scanned.append(scanned[-1] + self.step(scanned[-1]))
        logs = np.array([self.log_evidence(f, self.harmonics(f)) for f in scanned])
        peaks = [i for i in range(len(logs)) if logs[i] == logs[max(i - 1, 0):i + 2].max()]
        low = 0.8 * logs.max() - 20  # a peak between two frequencies is higher than both
        peaks = sorted((i for i in peaks if logs[i] > low), key=lambda i: -logs[i])[:_PEAKS]
        modes: list[tuple[float, float, float]] = []
        for middle, sigma, log in sorted((self.mode(scanned[i]) for i in peaks), key=lambda m: -m[2]):
            if all(abs(middle - other) > 3 * (sigma + width) for other, width, _ in modes):
                modes.append((middle, sigma, log))
        even = np.log(np.log(self.frequencies[1] / self.frequencies[0]))  # as likely as all periods together before the light is seen
        total = np.logaddexp.reduce([even, *(log for _, _, log in modes)])
        # The ends of a line are known to about half a bin, so its time is.
        shift = np.sqrt(12 / len(self.streaks)) * 0.35 * float(np.mean(self.bin)) / self.span_s
        out = [PossiblePeriod(1 / f, float(np.hypot(s / f ** 2, shift / f)), float(np.exp(log - total))) for f, s, log in modes]
        return [p for p in out if p.probability >= _MIN_PROBABILITY]
