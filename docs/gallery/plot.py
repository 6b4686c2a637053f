"""Draws light-curve.png and snapshots.png from what draw-gallery wrote: plot.py FOLDER"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot

here = pathlib.Path(__file__).parent
data = pathlib.Path(sys.argv[1])


def columns(name):
    rows = list(csv.reader(open(data / name)))[1:]
    return [[float(row[i]) for row in rows] for i in range(len(rows[0]))]


seconds, v_mag = columns("light-curve.csv")
figure, axes = pyplot.subplots(figsize=(7, 3))
axes.plot(seconds, v_mag, linewidth=1)
axes.invert_yaxis()
axes.set_xlabel("s")
axes.set_ylabel("V at 1000 km [mag]")
axes.set_title("Box-wing satellite, 10 turns a minute", fontsize=10)
axes.grid(alpha=0.3)
figure.tight_layout()
figure.savefig(here / "light-curve.png", dpi=90)

count, misplaced, us = columns("snapshots.csv")
figure, (left, right) = pyplot.subplots(1, 2, figsize=(7, 3))
left.loglog(count[1:], misplaced[1:], "o-", markersize=3, label="snapshots")
left.loglog(count[1:], [misplaced[1] / n for n in count[1:]], "--", linewidth=1, label="1/N")
left.set_xlabel("snapshots N")
left.set_ylabel("misplaced share of light")
left.legend(fontsize=8)
right.loglog(count[1:], us[1:], "o-", markersize=3, label="snapshots")
right.axhline(us[0], linestyle="--", linewidth=1, label="path integral")
right.set_xlabel("snapshots N")
right.set_ylabel("time [us]")
right.legend(fontsize=8)
for axes in (left, right):
    axes.grid(alpha=0.3)
figure.suptitle("Streak of 60 px: time-delay integration against the path integral", fontsize=10)
figure.tight_layout()
figure.savefig(here / "snapshots.png", dpi=90)
