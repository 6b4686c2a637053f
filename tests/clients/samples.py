"""Samples in memory: those of `dmise dataset`, in any process, and each seed by one worker.

    samples.py DMISE
"""
import functools
import json
import multiprocessing
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import tempfile
import threading
import types
import unittest

import package

package.require("numpy", "dmise.engine")
import numpy as np  # noqa: E402

import dmise  # noqa: E402
from dmise.datasets import FrameStream, map_seed, open_dataset, stream  # noqa: E402
from package import DMISE  # noqa: E402
from scenarios import DRAWN_HEAD, drawn_sensor, sensor  # noqa: E402

COLUMNS, ROWS = 96, 64
SCENARIO = "stars: {catalogue: kstars}\n" + DRAWN_HEAD + drawn_sensor("west", COLUMNS, ROWS) + drawn_sensor("east", COLUMNS, ROWS)
SEEDS = range(5, 11)


def key_of(sample):
    return sample.key


def as_bytes(sample):
    return sample.key, sample.image.tobytes(), sample.image.dtype, sample.mask.tobytes(), sample.labels


class Samples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory(prefix="dmise-test-")
        base = pathlib.Path(cls.directory.name)
        cls.path = base / "dataset.yaml"
        cls.path.write_text(SCENARIO)
        cls.out = base / "out"
        subprocess.run([DMISE, "dataset", cls.path, "--seeds", "5..10", "--out", cls.out], check=True, capture_output=True)
        cls.written = list(open_dataset(cls.out))

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def test_they_are_those_of_the_command(self):
        """Images, masks and labels with the digest of the data set, of four frames of two sensors for each seed."""
        made = list(stream(self.path, SEEDS))
        self.assertEqual(len(made), 24)
        for ours, theirs in zip(made, self.written, strict=True):
            self.assertEqual(as_bytes(ours), as_bytes(theirs))
            for mine, other in zip(ours.masks(), theirs.masks(), strict=True):
                np.testing.assert_array_equal(mine, other)
        self.assertGreater(sum(len(sample.objects) for sample in made), 0)

    def test_other_processes_map_over_seeds(self):
        for method in ("spawn", "fork"):
            with multiprocessing.get_context(method).Pool(2) as pool:
                made = [sample for each in pool.imap(functools.partial(map_seed, self.path), SEEDS) for sample in each]
            self.assertEqual(list(map(as_bytes, made)), list(map(as_bytes, self.written)), method)

    def test_a_process_that_is_forked_while_a_sample_is_made(self):
        """It makes its own: the thread that makes the other is not in it."""
        ended = threading.Event()

        def make():
            while not ended.is_set():
                map_seed(self.path, 5)

        thread = threading.Thread(target=make)
        thread.start()
        try:
            context = multiprocessing.get_context("fork")
            for _ in range(5):
                process = context.Process(target=map_seed, args=(self.path, 6))
                process.start()
                process.join(60.0)
                code = process.exitcode
                process.kill()
                process.join()
                self.assertEqual(code, 0)
        finally:
            ended.set()
            thread.join()

    def test_scenarios_may_be_text(self):
        """The digest is of the text; images are the same."""
        ours, theirs = map_seed(SCENARIO, 7), map_seed(self.path, 7)
        self.assertEqual([as_bytes(sample) for sample in ours], [as_bytes(sample) for sample in theirs])
        mapping = {"simulation": {"start": {"one_of": ["2018-01-21T03:00:00Z"]}, "duration_s": 1, "tick_s": 1}}
        with self.assertRaisesRegex(dmise.ScenarioError, "sensors"):
            map_seed(mapping, 1)

    def test_the_number_of_objects_is_drawn(self):
        """A choice among lists, one of which is empty: images with none, one and two."""
        def night(objects, pointing):
            return ("simulation: {start: 2018-01-21T03:00:00Z, duration_s: 20, tick_s: 10}\n"
                    f"objects: {objects}\nsensors:\n{sensor('west', pointing, columns=COLUMNS, rows=ROWS)}")

        alone = "{catalogue: demo, only: [GOES 13], radius_m: 3}"
        report = next(dmise.Simulation(night(f"[{alone}]", "{target: GOES 13, tracking: fixed}")).frames()).report
        there = f"{{ra_deg: {np.degrees(report.boresight_ra_rad)}, dec_deg: {np.degrees(report.boresight_dec_rad)}, tracking: fixed}}"
        twin = "{name: twin, radius_m: 3, motion: {fixed: {gcrs_m: [-4e7, 1e7, 0]}}}"
        drawn = night(f"{{one_of: [[], [{alone}], [{alone}, {twin}]]}}", there)
        made = [sample for sample in stream(drawn, range(1, 13)) if sample.labels["frame"] == 1]
        self.assertEqual({int(sample.labels["drawn"]["objects.one_of"]) for sample in made}, {0, 1, 2})
        for sample in made:
            names = [found["name"] for found in sample.objects]
            self.assertEqual(names, [] if sample.labels["drawn"]["objects.one_of"] == 0 else ["GOES 13"])
            self.assertEqual(bool(sample.mask.any()), bool(names))

    def test_a_scenario_that_changes_is_read_again(self):
        """Also one that keeps its size and time."""
        path = self.path.with_name("changing.yaml")
        path.write_text(SCENARIO)
        before = map_seed(path, 5)[0]
        facts = path.stat()
        path.write_text(SCENARIO.replace("full_well_e: 60000", "full_well_e: 61000"))
        os.utime(path, ns=(facts.st_atime_ns, facts.st_mtime_ns))
        self.assertEqual(path.stat().st_size, facts.st_size)
        self.assertNotEqual(map_seed(path, 5)[0].labels["digest"], before.labels["digest"])

    def test_workers_share_the_seeds(self):
        """PyTorch tells a worker its number and how many there are; a stub does in its place."""
        module = sys.modules[FrameStream.__module__]
        usual = module.get_worker_info
        streams = [pickle.loads(pickle.dumps(FrameStream(self.path, range(1, 12), worker=rank, workers=2))) for rank in range(2)]
        self.assertEqual([list(each.own_seeds()) for each in streams], [[1, 3, 5, 7, 9, 11], [2, 4, 6, 8, 10]])
        try:
            found = []
            for rank in range(2):
                for k in range(3):
                    module.get_worker_info = lambda k=k: types.SimpleNamespace(id=k, num_workers=3)
                    found.append(list(streams[rank].own_seeds()))
        finally:
            module.get_worker_info = usual
        self.assertEqual(sorted(seed for seeds in found for seed in seeds), list(range(1, 12)))
        self.assertLessEqual(max(map(len, found)) - min(map(len, found)), 1)

    def test_streams_give_what_a_model_takes(self):
        image, mask = next(iter(FrameStream(self.path, [6])))
        self.assertEqual((image.dtype, image.shape, mask.dtype, mask.shape), (np.float32, (1, ROWS, COLUMNS), np.int64, (ROWS, COLUMNS)))
        keys = list(FrameStream(self.path, SEEDS, transform=key_of, worker=1, workers=3))
        self.assertEqual(keys, [sample.key for sample in self.written if sample.labels["seed"] in (6, 9)])

    def test_bad_input_is_one_line(self):
        for scenario, seed, reason in (
                (SCENARIO.replace("uniform: [25, 40]", "uniform: [25, 100]"), 1, r"^scenario:.*latitude_deg.*the most of its uniform"),
                (SCENARIO.replace("uniform: [25, 40]", "unifrm: [25, 40]"), 1, "did you mean uniform"),
                (SCENARIO.replace("fits: off", "planes: [noise]"), 1, "output.planes"), ("/nonexistent.yaml", 1, "nonexistent"),
                (self.path, -1, "seed: must be in 0..999999999, got -1"), (self.path, 10**9, "seed: must be in")):
            with self.assertRaisesRegex(dmise.ScenarioError, reason):
                map_seed(scenario, seed)
        with self.assertRaises(TypeError):
            map_seed(self.path, 1.5)
        for worker, workers in ((2, 2), (-1, 2), (0, 0)):
            with self.assertRaisesRegex(ValueError, "worker"):
                FrameStream(self.path, SEEDS, worker=worker, workers=workers)

    def test_damaged_data_sets(self):
        """By a manifest that is none, and archives that are not as it says."""
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            copy = shutil.copytree(self.out, pathlib.Path(directory) / "copy")
            manifest, archive = copy / "dataset.json", copy / "dataset-000000.tar"
            info, content = json.loads(manifest.read_text()), archive.read_bytes()

            def expect_refused(shard, reason):
                manifest.write_text(json.dumps(info | {"shards": [info["shards"][0] | shard]}))
                with self.assertRaisesRegex(ValueError, reason):
                    open_dataset(copy)[0]

            for shard in ({"frames": "24"}, {"frames": -1}, {"frames": 1e30}, {"name": "../dataset-000000.tar"}, {"name": 5}):
                expect_refused(shard, "dataset.json: not the manifest of a data set: no archive: ")
            expect_refused({"frames": 25}, "dataset-000000.tar: does not have the frames of dataset.json")
            for damaged in (content[:900], bytes(len(content)), b"", b"x" * 10240):
                archive.write_bytes(damaged)
                expect_refused({}, "dataset-000000.tar: (does not have|not an archive)")

    def test_pytorch_reads_a_stream(self):
        try:
            from torch.utils.data import DataLoader
        except ImportError:
            self.skipTest("torch is not installed")
        stream_of_keys = FrameStream(self.path, SEEDS, transform=key_of)
        for workers in (0, 2, 4):
            loader = DataLoader(stream_of_keys, batch_size=None, num_workers=workers)
            self.assertEqual(sorted(loader), [sample.key for sample in self.written])


if __name__ == "__main__":
    package.main()
