"""Measures 2 to 200 sensor nodes, fits what they cost, simulates up to 10,000, and writes
docs/scaling.md and docs/gallery/scaling.png.

    scaling.py [--measured FILE] [--network FILE] [--output FILE] [--plot FILE]      (python3-matplotlib)

--measured: JSON lines of `dmise bench scaling --json`, in place of a run of it; --network: those of
`dmise bench network --json`, for what a frame costs.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import re
import subprocess

import matplotlib
import numpy

from report import machine, number, table
from scaling_model import Costs, Network, simulate

matplotlib.use("Agg")
from matplotlib import pyplot

ROOT = pathlib.Path(__file__).resolve().parents[1]
BINARY = ROOT / "build/release/bin/dmise"
FITTED_TO = 64                # sensors; what lies beyond is foretold
SENSORS_A_HOST, CORES = 20, 2
SIZES = (200, 500, 1000, 2000, 5000, 10000)
STATE_BYTES = 18470 * 73      # nine doubles and a code
TICK_S, FRAME_TICKS = 5.0, 4
USUAL_FRAME_S = 0.3           # where `dmise bench network` was not run


def measured_figures(lines):
    """{kind: {sensors: {figure: value}}} of kinds barrier, states, fields, paced."""
    kinds = {}
    for line in lines:
        figure = json.loads(line)
        parts = re.fullmatch(r"scaling_([a-z-]+)_(\w+)_(\d+)", figure["name"])
        if parts is None:
            continue  # a figure with a target, of values that are here too
        kind, name, sensors = parts.groups()
        kinds.setdefault(kind, {}).setdefault(int(sensors), {})[name] = figure["value"]
    return kinds


def line_through(points):
    """(a, b) of a + b n by least squares of relative errors, neither below 0."""
    n, y = numpy.array(sorted(points.items()), dtype=float).T
    rows = numpy.stack([1 / y, n / y], axis=1)
    both = numpy.linalg.lstsq(rows, numpy.ones_like(y), rcond=None)[0]
    if both.min() >= 0:
        return tuple(both)
    slope = float((n / y).sum() / ((n / y) ** 2).sum())
    return (0.0, slope) if both[0] < 0 else (1 / float((1 / y).mean()), 0.0)


def worst_error(points, fit, least=0, most=1e9):
    """Largest relative error of a + b n at the points with least < n <= most."""
    errors = [abs(fit[0] + fit[1] * n - y) / y for n, y in points.items() if least < n <= most]
    return max(errors, default=float("nan"))


class Fits:
    def __init__(self, kinds):
        barrier, states, paced = (kinds[k] for k in ("barrier", "states", "paced"))

        def of(kind, figure, rest=None):
            """Seconds a tick; less what time alone costs."""
            return {n: 1e-6 * m[figure] - (rest[0] + rest[1] * n) / m["ticks_per_s"] if rest else 1e-6 * m[figure]
                    for n, m in kind.items()}

        def small(points, most=FITTED_TO):
            return {n: y for n, y in points.items() if n <= most and y > 0}

        self.rest_points = {n: 1e-6 * m["master_us"] * m["ticks_per_s"] for n, m in paced.items()}
        self.rest = line_through(small(self.rest_points))
        self.master_points = of(barrier, "master_us", self.rest)
        self.master = line_through(small(self.master_points))
        self.broker_points = of(barrier, "broker_us")
        self.broker = line_through(small(self.broker_points))
        self.copies_points = of(states, "broker_us")
        copies = line_through(small(self.copies_points))
        self.copies = copies
        self.bytes_points = {n: m["bytes"] for n, m in barrier.items() if "bytes" in m}
        self.bytes = line_through(small(self.bytes_points)) if self.bytes_points else (0.0, 400.0)
        alone = {kind: {f: float(numpy.median([1e-6 * m[f] for n, m in points.items() if n <= 8]))
                        for f in ("orbit_us", "sensor_us")}
                 for kind, points in (("barrier", barrier), ("states", states))}
        self.empty = Costs(master_s=self.master[0], master_per_node_s=self.master[1], broker_s=self.broker[0],
                           broker_per_node_s=self.broker[1], orbit_s=alone["barrier"]["orbit_us"],
                           sensor_s=alone["barrier"]["sensor_us"], node_bytes=self.bytes[1])
        self.full = dataclasses.replace(
            self.empty, state_bytes=STATE_BYTES, broker_s=copies[0],
            copy_s=max(0.0, copies[1] - self.broker[1]),
            publish_s=max(0.0, alone["states"]["orbit_us"] - alone["barrier"]["orbit_us"]),
            take_in_s=max(0.0, alone["states"]["sensor_us"] - alone["barrier"]["sensor_us"]))

    def table(self):
        def us(x):
            return number(1e6 * x)
        rows = []
        for what, fit, points in (("time-master, a tick", self.master, self.master_points),
                                  ("broker, a tick of empty states", self.broker, self.broker_points),
                                  ("broker, a tick of 18,470 states", self.copies, self.copies_points),
                                  ("time-master, a second of heartbeats", self.rest, self.rest_points)):
            rows.append([what, f"{us(fit[0])} + {us(fit[1])} N us", f"{100 * worst_error(points, fit, 0, FITTED_TO):.0f} %",
                         f"{100 * worst_error(points, fit, FITTED_TO):.0f} %"])
        if self.bytes_points:
            rows.append(["bytes of a tick of empty states", f"{number(self.bytes[0])} + {number(self.bytes[1])} N",
                         f"{100 * worst_error(self.bytes_points, self.bytes, 0, FITTED_TO):.0f} %",
                         f"{100 * worst_error(self.bytes_points, self.bytes, FITTED_TO):.0f} %"])
        for what, s in (("orbit node, a tick of empty states", self.full.orbit_s),
                        ("orbit node, publishing 18,470 states", self.full.publish_s),
                        ("sensor node, a tick of empty states", self.full.sensor_s),
                        ("sensor node, taking in 18,470 states", self.full.take_in_s)):
            rows.append([what, f"{us(s)} us", "", ""])
        return table(("processor time (N sensors)", "fit", f"worst error, N <= {FITTED_TO}", "beyond"), rows)


def busy_cores(sensors, m):
    """Processors that the network had: fewer than there are where others work beside it."""
    return 1e-6 * m["ticks_per_s"] * (m["master_us"] + m["broker_us"] + m["orbit_us"] + m.get("environment_us", 0)
                                      + sensors * m["sensor_us"])


def here(kinds, fits):
    """Measured beside simulated, on this machine; returns the table and the simulated ticks a second."""
    rows, simulated = [], {}
    for kind, costs in (("barrier", fits.empty), ("states", fits.full)):
        for n, m in sorted(kinds[kind].items()):
            found = simulate(costs, Network(sensors=n, cores=os.cpu_count()), 24).ticks_per_s
            simulated[kind, n] = found
            rows.append([n, "empty" if kind == "barrier" else "18,470", number(m["ticks_per_s"]), number(found),
                         f"{100 * (found / m['ticks_per_s'] - 1):+.0f} %", number(m["master_us"]),
                         number(m["broker_us"]), number(m["sensor_us"]), number(busy_cores(n, m)),
                         number(m.get("bytes", 0) * m["ticks_per_s"] / 1e6)])
    head = ("sensor nodes", "states", "ticks/s", "simulated", "error", "master, us/tick", "broker, us/tick",
            "a sensor, us/tick", "busy cores", "all links, MB/s")
    return table(head, rows), simulated


def telescopes(kinds):
    """Measured networks of sensors that find objects themselves; empty if there are none."""
    rows = [[n, number(m["ticks_per_s"]), number(m["master_us"]), number(m["broker_us"]), number(m["orbit_us"]),
             number(m["environment_us"]), number(m["sensor_us"]), number(busy_cores(n, m)),
             number(m.get("bytes", 0) * m["ticks_per_s"] / 1e6)] for n, m in sorted(kinds.get("fields", {}).items())]
    if not rows:
        return ""
    head = ("telescopes", "ticks/s", "master, us/tick", "broker, us/tick", "orbit node, us/tick",
            "environment node, us/tick", "a sensor, us/tick", "busy cores", "all links, MB/s")
    return f"""Telescopes on the ground over the same 18,470 objects, with an exposure in every tick of 5 s: each propagates what may be
