"""A bad scenario is refused with `file:line:column: key: reason, got value`, one line, exit code 2.

    bad_input.py DMISE
"""

import os
import re
import subprocess

from harness import check, main, write_scenario

# (text of a good scenario, what replaces it, line, column or None, rest of the message)
CASES = [
    ("duration_s: 3600", "duration_s: -1", 1, None, r"simulation\.duration_s: must be >=? \S+, got -1"),
    ("duration_s: 3600", "duration_s: 3602", 1, None,
     r"simulation\.duration_s: must be a whole number of ticks \(tick_s: 5\): 3600 or 3605, got 3602"),
    ("duration_s: 3600", "duration_s: fast", 1, None, r"simulation\.duration_s: must be a number, got fast"),
    ("duration_s: 3600", "duration_s: .nan", 1, None, r"simulation\.duration_s: must be a number, got \.nan"),
    ("duration_s: 3600", "duraton_s: 3600", 1, None,
     r"simulation\.duraton_s: unknown key, did you mean duration_s\?"),
    ("start: 2018-01-21T00:15:00Z", "start: yesterday", 1, 21,
     r"simulation\.start: must be a UTC time .*, got yesterday"),
    ("catalogue: demo", "catalogue: none.tle", 2, 23,
     r"objects\[0\]\.catalogue: there is no such file, got none\.tle"),
    ("catalogue: kstars", "catalogue: none.csv", 3, 20,
     r"stars\.catalogue: there is no such file, got none\.csv"),
    ("site: atlanta", "site: atlant", 5, 25, r"sensors\[0\]\.site: no such site, did you mean atlanta\?.*, got atlant"),
    ("camera: small.yaml", "camera: omnisa", 5, None,
     r"sensors\[0\]\.camera: no such camera, did you mean omnissa\?.*, got omnisa"),
    ("exposure_s: 2", "exposure_s: 0", 5, None, r"sensors\[0\]\.exposure_s: must be >=? \S+, got 0"),
    ("exposure_s: 2", "exposure_s: 6", 5, None, r"sensors\[0\]\.exposure_s: must be <= cadence_s, got 6"),
    ("site: atlanta", "site: atlanta, platform: ISS", 5, None, r"sensors\[0\]: has site and platform: give either .*"),
    ("exposure_s: 2", "exposure_s: {unifrom: [1, 2]}", 5, None, r"sensors\[0\]\.exposure_s\.unifrom: unknown key, did you mean uniform\?"),
    ("exposure_s: 2", "exposur_s: 2", 5, None, r"sensors\[0\]\.exposur_s: unknown key, did you mean exposure_s\?"),
    ("pointing: zenith", "pointing: {azimuth_deg: 0, elevation_deg: 91}", 5, None,
     r"sensors\[0\]\.pointing\.elevation_deg: must be <= 90, got 91"),
    ("name: beta", "name: alpha", 6, 12, r"sensors\[1\]\.name: another node has this name, got alpha"),
    ("name: beta", "name: time-master", 6, 12, r"sensors\[1\]\.name: another node has this name, got time-master"),
    ("name: beta", "name: ../beta", 6, 12, r"sensors\[1\]\.name: must be at most 64 letters.*, got \.\./beta"),
    ("on_silent_node: fail", "on_silent_node: panic", 7, None,
     r"network\.on_silent_node: must be one of fail, wait, drop, restart, got panic"),
    ("output: {png: false}", "output: {png: maybe}", 8, 15, r"output\.png: must be on or off, got maybe"),
    ("output: {png: false}", "output: {png: false", 8, None, r"not valid YAML: .+"),
    ("catalogue: demo", "catalogue: demo, only: [OSKAR 7]", 2, 36,
     r"objects\[0\]\.only\[0\]: no object of .*demo.tle has this name or number, did you mean OSCAR 7.*\?, got OSKAR 7"),
    ("catalogue: demo", "catalogue: demo, only: [25544, 25544]", 2, 43,
     r"objects\[0\]\.only\[1\]: is named twice, got 25544"),
    ("catalogue: demo", "catalogue: demo, only: []", 2, 35,
     r"objects\[0\]\.only: must name an object; without it all are taken"),
    ("catalogue: demo", "catalogue: small.yaml", 2, 23, r"objects\[0\]\.catalogue: .*small.yaml.*"),
    ("catalogue: kstars", "catalogue: small.yaml", 3, 20, r"stars\.catalogue: .*small.yaml.*"),
    ("pointing: zenith", "pointing: {target: OSCAR 77}", 5, None,
     r"sensors\[0\]\.pointing\.target: no such object, did you mean OSCAR 7.*\?, got OSCAR 77"),
    ("site: atlanta", "platform: METOP-B0", 5, None, r"sensors\[0\]\.platform: no such object.*, got METOP-B0"),
    ("duration_s: 3600", "duration_s: 3600, earth_orientation: small.yaml", 1, None,
     r"simulation\.earth_orientation: .*small.yaml:1: no modified Julian date.*"),
    ("name: beta", "name: ALPHA", 6, 12,
     r"sensors\[1\]\.name: another node has this name but for upper and lower case: alpha, got ALPHA"),
    ("name: beta", "name: operator", 6, 12, r"sensors\[1\]\.name: another node has this name, got operator"),
    ("name: beta", "name: -beta", 6, 12, r"sensors\[1\]\.name: must not begin with -, got -beta"),
    ("output: {png: false}", "effects: {abberation: off}", 8, 11,
     r"effects\.abberation: unknown key, did you mean aberration\?"),
]


def test(binary, directory):
    good = write_scenario(directory)
    done = subprocess.run([binary, "check", good], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"the good scenario passes: {done.stderr.strip()}")
    for text, bad, line, column, message in CASES:
        path = directory / "bad.yaml"
        path.write_text(good.read_text().replace(text, bad, 1))
        for command in (["check", path], ["run", path, "--out", directory / "out"]):
            done = subprocess.run([binary, *command], capture_output=True, text=True, check=False)
            said = done.stderr.rstrip("\n")
            expected = rf"(dmise: )?{re.escape(str(path))}:{line}:{column or r'[0-9]+'}: {message}"
            check(done.returncode == 2 and re.fullmatch(expected, said),
                  f"{command[0]}: {bad}: code {done.returncode}: {said}")
    check(not (directory / "out").exists(), "a refused run leaves no directory")
    for seed in ("9223372036854775808", "18446744073709551615"):  # no scenario can have it
        done = subprocess.run([binary, "run", good, "--seed", seed, "--out", directory / "out"], capture_output=True, text=True,
                              check=False)
        check(done.returncode == 2 and re.fullmatch(r".*--seed.* 9223372036854775807.*\n", done.stderr),
              f"--seed {seed}: code {done.returncode}: {done.stderr}")
    for kind in ("cameras", "sites", "materials"):
        done = subprocess.run([binary, "list", kind], capture_output=True, text=True, check=False,
                              env={**os.environ, "DMISE_HOME": "/nonexistent"})
        check(done.returncode == 2 and re.fullmatch(rf".*/nonexistent/launch/{kind}: .*DMISE_HOME.*\n", done.stderr),
              f"list {kind} of no DMISE_HOME: code {done.returncode}: {done.stderr}")


if __name__ == "__main__":
    main(test)
