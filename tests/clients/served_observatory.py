"""What tests of an observatory's doors share: the server, its night, and the same night made again."""

import json
import pathlib
import re
import signal
import socket
import subprocess
import sys

import astropy.io.fits

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/system"))
from harness import Failure, check, check_same, main, wait_until  # noqa: E402, F401

SCENARIO = ROOT / "launch/scenarios/observatory.yaml"
ARCSEC = 1 / 3600


def argument(name, otherwise):
    return int(sys.argv[sys.argv.index(name) + 1]) if name in sys.argv else otherwise


def free_udp_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Served:
    """`dmise observatory` on a free port, until it is ended as by Ctrl-C."""

    def __init__(self, binary, out, *arguments, scenario=SCENARIO):
        self.process = subprocess.Popen([binary, "observatory", scenario, "--out", out, "--listen", "127.0.0.1:0", *arguments],
                                        stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        line = self.process.stdout.readline()
        found = re.search(r"http://(127\.0\.0\.1:\d+)/setup", line)
        if not found:
            raise Failure(f"no address in {line!r}")
        self.address = found.group(1)
        indi = re.search(r"INDI at 127\.0\.0\.1:(\d+)", line)
        self.indi_port = int(indi.group(1)) if indi else None
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.rest = self.process.communicate(timeout=60)[0]


def journal(out):
    path = out / "night.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def path_of(out, sensor, frame):
    path = out / sensor / f"frame-{frame:06d}.fits"
    wait_until(lambda: sum(1 for line in journal(out) if line["sensor"] == sensor and line["frame"] == frame), path.name)
    return path


def file_of(out, sensor, frame):
    return astropy.io.fits.open(path_of(out, sensor, frame))[0]


def same_again(binary, out, directory, scenario=SCENARIO):
    again = directory / "again"
    subprocess.run([binary, "observatory", scenario, "--commands", out / "night.jsonl", "--out", again], check=True,
                   stdout=subprocess.PIPE)
    check_same(again, out, f"the night of {len(journal(out))} exposures is made again, byte for byte")
