"""Looks for the glinting edges of launch/models that make the light curves of the fitted half smoothest about the model.

    dmise validate brightness --csv points.csv && fit_edges.py points.csv

The points are those of models without `glints`. Edges along the x axis of the body glint while the bisector of Sun and observer is across it
(core/facets/glints.h). What is minimised is the mean distance from each track's median within 12 deg of that plane, over half widths and shares;
tracks that stay more than 2 deg from it say nothing.
"""
import argparse
import csv

import numpy as np

VERSINE_OF_HALF_PEAK = 1 - 2 ** (-1 / 3)
HALF_WIDTHS_DEG = (1.2, 1.5, 1.8, 2.1, 2.5, 3.0, 3.5)
SHARES = (0.0, 0.005, 0.01, 0.014, 0.018, 0.022, 0.025, 0.03, 0.04)


def over_smooth(angle, half_width_deg, share):
    """Light over the smooth light at angles from the plane."""
    reach_versine = (1 - np.cos(np.radians(half_width_deg))) / VERSINE_OF_HALF_PEAK

    def lobe(at):
        return np.clip(1 - (1 - np.cos(at)) / reach_versine, 0, None) ** 3

    at = np.linspace(0, np.arccos(1 - reach_versine), 201)
    return 1 - share + share / np.trapz(lobe(at) * np.cos(at), at) * lobe(angle)


def tracks_of(rows, model, held_out):
    tracks = {}
    for row in rows:
        if row["model"] == model and row["held_out"] == held_out:
            tracks.setdefault(row["track"], []).append([float(row[c]) for c in (
                "measured_mag", "predicted_mag", "sun_x", "sun_y", "sun_z", "viewer_x", "viewer_y", "viewer_z")])
    out = []
    for points in map(np.array, tracks.values()):
        bisector = points[:, 2:5] + points[:, 5:8]
        angle = np.arcsin(bisector[:, 0] / np.linalg.norm(bisector, axis=1))
        if np.sum(np.abs(angle) < np.radians(2)) > 10:
            out.append((points[:, 0] - points[:, 1], angle))
    return out


def distance_mag(tracks, half_width_deg, share):
    off = []
    for difference, angle in tracks:
        left = difference + 2.5 * np.log10(over_smooth(angle, half_width_deg, share))
        off.append(np.abs(left - np.median(left))[np.abs(angle) < np.radians(12)])
    return np.mean(np.concatenate(off))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("points")
    with open(parser.parse_args().points) as file:
        rows = list(csv.DictReader(file))
    for model in ("oneweb", "iridium-next"):
        fitted, held_out = tracks_of(rows, model, "0"), tracks_of(rows, model, "1")
        _, width, share = min((distance_mag(fitted, w, s), w, s) for w in HALF_WIDTHS_DEG for s in SHARES)
        for name, tracks in (("fitted", fitted), ("held out", held_out)):
            print(f"{model}, {name}, {len(tracks)} tracks: {distance_mag(tracks, 2, 0):.3f} mag without edges, {distance_mag(tracks, width, share):.3f} with "
                  f"a half width of {width} deg and a share of {share}")


if __name__ == "__main__":
    main()
