#!/usr/bin/env python3
"""The JSON Schema that `dmise schema` prints says what the readers take: by python3-jsonschema every shipped file is valid, and
what `dmise check` refuses for a key, a type or a range, the schema refuses too, at the same place.

    schema.py DMISE
"""
import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
BASE = """
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 30, tick_s: 5}
sensors:
  - name: watcher
    site: {latitude_deg: 33.8, longitude_deg: -84.4, height_m: 300}
    camera:
      optics: {columns: 64, rows: 64, pixel_pitch_m: 9.0e-6, focal_length_m: 0.2, aperture_m: 0.1}
      detector: {quantum_efficiency: 0.6, read_noise_e: 5, full_well_e: 60000, gain_e_per_dn: 1}
      band: bessell-V
    pointing: {azimuth_deg: 180, elevation_deg: 60}
    exposure_s: 1
    cadence_s: 10
output: {fits: on}
"""
CAMERA = "sensors.0.camera."
GOOD = [("simulation.seed", 7), ("simulation.interpolation", "5"), ("output.fits", {"compression": "rice"}),
        ("sensors.0.effects", {"airglow": "off", "stars": "v9"}), ("sensors.0.sky", 20.5), ("sensors.0.sky", "urban"),
        ("sensors.0.first_exposure_s", 3), ("accuracy", "draft"), ("accuracy", {"position_px": 0.1}),
        ("network", {"real_time": 2}), ("output.star_truth", "on"), ("sensors.0.pointing", "zenith"),
        ("sensors.0.pointing", {"azimuth_deg": 180, "elevation_deg": 60, "cued": "off"}),
        ("sensors.0.weather", {"pressure_hpa": 960, "clouds": {"cover": 0.3}}),
        (CAMERA + "optics.psf", "diffraction"), (CAMERA + "detector.quantum_efficiency", 1)]
BAD = [("sensors", []), ("simulation.sed", 7), ("simulation.seed", -1), ("simulation.seed", 1.5), ("simulation.seed", 2**63),
       ("simulation.tick_s", 0), ("simulation.tick_s", "fast"), ("simulation.interpolation", "4"), ("simulation.start", None),
       ("sensors.0.exposure_s", -1), ("sensors.0.exposure_s", [1]), ("sensors.0.name", None), ("sensors.0.mask_deg", 90),
       ("sensors.0.site.latitude_deg", 91), ("sensors.0.site.colour", "red"), ("sensors.0.sky", "bright"),
       ("sensors.0.effects", {"airglo": "off"}), ("sensors.0.effects", {"airglow": "dim"}),
       ("sensors.0.pointing", {"azimuth_deg": 0, "elevation_deg": 99}), ("sensors.0.pointing", "down"),
       ("sensors.0.weather", {"clouds": {"cover": 2}}), (CAMERA + "optics.columns", 0),
       (CAMERA + "optics.columns", 64.5), (CAMERA + "optics.projection", "mercator"),
       (CAMERA + "optics.aperture_m", 0), (CAMERA + "detector.read_noise_e", -1),
       (CAMERA + "detector.quantum_efficiency", 0), (CAMERA + "detector.adc_bits", 99),
       ("output.png", "perhaps"), ("output.planes", ["light"]), ("output.preview_width_px", 1), ("accuracy", "best"),
       ("accuracy", {"position_px": -1}), ("network.window_ticks", 0), ("fusion", {"gate_d2": 0}), ("sensors", "none")]


class Loader(yaml.SafeLoader):
    """YAML 1.2, by which editors read: `on` is a text, 1e-6 a number, a time a text."""


Loader.yaml_implicit_resolvers = {}
for tag, pattern, first in (
        ("bool", r"^(?:true|True|TRUE|false|False|FALSE)$", "tTfF"),
        ("int", r"^[-+]?[0-9]+$", "-+0123456789"),
        ("float", r"^[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?$", "-+.0123456789"),
        ("null", r"^(?:~|null|Null|NULL|)$", ["~", "n", "N", ""])):
    Loader.add_implicit_resolver("tag:yaml.org,2002:" + tag, re.compile(pattern), list(first))


def with_text_keys(tree):
    """Keys of JSON are texts."""
    if isinstance(tree, dict):
        return {str(key): with_text_keys(value) for key, value in tree.items()}
    return [with_text_keys(item) for item in tree] if isinstance(tree, list) else tree


def read(text):
    return with_text_keys(yaml.load(text, Loader))


def changed(tree, path, value):
    """A copy with `value` at a dotted path; None removes what is there."""
    tree = copy.deepcopy(tree)
    *way, last = [int(word) if word.isdigit() else word for word in path.split(".")]
    at = tree
    for word in way:
        at = at[word] if isinstance(at, list) else at.setdefault(word, {})
    if value is None:
        del at[last]
    else:
        at[last] = value
    return tree


