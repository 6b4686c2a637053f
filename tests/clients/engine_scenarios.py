"""Scenarios as files, text and mappings, as YAML, and what is said of those that are not valid.

    engine_scenarios.py [DMISE [TEST..]]
"""
import json
import pathlib
import subprocess

import package

package.require("numpy", "yaml", "dmise.engine")
import numpy as np  # noqa: E402
import yaml  # noqa: E402

import dmise  # noqa: E402
from package import DMISE  # noqa: E402
from scenarios import NIGHT, NightRun  # noqa: E402


class Scenarios(NightRun):
    def test_scenarios_as_path_text_and_mapping_are_the_same(self):
        mapping = yaml.safe_load(NIGHT)
        mapping["sensors"][0]["exposure_s"] = np.float32(8.0)
        reference = next(dmise.Simulation(self.path).frames("west"))
        for scenario in (str(self.path), NIGHT, mapping):
            np.testing.assert_array_equal(next(dmise.Simulation(scenario).frames("west")).counts, reference.counts)

    def test_a_scenario_as_yaml_is_the_same(self):
        """Read by PyYAML, and by the engine."""
        mapping = yaml.safe_load(NIGHT)
        mapping["sensors"][0] |= {"exposure_s": np.float64(8.0), "name": "on"}
        text = dmise.to_yaml(mapping)
        self.assertEqual(yaml.safe_load(text), json.loads(dmise.Simulation(mapping).yaml))
        self.assertEqual(dmise.Simulation(text).digest, dmise.Simulation(mapping).digest)
        self.assertEqual(dmise.Simulation(self.path).yaml, NIGHT)
        for value in (1e-7, 1.5e20, "", "a: b", "#", "- x", "ü", "no", "No", "ON", "1", None, True, [], {}, [[1, {"a": []}], []],
                      "a\nb", "'"):
            self.assertEqual(yaml.safe_load(dmise.to_yaml({"k": value, "l": [{"m": value}]})), {"k": value, "l": [{"m": value}]})
        for wrong, error in (("text\n", TypeError), ({"a": float("nan")}, dmise.ScenarioError), ({"a": {1}}, dmise.ScenarioError)):
            with self.assertRaises(error):
                dmise.to_yaml(wrong)

    def test_errors_are_those_of_the_command_line(self):
        path = self.path.with_name("bad.yaml")
        path.write_text(NIGHT.replace("exposure_s: 8", "exposure_s: -8"))
        line = subprocess.run([DMISE, "run", path], capture_output=True, text=True).stderr.strip()
        with self.assertRaises(dmise.ScenarioError) as caught:
            dmise.Simulation(path)
        self.assertEqual(f"dmise: {caught.exception}", line)
        error = caught.exception
        self.assertEqual((error.file, error.line, error.key), (str(path), 13, "sensors[0].exposure_s"))
        for scenario, reason in ((NIGHT.replace("exposure_s", "exposur_s"), "did you mean exposure_s"), ("{\n", "scenario:"),
                                 ({}, "simulation"), ({"simulation": {"start": float("inf")}}, "simulation.start: must be finite"),
                                 ({"simulation": {"start": object()}}, "got object"), ("/nonexistent/night.yaml", "nonexistent"),
                                 (NIGHT.replace("GOES 13", "GOES 99"), "GOES 99"), ("\n" * 10, "mapping"),
                                 (NIGHT + "#\ud800\n", "UTF-8"), ("a\0.yaml", "NUL")):
            with self.assertRaisesRegex(dmise.ScenarioError, reason):
                next(dmise.Simulation(scenario).frames("west"))
        for argument in (5, None, [1]):
            with self.assertRaises(TypeError):
                dmise.Simulation(argument)
        with self.assertRaisesRegex(dmise.ScenarioError, "no sensor is named wst.*west"):
            dmise.Simulation(NIGHT).frames("wst")
        for seed in (-1, 2**63):
            with self.assertRaisesRegex(dmise.ScenarioError, "seed"):
                dmise.Simulation(NIGHT, seed=seed)
        with self.assertRaises(dmise.InputError):
            dmise.Simulation(NIGHT).frames("west", threads=0)

    def test_a_catalogue_that_changes_is_read_anew(self):
        def frame_of(stars):
            text = "ra_deg,dec_deg,mag_v\n" + "".join(f"{ra:.4f},{dec:.4f},5\n" for ra, dec in stars)
            path.write_text(text)
            sim = dmise.Simulation(NIGHT.replace("kstars", str(path)).replace("duration_s: 30", "duration_s: 10"))
            return sim.digest, next(sim.frames("west")).counts.astype(float).max()

        path = pathlib.Path(self.directory.name) / "stars.csv"
        report = next(dmise.Simulation(NIGHT).frames("west")).report
        middle = np.degrees([report.boresight_ra_rad, report.boresight_dec_rad])
        middle[0] %= 360.0
        in_frame, out_of_it = frame_of([middle]), frame_of([((middle[0] + 90.0) % 360.0, middle[1])])
        self.assertNotEqual(in_frame[0], out_of_it[0])
        self.assertGreater(in_frame[1], 10 * out_of_it[1])
        self.assertEqual(frame_of([middle]), in_frame)


if __name__ == "__main__":
    package.main()
