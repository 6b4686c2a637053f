#!/usr/bin/env python3
"""The detector beside sep and source-extractor, on GalSim's frames and on those of DMISE's own renderer.

    detect_beside_peers.py DMISE            few frames: neither finds more true streaks at equal false alarms
    detect_beside_peers.py DMISE --write    many frames: writes the tables of docs/detection.md

The others' thresholds, widths of filter, deblending and what counts as a streak (elongation, length, SNR) are chosen anew
for each kind of frame and number of false alarms so that they find the most. Needs sep and galsim (build/venv), and
source-extractor; without them it says so and exits 77, with DMISE_DATA set 1.
"""

import argparse
import itertools
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import peer_detectors
import peer_frames
import peer_scores
import referee

DOCUMENT = referee.SOURCE / "docs/detection.md"
SETTINGS = {  # thresholds in units of noise; sep's is that of the filtered frame
    "sep": {"threshold": (1.7, 2.5, 4.0), "wider": (1.0, 2.0), "contrast": (0.005, 1.0)},
    "source-extractor": {"threshold": (0.8, 1.3, 2.5), "wider": (1.0, 2.0), "contrast": (0.005, 1.0)},
}
FEW = {"sep": {"threshold": (2.5, 4.0), "wider": (1.0, 2.0), "contrast": (1.0,)},
       "source-extractor": {"threshold": (1.0, 2.0), "wider": (1.0, 2.0), "contrast": (1.0,)}}
SNR_BINS = (7, 10, 15, 30, 101)
KINDS = {"tracked": "GalSim, stars round", "fixed": "GalSim, stars trailed", "night": "DMISE, all-sky"}


def with_peer(name, scene, **settings):
    header = scene.header()
    if name == "sep":
        return peer_detectors.with_sep(scene.counts(), header, **settings)[0]
    return peer_detectors.with_source_extractor(scene.path, header, **settings)[0]


def candidates(dmise, scenes, settings):
    """{detector: [Candidates of each of its settings]}."""
    ours = [peer_detectors.dmise(dmise, scene.path) for scene in scenes]
    out = {"dmise": [peer_scores.Candidates(ours, scenes)]}
    for name, sweep in settings.items():
        out[name] = []
        for values in itertools.product(*sweep.values()):
            found = [with_peer(name, scene, **dict(zip(sweep, values))) for scene in scenes]
            out[name].append(peer_scores.Candidates(found, scenes))
    return out


def found_at(name, all_settings, false_alarms):
    """The largest set of streaks that a detector finds with at most so many false alarms."""
    if name == "dmise":
        return all_settings[0].best(false_alarms)
    return max((c.best_of_cuts(false_alarms) for c in all_settings), key=len)


