"""How many true streaks a detector finds at a number of false alarms, and how well it measures points."""

import itertools

import numpy as np

import peer_frames

GATE_PX = 5.0  # a detection is of a streak if its centroid is so near to its line
ROUND = (1.1, 1.2, 1.35, 1.5, 2.0, 3.0)
ELONGATIONS = (1.0, 1.3, 1.6, 2.0, 3.0, 5.0)
NO_STREAK, OTHER = -1, -2
LENGTHS_PX = (0.0, 5.0, 8.0, 12.0, 16.0, 24.0, 40.0)


def distance_to_line(x, y, line):
    """Distances [px] of points from a line of n x 2 pixels."""
    nearest = np.full(len(x), np.inf)
    for (x0, y0), (x1, y1) in zip(line[:-1], line[1:]):
        square = max((x1 - x0) ** 2 + (y1 - y0) ** 2, 1e-12)
        t = np.clip(((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / square, 0, 1)
        nearest = np.minimum(nearest, np.hypot(x - x0 - t * (x1 - x0), y - y0 - t * (y1 - y0)))
    return nearest


def streaks_of(catalogue, scene):
    """Index of each detection's streak; NO_STREAK, or OTHER of a true object that is not to be found."""
    nearest, index = np.full(len(catalogue), GATE_PX), np.full(len(catalogue), NO_STREAK)
    lines = [streak.line_px for streak in scene.streaks] + scene.others
    for i, line in enumerate(lines):
        distance = distance_to_line(catalogue["x"], catalogue["y"], line)
        index[distance < nearest] = i if i < len(scene.streaks) else OTHER
        nearest = np.minimum(nearest, distance)
    return index


class Candidates:
    """What one detector at one setting made of all scenes."""

    def __init__(self, catalogues, scenes):
        self.found = np.concatenate(catalogues)
        first = np.cumsum([0] + [len(scene.streaks) for scene in scenes])
        index = [streaks_of(c, scene) for c, scene in zip(catalogues, scenes)]
        self.streak = np.concatenate([np.where(i < 0, i, i + start) for i, start in zip(index, first)]).astype(int)

    def false_alarms(self):
        return int(np.sum(self.streak == NO_STREAK))

    def best(self, false_alarms):
        """Set of streaks found with at most so many false alarms, without any choice but by SNR."""
        return self._down_to(np.arange(len(self.found)), "snr", false_alarms)

    def best_of_points(self, false_alarms):
        """The largest such set over all greatest elongations."""
        elongation = self.found["length"] / np.maximum(self.found["width"], 1e-3)
        return max((self._down_to(np.flatnonzero(elongation <= most), "snr", false_alarms) for most in ROUND + (np.inf,)), key=len)

    def best_of_cuts(self, false_alarms):
        """The largest such set over all least elongations, least lengths, and orders by SNR or length."""
        length, width = self.found["length"], np.maximum(self.found["width"], 1e-3)
        best = set()
        for least_elongation, least_px in itertools.product(ELONGATIONS, LENGTHS_PX):
            kept = np.flatnonzero((length >= least_elongation * width) & (length >= least_px))
            for order in ("snr", "length"):
                found = self._down_to(kept, order, false_alarms)
                best = found if len(found) > len(best) else best
        return best

    def _down_to(self, kept, order, false_alarms):
        kept = kept[np.argsort(-self.found[order][kept], kind="stable")]
        streak = self.streak[kept]
        within = np.cumsum(streak == NO_STREAK) <= false_alarms
        return set(streak[within & (streak >= 0)])


def bounds(points, header):
    """(px per axis, relative in flux): least standard errors of points in electrons by the Fisher matrix over pixels."""
    sigma = peer_frames.sigma_px(header["PSFFWHM"])
    axis = np.arange(-10, 11)
    gaussian = np.exp(-axis**2 / (2 * sigma**2)) / np.sqrt(2 * np.pi) / sigma
    share = np.outer(gaussian, gaussian)
    slope = np.outer(gaussian, gaussian * axis / sigma**2)
    noise_e2 = peer_frames.SKY_E + header["RDNOISE"] ** 2 + header["GAIN"] ** 2 / 12
    variance = noise_e2 + points[:, 2, None, None] * share
    place = points[:, 2] ** -1 / np.sqrt(np.sum(slope**2 / variance, axis=(1, 2)))
    return place, points[:, 2] ** -1 / np.sqrt(np.sum(share**2 / variance, axis=(1, 2)))


def nearest(catalogue, points, within_px=1.5):
    """Index of the detection of each point; -1: none."""
    if not len(catalogue):
        return np.full(len(points), -1)
    distance = np.hypot(catalogue["x"] - points[:, 0, None], catalogue["y"] - points[:, 1, None])
    index = np.argmin(distance, axis=1)
    return np.where(distance[np.arange(len(points)), index] < within_px, index, -1)


def point_figures(found, points, header):
    """Figures of points, each with its detection: errors of place and of magnitude, by the better measure of flux."""
    place_bound, flux_bound = bounds(points, header)
    off = np.column_stack([found["x"] - points[:, 0], found["y"] - points[:, 1]])
    figures = {"rms_px": float(np.sqrt(np.mean(off**2))),
               "place_over_bound": float(np.sqrt(np.mean(off**2 / place_bound[:, None] ** 2)))}
    best = None
    for measure in ("auto_e", "aperture_e"):
        flux = np.maximum(found[measure], 1.0)
        magnitude = -2.5 * np.log10(flux / points[:, 2])
        bias = float(np.median(magnitude))
        scatter = (magnitude - bias) / (1.0857 * flux_bound)
        result = {"bias_mag": bias, "scatter_mag": float(np.sqrt(np.mean((magnitude - bias) ** 2))),
                  "scatter_over_bound": float(np.sqrt(np.mean(scatter**2)))}
        if best is None or result["scatter_over_bound"] < best["scatter_over_bound"]:
            best = result
    return {**figures, **best}
