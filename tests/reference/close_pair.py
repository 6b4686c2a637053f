#!/usr/bin/env python3
"""Two satellites close together in GEO through a 0.4 m telescope: drawn frames, detections, tracks of a night.

    close_pair.py DMISE                      one night of 1 km and of 300 m: the claims of CLAIMS hold
    close_pair.py DMISE --write              100 nights of each of CASES: writes the table of docs/models/fusion.md
    close_pair.py DMISE --nights N --separation METRES [--separation ..] [--motion KIND] [--fwhm ARCSEC] [--seed S] [--keep DIR] [--each] [--write]
                                             prints these rows, or writes them into the table
    close_pair.py --theory                   the separations at which theory splits a pair

A telescope of 0.4 m f/8 on Haleakala (0.57 arcsec a pixel, points of 2 or 1 arcsec FWHM, 96 x 96 px, 2 s) follows GOES 15 for 8 hours, an exposure
every four minutes. A second satellite, half a magnitude fainter, is near it. Motions:
  ahead    it stays ahead on the orbit at the separation
  ellipse  it goes round on the natural ellipse of a revolution, `separation` ahead and behind and half of that up and down: seen from the
           ground, both pass each other
  unknown  as ahead, but the fusion node doesn't know that there is a second satellite; 2 hours with an exposure a minute
The fusion node knows an element set of each, wrong by 500 m along the orbit and 200 m across it (1 sigma), another in each night: near
each other which is which is a guess. The stars are those of the sky to V = 16 and trail.
A night is kept if there are two confirmed tracks, no more, each from a quarter of an hour after both are first seen apart (an hour for an
unknown one) to the last quarter, and none takes detections of the other object three times in a row (a swap). The object of a detection is
that of `dmise score`.
"""

import argparse
import collections
import csv
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np
from scipy.optimize import least_squares

import referee

DOCUMENT = referee.SOURCE / "docs/models/fusion.md"
CHIEF, DEPUTY = "GOES 15", "neighbour"
LINE1 = "1 36411U 10008A   18020.04261932  .00000091  00000-0  00000-0 0  9992"
LINE2 = "2 36411   0.0777 254.7228 0001628 344.3928 120.8530  1.00259669 28904"
EXPOSURE_S, PIXELS = 2, 96
NIGHTS = {"ahead": (8, 240), "ellipse": (8, 240), "unknown": (2, 60)}  # hours, cadence [s]
ARCSEC_PER_PX = math.degrees(9e-6 / 3.25) * 3600
AXIS_M, RANGE_M = 42.166e6, 37.0e6
EDGE_S, SWAP_RUN = 900, 3
BEGIN_S = {"ahead": EDGE_S, "ellipse": EDGE_S, "unknown": 3600}  # until which a track must have begun
ALONG_SIGMA_M, ACROSS_SIGMA_M = 500, 200
TABLE_SEED = 4000
MOTIONS = ("ahead", "ellipse", "unknown")
SEPARATIONS_M = (2000, 1000, 500, 300, 200, 150, 100)
CASES = ([("ahead", 2.0, s) for s in SEPARATIONS_M] + [("ahead", 1.0, s) for s in (200, 150, 100)] + [("ellipse", 2.0, s) for s in (2000, 1000, 500)] +
         [("unknown", 2.0, s) for s in (1000, 300)])
CLAIMS = (("ahead", 2.0, 1000), ("ahead", 2.0, 300))

SCENARIO = """\
# Written by tests/reference/close_pair.py.
simulation: {{start: 2018-01-21T06:00:00Z, duration_s: {duration}, tick_s: 60, seed: {seed}}}
objects:
  - name: {chief}
    motion:
      sgp4:
        line1: {line1}
        line2: {line2}
    radius_m: 2.5
  - name: {deputy}
    motion: {{proximity: {{of: {chief}, {motion}}}}}
    radius_m: 2
stars: {{catalogue: kstars, synthetic_to: 16}}
sensors:
  - name: telescope
    site: haleakala
    camera:
      name: ritchey-chretien-40cm
      optics: {{columns: {pixels}, rows: {pixels}, pixel_pitch_m: 9e-6, focal_length_m: 3.25, aperture_m: 0.4, obscuration: 0.4, transmission: 0.75, psf_fwhm_px: {fwhm}}}
      detector: {{quantum_efficiency: 0.9, dark_e_per_s: 0.1, read_noise_e: 8, full_well_e: 100000, gain_e_per_dn: 1.6, bias_dn: 300, adc_bits: 16}}
      band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}
    pointing: {{target: {chief}}}
    exposure_s: {exposure}
    cadence_s: {cadence}
    sky: 21.9
fusion: {{catalogue: believed.tle, arc_window_s: 3600, tentative_s: 900}}
output: {{fits: {fits}, png: false, truth: true}}
"""


