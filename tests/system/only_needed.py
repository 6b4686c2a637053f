"""What each node of a launched run takes in and loads: a sensor in space no weather of a site, one without shapes no
renderer; run.json has topics, memory and start-up time of every node.

    only_needed.py DMISE
"""

import json
import pathlib

from harness import Run, check, main, wait_until, write_scenario

SPACE = """\
  - {name: orbiter, platform: carrier, camera: small.yaml, pointing: {ra_deg: 85.2, dec_deg: 0.7}, exposure_s: 2,
     cadence_s: 5, sky: space}
"""
CARRIER = """\
  - name: carrier
    motion:
      two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}
"""


def loaded(pid):
    """Shared objects of a process."""
    lines = pathlib.Path(f"/proc/{pid}/maps").read_text().splitlines()
    return {pathlib.Path(line.split()[-1]).name for line in lines if ".so" in line}


def test(binary, directory):
    path = write_scenario(directory, duration_s=100)
    text = path.read_text().replace("objects: [{catalogue: demo}]\n",
                                    "objects:\n  - {catalogue: demo}\n" + CARRIER)
    path.write_text(text.replace("network:", SPACE + "network:", 1))
    out = directory / "out"
    with Run(binary, "launch", path, "--out", out) as run:
        wait_until(lambda: (out / "orbiter/frames.jsonl").exists() or (out / "orbiter/frame-000001.fits").exists(),
                   "a frame of orbiter")
        pid = run.node("orbiter")
        libraries = loaded(pid) if pid else set()
        check(pid and not any("render" in name or "EGL" in name or "GL." in name for name in libraries),
              "a sensor without shapes loads no renderer")
        check(run.process.wait() == 0, "the run ends with 0")
    nodes = {node["name"]: node for node in json.loads((out / "run.json").read_text())["nodes"]}
    common = ["state/roster", "env/common"]
    check(nodes["orbiter"]["topics"] == common, "a sensor in space subscribes to no topic of a site")
    for name in ("alpha", "beta"):
        check(nodes[name]["topics"] == [*common, f"env/site/{name}"], f"{name} subscribes to the topics it needs alone")
    for name, node in nodes.items():
        check(node["peak_resident_bytes"] >= node["private_bytes"] > 1e6, f"{name}: its memory is in run.json")
        if name != "broker":
            check(0 < node["start_s"] < 120, f"{name}: its start-up time is in run.json")


main(test)
