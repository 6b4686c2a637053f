#!/usr/bin/python3
"""Purity and completeness of the tracks of a run, by its truth.

    score_tracks.py DMISE RUN

Joins detections and truth by `dmise score`, and each track that was confirmed with all detections that it took.
  purity        share of the detections of confirmed tracks that are of the object of which the track has most
  completeness  share of the objects with eight detections or more that have a confirmed track
  of noise      confirmed tracks that have most of no object
  cues          share of tasks whose target a telescope found within its first two exposures
"""
import collections
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

LEAST_DETECTIONS = 8


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def objects_of(dmise, run):
    """The object of each detection that is one."""
    with tempfile.TemporaryDirectory() as directory:
        table = pathlib.Path(directory) / "score.csv"
        subprocess.run([dmise, "score", run, "--csv", table], check=True, stdout=subprocess.DEVNULL)
        return {row["detection"]: row["id"] for row in csv.DictReader(table.read_text().splitlines())
                if row["fate"] == "found"}


def main(dmise, run):
    run = pathlib.Path(run)
    object_of = objects_of(dmise, run)
    seen = collections.Counter(object_of.values())
    taken, confirmed = collections.defaultdict(set), set()
    for state in lines_of(run / "tracks.jsonl"):
        taken[state["id"]].update(state["associated"])
        if state["status"] == "confirmed":
            confirmed.add(state["id"])
    pure = total = noise = 0
    tracked = {}
    for track in sorted(confirmed):
        count = collections.Counter(object_of.get(name) for name in taken[track])
        owner, most = count.most_common(1)[0]
        total += sum(count.values())
        if owner is None:
            noise += 1
            continue
        pure += most
        tracked[track] = owner
    wanted = {name for name, times in seen.items() if times >= LEAST_DETECTIONS}
    complete = len(wanted & set(tracked.values()))
    print(f"tracks {len(confirmed)}, of noise {noise}; purity {pure / total:.4f} of {total} detections; "
          f"completeness {complete} of {len(wanted)}")
    found = collections.defaultdict(set)  # frames of a telescope with an object
    for name, thing in object_of.items():
        sensor, frame, _ = name.rsplit("/", 2)
        found[sensor, thing].add(int(frame))
    frames = collections.defaultdict(list)
    for report in lines_of(run / "frames.jsonl"):
        frames[report["sensor"]].append(report["frame"])
    met = cues = 0
    for task in lines_of(run / "tasks.jsonl"):
        if task["track"] not in tracked:
            continue
        first = sorted(f for f in frames[task["sensor"]] if f >= task["first_frame"])[:2]
        cues += 1
        met += any(f in found[task["sensor"], tracked[task["track"]]] for f in first)
    print(f"cues {cues}, met within two exposures {met}: {met / cues:.3f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
