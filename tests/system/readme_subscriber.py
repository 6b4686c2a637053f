"""The subscriber that README.md tells of hears the detections of a launched run from anywhere, tells their UTC and ends
with the run; what it lacks it names.

    readme_subscriber.py DMISE
"""

import datetime
import json
import pathlib
import re
import shutil
import socket
import subprocess
import sys

from harness import PATIENCE_S, Run, check, main, wait_until, write_scenario

ROOT = pathlib.Path(__file__).resolve().parents[2]
START = datetime.datetime(2018, 1, 21, 0, 15, tzinfo=datetime.timezone.utc)  # start of the harness's scenarios


def said(directory, *command):
    """Exit code and last words of a command that is to end by itself."""
    done = subprocess.run(command, cwd=directory, capture_output=True, text=True, timeout=60)
    return done.returncode, done.stderr.strip()


def hears_a_run(binary, directory, subscriber):
    out = directory / "out"
    announced = out / "logs/master.address"
    with Run(binary, "launch", write_scenario(directory, duration_s=1500), "--out", out) as run:
        wait_until(lambda: announced.exists() and announced.read_text().strip(), "the time-master's address")
        heard = subprocess.run([sys.executable, subscriber, announced.read_text().strip()], cwd=directory,
                               capture_output=True, text=True, timeout=PATIENCE_S)
        check(run.finish()[0] == 0, "the run is complete")
    check(heard.returncode == 0, f"it ends by itself with the run: code {heard.returncode}: {heard.stderr.strip()}")
    lines = [line.split() for line in heard.stdout.splitlines()]
    times = {}
    for line in (out / "detections.jsonl").read_text().splitlines():
        detection = json.loads(line)
        times[detection["id"]] = START + datetime.timedelta(microseconds=detection["time_ns"] // 1000)
    check(lines and {line[0] for line in lines} <= times.keys(),
          f"it heard {len(lines)} detections of the run's {len(times)}")
    check(all(datetime.datetime.fromisoformat(line[1]) == times[line[0]] for line in lines),
          f"each with its UTC: {' '.join(lines[0])}")


def fails_with(binary, directory, subscriber):
    with Run(binary, "launch", write_scenario(directory, name="failing.yaml"), "--out", directory / "failing") as run:
        announced = directory / "failing/logs/master.address"
        wait_until(lambda: announced.exists() and announced.read_text().strip(), "the time-master's address")
        with Run(sys.executable, subscriber, announced.read_text().strip()) as listening:
            wait_until(lambda: list((directory / "failing").glob("*/frame-000002.fits")), "a frame")
            run.interrupt()
            run.finish()
            code, _ = listening.finish()
            check(code == 1, f"a run that ends before its time: code {code}: {listening.stderr.strip()}")


def names_what_it_lacks(directory, subscriber):
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))  # and does not listen
        address = f"tcp://127.0.0.1:{nobody.getsockname()[1]}"
        code, words = said(directory, sys.executable, subscriber, address)
        within = re.fullmatch(re.escape(address) + r": no time-master answers within ([0-9.]+) s", words)
        check(code == 1 and within and float(within[1]) <= 5, f"a wrong address: code {code}: {words}")
    code, words = said(directory, sys.executable, subscriber, "127.0.0.1:7998")
    check(code == 1 and "tcp://HOST:PORT" in words, f"an address without transport: {words}")
    code, words = said(directory, sys.executable, "-S", "-E", subscriber, address)
    check(code == 1 and "pyzmq" in words and "python3-protobuf" in words, f"without packages: {words}")
    elsewhere = directory / "clients/python"
    elsewhere.mkdir(parents=True)
    shutil.copy(subscriber, elsewhere)
    code, words = said(directory, sys.executable, elsewhere / subscriber.name, address)
    check(code == 1 and "./dmise build" in words, f"without the messages: {words}")


def test(binary, directory):
    command = re.search(r"\n    (\S+) \"\$\(cat out/demo/logs/master\.address\)\"\n", (ROOT / "README.md").read_text())
    subscriber = ROOT / command[1]
    names_what_it_lacks(directory, subscriber)
    hears_a_run(binary, directory, subscriber)
    fails_with(binary, directory, subscriber)


if __name__ == "__main__":
    main(test)
