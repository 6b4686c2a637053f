"""`dmise visible`: the table, CSV, JSON lines and figure of a scenario, and what it refuses.

    visible.py DMISE
"""

import csv
import io
import json
import re
import subprocess
import xml.etree.ElementTree

from harness import check, main, write_scenario


def call(binary, *arguments):
    return subprocess.run([binary, "visible", *map(str, arguments)], capture_output=True, text=True, check=False)


def test(binary, directory):
    scenario = write_scenario(directory, duration_s=21600)
    out = directory / "out"
    done = call(binary, scenario, "--sensor", "alpha", "--out", out)
    check(done.returncode == 0, f"prints passes: {done.stderr.strip()}")
    head = re.search(r"^alpha, 2018-01-21T00:15:00Z to 2018-01-21T06:15:00Z: (\d+) passes of (\d+) objects$",
                     done.stdout, re.MULTILINE)
    check(head and int(head[1]) >= int(head[2]) > 5, f"the table's head counts: {done.stdout.splitlines()[0]}")

    with open(out / "alpha/passes.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    check(len(rows) == int(head[1]), f"passes.csv has the {len(rows)} passes")
    for row in rows:
        check_row(row)
    check(True, "rise <= top <= set; the highest point is in the field; lit times within the pass")
    lines = [json.loads(line) for line in (out / "alpha/passes.jsonl").read_text().splitlines()]
    check([str(x["catalogue_number"]) for x in lines] == [x["catalogue_number"] for x in rows],
          "passes.jsonl has the same passes")
    root = xml.etree.ElementTree.parse(out / "alpha/figure.svg").getroot()
    text = "".join(root.itertext())
    check("Range [km]" in text and "Time [UTC]" in text and "LEO (" in text, "figure.svg is XML with axes and legend")

    printed = call(binary, scenario, "--csv", "--print-only", "--threads", 3).stdout
    both = list(csv.DictReader(io.StringIO(printed)))
    check([x for x in both if x["sensor"] == "alpha"] == rows, "three threads find the same passes, to the byte")
    check({x["sensor"] for x in both} == {"alpha", "beta"}, "without --sensor all sensors are told, one header")
    coarse = call(binary, scenario, "--csv", "--print-only", "--step", 3500).stdout
    check(list(csv.DictReader(io.StringIO(coarse))) == both,
          "instants 3500 s apart, the last step shorter, have the same passes")
    lit = list(csv.DictReader(io.StringIO(call(binary, scenario, "--csv", "--print-only", "--sunlit").stdout)))
    check(lit == [x for x in both if float(x["lit_s"]) > 0], "--sunlit leaves the passes with light")
    night = list(csv.DictReader(io.StringIO(call(binary, scenario, "--csv", "--print-only", "--night").stdout)))
    check(night == both, "after dusk --night leaves all")
    day = call(binary, scenario, "--csv", "--print-only", "--night", "--from", "2018-01-21T16:00:00Z")
    check(len(day.stdout.splitlines()) == 1, "by day it leaves none")

    leap = call(binary, scenario, "--sensor", "alpha", "--print-only", "--from", "2016-12-31T23:59:60.5Z", "--duration", "3")
    check(leap.stdout.startswith("alpha, 2016-12-31T23:59:60.500Z to 2017-01-01T00:00:02.500Z: "),
          f"the head has fractions of seconds: {leap.stdout.splitlines()[:1]} {leap.stderr}")

    for arguments, code, message in [
            (["--from", "2308-01-01T00:00:00Z", "--duration", "3.2e8", "--step", "3600"], 2,
             r"dmise: --from: the span ends more than 291 years after .*"),
            (["--from", "yesterday"], 2, r"dmise: --from: not a UTC time: .*"),
            (["--from", "2200-01-01T00:00:00Z"], 2, r"dmise: --from: the span must be within 1900 to 2100, .*"),
            (["--rows", "-1"], 2, r"dmise visible: --rows: Value -1 not in range.*"),
            (["--sensor", "alpha", "--sensor", "alpha"], 2, r"dmise: --sensor: alpha is there twice"),
            (["--sensor", "alpa"], 2, r"dmise: .*: no sensor is named alpa, did you mean alpha\?"),
            (["--step", "0"], 2, r"dmise visible: --step: Value 0 not in range.*"),
            (["--sunlit", "--dark"], 2, r"dmise visible: --(sunlit|dark) excludes --(dark|sunlit).*"),
            (["--step", "0.001", "--duration", "86400"], 2, r"dmise: --step: 86400000 instants, .*"),
            (["--duration", "60", "--out", "/proc/none"], 1, r"dmise: /proc/none(/alpha)?: .*")]:
        done = call(binary, scenario, *arguments)
        said = [x for x in done.stderr.splitlines() if not x.startswith("note:")]
        check(done.returncode == code and re.fullmatch(message, said[0]), f"{' '.join(arguments)}: {said[0]}")
    bad = directory / "bad.yaml"
    bad.write_text(scenario.read_text().replace("exposure_s: 2", "mask_deg: 90, exposure_s: 2", 1))
    done = call(binary, bad)
    check(done.returncode == 2 and re.search(r"bad\.yaml:5:\d+: sensors\[0\]\.mask_deg: must be <= 89, got 90",
                                             done.stderr), done.stderr.strip())

    own = directory / "own.yaml"
    own.write_text(scenario.read_text().replace(
        "objects: [", "objects: [{name: inspector, motion: {two_body: {position_m: [7.0e6, 0, 0], "
        "velocity_m_per_s: [0, 5.3e3, 5.3e3]}}}, ", 1))
    done = call(binary, own, "--print-only", "--duration", "60")
    check(done.returncode == 0 and "note: 1 of 980 objects are left out: no element sets" in done.stderr,
          "an object of another motion model is left out with a note")
    own.write_text(own.read_text().replace("site: atlanta", "platform: inspector", 1))
    done = call(binary, own, "--print-only", "--duration", "60")
    check(done.returncode == 2 and "alpha: platform: inspector has no element set" in done.stderr,
          done.stderr.splitlines()[-1])


def check_row(row):
    what = f"{row['catalogue_number']} at {row['rise_utc']}"
    if not row["rise_utc"] <= row["top_utc"] <= row["set_utc"]:
        check(False, f"{what}: rise <= top <= set")
    # The camera looks at the zenith: its corner is 9.3 deg away.
    if float(row["top_elevation_deg"]) < 80.6 or float(row["least_range_km"]) < 150:
        check(False, f"{what}: in the field")
    if row["lit_from_utc"] and not row["rise_utc"] <= row["lit_from_utc"] <= row["lit_to_utc"] <= row["set_utc"]:
        check(False, f"{what}: lit within the pass")
    if bool(row["lit_from_utc"]) != (float(row["lit_s"]) > 0):
        check(False, f"{what}: lit seconds")


if __name__ == "__main__":
    main(test)
