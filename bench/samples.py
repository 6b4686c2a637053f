"""Samples a second in memory, by two processes that map over seeds, beside those of `dmise dataset` with two workers.

    python3 bench/samples.py [NUMBER]      of a build in build/release and build/python; by default 200 samples, three times

Where torch is installed, also those of a DataLoader with two workers, whose time includes their start.
"""
import functools
import multiprocessing
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "build/python"))
from dmise.datasets import FrameStream, map_seed  # noqa: E402

try:
    from torch.utils.data import DataLoader
except ImportError:
    DataLoader = None

SCENARIO, WORKERS = ROOT / "launch/scenarios/dataset.yaml", 2


def children_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measured(make, number):
    """Samples a second of wall clock, and processor seconds."""
    begin, before_s = time.monotonic(), children_s()
    make(number)
    return number / (time.monotonic() - begin), children_s() - before_s


def written(number):
    with tempfile.TemporaryDirectory() as directory:
        subprocess.run([ROOT / "build/release/bin/dmise", "dataset", SCENARIO, "--seeds", f"1..{number}", "--workers", str(WORKERS),
                        "--out", directory], check=True, capture_output=True)


def size_of(seed):
    return [sample.image.nbytes for sample in map_seed(SCENARIO, seed)]


def mapped(number, work=functools.partial(map_seed, SCENARIO)):
    with multiprocessing.get_context("spawn").Pool(WORKERS) as pool:
        if sum(1 for _ in pool.imap(work, range(1, number + 1), chunksize=4)) != number:
            raise SystemExit("samples are missing")
        pool.close()
        pool.join()


def loaded(number):
    """Batches of images and masks, as a training takes them."""
    loader = DataLoader(FrameStream(SCENARIO, range(1, number + 1)), batch_size=8, num_workers=WORKERS)
    if sum(len(images) for images, _ in loader) != number:
        raise SystemExit("samples are missing")


def main():
    ways = [("dmise dataset", written), ("map_seed, samples sent back", mapped),
            ("map_seed, samples used where they are made", functools.partial(mapped, work=size_of))]
    if DataLoader:
        ways.append(("FrameStream under torch's DataLoader", loaded))
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    for _ in range(3):
        for name, make in ways:
            rate, used_s = measured(make, number)
            print(f"{name:45} {rate:7.1f} samples/s {number / used_s:7.1f} samples a processor second", flush=True)


if __name__ == "__main__":
    main()
