"""`dmise survey`: tables, JSON, map and files of a network, what it chooses, how it goes on, and what it refuses.

    survey.py DMISE
"""

import json
import re
import subprocess
import xml.etree.ElementTree

from harness import check, main

SCENARIO = """simulation: {start: 2018-01-21T00:15:00Z, duration_s: %d, tick_s: 10, seed: 1}
objects: %s
stars: {catalogue: kstars}
sensors:
"""
CAMERA = """name: piece
optics: {projection: gnomonic, columns: 1000, rows: 1000, pixel_pitch_m: 5.4e-6, focal_length_m: 8.98e-3, aperture_m: 0.0375,
         transmission: 0.8, psf_fwhm_px: 1.5, equivalent_aperture: true}
detector: {quantum_efficiency: 0.54, read_noise_e: 9.3, full_well_e: 25500, gain_e_per_dn: 0.35, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
"""
SITES = {"atlanta": "atlanta", "tololo": "cerro-tololo", "palma": "la-palma", "day": "haleakala"}


def write(directory, name="network.yaml", duration_s=1500, objects="[{catalogue: demo}]", sites=None, more=""):
    (directory / "piece.yaml").write_text(CAMERA)
    path = directory / name
    text = SCENARIO % (duration_s, objects)
    for sensor, site in (sites or SITES).items():
        text += (f"  - {{name: {sensor}, site: {site}, camera: piece.yaml, pointing: zenith, exposure_s: 10, "
                 f"cadence_s: 20{more}}}\n")
    path.write_text(text)
    return path


def call(binary, *arguments):
    return subprocess.run([binary, "survey", *map(str, arguments)], capture_output=True, text=True, check=False)


def files(out):
    return {str(path.relative_to(out)): path.read_bytes() for path in sorted(out.rglob("*"))
            if path.is_file() and path.name != ".run-lock"}


def test(binary, directory):
    scenario, out = write(directory), directory / "out"
    done = call(binary, scenario, "--out", out, "--optimise", "sites=2")
    check(done.returncode == 0, f"surveys: {done.stderr.strip()}")
    check(re.search(r"^shell +objects +covered +detected", done.stdout, re.MULTILINE), "the table has shells")
    check("2 of 4 sites" in done.stdout and "no choice of 2 has more than" in done.stdout, "and the choice with its bound")
    check("haleakala" not in done.stderr and "day: no exposure while the Sun is below -6 deg" in done.stderr,
          f"a site in daylight is noted: {done.stderr.strip()}")
    report = json.loads((out / "survey.json").read_text())
    everything = report["run"]["all"]
    check(0 < everything["detected"] <= everything["covered"] <= everything["objects"] == report["objects"],
          f"detected <= covered <= objects: {everything}")
    for key in ("objects", "covered", "visits", "detected", "detections"):
        check(abs(sum(shell[key] for shell in report["run"]["shells"]) - everything[key]) < 1e-6 * (1 + everything[key]),
              f"{key} of shells add up to those of all")
    choice = report["optimised"]
    check(len(choice["sites"]) == 2 and "day" not in choice["sites"], f"two sites at night are chosen: {choice['sites']}")
    check(choice["detected_by_greedy"] <= choice["detected_per_night"] <= choice["bound"], "no more than the bound")
    check(abs(choice["all"]["detected"] - choice["detected_per_night"]) < 1e-6, "the chosen network detects that many")
    check(choice["all"]["detected"] <= everything["detected"] + 1e-9, "fewer sites never detect more")
    root = xml.etree.ElementTree.parse(out / "map.svg").getroot()
    words = "".join(root.itertext())
    check("objects detected" in words, "map.svg is XML")
    check("longitude [deg]" in words and "latitude [deg]" in words and "60 W" in words, "its axes have names and units")
    check((out / "map.svg").read_text().count("#5a5a5a") > 0, "it has coastlines")

    first = files(out)
    again = call(binary, scenario, "--out", out, "--optimise", "sites=2")
    check("surveys of 4 of 4 sensors were there" in again.stderr and files(out) == first, "what is done is not done again")
    for name in ("passes.csv", "map.csv"):
        path = out / "palma" / name
        path.write_bytes(b"".join(path.read_bytes().splitlines(True)[:-2]))
        again = call(binary, scenario, "--out", out, "--optimise", "sites=2", "--threads", 3)
        check("surveys of 3 of 4 sensors were there" in again.stderr and files(out) == first
              and "palma: files of its survey are damaged or incomplete: it is surveyed again" in again.stderr,
              f"without all rows of {name} of one that sensor is surveyed again, to the same bytes on three threads")
    fewer = call(binary, write(directory, sites={k: SITES[k] for k in ("atlanta", "tololo", "day")}), "--out", out, "--json")
    check("surveys of 3 of 3 sensors were there" in fewer.stderr, "another network takes the sensors that it has")
    check(json.loads(fewer.stdout)["run"]["all"]["detected"] <= everything["detected"] + 1e-9,
          "a sensor less never detects more")

    compared = call(binary, write(directory), "--out", out, "--check", 4, "--fit", 4)
    check(re.search(r"^4 rendered frames: [\d.]+ detections expected, \d+ found", compared.stdout, re.MULTILINE),
          f"--check renders frames: {compared.stdout[-300:]} {compared.stderr[-300:]}")
    check((out / "check.csv").read_text().startswith("sensor,frame,"), "and lists their objects")

    empty = call(binary, write(directory, "empty.yaml", objects="[]"), "--out", directory / "empty", "--optimise", "sites=1")
    check(empty.returncode == 0 and "note: the scenario has no objects" in empty.stderr, "no object is a note")
    cloudy = call(binary, write(directory, "cloudy.yaml", more=", weather: {clouds: {transmission: 0}}"), "--out",
                  directory / "cloudy", "--json")
    check(json.loads(cloudy.stdout)["run"]["all"]["detected"] == 0, "under opaque clouds nothing is detected")
    check(call(binary, scenario, "--out", directory / "all", "--optimise", "sites=4").returncode == 0, "K may be N")

    number = r"must be sites=K, K in 1\.\.4, the places of the scenario's sensors on the ground, got "
    for arguments, message in [
            (["--optimise", "sites=5"], number + "sites=5"),
            (["--optimise", "sites=0"], number + "sites=0"),
            (["--optimise", "sites=two"], number + "sites=two"),
            (["--optimise", "cameras=2"], number + "cameras=2"),
            (["--shells", "600,500"], r"--shells: must be above 0 and ascend"),
            (["--night", "100"], r"--night: .*"),
            (["--check", "0"], r"--check: .*")]:
        done = call(binary, scenario, "--out", directory / "refused", *arguments)
        check(done.returncode == 2 and re.search(message, done.stderr) and len(done.stderr.splitlines()) == 1,
              f"{' '.join(arguments)} is refused in one line: {done.stderr.strip()}")
    check(not (directory / "refused").exists(), "and no directory is made")
    longer = call(binary, write(directory, "longer.yaml", more=", first_exposure_s: -1"), "--out", directory / "refused")
    check(longer.returncode == 2 and len(longer.stderr.splitlines()) == 1, f"so is a wrong key: {longer.stderr.strip()}")


main(test)
