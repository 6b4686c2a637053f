"""Data sets written to S3, and read there: the archives, labels and manifest of `dmise dataset` on a disk. The store is moto's server.

    shard_store.py DMISE
"""
import logging
import multiprocessing
import pathlib
import pickle
import subprocess
import sys
import tempfile
import unittest.mock

import package

package.require("numpy", "moto.server", "s3fs")
import numpy as np  # noqa: E402
import s3fs  # noqa: E402
from moto.server import ThreadedMotoServer  # noqa: E402

import dmise  # noqa: E402
from dmise.datasets import open_dataset, write_shards  # noqa: E402
from dmise.shard_store import file_system  # noqa: E402
from package import DMISE  # noqa: E402
from scenarios import DRAWN_HEAD, drawn_sensor  # noqa: E402

SCENARIO = DRAWN_HEAD + drawn_sensor("watcher", 48, 32)


def expect(dataset, key):
    """A process that ends with 0 if the first sample has the key."""
    sys.exit(dataset[0].key != key)


class ShardStore(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        logging.getLogger("werkzeug").setLevel(logging.ERROR)
        cls.server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
        cls.server.start()
        host, port = cls.server.get_host_and_port()
        cls.options = {"endpoint_url": f"http://{host}:{port}", "key": "test", "secret": "test"}
        cls.store = s3fs.S3FileSystem(**cls.options)
        cls.store.mkdir("images")
        cls.directory = tempfile.TemporaryDirectory(prefix="dmise-test-")
        base = pathlib.Path(cls.directory.name)
        cls.path = base / "dataset.yaml"
        cls.path.write_text(SCENARIO)
        cls.local = base / "out"
        subprocess.run([DMISE, "dataset", cls.path, "--seeds", "5..10", "--per-shard", "2", "--out", cls.local], check=True,
                       capture_output=True)

    @classmethod
    def tearDownClass(cls):
        cls.server.stop()
        cls.directory.cleanup()

    def write(self, prefix, seeds=range(5, 11), per_shard=2, scenario=None, **more):
        return write_shards(scenario or self.path, seeds, f"s3://images/{prefix}", per_shard=per_shard, workers=1,
                            storage_options=self.options, **more)

    def assert_those_of_the_command(self, prefix):
        self.store.invalidate_cache()
        there = {path.removeprefix(f"images/{prefix}/"): self.store.cat_file(path) for path in self.store.find(f"images/{prefix}")}
        here = {path.name: path.read_bytes() for path in self.local.iterdir() if path.name != ".dataset-lock"}
        self.assertEqual(sorted(there), sorted(here))
        self.assertEqual([name for name in here if here[name] != there[name]], [])

    def test_seeds_are_added_and_read(self):
        """Five seeds, of which the last archive is not full, then six: the bytes of six at once."""
        self.assertTrue(self.write("grown", range(5, 10)))
        self.assertTrue(self.write("grown", range(10, 11)))
        self.assert_those_of_the_command("grown")
        self.assertTrue(self.write("grown"), "it is complete: nothing is done")
        found = pickle.loads(pickle.dumps(open_dataset("s3://images/grown", self.options)))
        found.verify()
        for ours, theirs in zip(found, open_dataset(self.local), strict=True):
            self.assertEqual((ours.key, ours.labels), (theirs.key, theirs.labels))
            np.testing.assert_array_equal(ours.image, theirs.image)
            np.testing.assert_array_equal(ours.mask, theirs.mask)

    def test_a_forked_process_reads(self):
        """As the workers of a DataLoader, after the process that they come from has read."""
        self.assertTrue(self.write("forked", range(5, 7)))
        found = open_dataset("s3://images/forked", self.options)
        process = multiprocessing.get_context("fork").Process(target=expect, args=(found, found[0].key))
        process.start()
        process.join(60.0)
        self.assertEqual(process.exitcode, 0)

    def test_what_another_task_has_removed_meanwhile(self):
        """A listing that has a part which is no longer there is read again."""
        self.assertTrue(self.write("ended", range(5, 7)))
        files, root = file_system("s3://images/ended", self.options)
        find, listings = files.find, []

        def find_once_more(path, **options):
            found = find(path, **options)
            listings.append(found)
            return found if len(listings) > 1 else found | {f"{root}/parts/dataset-000000.json": {"size": 1}}

        with unittest.mock.patch.object(files, "find", find_once_more):
            self.assertTrue(self.write("ended", range(5, 7)))
        self.assertEqual(len(listings), 2)

    def test_tasks_share_archives_and_continue(self):
        """The second of two tasks, then the first, which found an archive whose record was not yet written."""
        self.assertFalse(self.write("shared", shard="2/2"))
        with self.assertRaises(FileNotFoundError):
            open_dataset("s3://images/shared", self.options)
        self.store.pipe_file("images/shared/dataset-000000.tar", b"cut short")
        kept = self.store.info("images/shared/dataset-000001.tar")["LastModified"]
        self.assertTrue(self.write("shared", shard="1/2"))
        self.assert_those_of_the_command("shared")
        self.assertEqual(self.store.info("images/shared/dataset-000001.tar")["LastModified"], kept)

    def test_bad_input_is_one_line(self):
        self.assertFalse(self.write("begun", shard="1/3"))
        other = SCENARIO.replace("full_well_e: 60000", "full_well_e: 61000")
        for more, kind, reason in (
                ({"scenario": other}, dmise.ScenarioError, "^s3://images/begun: contains another data set$"),
                ({"per_shard": 3}, dmise.ScenarioError, "^--per-shard: s3://images/begun has 2 seeds in an archive, got 3$"),
                ({"seeds": range(20, 30)}, dmise.ScenarioError, "^--seeds: s3://images/begun has seeds 5..10, unfinished"),
                ({"seeds": range(5, 5)}, ValueError, "^seeds: "), ({"seeds": [5, 6]}, ValueError, "^seeds: "),
                ({"per_shard": 0}, ValueError, "^per_shard: "), ({"shard": "3/2"}, ValueError, "^shard: .* got 3/2$"),
                ({"scenario": SCENARIO.replace("[25, 40]", "[25, 400]")}, dmise.ScenarioError, "^scenario:.*latitude_deg")):
            with self.assertRaisesRegex(kind, reason):
                self.write("begun", **more)


if __name__ == "__main__":
    package.main()
