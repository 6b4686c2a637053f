"""Draws light-curve.png from what draw-gallery wrote: plot.py FOLDER"""
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
