#!/usr/bin/env python3
"""Labelled samples made by the workers of Ray Data: samples_ray.py SCENARIO FIRST LAST. Ray uses the cluster at RAY_ADDRESS, else this
machine. The scenario's path is one that every worker sees."""
import json
import sys

import ray

from dmise.datasets import map_seed


def samples(scenario, seeds):
    """A Dataset of Ray: a row for each frame, made when it is read."""
    def rows(item):
        return [{"key": made.key, "image": made.image, "mask": made.mask, "labels": json.dumps(made.labels)}
                for made in map_seed(scenario, item["seed"])]

    return ray.data.from_items([{"seed": seed} for seed in seeds]).flat_map(rows)


if __name__ == "__main__":
    scenario, first, last = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    for batch in samples(scenario, range(first, last + 1)).iter_batches(batch_size=8):
        print(batch["image"].shape, batch["key"][0], "to", batch["key"][-1])  # a step of a training
