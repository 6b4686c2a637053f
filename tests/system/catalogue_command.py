"""`dmise catalogue info | states | synth | facts`: every format, frame, flag and refusal, against python3-sgp4 and ERFA.

    catalogue_command.py DMISE
"""

import csv
import gzip
import io
import json
import pathlib
import subprocess

import erfa
import numpy as np
from harness import check, main, write_scenario
from sgp4.api import WGS72, Satrec

ISS = ("1 25544U 98067A   18020.54791435  .00001690  00000-0  33046-4 0  9992",
       "2 25544  51.6422  42.6321 0003493 355.8117 150.1155 15.54153012 95401")
GOES = ("1 29155U 06018A   18020.76993589 -.00000277  00000-0  00000+0 0  9990",
        "2 29155   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 42737")
JD, FRACTION = 2458139.5, 0.25
COLUMNS = "id,code,x_km,y_km,z_km,vx_km_s,vy_km_s,vz_km_s"


def with_checksum(line):
    body = line[:68]
    return body + str(sum(int(c) if c.isdigit() else c == "-" for c in body) % 10)


def test(binary, directory):
    def dmise(*arguments, code=0, text=None):
        done = subprocess.run([binary, "catalogue", *map(str, arguments)], capture_output=True, input=text)
        check(done.returncode == code, f"catalogue {' '.join(map(str, arguments[:1]))} ends with {code}"
              + (f": {done.stderr.decode()}" if done.returncode != code else ""))
        return done.stdout.decode(), done.stderr.decode()

    def rows(text):
        check(text.splitlines()[0] == COLUMNS, f"the columns are {COLUMNS}")
        return list(csv.reader(io.StringIO(text)))[1:]

    lines = [with_checksum(line) for line in (*ISS, *GOES)]
    path = directory / "two.tle"
    path.write_text("ISS\n" + "\n".join(lines[:2]) + "\n0 GOES 13\n" + "\n".join(lines[2:]) + "\n")

    # States against python3-sgp4 (TEME) and ERFA (the other frames, UT1 = UTC, the pole at rest).
    tt = erfa.taitt(*erfa.utctai(JD, FRACTION))
    itrs_from_gcrs = erfa.c2t06a(*tt, JD, FRACTION, 0.0, 0.0)
    itrs_from_teme = erfa.pom00(0, 0, erfa.sp00(*tt)) @ erfa.rz(erfa.gmst82(JD, FRACTION), np.eye(3))
    turn = {"teme": np.eye(3), "itrs": itrs_from_teme, "gcrs": itrs_from_gcrs.T @ itrs_from_teme}
    earth_rad_s = np.array([0, 0, 7.292115146706979e-5])
    for frame, matrix in turn.items():
        out, err = dmise("states", path, "--at", "2018-01-21T06:00:00Z", "--frame", frame)
        for row, two_lines in zip(rows(out), (lines[:2], lines[2:]), strict=True):
            _, r, v = Satrec.twoline2rv(*two_lines, WGS72).sgp4(JD, FRACTION)
            r, v = matrix @ r, matrix @ v
            if frame == "itrs":
                v = v - np.cross(earth_rad_s, r)
            ours = np.array([float(x) for x in row[2:]])
            check(np.linalg.norm(ours[:3] - r) < 2e-8 and np.linalg.norm(ours[3:] - v) < 1e-9,
                  f"{frame} of {row[0]} is the reference's to {np.linalg.norm(ours[:3] - r):.1e} km")
        check(("UT1" in err) == (frame != "teme"), f"{frame}: what is not known of the Earth is said where it matters")
    by_utc = dmise("states", path, "--at", "2018-01-21T06:00:00Z")[0]
    check(by_utc == dmise("states", path, "--at", "2458139.75")[0], "a Julian date and a UTC time give the same bytes")

    # The same objects however they come.
    (directory / "two.tle.gz").write_bytes(gzip.compress(path.read_bytes()))
    check(by_utc == dmise("states", directory / "two.tle.gz", "--at", "2458139.75")[0], "gzip makes no difference")
    check(by_utc == dmise("states", "-", "--at", "2458139.75", text=path.read_bytes())[0], "- reads standard input")
    record = {"OBJECT_NAME": "NINE", "OBJECT_ID": "1998-067A", "EPOCH": "2018-01-20T13:08:59.799840",
              "MEAN_MOTION": 15.54153012, "ECCENTRICITY": 0.0003493, "INCLINATION": 51.6422,
              "RA_OF_ASC_NODE": 42.6321, "ARG_OF_PERICENTER": 355.8117, "MEAN_ANOMALY": 150.1155,
              "EPHEMERIS_TYPE": 0, "CLASSIFICATION_TYPE": "U", "NORAD_CAT_ID": 799501234, "ELEMENT_SET_NO": 999,
              "REV_AT_EPOCH": 9540, "BSTAR": 0.33046e-4, "MEAN_MOTION_DOT": 1.69e-5, "MEAN_MOTION_DDOT": 0}
    (directory / "nine.json").write_text(json.dumps([record]))
    nine = rows(dmise("states", directory / "nine.json", "--at", "2458139.75")[0])[0]
    iss = rows(by_utc)[0]
    check(nine[0] == "799501234", "an OMM's number of nine digits is kept")
    check(all(abs(float(a) - float(b)) < 1e-3 for a, b in zip(nine[2:], iss[2:])), "and its state is the TLE's")

    # What has no state has a code and blanks; what is damaged is named.
    bad = lines[0][:68] + str((int(lines[0][68]) + 1) % 10)
    (directory / "bad.tle").write_text("\n".join([bad, *lines[1:]]) + "\n")
    out, err = dmise("states", directory / "bad.tle", "--at", "2458139.75")
    check(len(rows(out)) == 1 and "bad.tle:1: line 1 has a wrong checksum" in err, "a damaged set is left out by name")
    out, err = dmise("states", directory / "bad.tle", "--at", "2458139.75", "--lenient")
    check(len(rows(out)) == 2 and "bad.tle:1: " in err, "--lenient reads it with a warning")
    check("read with a warning   1" in dmise("info", directory / "bad.tle", "--lenient")[0], "info counts the warning")
    check("refused               1" in dmise("info", directory / "bad.tle")[0], "info counts what was refused")
    decayed = rows(dmise("states", path, "--at", "2060-01-01")[0])[0]
    check(decayed[1] != "0" and decayed[2:] == [""] * 6, f"a decayed object has code {decayed[1]} and no numbers")
    (directory / "none.tle").write_text("hello\n")
    _, err = dmise("states", directory / "none.tle", "--at", "2458139.75", code=2)
    check("none.tle:1: " in err and err.count("\n") == 1, "a file without a set is refused with its line")

    out, err = dmise("info", directory / "none.tle", code=2)
    check("refused               1" in out and "none.tle:1: " in err, "info reports on it and refuses it as well")

    (directory / "empty.json").write_text("[]")
    _, err = dmise("states", directory / "empty.json", "--at", "2458139.75", code=2)
    check("empty.json: contains no element sets" in err, "an empty list is refused")

    for arguments, said in ((("states", path, "--at", "tomorrow"), "--at: must be a UTC time"),
                            (("states", path, "--at", "1e9"), "--at: Julian date out of range, got 1e9"),
                            (("states", path, "--at", "nan"), "--at: must be a finite Julian date, got nan"),
                            (("states", path, "--at", "inf"), "--at: must be a finite Julian date, got inf"),
                            (("states", path, "--at", "2.4588375e6"),
                             "--at: must be a Julian date without an exponent, got 2.4588375e6"),
                            (("states", path), "--at is required"),
                            (("states", path, "--at", "2458139.75", "--frame", "j2000"), "--frame: must be one of teme, gcrs, itrs"),
                            (("info", directory / "absent"), "absent: No such file"),
                            (("synth", "--objects", "0"), "--objects: "),
                            (("synth", "--objects", "1000001"), "--objects: "),
                            (("synth", "--objects", "400000", "--format", "3le"), "--objects: a TLE has numbers")):
        check(said in dmise(*arguments, code=2)[1], f"refused: {said}")

    # Facts of somebody's table: a scenario that names them sees the sizes.
    table = directory / "sizes.csv"
    table.write_text("OBJECT,RCS\n25544,26.0\n29155,x\n5,\n")
    _, err = dmise("facts", table, "--id", "OBJECT", "--size", "RCS", "--is", "rcs", "--unit", "dBsm", "--out", directory / "facts.csv")
    check('sizes.csv:3: RCS is not a number, got "x" (left out)' in err, "a bad row is named with its column")
    check("3 rows: facts of 1 objects, 1 unknown, 1 left out" in err, "rows are counted")
    check((directory / "facts.csv").read_text().splitlines()[1].startswith("25544,,398.107"), "dBsm are square metres")
    for arguments, said in ((("facts", table, "--id", "OBJECT", "--size", "HBR"), "sizes.csv:1: no column HBR, of OBJECT, RCS"),
                            (("facts", table, "--id", "OBJECT", "--size", "RCS", "--unit", "m2"), "a length is in m, cm or mm"),
                            (("facts", table, "--id", "OBJECT", "--size", "RCS", "--unit", "ft"), "--unit: must be one of m, cm, mm, m2, dBsm"),
                            (("facts", table, "--id", "OBJECT"), "sizes.csv: nothing is known of any object")):
        check(said in dmise(*arguments, code=2)[1], f"refused: {said}")

    # Populations: the same seed the same bytes, numbers up to a million, readable by others.
    synthetic = dmise("synth", "--objects", "2000", "--seed", "3")[0]
    check(synthetic == dmise("synth", "--objects", "2000", "--seed", "3")[0], "a seed gives the same bytes")
    check(synthetic != dmise("synth", "--objects", "2000", "--seed", "4")[0], "another seed others")
    text = synthetic.splitlines()
    numbers = {Satrec.twoline2rv(text[k + 1], text[k + 2], WGS72).satnum for k in range(0, len(text), 3)}
    check(len(numbers) == 2000, "python3-sgp4 reads every set")
    million = dmise("synth", "--objects", "1000000")[0]
    check(million.count("\n") == 1_000_001 and million.startswith("OBJECT_NAME,"), "a million come as OMM")

    # Facts of objects in a scenario: what is known makes an object brighter; a bad row is named.
    facts = directory / "facts.csv"
    facts.write_text("catalogue_number,standard_magnitude,length_m\n25544,-1.8,\n29155,bright,\n")
    scenario = write_scenario(directory)
    scenario.write_text(scenario.read_text().replace("catalogue: demo", "catalogue: two.tle, facts: facts.csv"))
    done = subprocess.run([binary, "check", scenario], capture_output=True, text=True)
    check(done.returncode == 0 and "facts.csv:3: " in done.stdout + done.stderr and "2 objects" in done.stdout,
          "facts are read, a bad row is named")


main(test)
