"""Commands of an observatory: a frame on command is that of a run with the same pointing, byte for byte, for any number of threads;
what cannot be done is one clear line, and leaves nothing behind.

    observatory.py DMISE
"""

import json
import socket
import subprocess

from harness import check, check_same, main, products

SCENARIO = """simulation: {{start: 2018-01-21T00:30:00Z, duration_s: 60, tick_s: 5, seed: 3}}
objects: [{{catalogue: demo}}]
stars: {{catalogue: kstars, synthetic_to: 12}}
sensors:
  - name: fixed
    site: huntsville
    camera: small.yaml
    pointing: {{azimuth_deg: 150, elevation_deg: 50}}
    {times}
  - name: moving
    site: huntsville
    camera: small.yaml
    pointing: {{ra_deg: 60, dec_deg: 30, ra_rate_deg_per_s: 0.01, dec_rate_deg_per_s: -0.02, tracking: moving}}
    {times}
output: {{png: false}}
"""
CAMERA = """\
optics: {projection: gnomonic, columns: 384, rows: 256, pixel_pitch_m: 1.1e-5, focal_length_m: 0.04, aperture_m: 0.03}
detector: {full_well_e: 90000, gain_e_per_dn: 1.4, read_noise_e: 2, bias_dn: 100, dark_e_per_s: 0.2}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
"""
STARTS_S, LENGTH_S = (7.5, 27.5, 47.5), 2
NODES = "nodes:\n  - {name: eye, run: [python3, eye.py]}\n"


def night(starts_s=STARTS_S):
    """Lines of the commands that point as the scenario does."""
    for frame, start_s in enumerate(starts_s, 1):
        of_both = {"frame": frame, "start_ns": round(start_s * 1e9), "exposure_ns": LENGTH_S * 10**9, "roll_deg": 0, "bin": [1, 1],
                   "window": [0, 0, 384, 256], "gain": 0, "offset": 0, "temperature_c": 0}
        yield {"sensor": "fixed", "azimuth_deg": 150, "elevation_deg": 50} | of_both
        middle_s = start_s + LENGTH_S / 2
        yield {"sensor": "moving", "ra_deg": 60 + 0.01 * middle_s, "dec_deg": 30 - 0.02 * middle_s, "ra_rate_deg_per_s": 0.01,
               "dec_rate_deg_per_s": -0.02, "reference_ns": round(middle_s * 1e9)} | of_both


def refused(binary, directory, what, *arguments, code=2):
    done = subprocess.run([binary, "observatory", *arguments, "--out", directory / "refused"], capture_output=True, text=True)
    lines = [line for line in done.stderr.splitlines() if not line.startswith("note: ")]
    check(done.returncode == code and len(lines) == 1 and what in lines[0], f"refused in one line: {lines}")
    check(not (directory / "refused").exists(), "and nothing is left behind")


def test(binary, directory):
    (directory / "small.yaml").write_text(CAMERA)
    scenario, commands = directory / "scenario.yaml", directory / "night.jsonl"
    text = SCENARIO.format(times=f"first_exposure_s: {STARTS_S[0]}\n    exposure_s: {LENGTH_S}\n    cadence_s: 20")
    scenario.write_text(text)
    commands.write_text("".join(json.dumps(line) + "\n" for line in night()))
    subprocess.run([binary, "run", scenario, "--out", directory / "run"], check=True, capture_output=True)
    for threads in ("1", "3"):
        out = directory / f"commanded-{threads}"
        subprocess.run([binary, "observatory", scenario, "--commands", commands, "--out", out, "--threads", threads], check=True,
                       capture_output=True)
        journal = out / "night.jsonl"
        check(len(journal.read_text().splitlines()) == 6, "every exposure stands in the journal")
        journal.unlink()
    check_same(directory / "commanded-3", directory / "commanded-1", "three threads make what one makes")
    check_same(directory / "commanded-1", directory / "run", "frames on command are those of a run that points there")
    check(len(products(directory / "run")) > 6, "with detections and truth")

    refused(binary, directory, "not loopback: needs a file of tokens", scenario, "--listen", "0.0.0.0:0")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        refused(binary, directory, "in use", scenario, "--listen", f"127.0.0.1:{port}", code=1)
    refused(binary, directory, "No such file", scenario, "--commands", directory / "none.jsonl")
    commands.write_text(json.dumps(next(night((59,)))) + "\n")
    refused(binary, directory, "night.jsonl:1: start_ns: the exposure is not within the scenario", scenario, "--commands", commands)
    (directory / "eye.py").touch()
    scenario.write_text(text.replace("objects: [", "objects: [{name: own, motion: {node: eye}, radius_m: 1}, ") + NODES)
    refused(binary, directory, "nodes[0]: an observatory starts no programs", scenario)
    scenario.write_text(text.replace("site: huntsville", 'platform: "29499"').replace("{azimuth_deg: 150, elevation_deg: 50}", "zenith"))
    refused(binary, directory, "needs a camera at a site", scenario)


if __name__ == "__main__":
    main(test)