in its field from the roster, and finds what is in it at start, middle and end
([decision 0079](decisions/0079-sensors-propagate-what-is-in-their-field.md)); all states are published besides.

{table(head, rows)}
"""


def too_fast(kinds, simulated, least, most):
    """Largest excess of simulated ticks with states over measured ones, least < sensors <= most."""
    excess = [simulated["states", n] / m["ticks_per_s"] - 1 for n, m in kinds["states"].items() if least < n <= most]
    return f"{100 * max(0.0, *excess):.0f} %"


def beyond(fits):
    """Simulated networks of many hosts: rows, and curves for the plot."""
    rows, curves = [], {}
    for agents in (False, True):
        for n in SIZES:
            network = Network(sensors=n, hosts=n // SENSORS_A_HOST, cores=CORES, agents=agents)
            ticks = 16 if n <= 1000 else 6
            empty, full = simulate(fits.empty, network, ticks), simulate(fits.full, network, ticks)
            heard = network.hosts if agents else n
            share = full.master_s / TICK_S + fits.rest[0] + fits.rest[1] * heard
            rows.append([n, network.hosts, "one a host" if agents else "none", number(empty.ticks_per_s),
                         number(full.ticks_per_s), f"{100 * share:.1f} %",
                         number(full.broker_out_bytes / TICK_S / 1e6), number(STATE_BYTES * (1 if agents else SENSORS_A_HOST) / TICK_S / 1e6),
                         "yes" if full.ticks_per_s * TICK_S > 1 and share < 1 else "no"])
            curves.setdefault(agents, []).append((n, empty.ticks_per_s, full.ticks_per_s, share, full.broker_out_bytes / TICK_S))
    head = ("sensors", "hosts", "agents", "ticks/s, empty", "ticks/s, 18,470 states", "master's core at 5 s ticks",
            "broker's link, MB/s", "a host's link, MB/s", "5 s ticks in time")
    return table(head, rows), curves


def with_frames(fits, frame_s):
    rows = []
    for agents in (False, True):
        network = Network(sensors=SIZES[-1], hosts=SIZES[-1] // SENSORS_A_HOST, cores=CORES, agents=agents,
                          tick_s=TICK_S, frame_s=frame_s, frame_ticks=FRAME_TICKS)
        out = simulate(fits.full, network, 8)
        rows.append([network.sensors, network.hosts, "one a host" if agents else "none", out.overruns, number(out.worst_lag_s)])
    return table(("sensors", "hosts", "agents", "late ticks of 8", "worst lag, s"), rows)


def draw(kinds, simulated, curves, path):
    figure, (left, middle, right) = pyplot.subplots(1, 3, figsize=(12, 3.8))
    for kind, colour, what in (("barrier", "C0", "empty states"), ("states", "C1", "18,470 states")):
        points = sorted((n, m["ticks_per_s"]) for n, m in kinds[kind].items())
        left.loglog(*zip(*points), "o", color=colour, markersize=4, label=f"measured, {what}")
        left.loglog(*zip(*[(n, simulated[kind, n]) for n, _ in points]), "-", color=colour, label="simulated, this machine")
        column = 1 if kind == "barrier" else 2
        for agents, style in ((False, "--"), (True, ":")):
            left.loglog([c[0] for c in curves[agents]], [c[column] for c in curves[agents]], style, color=colour,
                        label=f"{SENSORS_A_HOST} a host, {'agents' if agents else 'flat'}")
    left.axhline(1 / TICK_S, color="0.6", linewidth=0.8)
    left.set_ylabel("ticks a second")
    for agents, style, what in ((False, "--", "flat"), (True, ":", "agents")):
        sizes = [c[0] for c in curves[agents]]
        middle.loglog(sizes, [100 * c[3] for c in curves[agents]], style, color="C2", label=what)
        right.loglog(sizes, [c[4] / 1e6 for c in curves[agents]], style, color="C3", label=what)
    middle.axhline(100, color="0.6", linewidth=0.8)
    middle.set_ylabel("master at 5 s ticks, % of a core")
    right.axhline(1250, color="0.6", linewidth=0.8)
    right.text(SIZES[0], 1350, "10 Gbit/s", fontsize=8, color="0.4")
    right.set_ylabel("broker's link at 5 s ticks, MB/s")
    for axes in (left, middle, right):
        axes.set_xlabel("sensors")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=6, loc="lower right" if axes is right else "best")
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--measured", type=pathlib.Path)
    parser.add_argument("--network", type=pathlib.Path)
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "docs/scaling.md")
    parser.add_argument("--plot", type=pathlib.Path, default=ROOT / "docs/gallery/scaling.png")
    options = parser.parse_args()
    about = machine()
    if options.measured:
        lines = options.measured.read_text().splitlines()
    else:
        lines = subprocess.run([BINARY, "bench", "scaling", "--json"], check=True, text=True,
                               stdout=subprocess.PIPE).stdout.splitlines()
    kinds = measured_figures(lines)
    frame_s, frame_from = USUAL_FRAME_S, "assumed"
    if options.network:
        for line in options.network.read_text().splitlines():
            figure = json.loads(line)
            if figure["name"] == "network_frame_cpu_s":
                frame_s, frame_from = figure["value"], "measured by `dmise bench network`"
    fits = Fits(kinds)
    measured, simulated = here(kinds, fits)
    larger, curves = beyond(fits)
    draw(kinds, simulated, curves, options.plot)
    options.output.write_text(f"""# Scaling

