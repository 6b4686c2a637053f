"""Labelled frames for training: those that `dmise dataset` made, and the same ones made in memory.

    for sample in dmise.datasets.open_dataset("out/dataset"):
        print(sample.key, sample.image.shape, len(sample.objects))
    for sample in dmise.datasets.stream("dataset.yaml", range(1, 501)):
        ...

`FrameDataset` is a map-style Dataset of PyTorch, `FrameStream` an IterableDataset; neither needs torch to be imported.
"""
from __future__ import annotations

import bisect
import dataclasses
import hashlib
import io
import itertools
import json
import os
import pathlib
import re
import tarfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy

from .late_imports import importing
from .records import ArrayLike
from .scenario_text import Scenario

if TYPE_CHECKING:
    from .frame_stream import FrameStream as FrameStream

_MEMBERS = {"image.npy", "mask.npy", "labels.json"}  # every frame has these; docs/datasets.md has what else there may be


def mask_of(segmentation: dict[str, Any]) -> ArrayLike:
    """A mask, rows x columns bool, of COCO's compressed run lengths: {"size": [rows, columns], "counts": text}."""
    runs: list[int] = []
    value = shift = 0
    for code in segmentation["counts"].encode():
        bits = code - 48
        value |= (bits & 0x1f) << shift
        shift += 5
        if not bits & 0x20:
            if bits & 0x10:
                value -= 1 << shift
            runs.append(value + (runs[-2] if len(runs) > 2 else 0))
            value = shift = 0
    rows, columns = segmentation["size"]
    flat = numpy.repeat(numpy.arange(len(runs)) % 2 == 1, runs)
    return flat.reshape(columns, rows).T


@dataclasses.dataclass(frozen=True)
class Sample:
    """One frame: counts and object numbers, rows x columns uint16, and its labels as docs/datasets.md has them."""

    key: str
    image: ArrayLike
    mask: ArrayLike
    labels: dict[str, Any]

    @property
    def objects(self) -> list[dict[str, Any]]:
        """The objects with light in the frame; the k-th has the number k + 1 in `mask`."""
        return list(self.labels["objects"])

    def masks(self) -> list[ArrayLike]:
        """A mask for each object, rows x columns bool; they may overlap."""
        return [mask_of(found["segmentation"]) for found in self.objects]


def _frames_of(shard: Any) -> int:
    """How many frames an archive has, by the manifest. Raises ValueError for an entry that is none of `dmise dataset`."""
    name, frames = shard["name"], shard["frames"]
    if not (isinstance(name, str) and re.fullmatch(r"dataset-\d{6,}\.tar", name) and type(frames) is int and frames >= 0):
        raise ValueError(f"no archive: {str(shard)[:80]}")
    return frames


class Dataset:
    """The frames of a data set, by number; may be passed to other processes."""

    def __init__(self, directory: str | pathlib.Path, storage_options: Mapping[str, Any] | None = None) -> None:
        self.directory = directory if "://" in str(directory) else pathlib.Path(directory)
        self._url = os.fspath(directory).rstrip("/")
        self._options = storage_options
        path = self._path("dataset.json")
        try:
            with self._open("dataset.json") as file:
                self.info: dict[str, Any] = json.loads(file.read())
            self._ends = list(itertools.accumulate(map(_frames_of, self.info["shards"])))
        except OSError as error:
            raise FileNotFoundError(f"{path}: {error.strerror or 'cannot be read'}; is this the directory of a complete data set?") from None
        except (ValueError, TypeError, KeyError) as error:
            raise ValueError(f"{path}: not the manifest of a data set: {error}") from None
        self._members: dict[int, list[dict[str, tuple[int, int]]]] = {}

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0

    def __iter__(self) -> Iterator[Sample]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, index: int) -> Sample:
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        index %= len(self)
        shard = bisect.bisect_right(self._ends, index)
        members = self._members_of(shard)[index - (self._ends[shard - 1] if shard else 0)]
        with self._open(self._name(shard)) as file:
            def content(ending: str) -> bytes:
                offset, size = members[ending]
                file.seek(offset)
                return bytes(file.read(size))

            labels = json.loads(content("labels.json"))
            return Sample(labels["key"], numpy.load(io.BytesIO(content("image.npy"))),
                          numpy.load(io.BytesIO(content("mask.npy"))), labels)

    def verify(self) -> None:
        """Raises ValueError for a file that is not what the manifest says."""
        for entry in [*self.info["shards"], self.info["coco"]]:
            sha = hashlib.sha256()
            with self._open(entry["name"]) as file:
                while piece := file.read(1 << 20):
                    sha.update(piece)
            if sha.hexdigest() != entry["sha256"]:
                raise ValueError(f"{self._path(entry['name'])}: its SHA-256 is not that of dataset.json")

    def _path(self, name: str) -> str:
        return str(self.directory / name) if isinstance(self.directory, pathlib.Path) else f"{self._url}/{name}"

    def _open(self, name: str) -> Any:
        """A file of the data set, of bytes."""
        if isinstance(self.directory, pathlib.Path):
            return open(self.directory / name, "rb")
        with importing:
            from .shard_store import file_system

        files, root = file_system(self._url, self._options)  # one for each process, of fsspec's own cache
        return files.open(f"{root}/{name}", "rb")

    def _name(self, shard: int) -> str:
        return str(self.info["shards"][shard]["name"])

    def _members_of(self, shard: int) -> list[dict[str, tuple[int, int]]]:
        """Places in the archive of each frame's files, by ending."""
        if shard not in self._members:
            name = self._name(shard)
            frames: dict[str, dict[str, tuple[int, int]]] = {}
            try:
                with self._open(name) as file, tarfile.open(fileobj=file, mode="r:") as archive:
                    for member in archive:
                        key, _, ending = member.name.partition(".")
                        frames.setdefault(key, {})[ending] = (member.offset_data, member.size)
            except tarfile.TarError as error:
                raise ValueError(f"{self._path(name)}: not an archive of a data set: {error}") from None
            if len(frames) != self.info["shards"][shard]["frames"] or not all(_MEMBERS <= frame.keys() for frame in frames.values()):
                raise ValueError(f"{self._path(name)}: does not have the frames of dataset.json")
            self._members[shard] = list(frames.values())
        return self._members[shard]


