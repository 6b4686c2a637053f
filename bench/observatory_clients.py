"""Clients of an observatory in real time: each slews its telescope of 1 megapixel, exposes, takes the image and solves it.

    build/observatory-venv/bin/python bench/observatory_clients.py [--clients 20] [--frames 100] [--exposure 10] [--cores 2]
        [--solve-each 1] [--blind] [--binary build/release/bin/dmise] [--out DIRECTORY]

Every client is a process of alpyca's. It writes what it was sent as a FITS file of its own with the cards that such programs write
(where the telescope says that it is, focal length, size of pixels, time), without a WCS, and `dmise solve` must find the place that
the telescope was sent to within 5 arcsec; with --blind from the width of the field alone. Printed are the time from the end of an
exposure to its whole image at the client, what was late (over 0.5 s) or not solved, the processor time, and whether `--commands`
makes the night again byte for byte. Stars are Tycho-2's: `dmise catalogue fetch tycho2`.
"""

import argparse
import filecmp
import json
import math
import multiprocessing
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

import numpy
from alpaca.camera import Camera
from alpaca.telescope import Telescope

ROOT = pathlib.Path(__file__).resolve().parents[1]
LATE_S = 0.5
SITES = ("huntsville", "atlanta", "savannah", "mcdonald")
SCENARIO = """\
simulation: {{start: 2018-01-21T02:30:00Z, duration_s: 28800, tick_s: 5, seed: 1}}
objects: [{{catalogue: demo}}]
stars: {{catalogue: tycho2, faintest_mag: 12, synthetic_to: 15}}
sensors:
{sensors}output: {{png: false}}
"""
SENSOR = """\
  - name: t{number:02d}
    site: {site}
    camera:
      name: telescope-0.3m
      optics: {{columns: 1024, rows: 1024, pixel_pitch_m: 13e-6, focal_length_m: 0.6, aperture_m: 0.3, obscuration: 0.4,
               transmission: 0.8, psf_fwhm_px: 1.8}}
      detector: {{quantum_efficiency: 0.9, dark_e_per_s: 0.1, dark_reference_c: -20, temperature_c: -20,
                 read_noise_e: 6, full_well_e: 90000, gain_e_per_dn: 1.4, bias_dn: 300, adc_bits: 16}}
      band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}
    pointing: zenith
    exposure_s: 2
    cadence_s: 3600
    sky: suburban
    mask_deg: 10
"""


