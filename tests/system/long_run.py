"""Memory of a real run over many frames, and of the time-master whose observers come and go: nobody keeps what is over.

    long_run.py [DMISE] [--hours H] [--observers N] [--most KIB] [--json FILE]

`--most`: growth of the heap of a process that is borne, after the first third of the run, and from a third of the observers on.
"""

import argparse
import collections
import pathlib
import statistics
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "build/python"))
import dmise  # noqa: E402
from harness import Failure, Run, command_of, tell_figures, wait_until  # noqa: E402
from schedules import BUILT  # noqa: E402
from soak import memory_kib  # noqa: E402

TICK_S = 5
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: {tick_s}, seed: 1}}
objects: [{{catalogue: demo}}]
stars: {{catalogue: kstars}}
sensors:
  - {{name: alpha, site: atlanta, camera: tiny.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark}}
  - {{name: beta, site: savannah, camera: tiny.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark}}
network: {{real_time: {real_time}}}
output: {{png: false, fits: false}}
"""
CAMERA = """\
name: tiny
optics: {projection: gnomonic, columns: 32, rows: 32, pixel_pitch_m: 86.4e-6, field_of_view_deg: 15, aperture_m: 0.02}
detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
"""


def title(pid):
    command = command_of(pid)
    name = pathlib.Path(command[0]).name if command else "?"
    at = command.index("--name") + 1 if "--name" in command else None
    return command[at] if at else name


def launched(binary, directory, hours, real_time=0):
    (directory / "tiny.yaml").write_text(CAMERA)
    (directory / "scenario.yaml").write_text(
        SCENARIO.format(duration_s=int(hours * 3600), tick_s=TICK_S, real_time=real_time))
    return Run(binary, "launch", directory / "scenario.yaml", "--out", directory / "out")


def over_frames(binary, directory, hours):
    """Samples of (frames, KiB of heap) by process."""
    lines = directory / "out/alpha/frames.jsonl"
    frames, samples = int(hours * 3600 / TICK_S), collections.defaultdict(list)
    with launched(binary, directory, hours) as run:
        wait_until(lambda: lines.exists() or run.process.poll() is not None, "a first frame")
        pids, next_frame, made, place = None, 0, 0, 0
        while run.process.poll() is None:
            with open(lines, "rb") as file:
                file.seek(place)
                more = file.read()
            place, made = place + len(more), made + more.count(b"\n")
            if made >= next_frame:
                pids = pids or {title(pid): pid for pid in run.living() if pid != run.process.pid}
                next_frame = made + frames / 100
                for name, pid in pids.items():
                    if memory := memory_kib(pid):
                        samples[name].append((made, memory[1]))
            time.sleep(0.05)
        code, _ = run.finish()
        if code != 0:
            raise Failure(f"the run ends with {code}: {run.stderr[-300:]}")
    return samples, frames


def over_observers(binary, directory, observers):
    """Samples of (observers that have come and gone, KiB of heap) of the time-master."""
    samples = []
    with launched(binary, directory, 24, real_time=60) as run:
        announced = directory / "out/logs/master.address"
        wait_until(lambda: list((directory / "out").glob("*/frames.jsonl")), "a first frame")
        address, clock = announced.read_text().strip(), run.node("time-master")
        for number in range(observers + 1):
            if number % max(1, observers // 30) == 0:
                time.sleep(0.2)
                samples.append((number, memory_kib(clock)[1]))
            dmise.subscribe(address, "detection/").close()
        run.interrupt()
        run.finish()
    return samples


def growth_of(samples, end):
    early = [kib for at, kib in samples if end / 3 <= at < end / 2]
    late = [kib for at, kib in samples if at >= 0.85 * end]
    return statistics.median(early), statistics.median(late)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise", nargs="?", default=BUILT)
    parser.add_argument("--hours", type=float, default=8)
    parser.add_argument("--observers", type=int, default=300)
    parser.add_argument("--most", type=float, default=512, help="KiB")
    parser.add_argument("--json", help="append a line of figures to this file")
    options = parser.parse_args()
    binary = pathlib.Path(options.dmise).resolve()
    figures = {"name": "long_run_growth", "unit": "KiB", "target": options.most, "hours": options.hours}
    grown = {}
    with tempfile.TemporaryDirectory(prefix="dmise-long-run-") as name:
        if options.hours:
            samples, frames = over_frames(binary, pathlib.Path(name), options.hours)
            grown = {process: growth_of(of_process, frames) for process, of_process in samples.items()}
    with tempfile.TemporaryDirectory(prefix="dmise-long-run-") as name:
        if options.observers:
            grown["time-master after observers"] = growth_of(
                over_observers(binary, pathlib.Path(name), options.observers), options.observers)
    for process, (early, late) in grown.items():
        print(f"{process}: {early:.0f} -> {late:.0f} KiB of heap ({late - early:+.0f})")
        figures[process] = [early, late]
    figures["value"] = max(late - early for early, late in grown.values())
    figures["met"] = figures["value"] <= options.most
    tell_figures(figures, options.json)
    return 0 if figures["met"] else 1


if __name__ == "__main__":
    sys.exit(main())
