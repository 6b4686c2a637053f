"""`dmise catalogue fetch | index`: indexes that scenarios name, and refusals in one line.

    star_catalogues.py DMISE
"""

import os
import subprocess
from pathlib import Path

from harness import check, main

GAIA = """ra,dec,phot_g_mean_mag,bp_rp,pmra,pmdec,parallax
80.1,20.0,8.1,0.8,1,2,3
80.2,20.1,9.0,null,null,null,null
80.3,20.2,null,0.8,1,2,3
"""
SCENARIO = """simulation: {start: 2018-01-20T23:40:00Z, duration_s: 10, tick_s: 5}
stars: {catalogue: %s}
sensors:
  - {name: a, site: atlanta, camera: geo-watch, pointing: {ra_deg: 80, dec_deg: 20}, exposure_s: 2, cadence_s: 10}
"""


def test(binary, directory):
    environment = dict(os.environ, XDG_DATA_HOME=str(directory / "data"), XDG_CACHE_HOME=str(directory / "cache"))

    def dmise(*arguments, code=0):
        done = subprocess.run([binary, *map(str, arguments)], capture_output=True, text=True, cwd=directory, env=environment)
        check(done.returncode == code, f"dmise {' '.join(map(str, arguments[:3]))} ends with {code}"
              + (f": {done.stderr}" if done.returncode != code else ""))
        return done.stdout, done.stderr

    def refused(*arguments, reason):
        _, said = dmise(*arguments, code=2)
        check(reason in said and said.count("\n") == 1, f"in one line: {said.strip()}")

    (directory / "gaia.csv").write_text(GAIA)
    out, notes = dmise("catalogue", "index", "gaia.csv", "--out", "gaia.stars")
    check(out == "gaia.stars: 2 stars\n", f"it says how many stars it has: {out.strip()}")
    check("gaia.csv:4: phot_g_mean_mag: must be a number (left out)" in notes, "a row that is left out is named")
    for catalogue in ("gaia.stars", "gaia.csv"):
        (directory / "scenario.yaml").write_text(SCENARIO % catalogue)
        dmise("run", "scenario.yaml", "--out", catalogue + ".run")
    frames = [(directory / f"{name}.run/a/frame-000001.fits").read_bytes() for name in ("gaia.stars", "gaia.csv")]
    pixels = [frame[-(len(frame) // 2):] for frame in frames]  # headers have the scenario's digest
    check(pixels[0] == pixels[1], "a scenario may name the file or its index")

    whole = (directory / "gaia.stars").read_bytes()
    (directory / "scenario.yaml").write_text(SCENARIO % "gaia.stars")
    for name, content, reason in (("cut short", whole[:-64], "bytes, has"), ("damaged", whole[:5000] + b"?" + whole[5001:], "checksum"),
                                  ("of another version", whole[:8] + b"\x01" + whole[9:], "make it anew")):
        (directory / "gaia.stars").write_bytes(content)
        refused("check", "scenario.yaml", reason=reason)

    (directory / "scenario.yaml").write_text(SCENARIO % "tycho2")
    home = directory / "home"  # where nobody has fetched it
    checkout = Path(__file__).resolve().parents[2]
    home.mkdir()
    (home / "launch").symlink_to(checkout / "launch")
    environment["DMISE_HOME"] = str(home)
    refused("check", "scenario.yaml", reason="scenario.yaml:2:20: stars.catalogue: Tycho-2 is missing; `dmise catalogue fetch tycho2` makes it")
    refused("catalogue", "fetch", "tycho2", "--to", "data", "--from", "absent.dat", reason="absent.dat: there is no such file")
    refused("catalogue", "fetch", "tycho2", "--to", "data", "--from", "gaia.csv", reason="its SHA-256 must be")
    check(list((directory / "data").iterdir()) == [], "nothing is left of what could not be fetched")
    refused("catalogue", "index", "absent.csv", "--out", "x.stars", reason="absent.csv")
    refused("catalogue", "index", "gaia.csv", "--out", "./gaia.csv", reason="--out")


if __name__ == "__main__":
    main(test)
