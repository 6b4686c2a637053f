"""The demonstration leaves what it promises, within 60 s.

    demo_products.py RUN
"""

import json
import pathlib
import sys

LONGEST_S = 60.0


def problems(run):
    record = json.loads((run / "run.json").read_text())
    if record["status"] != "complete":
        yield f"run.json says {record['status']}"
    if record["wall_s"] > LONGEST_S:
        yield f"the run took {record['wall_s']:.1f} s (<= {LONGEST_S:g})"
    for name in ("index.html", "detections.jsonl", "truth.jsonl", "frames.jsonl"):
        if not (run / name).stat().st_size:
            yield f"{name} is empty"
    reports = [json.loads(line) for line in (run / "frames.jsonl").read_text().splitlines()]
    sensors = [sensor["name"] for sensor in record["scenario"]["sensors"]]
    if len(sensors) != 4:
        yield f"{len(sensors)} sensors, not 4"
    for sensor in sensors:
        frames = sorted((run / sensor).glob("frame-*.fits"))
        if not frames or len(frames) != sum(r["sensor"] == sensor for r in reports):
            yield f"{sensor}: {len(frames)} frames, another number of frame reports"
        for frame in frames:
            for ending in (".png", "-marked.png"):
                if not frame.with_name(frame.stem + ending).exists():
                    yield f"{frame}: no picture *{ending}"
    truths = [json.loads(line) for line in (run / "truth.jsonl").read_text().splitlines()]
    if not any(t["in_frame"] for t in truths):
        yield "no object is in any frame"
    if not (run / "detections.jsonl").read_text().strip():
        yield "nothing was detected"


if __name__ == "__main__":
    found = list(problems(pathlib.Path(sys.argv[1])))
    sys.exit("\n".join(f"FAIL: {p}" for p in found) if found else 0)
