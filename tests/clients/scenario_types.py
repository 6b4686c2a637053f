"""Scenarios as typed mappings: the module is what the program's schema says, and mypy finds what is wrong in a scenario.

    scenario_types.py DMISE
"""
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DMISE = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build/release/bin/dmise"
PACKAGE = ROOT / "clients/python"
if importlib.util.find_spec("mypy") is None:
    print("skipped: mypy is not installed (./dmise setup --tests)")
    sys.exit(77)

WRONG = {  # what replaces what in the example, and what mypy says of it
    '"exposure_s": exposure_s': ('"exposur_s": exposure_s', 'Extra key "exposur_s"'),
    '"tracking": "fixed"': ('"tracking": "fixd"', 'TypedDict item "pointing"'),
    '"columns": 512': ('"columns": "512"', 'expression has type "str"'),
    '"cadence_s": 10,': ("", 'Missing key "cadence_s"'),
}


def mypy(*files):
    """What mypy --strict prints of programs."""
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir=/dev/null",
                           "--follow-imports=silent", *map(str, files)],
                          capture_output=True, text=True, cwd=PACKAGE / "src")
    return done.stdout


class Types(unittest.TestCase):
    def test_the_module_is_what_the_schema_says(self):
        made = subprocess.run([sys.executable, PACKAGE / "scenario_types.py", DMISE], check=True, capture_output=True, text=True)
        self.assertEqual((PACKAGE / "src/dmise/scenario.py").read_text(), made.stdout, "write it anew: clients/python/scenario_types.py")

    def test_mypy_takes_the_example_and_finds_mistakes(self):
        example = PACKAGE / "examples/typed_scenario.py"
        with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
            files = {}
            for i, (right, (wrong, reason)) in enumerate(WRONG.items()):
                self.assertIn(right, example.read_text())
                files[pathlib.Path(directory) / f"wrong_{i}.py"] = reason
                (pathlib.Path(directory) / f"wrong_{i}.py").write_text(example.read_text().replace(right, wrong))
            said = mypy(example, *files)
        self.assertNotIn(f"{example.name}:", said)
        for path, reason in files.items():
            self.assertTrue(any(path.name in line and reason in line for line in said.splitlines()), f"{reason}: {said}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
