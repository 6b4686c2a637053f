"""`dmise tradeoff`: a row for each level and budget, a page that needs nothing else, and a run that goes on where it was
stopped without changing what it had measured.

    tradeoff.py DMISE
"""

import csv
import json
import subprocess

from harness import check, main

SCENARIO = """simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5, seed: 1}
stars: {catalogue: kstars}
sensors:
  - name: eye
    site: atlanta
    camera: {optics: {projection: gnomonic, columns: 96, rows: 64, pixel_pitch_m: 2.0e-5, focal_length_m: 0.1, aperture_m: 0.05, psf_fwhm_px: 2},
             detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100},
             band: {centre_m: 0.55e-6, width_m: 0.128e-6}}
    pointing: zenith
    exposure_s: 2
    cadence_s: 5
    sky: dark
"""


def test(binary, directory):
    scenario, out = directory / "small.yaml", directory / "out"
    scenario.write_text(SCENARIO)

    def tradeoff(*options, expect=0):
        done = subprocess.run([binary, "tradeoff", scenario, "--out", out, *options], capture_output=True, text=True)
        check(done.returncode == expect, f"tradeoff exits with {expect}: {done.stderr[-300:]}")
        return done

    def rows():
        lines = (out / "tradeoff.csv").read_text().splitlines()
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))

    tradeoff()
    first = rows()
    check({row["level"] for row in first if row["effect"] == "sky_grid"} == {"2%", "0.5%", "0.1%", "0.02%"},
          "every level but the reference of an effect has a row")
    check({"draft", "standard"} <= {row["level"] for row in first if row["effect"] == "budget"}, "budgets have rows")
    check(all(float(row["seconds"]) > 0 and float(row["reference_s"]) > 0 for row in first), "times are positive")
    check(len(json.loads((out / "tradeoff.json").read_text())["rows"]) == len(first), "JSON has the same rows")
    page = (out / "index.html").read_text()
    check("<svg" in page and "http" not in page.replace("http://www.w3.org", ""), "the page needs no network")

    table = out / "tradeoff.csv"
    table.write_text("\n".join(table.read_text().splitlines()[:6]) + "\n")
    tradeoff()
    check(rows()[:4] == first[:4] and len(rows()) == len(first), "it goes on where it was stopped")
    check(tradeoff("--sensor", "nobody", expect=2).stderr.count("\n") == 1, "an unknown sensor is refused in one line")
    check(tradeoff("--frame", "99", expect=2).stderr.count("\n") == 1, "a frame after the run is refused in one line")


main(test)