def checksum(line):
    return str(sum(int(c) if c.isdigit() else c == "-" for c in line) % 10)


def element_set(number, ahead_m, across_m):
    """The chief's set with another number, ahead on its orbit, and inclined so that it goes across by so much."""
    line1 = f"1 {number:5d}" + LINE1[7:68]
    inclination = float(LINE2[8:16]) + math.degrees(across_m / AXIS_M)
    anomaly = (float(LINE2[43:51]) + math.degrees(ahead_m / AXIS_M)) % 360
    line2 = f"2 {number:5d} {abs(inclination):8.4f}" + LINE2[16:43] + f"{anomaly:8.4f}" + LINE2[51:68]
    return line1 + checksum(line1), line2 + checksum(line2)


def motion_of(kind, separation_m, random):
    """The deputy's motion as the scenario has it, and how far ahead it is at the start."""
    if kind != "ellipse":
        return f"hold_rtn_m: [0, {separation_m!r}, 0]", separation_m
    phase = random.uniform(0, 360)
    ellipse = f"circumnavigation: {{radial_m: {separation_m / 2!r}, phase_deg: {phase!r}}}"
    return ellipse, separation_m * math.cos(math.radians(phase))


def draw(dmise, directory, kind, fwhm_arcsec, separation_m, seed, fits=False):
    random = np.random.default_rng([seed, round(separation_m), MOTIONS.index(kind)])
    motion, ahead_m = motion_of(kind, separation_m, random)
    sets = []
    for number, name, place_m in ((36411, CHIEF, 0.0), (90001, DEPUTY.upper(), ahead_m)):
        if kind != "unknown" or name == CHIEF:
            sets += [name, *element_set(number, place_m + random.normal(0, ALONG_SIGMA_M), random.normal(0, ACROSS_SIGMA_M))]
    (directory / "believed.tle").write_text("\n".join(sets) + "\n")
    scenario = directory / "pair.yaml"
    hours, cadence_s = NIGHTS[kind]
    scenario.write_text(SCENARIO.format(duration=hours * 3600, cadence=cadence_s, exposure=EXPOSURE_S, seed=seed, chief=CHIEF, deputy=DEPUTY, line1=LINE1, line2=LINE2,
                                        motion=motion, pixels=PIXELS, fwhm=fwhm_arcsec / ARCSEC_PER_PX, fits=str(fits).lower()))
    done = subprocess.run([dmise, "run", scenario, "--out", directory / "run"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise referee.Failure(f"dmise run: {done.stderr.strip()[-400:]}")
    return directory / "run"


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def score(dmise, run):
    """Rows of truths and false alarms."""
    table = run / "score.csv"
    subprocess.run([dmise, "score", run, "--csv", table], check=True, stdout=subprocess.DEVNULL)
    return list(csv.DictReader(table.read_text().splitlines()))


def swaps_in(owners):
    """How often a sequence of owners changes for SWAP_RUN detections or more."""
    now, run, swaps = None, 0, 0
    candidate = None
    for owner in owners:
        if now is None:
            now = owner
        elif owner == now:
            candidate, run = None, 0
        else:
            run = run + 1 if owner == candidate else 1
            candidate = owner
            if run >= SWAP_RUN:
                now, candidate, run, swaps = owner, None, 0, swaps + 1
    return swaps


def judge_night(dmise, kind, run):
    rows = score(dmise, run)
    owner = {r["detection"]: r["id"] for r in rows if r["fate"] == "found"}
    found = collections.Counter(r["frame"] for r in rows if r["fate"] == "found")
    snr = [float(r["measured_snr"]) for r in rows if r["fate"] == "found"]
    tracks, status, ends_s = collections.defaultdict(list), {}, {}
    for state in lines_of(run / "tracks.jsonl"):
        if state["status"] != "lost":
            ends_s[state["id"]] = state["last_seen_ns"] / 1e9
        tracks[state["id"]] += [(state["time_ns"], owner.get(name)) for name in state["associated"]]
        if status.get(state["id"]) != "confirmed":
            status[state["id"]] = state["status"]
    confirmed = [t for t in tracks if status[t] == "confirmed"]
    hours, cadence_s = NIGHTS[kind]
    end_s = hours * 3600
    both_s = cadence_s * min((int(frame) for frame, n in found.items() if n == 2), default=0)  # from which both are seen
    spans = [(min(s for s, _ in tracks[t]) / 1e9 - both_s, ends_s[t]) for t in confirmed]
    begin_s = BEGIN_S[kind]
    whole = sum(first < begin_s and last > end_s - EDGE_S for first, last in spans)
    owners = [[o for _, o in sorted(tracks[t], key=lambda x: x[0]) if o] for t in confirmed]
    swaps = sum(swaps_in(o) for o in owners)
    strange = sum(min(collections.Counter(o).values()) if len(set(o)) > 1 else 0 for o in owners)
    frames = len({r["frame"] for r in rows if r["fate"] != "false"})
    two = sum(n == 2 for n in found.values())
    return {"frames": frames, "two": two, "one": sum(n == 1 for n in found.values()), "none": frames - len(found),
            "false": sum(r["fate"] == "false" for r in rows), "snr": float(np.median(snr)) if snr else 0.0,
            "confirmed": len(confirmed), "whole": whole, "swaps": swaps, "strange": strange,
            "kept": len(confirmed) == 2 and whole == 2 and swaps == 0}


def night(dmise, kind, fwhm_arcsec, separation_m, seed, keep=None):
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        if keep:
            directory = keep / f"{kind}-{fwhm_arcsec:g}-{separation_m:g}-{seed}"
            directory.mkdir(parents=True, exist_ok=True)
        return judge_night(dmise, kind, draw(dmise, directory, kind, fwhm_arcsec, separation_m, seed, fits=bool(keep)))


def measure(dmise, kind, fwhm_arcsec, separation_m, first, count, each=False, keep=None):
    nights = []
    for seed in range(first, first + count):
        nights.append(night(dmise, kind, fwhm_arcsec, separation_m, seed, keep))
        if each:
            print(kind, fwhm_arcsec, separation_m, seed, nights[-1], flush=True)
    return nights


def row_of(kind, fwhm_arcsec, separation_m, nights):
    arcsec = math.degrees(separation_m / RANGE_M) * 3600
    total = lambda key: sum(n[key] for n in nights)  # noqa: E731
    frames = total("frames")
    swapped = sum(n["swaps"] > 0 for n in nights)
    return (f"| {kind} | {fwhm_arcsec:g} | {separation_m:g} | {arcsec:.2f} | {arcsec / fwhm_arcsec:.2f} | {np.mean([n['snr'] for n in nights]):.0f} | {100 * total('two') / frames:.1f} | {100 * total('one') / frames:.1f} | "
            f"{total('false') / frames:.4f} | {total('kept')} of {len(nights)} | {swapped} |")


HEAD = ["| motion | FWHM, arcsec | m | arcsec | in FWHM | SNR | both detected, % of frames | one, % | false, a frame | nights with two tracks kept | nights with a swap |",
        "|---|---|---|---|---|---|---|---|---|---|---|"]


def expected_gain(separation_px, fwhm_px, electrons, noise_e):
    """By how much a pair's deviance is less than that of the best even line, on average and without noise."""
    sigma = math.hypot(fwhm_px / 2.35482, math.sqrt(1 / 12))
    y, x = np.mgrid[-12:13, -12:13].astype(float)

    def point(x0, y0, e):
        return e / (2 * math.pi * sigma**2) * np.exp(-((x - x0) ** 2 + (y - y0) ** 2) / (2 * sigma**2))

    share = 1 / (1 + 0.64)
    pair = point(-separation_px * (1 - share), 0, electrons * share) + point(separation_px * share, 0, electrons * (1 - share))
    weight = 1 / np.sqrt(pair + noise_e**2)

    def line(p):
        steps = (np.arange(9) - 4) / 9 * p[2]
        return sum(point(p[0] + s, p[1], electrons * p[3] / 9) for s in steps)

    best = least_squares(lambda p: ((line(p) - pair) * weight).ravel(), [0.0, 0.0, math.sqrt(12 * share * (1 - share)) * separation_px, 1.0])
    return 2 * best.cost


def write(rows):
    """Puts rows into the document's table, in the order of CASES."""
    begin, end = "<!-- close pairs -->\n", "<!-- end of close pairs -->\n"
    before, _, rest = DOCUMENT.read_text().partition(begin)
    table, _, rest = rest.partition(end)
    case_of = lambda row: tuple(cell.strip() for cell in row.split("|")[1:4])  # noqa: E731
    known = {case_of(row): row for row in [*table.splitlines()[2:], *rows] if row.startswith("| ")}
    order = [(kind, f"{fwhm:g}", f"{metres:g}") for kind, fwhm, metres in CASES]
    text = "\n".join(HEAD + [known[case] for case in order if case in known]) + f"\n\nMeasured on {referee.occasion()}.\n"
    DOCUMENT.write_text(before + begin + text + end + rest)


def theory():
    """Separations [FWHM] at which an ideal test with a known point spread prefers two points to a line by 16 of chi-square."""
    lines = []
    for fwhm_arcsec in (2.0, 1.0):
        fwhm_px = fwhm_arcsec / ARCSEC_PER_PX
        for electrons in (3e3, 1e4, 3e4, 1e5):
            low, high = 0.2, 12.0
            while high - low > 0.01:
                middle = (low + high) / 2
                low, high = (low, middle) if expected_gain(middle, fwhm_px, electrons, 10.0) > 16 else (middle, high)
            metres = math.radians(high * ARCSEC_PER_PX / 3600) * RANGE_M
            lines.append(f"{fwhm_arcsec:g} arcsec, {electrons:.0f} electrons of both: {high / fwhm_px:.2f} FWHM, {high * ARCSEC_PER_PX:.2f} arcsec, {metres:.0f} m")
    return lines


def judge(dmise):
    for kind, fwhm_arcsec, separation_m in CLAIMS:
        n = night(dmise, kind, fwhm_arcsec, separation_m, 1)
        referee.check(n["kept"], f"{kind}, {separation_m} m: {n['confirmed']} tracks, {n['whole']} of the whole night, {n['swaps']} swaps, both in {n['two']} of {n['frames']} frames")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dmise", type=pathlib.Path, nargs="?")
    parser.add_argument("--write", action="store_true", help="write the table of docs/models/fusion.md")
    parser.add_argument("--nights", type=int, help="print rows of so many nights")
    parser.add_argument("--separation", type=float, action="append", help="[m]")
    parser.add_argument("--motion", choices=MOTIONS, default="ahead")
    parser.add_argument("--fwhm", type=float, default=2.0, help="[arcsec]")
    parser.add_argument("--seed", type=int, default=TABLE_SEED, help="of the first night (%(default)s)")
    parser.add_argument("--keep", type=pathlib.Path, help="directory in which runs stay")
    parser.add_argument("--each", action="store_true", help="print a line for each night")
    parser.add_argument("--theory", action="store_true")
    options = parser.parse_args()
    if options.theory:
        print("\n".join(theory()))
        return
    dmise = options.dmise.resolve()
    if options.nights or options.write:
        cases = [(options.motion, options.fwhm, s) for s in options.separation] if options.separation else CASES
        if not options.write:
            print("\n".join(HEAD), flush=True)
        for case in cases:
            row = row_of(*case, measure(dmise, *case, options.seed, options.nights or 100, options.each, options.keep))
            write([row]) if options.write else print(row, flush=True)
    else:
        judge(dmise)


if __name__ == "__main__":
    referee.main(main)
