"""Data sets in a store of fsspec, such as S3: `dmise dataset` makes one archive at a time here, and it is sent there."""
from __future__ import annotations

import json
import os
import pathlib
import re
import tempfile
from collections.abc import Iterator, Mapping
from typing import Any

from .commands import file_of, run_command
from .errors import EngineError, ScenarioError
from .scenario_text import Scenario

_MANIFEST, _PLAN = "dataset.json", "parts/plan.json"
# In the order in which they are sent: a part's .json tells that its archive is there, the manifest that all is.
_SENT = tuple(re.compile(pattern) for pattern in (
    r"parts/plan\.json", r"dataset-\d{6,}\.tar", r"parts/dataset-\d{6,}\.coco", r"parts/dataset-\d{6,}\.json", r"scenario\.yaml",
    r"coco\.json", r"dataset\.json"))
_Version = tuple[int, int, int]
MAX_ROUNDS = 5  # readings of a store that other tasks change


def file_system(url: str, options: Mapping[str, Any] | None) -> tuple[Any, str]:
    """The file system of a URL, and the path in it. Raises ImportError, which names the package that is missing."""
    try:
        from fsspec.core import url_to_fs
    except ImportError:
        raise ImportError(f"{url}: needs fsspec, which is not installed") from None
    found, path = url_to_fs(url, **(options or {}))
    return found, str(path).rstrip("/")


class _Mirror:
    """The files of a data set in a local directory and in a store. Archives have no content here, only their size."""

    def __init__(self, local: pathlib.Path, url: str, options: Mapping[str, Any] | None) -> None:
        self.local, self.url = local, url
        self.files, self.root = file_system(url, options)
        self._sent: dict[str, _Version] = {}
        (local / "parts").mkdir()

    def fetch(self) -> None:
        """Brings what is in the store and not here, or not in this size."""
        for _ in range(MAX_ROUNDS):
            try:
                return self._fetch_listed()
            except FileNotFoundError:
                pass  # another task has removed parts, for all is done
        raise EngineError(f"{self.url}: its files change while they are read")

    def _fetch_listed(self) -> None:
        self.files.invalidate_cache()
        for path, facts in sorted(self.files.find(self.root, detail=True).items()):
            name = path[len(self.root) + 1:]
            known = name in self._sent and self._sent[name][2] == facts["size"]
            if known or not any(pattern.fullmatch(name) for pattern in _SENT):
                continue
            if name.endswith(".tar"):
                self._make_hollow(name, facts["size"])
            else:
                self.files.get_file(path, str(self.local / name))
            self._sent[name] = self._version(name)

    def send(self) -> None:
        """Stores what is new here, and removes there what is gone here."""
        self.files.makedirs(f"{self.root}/parts", exist_ok=True)
        self._require_plan()
        if not (self.local / _MANIFEST).exists():
            self._remove(_MANIFEST)  # it told of fewer seeds: the set is no longer complete
        for name in self._names():
            if self._sent.get(name) != self._version(name):
                self.files.put_file(str(self.local / name), f"{self.root}/{name}")
                if name.endswith(".tar"):
                    self._make_hollow(name, (self.local / name).stat().st_size)
                self._sent[name] = self._version(name)
        for name in sorted(set(self._sent) - set(self._names())):
            self._remove(name)

    def is_complete(self) -> bool:
        return (self.local / _MANIFEST).exists()

    def seeds(self) -> range | None:
        """Those of the data set that is there, complete or begun."""
        for name in (_MANIFEST, _PLAN):
            if (self.local / name).exists():
                try:
                    first, last = json.loads((self.local / name).read_text(encoding="utf-8"))["seeds"]
                    return range(first, last + 1)
                except (ValueError, TypeError, KeyError) as error:
                    raise ValueError(f"{self.url}/{name}: not of a data set: {error}") from None
        return None

    def _require_plan(self) -> None:
        """Raises ScenarioError if another task has begun another data set there since `fetch`."""
        if _PLAN in self._sent or not (self.local / _PLAN).exists() or not self.files.exists(f"{self.root}/{_PLAN}"):
            return
        if self.files.cat_file(f"{self.root}/{_PLAN}") != (self.local / _PLAN).read_bytes():
            raise ScenarioError(f"{self.url}: contains another data set")

    def _names(self) -> Iterator[str]:
        there = sorted(str(path.relative_to(self.local)) for path in self.local.rglob("*") if path.is_file())
        return (name for pattern in _SENT for name in there if pattern.fullmatch(name))

    def _version(self, name: str) -> _Version:
        facts = (self.local / name).stat()
        return facts.st_ino, facts.st_mtime_ns, facts.st_size

    def _make_hollow(self, name: str, size: int) -> None:
        with open(self.local / name, "wb") as file:
            os.truncate(file.fileno(), size)

    def _remove(self, name: str) -> None:
        if self._sent.pop(name, None):
            try:
                self.files.rm_file(f"{self.root}/{name}")
            except FileNotFoundError:
                pass  # another task has removed it


def _task(shard: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,9})/(\d{1,9})", shard)
    if not found or not 1 <= int(found[1]) <= int(found[2]):
        raise ValueError(f"shard: must be i/n with i from 1 to n, got {shard}")
    return int(found[1]), int(found[2])


def write(scenario: Scenario, seeds: range, url: str, per_shard: int, shard: str, workers: int | None,
          options: Mapping[str, Any] | None) -> bool:
    """As `dmise.datasets.write_shards` says."""
    if not isinstance(seeds, range) or seeds.step != 1 or not seeds:
        raise ValueError(f"seeds: must be a range of one or more in steps of 1, got {seeds}")
    if not os.fspath(url):
        raise ValueError("url: is empty")
    if per_shard < 1:
        raise ValueError(f"per_shard: must be from 1, got {per_shard}")
    task, tasks = _task(shard)
    with tempfile.TemporaryDirectory(prefix="dmise-shards-") as directory, file_of(scenario) as path:
        mirror = _Mirror(pathlib.Path(directory), url, options)
        mirror.fetch()
        there = mirror.seeds() or seeds
        archives = -(-(max(there.stop, seeds.stop) - min(there.start, seeds.start)) // per_shard)

        def run(part: str, **more: Any) -> None:
            try:
                run_command("dataset", [path], {"seeds": f"{seeds.start}..{seeds.stop - 1}", "per_shard": per_shard,
                                                "out": directory, "shard": part, "workers": workers, **more})
            except (ScenarioError, EngineError) as error:
                raise type(error)(str(error).replace(directory, url).partition("; --force")[0]) from None

        run(shard, check=True)
        for archive in range(task, archives + 1, tasks):
            run(f"{archive}/{archives}")
            mirror.send()
            if mirror.is_complete():
                return True
        if task <= archives:
            mirror.fetch()  # what other tasks have made meanwhile
            run(f"{task}/{archives}")
            mirror.send()
        return mirror.is_complete()