def write_fits(path, image, keys):
    """A FITS file of unsigned 16-bit counts [y][x] with these cards."""
    cards = [f"SIMPLE  = {'T':>20}", f"BITPIX  = {16:>20}", f"NAXIS   = {2:>20}", f"NAXIS1  = {image.shape[1]:>20}",
             f"NAXIS2  = {image.shape[0]:>20}", f"BZERO   = {32768:>20}", f"BSCALE  = {1:>20}",
             *(f"{key:8}= " + (f"'{value}'" if isinstance(value, str) else f"{value:>20.10g}") for key, value in keys.items()), "END"]
    header = "".join(card.ljust(80) for card in cards)
    data = (image.astype(numpy.int32) - 32768).astype(">i2").tobytes()
    path.write_bytes(header.ljust(-(-len(header) // 2880) * 2880).encode() + data + b"\0" * (-len(data) % 2880))


def until(holds, every_s):
    while not holds():
        time.sleep(every_s)


def apart_arcsec(a, b):
    (ra1, dec1), (ra2, dec2) = ((math.radians(x) for x in place) for place in (a, b))
    half = math.sin((dec2 - dec1) / 2) ** 2 + math.cos(dec1) * math.cos(dec2) * math.sin((ra2 - ra1) / 2) ** 2
    return math.degrees(2 * math.asin(min(1.0, math.sqrt(half)))) * 3600


def solved(binary, path, place, blind):
    """Whether a frame is solved where the telescope was sent; and how long that took."""
    begin = time.monotonic()
    done = subprocess.run(["nice", binary, "solve", path, "--catalogue", "tycho2", "--json",
                           *(["--blind", "--field", "1.27"] if blind else [])], capture_output=True, text=True)
    took_s = time.monotonic() - begin
    if done.returncode:
        return False, took_s, done.stderr.strip().splitlines()[-1:]
    found = json.loads(done.stdout)
    offset = apart_arcsec((found["ra_deg"], found["dec_deg"]), place)
    return offset < 5.0, took_s, f"{offset:.2f} arcsec"


def observe(number, address, options, directory, results):
    draw = random.Random(number)
    telescope, camera = Telescope(address, number), Camera(address, number)
    telescope.Connected = camera.Connected = True
    telescope.Tracking = True
    time.sleep(draw.uniform(0, options.exposure))
    for frame in range(options.frames):
        hour_angle_h = draw.uniform(-2.5, 2.5)
        place = ((telescope.SiderealTime - hour_angle_h) % 24 * 15, draw.uniform(0, 60))
        telescope.SlewToCoordinatesAsync(place[0] / 15, place[1])
        until(lambda: not telescope.Slewing, 0.2)
        there = telescope.RightAscension * 15, telescope.Declination
        begin = time.monotonic()
        camera.StartExposure(options.exposure, True)
        time.sleep(max(0.0, begin + options.exposure - time.monotonic()))
        until(lambda: camera.ImageReady, 0.05)
        ready_s = time.monotonic() - begin - options.exposure
        raw = camera.ImageArrayRaw
        late_s = time.monotonic() - begin - options.exposure
        result = {"client": number, "frame": frame, "late_s": late_s, "ready_s": ready_s}
        if frame % options.solve_each == 0:
            path = directory / f"client-{number:02d}.fits"
            keys = {"RA": there[0], "DEC": there[1], "FOCALLEN": 600.0, "XPIXSZ": 13.0, "YPIXSZ": 13.0,
                    "DATE-OBS": camera.LastExposureStartTime, "EXPTIME": options.exposure}
            write_fits(path, numpy.array(raw, dtype=numpy.uint16).reshape(1024, 1024).T, {} if options.blind else keys)
            result["solved"], result["solve_s"], result["how"] = solved(options.binary, path, place, options.blind)
        results.put(result)


def serve(options, scenario, out):
    process = subprocess.Popen([options.binary, "observatory", scenario, "--out", out, "--listen", "127.0.0.1:0", "--no-discovery",
                                "--slew-rate", "10"], stdout=subprocess.PIPE, text=True)
    return process, re.search(r"http://(127\.0\.0\.1:\d+)/", process.stdout.readline()).group(1)


def night(options, scenario, directory, out):
    process, address = serve(options, scenario, out)
    results = multiprocessing.Queue()
    clients = [multiprocessing.Process(target=observe, args=(k, address, options, directory, results)) for k in range(options.clients)]
    begin = time.monotonic()
    for client in clients:
        client.start()
    found = []
    while len(found) < options.clients * options.frames:
        found.append(results.get(timeout=600 + 3 * options.exposure))
        if len(found) % options.clients == 0:
            print(f"   {len(found)} frames in {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)
    wall_s = time.monotonic() - begin
    for client in clients:
        client.join()
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=120)
    return found, wall_s


def same_tree(a, b):
    """Whether all products are the same bytes. run.json, the page and the costs have the wall clock."""
    names = sorted(path.relative_to(a) for path in a.rglob("*") if path.is_file() and path.name not in ("run.json", "index.html", "cost.jsonl"))
    return len(names), [str(name) for name in names if not (b / name).exists() or not filecmp.cmp(a / name, b / name, shallow=False)]


def figures(found, wall_s):
    late = sorted(result["late_s"] for result in found)
    tried = [result for result in found if "solved" in result]
    good = sum(result["solved"] for result in tried)
    overruns = sum(s > LATE_S for s in late)
    print(f"{len(found)} frames of {len({r['client'] for r in found})} clients in {wall_s:.0f} s, load {os.getloadavg()[0]:.1f}")
    print(f"image at the client after the end of its exposure: median {late[len(late) // 2]:.3f} s, "
          f"99 % {late[int(0.99 * (len(late) - 1))]:.3f} s, at most {late[-1]:.3f} s; {overruns} later than {LATE_S} s")
    if tried:
        took = sorted(result["solve_s"] for result in tried)
        print(f"solved: {good} of {len(tried)} ({100 * good / len(tried):.1f} %), median {took[len(took) // 2]:.2f} s of wall clock")
        for result in tried:
            if not result["solved"]:
                print(f"   client {result['client']} frame {result['frame'] + 1}: {result['how']}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=str(ROOT / "build/release/bin/dmise"))
    parser.add_argument("--clients", type=int, default=20)
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--exposure", type=float, default=10.0)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--solve-each", type=int, default=1, help="solves every so manieth frame of a client")
    parser.add_argument("--blind", action="store_true", help="solves without the place that the telescope told")
    parser.add_argument("--out", type=pathlib.Path)
    options = parser.parse_args()
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:options.cores])
    with tempfile.TemporaryDirectory() as temporary:
        directory = options.out or pathlib.Path(temporary)
        directory.mkdir(parents=True, exist_ok=True)
        scenario, out, again = directory / "scenario.yaml", directory / "night", directory / "again"
        scenario.write_text(SCENARIO.format(sensors="".join(
            SENSOR.format(number=k + 1, site=SITES[k % len(SITES)]) for k in range(options.clients))))
        found, wall_s = night(options, scenario, directory, out)
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(f"processor time of server, clients and solvers: {used.ru_utime + used.ru_stime:.0f} s, of {options.cores * wall_s:.0f} s")
        figures(found, wall_s)
        subprocess.run([options.binary, "observatory", scenario, "--commands", out / "night.jsonl", "--out", again], check=True,
                       stdout=subprocess.DEVNULL)
        count, different = same_tree(out, again)
        print(f"made again from its commands: {count} files, {len(different)} differ {different[:3]}")
        sys.exit(bool(different))


if __name__ == "__main__":
    main()
