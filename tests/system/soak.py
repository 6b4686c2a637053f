"""Memory over many ticks: a network of small nodes runs on, and no process may grow after its first tenth.

    soak.py DMISE [--ticks N] [--window W] [--most FRACTION] [--json FILE]

Memory is the resident set, sampled as ticks go by; its growth is the median over the last tenth of the ticks
against that over the second tenth.
"""

import argparse
import collections
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from harness import tell_figures

NODES = ("orbit", "a", "b", "recorder")
SAMPLES = 200
MOST_GROWTH = 0.01
STANDSTILL_S = 120.0  # without a tick: it hangs


def memory_kib(pid):
    """(resident, anonymous) memory of a process; None when it has ended."""
    try:
        lines = pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()[1:]
    except OSError:
        return None
    value = {line.split(":")[0]: int(line.split()[1]) for line in lines}
    return (value["Rss"], value["Anonymous"]) if value else None


def last_step(path):
    """The last tick whose step has begun, of a node's output."""
    with open(path, "rb") as file:
        file.seek(max(0, path.stat().st_size - 200))
        lines = file.read().split(b"\n")
    steps = [line for line in lines[:-1] if line.startswith(b"step ")]
    return int(steps[-1][5:]) if steps else -1


def run(binary, directory, ticks, window):
    """Samples of each process, (tick, resident, anonymous), while a network makes `ticks`; and seconds taken."""
    bin_ = binary.parent
    announced, steps = directory / "address", directory / "steps"
    quiet = dict(stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    with open(directory / "log", "w") as log:
        processes = {"time-master": subprocess.Popen(
            [bin_ / "dmise-time-master", "--expect", ",".join(NODES), "--ticks", str(ticks), "--window", str(window),
             "--announce", announced, "--silent-after", "60"], stderr=log, **quiet)}
        try:
            while not announced.exists():
                time.sleep(0.01)
            master = ["--master", announced.read_text().strip()]
            processes["broker"] = subprocess.Popen([bin_ / "dmise-broker", *master], stderr=log, **quiet)
            for name in NODES:
                role = "camera" if name in ("a", "b") else name
                with open(steps if name == "recorder" else "/dev/null", "w") as out:
                    processes[name] = subprocess.Popen(
                        [bin_ / "toy-node", "--role", role, "--name", name, *master],
                        stdin=subprocess.DEVNULL, stdout=out, stderr=log)
            return watch(processes, steps, ticks)
        finally:
            for process in processes.values():
                process.kill()
                process.wait()


def watch(processes, steps, ticks):
    samples = collections.defaultdict(list)
    began = moved = time.monotonic()
    seen, next_sample = -1, 0
    while processes["time-master"].poll() is None:
        tick = last_step(steps)
        if tick > seen:
            seen, moved = tick, time.monotonic()
        elif time.monotonic() - moved > STANDSTILL_S:
            sys.exit(f"FAIL: nothing has moved since tick {seen}")
        if tick >= next_sample:
            next_sample = tick + ticks / SAMPLES
            for name, process in processes.items():
                if memory := memory_kib(process.pid):
                    samples[name].append((tick, *memory))
        time.sleep(0.02)
    if processes["time-master"].returncode != 0:
        sys.exit(f"FAIL: the run ended with code {processes['time-master'].returncode}")
    return samples, time.monotonic() - began


def growth(samples, ticks, column):
    early = [s[column] for s in samples if 0.1 * ticks <= s[0] < 0.2 * ticks]
    late = [s[column] for s in samples if s[0] >= 0.9 * ticks]
    if not early or not late:
        return None
    return statistics.median(early), statistics.median(late)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise")
    parser.add_argument("--ticks", type=int, default=20000)
    parser.add_argument("--window", type=int, default=1, help="ticks that nodes may be apart; 1: lock-step")
    parser.add_argument("--most", type=float, default=MOST_GROWTH, help="growth that is borne; short runs are still warming up")
    parser.add_argument("--json", help="append a line of figures to this file")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="dmise-soak-") as directory:
        samples, wall_s = run(pathlib.Path(options.dmise).resolve(), pathlib.Path(directory), options.ticks, options.window)
    figures = {"name": "soak_growth_worst", "value": 0.0, "unit": "of resident memory", "target": options.most,
               "met": True, "ticks": options.ticks, "window": options.window, "wall_s": round(wall_s, 1), "ticks_per_s": round(options.ticks / wall_s)}
    for name, of_process in samples.items():
        resident, anonymous = growth(of_process, options.ticks, 1), growth(of_process, options.ticks, 2)
        if resident is None:
            sys.exit(f"FAIL: {name}: too few samples: {len(of_process)}")
        grown = resident[1] / resident[0] - 1.0
        print(f"{name}: {resident[0]:.0f} -> {resident[1]:.0f} KiB ({100 * grown:+.2f} %), "
              f"of it on the heap {anonymous[0]:.0f} -> {anonymous[1]:.0f} KiB, {len(of_process)} samples")
        figures["value"] = max(figures["value"], round(grown, 5))
        figures[name] = [resident[0], resident[1]]
    figures["met"] = figures["value"] <= options.most
    tell_figures(figures, options.json)
    return 0 if figures["met"] else 1


if __name__ == "__main__":
    sys.exit(main())
