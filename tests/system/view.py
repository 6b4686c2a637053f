"""The live view: what a browser shows of a run, and that the run does not notice it.

    view.py DMISE
"""

import http.client
import json
import os
import pathlib
import random
import shutil
import signal
import socket
import struct
import subprocess
import sys
import urllib.parse
import zlib

from harness import CAMERA, Run, check, check_same, first_frame, main, wait_until

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULES = ROOT / "build/node/node_modules"
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 5, seed: 1}}
objects: [{{catalogue: demo}}]
stars: {{catalogue: kstars}}
sensors:
  - {{name: alpha, site: atlanta, camera: small.yaml, pointing: zenith, exposure_s: 2, cadence_s: 10}}
  - {{name: beta, site: la-palma, camera: small.yaml, pointing: zenith, exposure_s: 2, cadence_s: 10}}
network: {{real_time: {real_time}}}
output: {{png: true}}
"""


def write(directory, name, duration_s, real_time):
    # So wide that something is in many frames.
    wide = CAMERA.replace("field_of_view_deg: 15", "field_of_view_deg: 70").replace("aperture_m: 0.02", "aperture_m: 0.003")
    (directory / "small.yaml").write_text(wide)
    path = directory / name
    path.write_text(SCENARIO.format(duration_s=duration_s, real_time=real_time))
    return path


def url_of(out):
    path = out / "logs/view.url"
    wait_until(path.exists, "the URL of the live view")
    return path.read_text().strip()


def killing_it_changes_nothing(binary, directory):
    scenario = write(directory, "short.yaml", 60, 0)
    whole, seen = directory / "whole", directory / "seen"
    subprocess.run([binary, "run", scenario, "--out", whole], check=True, capture_output=True)
    with Run(binary, "launch", scenario, "--out", seen, "--view") as run:
        url_of(seen)
        first_frame(seen)
        gateway = run.node("gateway")
        check(gateway is not None, "a gateway runs beside the run")
        os.kill(gateway, signal.SIGKILL)
        code, _ = run.finish()
        check(code == 0, "the run does not notice that the gateway was killed" + (run.stderr[-300:] if code else ""))
        check("live view: http://127.0.0.1:" in run.stdout + run.stderr, "the launcher tells the URL")
    check_same(seen, whole, "its products are those of a run that nobody watched")


def another_pace_changes_nothing(binary, directory):
    """At the scenario's pace the run would take 16 hours."""
    scenario = write(directory, "slow.yaml", 60, 0.001)
    whole, paced = directory / "unpaced", directory / "paced"
    subprocess.run([binary, "run", scenario, "--out", whole], check=True, capture_output=True)
    with Run(binary, "launch", scenario, "--out", paced) as run:
        wait_until((paced / "logs/master.address").exists, "the address of the time-master")
        master = (paced / "logs/master.address").read_text().strip()
        wait_until(lambda: "tick 0 of" in status_of(binary, master), "the first tick")
        check("pace: 0.001 times real time" in status_of(binary, master), "a run keeps the pace of its scenario")
        stepped = subprocess.run([binary, "clock", "step", master, "2"], capture_output=True, text=True)
        check(stepped.returncode == 0, f"clock step ADDRESS 2 makes two ticks {stepped.stderr.strip()}")
        subprocess.run([binary, "clock", "go-on", master], check=True, capture_output=True)
        done = subprocess.run([binary, "clock", "pace", master, "-1"], capture_output=True, text=True)
        check(done.returncode == 2, f"a pace that is none is refused: {done.stderr.strip().splitlines()[0]}")
        for pace in ("0.005", "0"):
            subprocess.run([binary, "clock", "pace", master, pace], check=True, capture_output=True)
        code, _ = run.finish()
        check(code == 0, "as fast as possible it ends" + (run.stderr[-300:] if code else ""))
    log = (paced / "logs/time-master.log").read_text()
    for asked in ("step 2 ticks", "go on", "keep a pace of 0.005 times real time", "run as fast as possible"):
        check(f"asked to {asked}" in log, f"the log of the clock says that it was asked to {asked}")
    check_same(paced, whole, "and its products are those of any other pace")


def status_of(binary, master):
    return subprocess.run([binary, "status", master, "--once"], capture_output=True, text=True).stdout


def truths_of(out, sensor, frame):
    """How many objects are in a frame, by the sensor's own file."""
    lines = (out / sensor / "truth.jsonl").read_text().splitlines()
    return sum(t["in_frame"] for t in map(json.loads, lines) if t["frame"] == frame)


def a_dead_address_is_told(binary):
    with socket.socket() as nobody:  # bound, and nobody listens
        nobody.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{nobody.getsockname()[1]}"
        done = subprocess.run([binary, "view", address, "--answer-within", "1"], capture_output=True, text=True, timeout=60)
    check(done.returncode == 1 and f"{address}: no time-master answers within 1 s" in done.stderr,
          f"view of a dead address ends: {done.returncode} {done.stderr.strip()[-200:]}")


