"""`dmise tradeoff`: a row for each level and budget, a page that needs nothing else, and a run that goes on where it was
stopped without changing what it had measured.

    tradeoff.py DMISE
"""

import csv
import json
import subprocess

from harness import check, main, wait_until

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


# A lens of 200 degrees over 96 pixels: every pixel is near a star, and every star near another.
WIDE = SCENARIO.replace("projection: gnomonic", "projection: kannala_brandt, distortion: {k1: 0.02}").replace(
    "pixel_pitch_m: 2.0e-5, focal_length_m: 0.1, aperture_m: 0.05", "pixel_pitch_m: 2.0e-5, field_of_view_deg: 200, aperture_m: 0.05, equivalent_aperture: true")


def test_wide(binary, directory):
    """Where nothing can show an error none is recorded."""
    scenario, out = directory / "wide.yaml", directory / "wide"
    scenario.write_text(WIDE)
    done = subprocess.run([binary, "tradeoff", scenario, "--out", out, "--repeats", "1"], capture_output=True, text=True)
    check(done.returncode == 0, f"a wide lens: {done.stderr[-300:]}")
    check("note: the frame has no isolated source: photometry_mag and position_px are not measured" in done.stderr,
          f"it says what is not measured: {done.stderr}")
    rows = json.loads((out / "tradeoff.json").read_text())["rows"]
    check(all(row["measured"]["photometry_mag"] is None and row["detected"] is None for row in rows), "null in JSON")
    sky = next(row for row in rows if row["effect"] == "sky" and row["level"] == "off")
    check(sky["bound"]["background_sigma"] is None or sky["bound"]["background_sigma"] > 0,
          "a forced level states the bound that it has as a level")
    text = (out / "tradeoff.csv").read_text()
    check(",," in text and "nan" not in text, "empty in CSV")
    before = (out / "tradeoff.csv").read_bytes()
    subprocess.run([binary, "tradeoff", scenario, "--out", out, "--repeats", "1"], check=True, capture_output=True)
    check((out / "tradeoff.csv").read_bytes() == before, "rows with empty fields are read back")
    check("<td>- / " in (out / "index.html").read_text(), "- on the page")


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

    head = table.read_text().splitlines()[0]
    table.write_text(table.read_text().replace(head, head.replace("DMISE ", "DMISE 0.")))
    one = subprocess.Popen([binary, "tradeoff", scenario, "--out", out], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    wait_until(lambda: (out / ".run-lock").exists() or one.poll() is not None, "the lock of the directory")
    refusal = tradeoff(expect=2).stderr
    check("is in use by" in refusal and refusal.count("\n") == 1, f"a second one is refused while the first works: {refusal}")
    check(one.wait() == 0 and table.read_text().splitlines()[0] == head, "rows of another version are measured again")
    test_wide(binary, directory)


main(test)
