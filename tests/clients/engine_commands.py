"""Commands as functions return what the commands print.

    engine_commands.py [DMISE [TEST..]]
"""
import json
import os
import pathlib
import subprocess
import tempfile

import package

package.require("numpy", "dmise.engine")
import dmise  # noqa: E402
from package import DMISE  # noqa: E402
from scenarios import NIGHT, NightRun  # noqa: E402


class Commands(NightRun):
    def test_check_is_the_commands(self):
        text = subprocess.run([DMISE, "check", self.path, "--json"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(dmise.check(self.path), json.loads(text))
        self.assertEqual(dmise.check(NIGHT), {**json.loads(text), "scenario": "scenario"})
        with self.assertRaisesRegex(dmise.ScenarioError, "^scenario:2:16: simulation.start: is missing"):
            dmise.check({"simulation": {}})
        with self.assertRaisesRegex(dmise.ScenarioError, "--help: No such file"):
            dmise.check("--help")

    def test_survey_is_the_command(self):
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            text = subprocess.run([DMISE, "survey", self.path, "--json", "--out", directory, "--shells", "600,900"],
                                  check=True, capture_output=True, text=True).stdout
        self.assertEqual(dmise.survey(self.path, shells=[600, 900]), json.loads(text))
        self.assertEqual(dmise.survey(NIGHT, shells=[600, 900]), {**json.loads(text), "scenario": "scenario"})

    def test_tradeoff_is_the_command(self):
        small = NIGHT.replace("columns: 160, rows: 120", "columns: 48, rows: 32").replace(
            "catalogue: demo", "catalogue: demo, only: [GOES 13, GOES 14]")
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            found = dmise.tradeoff(small, repeats=1, sensor="east", out=directory)
            written = json.loads((pathlib.Path(directory) / "tradeoff.json").read_text())
        self.assertEqual(found, written)
        self.assertEqual(found["digest"], dmise.Simulation(small).digest)
        self.assertTrue({("sky", "off"), ("budget", "draft")} <= {(row["effect"], row["level"]) for row in found["rows"]})

    def test_visible_and_score_are_the_commands(self):
        before = sorted(os.listdir())
        passes = dmise.visible(self.path)
        self.assertEqual(sorted(os.listdir()), before, "nothing is left in the directory that one is in")
        self.assertTrue(passes and all("sensor" in one for one in passes))
        self.assertIn("sensors", dmise.score(self.run_directory))


if __name__ == "__main__":
    package.main()