class Keys:
    """Which keys of a schema a file has, as (section, key)."""

    def __init__(self, schema):
        self.sections = schema["definitions"]
        self.used = set()

    def see(self, tree, section):
        at = self.sections[section]
        for key, value in tree.items():
            self.used.add((section, key))
            self.see_value(value, at["properties"].get(key) or next(iter(at.get("patternProperties", {}).values())))

    def see_value(self, value, form):
        if "anyOf" in form:
            for one in form["anyOf"]:
                self.see_value(value, one)
        elif isinstance(value, list) and form.get("type") == "array":
            for item in value:
                self.see_value(item, form["items"])
        elif isinstance(value, dict) and "$ref" in form:
            section = form["$ref"].rpartition("/")[2]
            if "patternProperties" in self.sections[section] or value.keys() <= self.sections[section]["properties"].keys():
                self.see(value, section)

    def missing(self):
        return [f"{name}.{key}" for name, section in self.sections.items() for key in section["properties"]
                if (name, key) not in self.used and name != "effects"]  # by EffectList.EachCanBeSwitchedByItsName


class Referee:
    def __init__(self, binary):
        self.binary = binary
        self.failures = 0
        self.validators = {}
        self.schemas = {}
        for kind in ("scenario", "dataset", "camera", "site", "materials"):
            schema = json.loads(subprocess.run([binary, "schema", kind], capture_output=True, check=True).stdout)
            jsonschema.Draft7Validator.check_schema(schema)
            self.schemas[kind] = schema
            self.validators[kind] = jsonschema.Draft7Validator(schema)

    def check(self, holds, what):
        if not holds:
            print("FAILED:", what)
            self.failures += 1

    def refused(self, kind, tree):
        """Why a tree is not valid; empty if it is."""
        error = jsonschema.exceptions.best_match(self.validators[kind].iter_errors(tree))
        return f"{'.'.join(map(str, error.absolute_path))}: {error.message[:200]}" if error else ""

    def shipped(self):
        count = 0
        for kind, pattern in (("scenario", "launch/scenarios/**/*.yaml"), ("scenario", "tests/**/*.yaml"),
                              ("camera", "launch/cameras/*.yaml"), ("site", "launch/sites/*.yaml"),
                              ("materials", "launch/materials/*.yaml")):
            for path in sorted(ROOT.glob(pattern)):
                tree = read(path.read_text())
                if kind == "scenario" and "simulation" not in tree:
                    continue  # a file of a container stack
                count += 1
                draws = path.name == "dataset.yaml"
                why = self.refused("dataset" if draws else kind, tree)
                self.check(not why, f"{path.relative_to(ROOT)}: {why}")
                if kind == "scenario" and not draws:
                    self.check(not self.refused("dataset", tree), f"{path.relative_to(ROOT)} is one for dmise dataset, too")
                if draws:
                    self.check(self.refused("scenario", tree), f"{path.name}: a scenario that is drawn is none to run")
        print(f"{count} shipped files are valid")

    def every_key(self):
        """Scenarios that have every key of the schema are ones that the readers take."""
        keys = Keys(self.schemas["scenario"])
        for path in sorted((pathlib.Path(__file__).parent / "every_key").glob("*.yaml")):
            tree = read(path.read_text())
            why = self.refused("scenario", tree)
            with tempfile.TemporaryDirectory() as made:  # keygen reads a scenario and does not compute what its sensors see
                done = subprocess.run([self.binary, "keygen", f"{made}/keys", "--scenario", path], capture_output=True,
                                      text=True, check=False)
            self.check(not why and done.returncode == 0, f"{path.name}: schema: {why}; readers: {done.stderr.strip()[:300]}")
            keys.see(tree, "scenario")
        self.check(not keys.missing(), f"every_key lacks keys that a table states: {' '.join(keys.missing())}")
        print(f"{len(keys.used)} keys are read by those who state them")

    def by_both(self, path, value, good):
        """The schema and `dmise check` agree about a change of the scenario."""
        tree = changed(read(BASE), path, value)
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            yaml.safe_dump(tree, file, default_flow_style=True)
            file.flush()
            done = subprocess.run([self.binary, "check", file.name], capture_output=True, text=True, check=False)
        why = self.refused("scenario", tree)
        what = f"{path}: {value}: schema: {why or 'valid'}; dmise check: {done.returncode} {done.stderr.strip()[:200]}"
        self.check(done.returncode == (0 if good else 2) and bool(why) != good, what)


def main():
    referee = Referee(sys.argv[1])
    referee.shipped()
    referee.every_key()
    for path, value in GOOD:
        referee.by_both(path, value, good=True)
    for path, value in BAD:
        referee.by_both(path, value, good=False)
    print(f"{len(GOOD)} good and {len(BAD)} bad changes of a scenario: "
          + ("schema and readers agree" if not referee.failures else f"{referee.failures} failures"))
    return 1 if referee.failures else 0


if __name__ == "__main__":
    sys.exit(main())
