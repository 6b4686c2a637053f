"""`dmise check` lists the effects of every sensor with their parameters: as text in the order of the scenario, and as
JSON. The reference is the scenario: what it switches and sets.

    check_effects.py DMISE
"""

import json
import re
import subprocess

from harness import check, main

SENSOR = "site: atlanta, pointing: zenith, exposure_s: 1, cadence_s: 5"
SCENARIO = f"""simulation: {{start: 2018-01-21T00:15:00Z, duration_s: 5, tick_s: 5}}
sensors:
  - {{name: zulu, {SENSOR}, camera: omnissa}}
  - {{name: alpha, {SENSOR}, camera: omnissa, effects: {{refraction: off, read_noise: off}}}}
  - {{name: mike, {SENSOR}, camera: omnissa}}
"""


def test(binary, directory):
    path = directory / "effects.yaml"
    path.write_text(SCENARIO)

    def output(*options):
        done = subprocess.run([binary, "check", path, *options], capture_output=True, text=True)
        check(done.returncode == 0, f"check {' '.join(options)} passes {done.stderr}")
        return done.stdout

    groups = re.findall(r"^effects of (.*):$", output(), re.M)
    check(groups == ["zulu, mike", "alpha"], f"sensors come in the order of the scenario: {groups}")

    effects = json.loads(output("--json"))["effects"]
    check(list(effects) == ["zulu", "alpha", "mike"], f"every sensor has its effects: {list(effects)}")
    names = {sensor: [effect["name"] for effect in listed] for sensor, listed in effects.items()}
    off = [name for name in names["zulu"] if name not in names["alpha"]]
    check(off == ["refraction", "read_noise"], f"alpha lacks what it switches off: {off}")
    noise = next(effect for effect in effects["zulu"] if effect["name"] == "read_noise")
    check(isinstance(noise["parameters"]["read_noise_e"], (int, float)), f"parameters are numbers: {noise}")
    check(all(effect["what"] for listed in effects.values() for effect in listed), "every effect says what it does")


main(test)
