"""What stands in the way of a run is said in one clear line, with a code other than 0 and nothing left.

    refusals.py DMISE
"""

import os
import socket
import subprocess

from harness import Run, check, main, write_scenario

PATIENCE_S = 20.0


def refused(run, why, code, *words):
    """The run ends with `code`; its last line on stderr, and no other but notes, holds `words`."""
    got, _ = run.finish(PATIENCE_S)
    said = [line for line in run.stderr.splitlines() if line.strip() and not line.startswith("note: ")
            and not line.startswith("simulated ")]
    check(got == code and len(said) == 1 and all(word in said[0] for word in words),
          f"{why}: code {got}: {' | '.join(said)}")
    run.nothing_left()


def test(binary, directory):
    good = write_scenario(directory)

    bad = write_scenario(directory, objects=directory / "absent.tle", name="catalogue.yaml")
    with Run(binary, "launch", bad, "--out", directory / "a") as run:
        refused(run, "missing catalogue", 2, "catalogue.yaml:2:", "objects[0].catalogue", "absent.tle")

    bad = write_scenario(directory, first="alpha", second="alpha", name="names.yaml")
    with Run(binary, "launch", bad, "--out", directory / "b") as run:
        refused(run, "two nodes of one name", 2, "names.yaml:6:", "sensors[1].name", "alpha")

    with Run(binary, "launch", directory / "absent.yaml", "--out", directory / "c") as run:
        refused(run, "no scenario", 2, "absent.yaml")

    (directory / "file").write_text("")
    with Run(binary, "launch", good, "--out", directory / "file/out") as run:
        refused(run, "directory that can't be made", 1, "file/out")

    with Run(binary, "launch", good, "--out", "/proc") as run:
        refused(run, "directory that can't be written", 1, "/proc")

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        address = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
        with Run(binary, "launch", good, "--out", directory / "d", "--bind", address) as run:
            refused(run, "port in use", 1, address, "in use")

    keys = directory / "keys"
    subprocess.run([str(binary), "keygen", str(keys), "--scenario", str(good)], check=True, stdout=subprocess.DEVNULL)
    whole = (keys / "alpha.pub").read_text()
    (keys / "alpha.pub").write_text(whole[:20])
    with Run(binary, "launch", good, "--out", directory / "e", "--keys", keys) as run:
        refused(run, "truncated key", 1, f"{keys}/alpha.pub: not a key of dmise keygen", "13 of 40 characters")
    (keys / "alpha.pub").unlink()
    os.mkfifo(keys / "alpha.pub")
    with Run(binary, "launch", good, "--out", directory / "f", "--keys", keys) as run:
        refused(run, "FIFO for a key", 1, f"{keys}/alpha.pub: is a FIFO, not a regular file")

    for out, reason in ((directory / ("n" * 300), "can't be made"), ("/proc", "can't be written"),
                        ("/proc/x", "can't be made"), (directory / "file/out", "is not a directory")):
        with Run(binary, "check", good, "--out", out) as run:
            refused(run, "check of a directory that a run could not write", 2, "--out: ", reason)
    with Run(binary, "check", good, "--hosts", "3") as run:
        refused(run, "hosts without keys", 2, "--hosts", "--keys")
    zoned = directory / "zoned.yaml"
    zoned.write_text(good.read_text().replace("2018-01-21T00:15:00Z", "2018-01-21 00:15:00").replace(
        "duration_s: 3600", "duration_s: 60"))
    done = subprocess.run([binary, "check", zoned, "--json", "--out", directory / "g/h"], capture_output=True, text=True,
                          check=False)
    check(done.returncode == 0 and not (directory / "g").exists(), f"check leaves no directory: {done.stderr}")
    check('"start_utc":"2018-01-21T00:15:00.000000Z","duration_s":60,' in done.stdout, f"UTC and seconds: {done.stdout[:200]}")
    first = directory / "first.yaml"
    first.write_text(good.read_text().replace("2018-01-21T00:15:00Z", "1972-01-01T00:00:00Z").replace(
        "duration_s: 3600", "duration_s: 10"))
    done = subprocess.run([binary, "check", first], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"runs may begin with UTC's first whole second: {done.stderr}")


if __name__ == "__main__":
    main(test)
