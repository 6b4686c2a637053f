#!/usr/bin/env python3
"""Labelled samples made by the workers of Dask: samples_dask.py SCENARIO FIRST LAST. Dask uses the cluster at DASK_SCHEDULER_ADDRESS,
else this machine. The scenario's path is one that every worker sees."""
import functools
import sys

from distributed import Client, as_completed

from dmise.datasets import map_seed


def samples(client, scenario, seeds):
    """The samples in the order in which workers end."""
    made = client.map(functools.partial(map_seed, scenario), seeds, pure=False)
    for future, found in as_completed(made, with_results=True):
        yield from found
        future.release()


if __name__ == "__main__":
    scenario, first, last = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    with Client() as client:
        for sample in samples(client, scenario, range(first, last + 1)):
            print(sample.key, len(sample.objects), "objects")  # a step of a training