Written by `bench/scaling.py` from `dmise bench scaling` (measured) and `bench/scaling_model.py` (simulated).

{table(("", ""), about)}
## Measured here
Sensor nodes that do nothing but take part, each a process, with orbit node, broker and time-master, as fast as
possible, window of 4 ticks; bytes as the loopback device counts them, with headers and acknowledgements. Simulated:
the same network, from the costs below, with all {os.cpu_count()} cores to itself.

{measured}
{telescopes(kinds)}
## What a network costs
Straight lines through up to {FITTED_TO} sensors, judged by what lies beyond. The master's ticks are counted without the
heartbeats, which come by time (4 a second of each node).

{fits.table()}
## The model
A discrete-event simulation: each process is a queue of work, a host has {CORES} cores, a link 10 Gbit/s each way and 50 us;
time-master, broker and orbit node have a host each, {SENSORS_A_HOST} sensors share one. An agent is to the master what
one node is, and to the sensors of its host what master and broker are; its costs are theirs, as fitted. It takes one
copy of the states for its host. Left out: threads of a process side by side, caches, losses and questions for what is
late. That shows where states go to many processes of one machine: with up to {SENSORS_A_HOST} sensors, as on a host below, the model
is too fast by up to {too_fast(kinds, simulated, 0, SENSORS_A_HOST)}, with more by up to {too_fast(kinds, simulated, SENSORS_A_HOST, 1000)}.

{larger}
The last column: a tick of 18,470 states takes less than {TICK_S:g} s, and the master's core suffices.

With frames of {frame_s:.2f} s of one core ({frame_from}), one of each sensor every {FRAME_TICKS} ticks, at real time:

{with_frames(fits, frame_s)}
![Ticks a second, the master's processor time and the broker's link against the number of sensors](gallery/scaling.png)
""")
    print(options.output)


if __name__ == "__main__":
    main()
