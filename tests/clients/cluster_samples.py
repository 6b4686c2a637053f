"""The examples that make samples on clusters, each on two local workers: the samples of `dmise dataset`.

    cluster_samples.py DMISE dask|ray|slurm
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import package
from package import DMISE, PACKAGE, ROOT

KIND = sys.argv[2]
MODULE, HOW = {"dask": ("distributed", "./dmise setup --tests"), "ray": ("ray.data", "python -m pip install 'ray[data]'"),
               "slurm": ("dmise.datasets", "")}[KIND]
package.require("numpy", "dmise.engine")
package.require(MODULE, how=HOW)
import numpy as np  # noqa: E402

from dmise.datasets import open_dataset  # noqa: E402

EXAMPLES = ROOT / "clients/python/examples"
sys.path.insert(0, str(EXAMPLES))
os.environ["PYTHONPATH"] = PACKAGE  # workers find the package there
SEEDS = range(1, 7)


def by_dask(path, _):
    import distributed
    from samples_dask import samples

    with distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        return {made.key: (made.image, made.mask, made.labels) for made in samples(client, str(path), SEEDS)}


def by_ray(path, _):
    import ray
    from samples_ray import samples

    ray.init(address="local", num_cpus=2, include_dashboard=False)
    try:
        return {row["key"]: (row["image"], row["mask"], json.loads(row["labels"])) for row in samples(str(path), SEEDS).iter_rows()}
    finally:
        ray.shutdown()


def by_slurm(path, out):
    """What each task keeps of its samples."""
    found = {}
    for task in (4, 3):
        environment = {"SLURM_ARRAY_TASK_ID": str(task), "SLURM_ARRAY_TASK_MIN": "3", "SLURM_ARRAY_TASK_COUNT": "2"}
        subprocess.run([sys.executable, EXAMPLES / "samples_slurm.py", path, str(SEEDS[0]), str(SEEDS[-1]), out], check=True,
                       env={**os.environ, **environment})
        found.update(json.loads((out / f"brightest-{task - 3}.json").read_text()))
    return found


class ClusterSamples(unittest.TestCase):
    def test_they_are_those_of_the_command(self):
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            base = pathlib.Path(directory)
            scenario = (ROOT / "launch/scenarios/dataset.yaml").read_text()
            small = scenario.replace("columns: 512", "columns: 96").replace("rows: 512", "rows: 64")
            self.assertNotEqual(small, scenario)
            path = base / "dataset.yaml"
            path.write_text(small)
            subprocess.run([DMISE, "dataset", path, "--seeds", f"{SEEDS[0]}..{SEEDS[-1]}", "--out", base / "out"], check=True,
                           capture_output=True)
            written = {sample.key: sample for sample in open_dataset(base / "out")}
            made = {"dask": by_dask, "ray": by_ray, "slurm": by_slurm}[KIND](path, base / "found")
        self.assertEqual(sorted(made), sorted(written))
        for key, theirs in written.items():
            if KIND == "slurm":
                snr = max((found["snr"] for found in theirs.objects), default=0.0)
                self.assertEqual(made[key], [snr, int(theirs.image.max())])
                continue
            image, mask, labels = made[key]
            self.assertEqual((image.dtype, labels), (theirs.image.dtype, theirs.labels))
            np.testing.assert_array_equal(image, theirs.image)
            np.testing.assert_array_equal(mask, theirs.mask)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
