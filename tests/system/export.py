"""`dmise export --to omm` writes the element sets of the objects as the run had them, and refuses what has changed since; runs that
have not ended and outputs of the wrong kind are refused in one line.

    export.py DMISE
"""

import json
import re
import subprocess

from harness import check, main

OLD = """OLD
1 29155U 98067A   18020.50000000  .00000000  00000-0  00000-0 0  9998
2 29155  50.0000 100.0000 0005000  90.0000 270.0000 14.00000000000019
"""
NEW = """NEW
1 29155U 98067A   18021.00000000  .00000000  00000-0  00000-0 0  9994
2 29155  60.0000 100.0000 0005000  90.0000 270.0000 13.00000000000019
"""
SCENARIO = """simulation: {{start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 10}}
objects: [{objects}]
sensors: [{{name: g, site: atlanta, camera: star-tracker, pointing: zenith, exposure_s: 0.1, cadence_s: 10, sky: dark}}]
detection: off
output: {{fits: false, png: false}}
"""
SGP4 = NEW.split("\n")
OWN = f'{{name: mine, motion: {{sgp4: {{line1: "{SGP4[1]}", line2: "{SGP4[2]}"}}}}}}'
ORBIT = "motion: {two_body: {semi_major_axis_m: 42164000, eccentricity: 0, inclination_deg: 0}}"
REPLACES = f"{{name: mine, catalogue_number: 29155, {ORBIT}}}"


def test(binary, directory):
    (directory / "a1.tle").write_text(OLD)
    (directory / "a2.tle").write_text(NEW)

    def dmise(*arguments):
        return subprocess.run([binary, *map(str, arguments)], cwd=directory, capture_output=True, text=True, check=False)

    def run_of(name, objects):
        (directory / f"{name}.yaml").write_text(SCENARIO.format(objects=objects))
        done = dmise("run", f"{name}.yaml", "--out", name)
        check(done.returncode == 0, f"{name} runs {done.stderr if done.returncode else ''}")
        return done.stderr

    def sets(name, *arguments):
        done = dmise("export", name, "--to", "omm", "--out", f"{name}.xml", *arguments)
        check(done.returncode == 0, f"OMM of {name} {done.stderr}")
        text = (directory / f"{name}.xml").read_text()
        values = [re.findall(f"<{key}>(.*?)</{key}>", text) for key in ("NORAD_CAT_ID", "OBJECT_NAME", "INCLINATION")]
        return list(zip(*values))

    def refused(words, *arguments):
        done = dmise("export", *arguments)
        check(done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1,
              f"exit 2 and one line, {words}: {done.returncode} {done.stderr.strip()}")

    notes = run_of("two", "{catalogue: a1.tle}, {catalogue: a2.tle}")
    check("a2.tle: 1 element set left out" in notes, f"a note says that the second set is left out: {notes.strip()}")
    check(sets("two") == [("29155", "OLD", "50")], "of two catalogues' sets that of the first, which flew")
    run_of("own", "{catalogue: a1.tle}, " + OWN)
    check(sets("own") == [("29155", "mine", "60")], "the set of an own object in the catalogue's place")
    run_of("only_own", OWN)
    check(sets("only_own") == [("29155", "mine", "60")], "the set of an own object alone")
    run_of("replaced", "{catalogue: a1.tle}, " + REPLACES)
    refused("no object of the scenario has an element set", "replaced", "--to", "omm")
    (directory / "a1.tle").write_text(NEW)
    refused("a1.tle: is not the file that the run read", "two", "--to", "omm")
    check(sets("two", "--catalogue", "a2.tle") == [("29155", "NEW", "60")], "a file that is named is not compared")
    record = directory / "two/run.json"
    fields = json.loads(record.read_text())
    del fields["catalogue_sha256"]
    record.write_text(json.dumps(fields))
    refused("catalogue_sha256: is missing", "two", "--to", "omm")
    record.write_text('{"status":"begun","digest":"0"}\n')
    refused("the run has not ended, or was refused at its start", "two", "--to", "udl")
    (directory / "there").mkdir()
    refused("--out: udl is written to a file, got the directory there", "own", "--to", "udl", "--out", "there")
    refused("--out: csv is written to a directory, got the file a2.tle", "own", "--to", "csv", "--out", "a2.tle")


main(test)
