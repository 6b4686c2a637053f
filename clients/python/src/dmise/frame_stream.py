"""Samples made in the workers that train: an IterableDataset of PyTorch, where that is installed."""
from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from .datasets import Sample, image_and_mask, map_seed
from .scenario_text import Scenario

try:
    from torch.utils.data import IterableDataset, get_worker_info
except ImportError:
    IterableDataset = object

    def get_worker_info() -> Any:
        """None: this is the only process."""
        return None


class FrameStream(IterableDataset):  # type: ignore[misc]
    """The samples of seeds, each made when it is asked for: every worker of a DataLoader makes a part of them.

    scenario    as of `map_seed`
    seeds       a sequence: range(1, 501)
    transform   makes of a `Sample` what a model takes; by default (image, mask) as of `FrameDataset`
    worker      of `workers` processes that each have a FrameStream, from 0: the rank of a training on several machines

    The k-th of n workers makes every n-th seed from the k-th on, so all together make each once.
    """

    def __init__(self, scenario: Scenario, seeds: Iterable[int], transform: Callable[[Sample], Any] | None = None,
                 worker: int = 0, workers: int = 1) -> None:
        super().__init__()
        self.scenario, self.seeds = scenario, seeds if isinstance(seeds, range) else tuple(seeds)
        self.transform = transform or image_and_mask
        self.worker, self.workers = operator.index(worker), operator.index(workers)
        if not 0 <= self.worker < self.workers:
            raise ValueError(f"worker: must be in 0..workers - 1, got {worker} of {workers}")

    def own_seeds(self) -> Iterable[int]:
        """The seeds that this worker makes."""
        worker, workers = self.worker, self.workers
        if (info := get_worker_info()) is not None:  # this is a worker of a DataLoader
            worker, workers = worker * info.num_workers + info.id, workers * info.num_workers
        return self.seeds[worker::workers]

    def __iter__(self) -> Iterator[Any]:
        for seed in self.own_seeds():
            for sample in map_seed(self.scenario, seed):
                yield self.transform(sample)
