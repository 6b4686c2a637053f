"""What notebooks show of frames, tables and runs, and bars of progress.

    engine_display.py [DMISE [TEST..]]
"""
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest.mock
import xml.etree.ElementTree

import package

package.require("numpy", "dmise.engine")
import dmise  # noqa: E402
from package import DMISE  # noqa: E402
from scenarios import NIGHT, NightRun  # noqa: E402


class Display(NightRun):
    def test_a_picture_is_that_of_a_run(self):
        """One that writes pictures."""
        frame = next(dmise.Simulation(self.path, seed=3).frames("west"))
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            pictured = pathlib.Path(directory) / "night.yaml"
            pictured.write_text(NIGHT.replace("png: off", "png: on"))
            subprocess.run([DMISE, "run", pictured, "--out", f"{directory}/run", "--seed", "3"], check=True, capture_output=True)
            self.assertEqual(frame.to_png(), (pathlib.Path(directory) / "run/west/frame-000001.png").read_bytes())
        self.assertEqual(frame._repr_png_(), frame.to_png())

    def test_notebooks_show_tables_and_runs(self):
        frame = next(dmise.Simulation(self.path, seed=3).frames("west"))
        shown = xml.etree.ElementTree.fromstring(f"<body>{frame.detections._repr_html_()}</body>")
        head = [cell.text for cell in shown.iter("th")]
        self.assertEqual(head, list(frame.detections.dtype.names))
        row = [cell.text for cell in shown.find(".//tbody/tr")]
        self.assertEqual(row[head.index("sensor")], "west")
        self.assertAlmostEqual(float(row[head.index("x_px")]), frame.detections["x_px"][0], places=3)
        self.assertIn(f"{len(frame.detections)} rows", shown.find("p").text)
        self.assertIn("0 rows", frame.detections[:0]._repr_html_())
        rows = [[cell.text for cell in line] for line in
                xml.etree.ElementTree.fromstring(f"<body>{self.run_._repr_html_()}</body>").iter("tr")]
        for sensor in ("west", "east"):
            counts = [str(sum(record.sensor == sensor for record in records))
                      for records in (self.run_.frames, self.run_.truth, self.run_.detections)]
            self.assertIn([sensor, *counts], rows)

    def test_texts_in_a_page_are_escaped(self):
        link = self.run_directory.with_name("a<b>&c")
        link.symlink_to(self.run_directory)
        self.assertIn("a&lt;b&gt;&amp;c", dmise.open_run(link)._repr_html_())

    def test_progress_counts_frames(self):
        bars = []

        class Bar:
            def __init__(self, total, unit):
                bars.append([total, 0, False])

            def __enter__(self):
                return self

            def __exit__(self, *error):
                bars[-1][2] = True

            def update(self):
                bars[-1][1] += 1

        with unittest.mock.patch.dict(sys.modules, {"tqdm": types.ModuleType("tqdm"), "tqdm.auto": types.SimpleNamespace(tqdm=Bar)}):
            simulation = dmise.Simulation(NIGHT)
            self.assertEqual([f.number for f in simulation.frames("west", progress=True)], [1, 2, 3])
            next(simulation.frames(progress=True))
        self.assertEqual(bars, [[3, 3, True], [6, 1, True]])
        with unittest.mock.patch.dict(sys.modules, {"tqdm": None, "tqdm.auto": None}), self.assertRaisesRegex(ImportError, "tqdm"):
            dmise.Simulation(NIGHT).frames(progress=True)


if __name__ == "__main__":
    package.main()