def hostile_clients_do_not_disturb(url, seed=7):
    """Bytes that no browser sends, then a request that is answered."""
    place = urllib.parse.urlsplit(url)
    draw = random.Random(seed)
    handshake = (b"GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                 b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n")
    for trial in range(60):
        with socket.create_connection((place.hostname, place.port), timeout=20) as client:
            bytes_ = draw.randbytes(draw.randrange(1, 3000))
            if trial % 3 == 1:
                bytes_ = handshake + bytes_
            elif trial % 3 == 2:  # a handshake with one byte changed
                at = draw.randrange(len(handshake))
                bytes_ = handshake[:at] + draw.randbytes(1) + handshake[at + 1:] + bytes_
            try:
                client.sendall(bytes_)
                client.shutdown(socket.SHUT_WR)
            except OSError:
                pass  # it was closed before
    answer = http.client.HTTPConnection(place.hostname, place.port, timeout=60)
    answer.request("GET", "/", headers={"Host": "localhost"})
    check(answer.getresponse().status == 200, "60 hostile clients do not disturb the gateway")
    foreign = http.client.HTTPConnection(place.hostname, place.port, timeout=60)
    foreign.request("GET", "/", headers={"Host": "foreign.example"})
    check(foreign.getresponse().status == 421, "nor does a foreign name lead to it")


def tool_that_misses(binary):
    """What a browser's test needs and is not there; ""."""
    for name in ("node", "chromium"):
        if not shutil.which(name):
            return name
    if not (binary.parent.parent / "dashboard/index.html").exists():
        return "the dashboard (./dmise dashboard)"
    return "" if (MODULES / "playwright-core").exists() and (MODULES / "axe-core").exists() else f"playwright-core in {MODULES}"


def a_browser_shows_it(url, directory, out):
    script = pathlib.Path(__file__).parent / "view/browser.mjs"
    done = subprocess.run(["node", script, MODULES, shutil.which("chromium"), url, "alpha", directory / "page.png"],
                          capture_output=True, text=True, timeout=280, env=os.environ | {"HOME": str(directory)})
    check(done.returncode == 0, "a browser shows the run" + done.stderr.strip()[-600:])
    found = json.loads(done.stdout.strip().splitlines()[-1])
    print(json.dumps(found))
    check(found["errors"] == [], f"without an error in its console {found['errors'][:3]}")
    check(found["foreign"] == [], f"and nothing from elsewhere {found['foreign'][:3]}")
    check(found["objects"] > 900 and found["nodes"] == 5, f"{found['objects']} objects, {found['nodes']} nodes")
    check(found["lit"], f"a click on a sensor shows its last frame, {found['click_ms']} ms later")
    check(found["pace"] == 50, f"the clock runs as fast as was chosen: {found['pace']} times real time")
    check(found["shows_truth"] and 0 < found["truths"] == truths_of(out, "alpha", found["frame"]),
          f"the truth of frame {found.get('frame')} is shown: {found.get('truths')} objects")
    check(found["later_s"] == found["paused_s"], f"a pause stops the simulation's time, at {found['paused_s']} s")
    check(found["past_s"] < found["paused_s"], f"the past is shown: {found['past_s']} s")
    check(found["violations"] == [], f"axe-core finds no violation in {found['checked']} checks {found['violations']}")


def dark_preview(path, columns=640, rows=480):
    """A picture as `preview` draws a field of few stars: sky and noise in the darkest eighth of its greys."""
    draw = random.Random(1)
    pixels = [bytearray(min(255, max(0, round(draw.gauss(31, 11)))) for _ in range(columns)) for _ in range(rows)]
    for _ in range(60):
        pixels[draw.randrange(rows)][draw.randrange(columns)] = draw.randrange(100, 256)
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", columns, rows, 8, 0, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in pixels))) + chunk(b"IEND", b""))


def it_fits_screens(binary, directory):
    dark_preview(directory / "dark.png")
    script = pathlib.Path(__file__).parent / "view/layout.mjs"
    done = subprocess.run(["node", script, MODULES, shutil.which("chromium"), binary.parent.parent / "dashboard", directory / "dark.png",
                           directory], capture_output=True, text=True, timeout=280, env=os.environ | {"HOME": str(directory)})
    check(done.returncode == 0, "a browser shows a run of eight sites" + done.stderr.strip()[-600:])
    found = json.loads(done.stdout.strip().splitlines()[-1])
    print(json.dumps(found))
    check(found["errors"] == [], f"without an error {found['errors']}")
    check(found["names"] >= 7 and found["meeting"] == 0, f"of {found['names']} names on the globe {found['meeting']} meet others")
    check(50 <= found["median"] <= 130, f"half of a dark frame's pixels are shown brighter than {found['median']} of 255")
    phone = found["phone"]
    check(abs(phone["seen_px"] - phone["frame_px"]) <= 1 and phone["frame_px"] > 250 and phone["wide_px"] <= 390,
          f"a phone shows {phone['seen_px']} of {phone['frame_px']} px of the frame, and nothing is wider than it: {phone['wide_px']} px")


def test(binary, directory):
    a_dead_address_is_told(binary)
    killing_it_changes_nothing(binary, directory)
    another_pace_changes_nothing(binary, directory)
    scenario, out = write(directory, "long.yaml", 36000, 20), directory / "out"
    with Run(binary, "launch", scenario, "--out", out, "--view", "--view-truth") as run:
        url = url_of(out)
        first_frame(out)
        hostile_clients_do_not_disturb(url)
        missing = tool_that_misses(binary)
        if not missing:
            a_browser_shows_it(url, directory, out)
        run.interrupt()
        run.finish()
        run.nothing_left()
    if not missing:
        it_fits_screens(binary, directory)
    if missing:
        print(f"skipped: no browser shows the page: there is no {missing}")
        sys.exit(77)


main(test)
