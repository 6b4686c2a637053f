"""Cameras whose Sun and Moon are too near: `check`, `explain`, `run`, `detect`, `solve` and `visible` say the same of them, one process and
many make the same bytes, and a sensor that is cued to where its shutter is closed has dark frames.

    exclusion.py DMISE
"""

import json
import subprocess

from harness import check, main

CAMERA = """\
optics: {projection: gnomonic, columns: 96, rows: 96, pixel_pitch_m: 1.0e-5, focal_length_m: 0.1, aperture_m: 0.05}
detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
"""
# The Moon of that evening is at (345.7, -9.3) deg from Atlanta, 4 deg from the first two cameras' axes.
SENSOR = "site: atlanta, exposure_s: 1, cadence_s: 5, sky: dark, pointing: {ra_deg: 345.7, dec_deg: -5.3, tracking: sidereal}"
SCENARIO = f"""simulation: {{start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5}}
objects: [{{catalogue: demo}}]
stars: {{catalogue: kstars}}
fusion: on
accuracy: ACCURACY
sensors:
  - {{name: closed, {SENSOR}, camera: closed.yaml}}
  - {{name: flagged, {SENSOR}, camera: flagged.yaml}}
  - {{name: plain, {SENSOR}, camera: plain.yaml}}
  - {{name: cued, site: atlanta, exposure_s: 1, cadence_s: 5, sky: dark, camera: closed.yaml,
     pointing: {{cued: {{park: {{azimuth_deg: AZIMUTH, elevation_deg: ELEVATION}}}}}}}}
output: {{png: false}}
"""


def test(binary, directory):
    for name, action in (("closed", "close_shutter"), ("flagged", "flag"), ("plain", None)):
        exclusion = f"exclusion: {{sun_deg: 40, moon_deg: 10, action: {action}}}\n" if action else ""
        (directory / f"{name}.yaml").write_text(CAMERA + exclusion)
    path = directory / "scenario.yaml"
    text = SCENARIO.replace("AZIMUTH", "230").replace("ELEVATION", "35")
    path.write_text(text.replace("ACCURACY", "off"))

    def done(*command, code=0):
        result = subprocess.run([binary, *command], capture_output=True, text=True)
        check(result.returncode == code, f"{' '.join(map(str, command))} ends with {code} {result.stderr[-400:]}")
        return result

    lines = done("check", path).stdout.splitlines()
    of_moon = [line for line in lines if "exclusion: the Moon is within 10 deg in 4 of 4 frames" in line]
    check(len(of_moon) >= 2, f"check tells where the Moon excludes: {of_moon}")
    check(any(line.startswith("closed: exclusion") and line.endswith("the shutter is closed") for line in of_moon) and
          any(line.startswith("flagged: exclusion") and line.endswith("flagged") for line in of_moon), "and what happens")
    warnings = [line for line in lines if line.startswith("warning") and "shutter is closed in 4 of 4 frames" in line]
    check(any("sensors[0]" in line for line in warnings), f"and warns of dark frames: {warnings}")
    check(not any(line.startswith("plain: exclusion") for line in lines), "and nothing of a camera without")
    sensors = {s["name"]: s for s in json.loads(done("check", "--json", path).stdout)["sensors"]}
    exclusion = sensors["closed"]["exclusion"]
    check(exclusion["frames_excluded"] == 4 and exclusion["moon"]["first_frame"] == 1 and
          abs(exclusion["moon"]["least_deg"] - 4.0) < 1.0, f"the same in JSON: {exclusion}")
    check("exclusion" not in sensors["plain"], "which has no key of it otherwise")

    planned = directory / "planned.yaml"
    planned.write_text(text.replace("ACCURACY", "standard"))
    explained = done("explain", planned, "--sensor", "closed").stdout
    check("the shutter is closed" in explained and "stars" not in explained, "explain plans the detector alone")

    one, many = directory / "one", directory / "many"
    done("run", path, "--out", one)
    done("launch", path, "--out", many)
    names = sorted(p.relative_to(one) for p in one.rglob("*.fits")) + ["detections.jsonl", "truth.jsonl", "frames.jsonl"]
    check(all((one / n).read_bytes() == (many / n).read_bytes() for n in names), f"{len(names)} files of run and launch are the same")
    reports = [json.loads(line) for line in (one / "frames.jsonl").read_text().splitlines()]
    of = {name: [r for r in reports if r["sensor"] == name] for name in ("closed", "flagged", "plain", "cued")}
    check(all(r.get("shutter_closed") and r["moon_excludes"] and r["detection_off"] and "sun_excludes" not in r
              for r in of["closed"]), "reports of dark frames say why")
    check(all(r.get("moon_excludes") and "shutter_closed" not in r for r in of["flagged"]), "flagged frames are flagged")
    check(not any(key.endswith("excludes") or key == "shutter_closed" for r in of["plain"] for key in r),
          "a camera without has the keys it had")
    check(len(of["cued"]) <= 4, "the cued sensor ran")

    frame = one / "closed" / "frame-000001.fits"
    found = done("detect", frame)
    check(found.stdout == "" and found.stderr.count("\n") == 1 and
          "the shutter was closed because of the Moon" in found.stderr, f"detect says it in one line: {found.stderr}")
    solved = done("solve", frame, code=1)
    check("the shutter was closed because of the Moon" in solved.stderr, f"solve, too: {solved.stderr}")
    before = frame.read_bytes()
    for out, why in ((frame, "must not be the frame itself"), (directory / "solved.fits.gz", "an uncompressed file is written")):
        check(why in done("solve", frame, "--out", out, code=2).stderr, f"solve --out {out.name} is refused")
    check(frame.read_bytes() == before and not (directory / "solved.fits.gz").exists(), "and nothing is written")

    passes = {name: done("visible", path, "--sensor", name, "--csv", "--print-only", "--duration", "10800").stdout.splitlines()
              for name in ("closed", "flagged", "plain")}
    check(passes["flagged"][0] == passes["plain"][0] + ",excluded", "visible has a column of its own for it")
    of_passes = {name: [line.split(",", 1)[1] for line in lines[1:]] for name, lines in passes.items()}  # without the sensor
    flagged = [line.rsplit(",", 1) for line in of_passes["flagged"]]
    check([line for line, _ in flagged] == of_passes["plain"], "and the same passes")
    excluded = [line for line, mark in flagged if mark == "true"]
    check(len(excluded) >= 2 and len(excluded) < len(flagged), f"{len(excluded)} of {len(flagged)} while the Moon is up")
    check([line for line, mark in flagged if mark == "false"] == [line.rsplit(",", 1)[0] for line in of_passes["closed"]],
          "behind a shutter that the Moon closes there are those after it has set")


main(test)