def open_dataset(directory: str | pathlib.Path, storage_options: Mapping[str, Any] | None = None) -> Dataset:
    """The data set in a directory, or at a URL of fsspec: "s3://bucket/prefix". `storage_options` are those of its file
    system. Raises FileNotFoundError for one that is not complete, ValueError, also when a frame is read, for a damaged one."""
    return Dataset(directory, storage_options)


def write_shards(scenario: Scenario, seeds: range, url: str, *, per_shard: int = 100, shard: str = "1/1", workers: int | None = None,
                 storage_options: Mapping[str, Any] | None = None) -> bool:
    """Makes the data set of `dmise dataset` at a URL of fsspec: "s3://bucket/prefix", "gs://..", a directory.

    per_shard, shard, workers   as of the command; tasks with shards 1/n .. n/n may run on n machines at the same time
    storage_options             of the file system: {"endpoint_url": ..}

    Of this machine's disk it takes one archive. The same call continues after an interruption, at the archive that was being
    made; one with more seeds adds them. Returns whether the data set is complete. Raises `ScenarioError` for a scenario that is
    not valid and for a URL that has another data set, ImportError if the file system's package is missing.
    """
    with importing:
        from .shard_store import write

    return write(scenario, seeds, url, per_shard, shard, workers, storage_options)


def image_and_mask(sample: Sample) -> tuple[ArrayLike, ArrayLike]:
    """Types that PyTorch has: 1 x rows x columns float32, rows x columns int64."""
    return sample.image[None].astype("float32"), sample.mask.astype("int64")


class FrameDataset:
    """A map-style Dataset of PyTorch; `transform(sample)` makes of a `Sample` what a model takes."""

    def __init__(self, directory: str | pathlib.Path, transform: Callable[[Sample], Any] | None = None,
                 storage_options: Mapping[str, Any] | None = None) -> None:
        self.samples = open_dataset(directory, storage_options)
        self.transform = transform or image_and_mask

    def __len__(self) -> int:
        return len(self.samples)

    def __getitem__(self, index: int) -> Any:
        return self.transform(self.samples[index])


def map_seed(scenario: Scenario, seed: int) -> list[Sample]:
    """The samples that `dmise dataset` makes of a scenario for a seed: frames by sensor and number.

    It depends on its arguments alone, so other processes and machines may each call it for seeds of their own, by name:
    `pool.imap(functools.partial(map_seed, "dataset.yaml"), range(1, 501))`. What the scenario names is read once in a
    process. Raises `ScenarioError` as `Simulation`.
    """
    with importing:
        from .sample_makers import samples_of

    return [Sample(key, image, mask, json.loads(labels)) for key, image, mask, labels in samples_of(scenario, seed)]


def stream(scenario: Scenario, seeds: Iterable[int]) -> Iterator[Sample]:
    """The samples of seeds, one seed after the other, each made when it is asked for. No file is written."""
    for seed in seeds:
        yield from map_seed(scenario, seed)


def __getattr__(name: str) -> Any:
    """`FrameStream` looks for torch, which takes seconds to import, when it is used."""
    if name != "FrameStream":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    with importing:
        from .frame_stream import FrameStream

    globals()[name] = FrameStream
    return FrameStream