def scenes_of(dmise, directory, frames, sites, nights):
    """{kind: scenes}."""
    templates = peer_frames.templates(dmise, directory / "empty")
    out = {kind: [peer_frames.draw_streaks(templates[kind], directory / f"{kind}-{i}.fits", 100 * k + i)
                  for i in range(1, frames + 1)] for k, kind in enumerate(("tracked", "fixed"))}
    out["night"] = peer_frames.night(dmise, directory / "night", sites, nights)
    points = [peer_frames.draw_points(templates["fixed"], directory / f"points-{i}.fits", 900 + i)
              for i in range(1, max(frames // 4, 1) + 1)]
    return out, points


def points_table(dmise, scenes):
    """{detector: figures} of points that all three find."""
    rows = {name: [] for name in ("dmise", "sep", "source-extractor")}
    truths = []
    for scene in scenes:
        found = {"dmise": peer_detectors.dmise(dmise, scene.path), "sep": with_peer("sep", scene, threshold=3.0),
                 "source-extractor": with_peer("source-extractor", scene, threshold=1.5)}
        index = {name: peer_scores.nearest(c, scene.points) for name, c in found.items()}
        common = np.all([i >= 0 for i in index.values()], axis=0)
        truths.append(scene.points[common])
        for name, c in found.items():
            rows[name].append(c[index[name][common]])
    truths, header = np.concatenate(truths), scenes[0].header()
    return len(truths), {name: peer_scores.point_figures(np.concatenate(c), truths, header) for name, c in rows.items()}


def costs(dmise, scene):
    """{detector: (seconds, MB)} of one frame with one thread."""
    out = {"dmise": peer_detectors.cost_of([dmise, "detect", scene.path])}
    script = pathlib.Path(peer_detectors.__file__)
    done = subprocess.run([sys.executable, script, scene.path, "2.5"], capture_output=True, text=True, check=True)
    out["sep"] = tuple(map(float, done.stdout.split()))
    out["source-extractor"] = peer_detectors.with_source_extractor(scene.path, scene.header(), 1.5,
                                                                   stack_px=1_000_000)[1:]
    return out


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]) + "\n"


def found_tables(kinds, settings, dmise):
    """Two tables: streaks found at equal false alarms, and by SNR."""
    found_rows, snr_rows = [], []
    for kind, scenes in kinds.items():
        by = candidates(dmise, scenes, settings)
        ours = by["dmise"][0].false_alarms()
        snr = np.array([s.snr for scene in scenes for s in scene.streaks])
        for name, all_settings in by.items():
            sets = [found_at(name, all_settings, n) for n in (ours, len(scenes), 10 * len(scenes))]
            found_rows.append([KINDS[kind], name] + [f"{len(s)} of {len(snr)}" for s in sets])
            hit = np.isin(np.arange(len(snr)), list(sets[1]))
            within = [(snr >= low) & (snr < high) for low, high in zip(SNR_BINS, SNR_BINS[1:])]
            within[-1] |= snr >= SNR_BINS[-1]
            snr_rows.append([KINDS[kind], name] + [f"{hit[w].sum()} of {w.sum()}" for w in within])
        found_rows[-3][1] += f" (false alarms: {ours} in {len(scenes)} frames)"
    bins = [f"SNR {low} to {high}" for low, high in zip(SNR_BINS, SNR_BINS[1:-1])] + [f"{SNR_BINS[-2]} and more"]
    return (table(["frames", "detector", "streaks found at dmise's false alarms", "at 1 a frame", "at 10 a frame"], found_rows),
            table(["frames", "detector, at 1 a frame"] + bins, snr_rows))


def document(dmise, directory, frames, nights):
    kinds, point_scenes = scenes_of(dmise, directory, frames, ("atlanta", "huntsville"), nights)
    found, by_snr = found_tables(kinds, SETTINGS, dmise)
    n, figures = points_table(dmise, point_scenes)
    point_rows = [[name, f"{f['rms_px']:.4f}", f"{f['place_over_bound']:.2f}", f"{f['bias_mag']:+.4f}",
                   f"{f['scatter_mag']:.4f}", f"{f['scatter_over_bound']:.2f}"] for name, f in figures.items()]
    cost_rows = [[name, f"{seconds:.2f}", f"{mb:.0f}"] for name, (seconds, mb) in costs(dmise, kinds["night"][0]).items()]
    return (found + "\n" + by_snr + f"\n{n} points of an SNR of 15 to 350, which all three find:\n\n"
            + table(["detector", "rms, px", "over its bound", "magnitude bias", "scatter", "over its bound"], point_rows)
            + "\nAn all-sky frame of 3326 x 2504 pixels, one thread:\n\n"
            + table(["detector", "seconds", "peak memory, MB"], cost_rows) + f"\nMeasured on {referee.occasion()}; {peer_detectors.versions()}.\n")


def between(text, inside):
    begin, end = "<!-- peers -->\n", "<!-- end of peers -->\n"
    if begin not in text or end not in text:
        sys.exit(f"{DOCUMENT}: has no {begin.strip()} .. {end.strip()}")
    return text.partition(begin)[0] + begin + inside + end + text.partition(end)[2]


def judge(dmise, directory):
    kinds, point_scenes = scenes_of(dmise, directory, 3, ("atlanta",), 1)
    for kind, scenes in kinds.items():
        by = candidates(dmise, scenes, FEW)
        allowed = max(by["dmise"][0].false_alarms(), len(scenes))
        found = {name: len(found_at(name, c, allowed)) for name, c in by.items()}
        of = sum(len(scene.streaks) for scene in scenes)
        for name in FEW:
            referee.check(found[name] <= found["dmise"],
                          f"{KINDS[kind]}: {found['dmise']} of {of} streaks, {name} {found[name]}, "
                          f"with at most {allowed} false alarms in {len(scenes)} frames")
    n, figures = points_table(dmise, point_scenes)
    for name in FEW:
        for key, what in (("place_over_bound", "places"), ("scatter_over_bound", "magnitudes")):
            referee.check(figures["dmise"][key] <= 1.02 * figures[name][key],
                          f"{what} of {n} points over their bound: {figures['dmise'][key]:.3f}, {name} {figures[name][key]:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dmise", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="write the tables of docs/detection.md")
    parser.add_argument("--frames", type=int, default=8, help="GalSim's frames of each kind (%(default)s)")
    parser.add_argument("--nights", type=int, default=2, help="frames of each all-sky sensor (%(default)s)")
    options = parser.parse_args()
    dmise = options.dmise.resolve()
    if not dmise.is_file():
        raise referee.Failure(f"{options.dmise}: there is no such program")
    referee.need("source-extractor")
    for module in ("sep", "galsim"):
        try:
            __import__(module)
        except ImportError as error:
            raise referee.Missing(f"{module} is not installed (./dmise setup --tests)") from error
    with tempfile.TemporaryDirectory() as name:
        if not options.write:
            return judge(dmise, pathlib.Path(name))
        DOCUMENT.write_text(between(DOCUMENT.read_text(),
                                    document(dmise, pathlib.Path(name), options.frames, options.nights)))


if __name__ == "__main__":
    referee.main(main)
