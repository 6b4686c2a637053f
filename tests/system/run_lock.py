"""A directory is written by one run at a time: the second says whose it is and exits with 2, and the products of the
first are those of an undisturbed run, whatever command the two are.

    run_lock.py DMISE
"""

import json
import os
import shutil
import signal
import socket
import subprocess
import time

from harness import Failure, Run, check, check_same, first_frame, main, wait_until, write_scenario


def refused(binary, command, *words):
    """One line on stderr, beside notes, that holds the words; exit code 2."""
    with Run(binary, *command) as run:
        code, _ = run.finish()
        said = [line for line in run.stderr.splitlines() if not line.startswith(("note: ", "joining "))]
        check(code == 2 and len(said) == 1 and all(word in said[0] for word in words),
              f"{command[0]} beside it: code {code}: {' | '.join(said)}")


def beside_each_other(binary, directory, scenario, reference):
    for number, first in enumerate(("run", "launch")):
        out = directory / f"beside-{first}"
        with Run(binary, first, scenario, "--out", out) as run:
            wait_until((out / ".run-lock").exists, "the first to lock its directory")
            named = (f"{out}: is in use by pid {run.process.pid} on {socket.gethostname()} since 20",
                     f"dmise {first} {scenario} --out {out}")
            refused(binary, ("run", scenario, "--out", out), *named)
            if number == 0:
                refused(binary, ("launch", scenario, "--out", out, "--force"), *named)
                refused(binary, ("visible", scenario, "--out", out), *named)
            check(run.finish()[0] == 0, f"the first, {first}, is complete: {run.stderr[-300:]}")
        check_same(out, reference, f"{first}: the products are those of an undisturbed run")
        check(not (out / ".run-lock").exists(), "its lock has gone with it")


def at_the_same_moment(binary, directory, scenario, reference, rounds=3, starters=4):
    for number in range(rounds):
        out = directory / f"race-{number}"
        runs = [Run(binary, ("run", "launch")[i % 2], scenario, "--out", out) for i in range(starters)]
        codes = []
        for run in runs:
            with run:
                codes.append(run.finish()[0])
        first_words = [run.stdout for run, code in zip(runs, codes) if code == 0]
        # Who comes when the first has finished finds its products complete.
        worked = [words for words in first_words if "holds this run, complete" not in words]
        check(len(worked) == 1 and set(codes) <= {0, 2}, f"{starters} at once: one of them runs, codes {codes}")
        check_same(out, reference, "its products are those of an undisturbed run")


def after_a_kill(binary, directory, scenario, reference):
    """The launcher alone is killed; its processes end by themselves."""
    for command in ("launch", "run"):
        out = directory / f"killed-{command}"
        with Run(binary, command, scenario, "--out", out) as run:
            first_frame(out)
            os.kill(run.process.pid, signal.SIGKILL)
            with Run(binary, "run", scenario, "--out", out) as second:
                code, _ = second.finish()
                check(code == 0, f"after kill -9 of {command} another goes on at once: code {code}: {second.stderr}")
        check_same(out, reference, "the products are those of an undisturbed run")


def left_lock(out, age_s, **changes):
    """A lock such as another process, or host, leaves."""
    out.mkdir(exist_ok=True)
    holder = {"host": socket.gethostname(), "machine": "", "boot": "another", "pid": os.getpid(),
              "pid_namespace": os.readlink("/proc/self/ns/pid"), "start": 1, "since": "2026-01-01T00:00:00Z",
              "command": "dmise run", "token": "0123", "kernel_lock": False, "run": "0" * 16} | changes
    path = out / ".run-lock"
    path.write_text(json.dumps(holder) + "\n")
    os.utime(path, (time.time() - age_s,) * 2)


def of_others(binary, directory, scenario, reference):
    out = directory / "others"
    left_lock(out, 5, host="observatory-2", machine="1234")
    refused(binary, ("run", scenario, "--out", out), f"{out}: is in use by pid {os.getpid()} on observatory-2",
            "2026-01-01T00:00:00Z", "dmise run")
    boot = open("/proc/sys/kernel/random/boot_id").read().strip()
    for what, age_s, changes in (("a host that has been silent for two minutes", 120, {"host": "observatory-2"}),
                                 ("a pid that is used again", 0, {"boot": boot})):
        left_lock(out, age_s, **changes)
        with Run(binary, "run", scenario, "--out", out, "--force") as run:
            check(run.finish()[0] == 0, f"the lock of {what} is taken over: {run.stderr[-300:]}")
        check_same(out, reference, "the products are those of an undisturbed run")


def joined_elsewhere(binary, directory, scenario):
    """A node of one run does not write into the directory of another."""
    mine, theirs = directory / "mine", directory / "theirs"
    with Run(binary, "launch", scenario, "--out", mine, "--nodes-elsewhere") as launch, \
            Run(binary, "launch", scenario, "--out", theirs, "--nodes-elsewhere"):
        address = mine / "logs/master.address"
        wait_until(lambda: address.exists() and address.read_text().strip(), "the time-master")
        wait_until(lambda: json.loads((theirs / ".run-lock").read_text())["run"].strip("0"), "the other run's name")
        refused(binary, ("join", scenario, "alpha", "--master", address.read_text().strip(), "--out", theirs),
                f"{theirs}: is in use by pid", "--nodes-elsewhere")
        launch.interrupt()
        launch.finish()


def where_nothing_can_be_written(binary, directory, scenario):
    """One line, and what is said to be there is there."""
    if os.geteuid() == 0 and shutil.which("setpriv"):
        directory.chmod(0o755)
        with Run("setpriv", "--reuid=65534", "--clear-groups", binary, "run", scenario, "--out", "/") as run:
            code, _ = run.finish()
            check(code == 1 and run.stderr == "dmise: /: can't be written: Permission denied\n", run.stderr)
    # Full from the start, after some frames, at the end.
    for size_kb in (0, 64, 1500):
        disk = directory / "disk"
        script = (f"mkdir -p {disk} && mount -t tmpfs -o size={size_kb or 4}k none {disk} && "
                  + (f"(cat /dev/zero >{disk}/fill 2>/dev/null; true) && " if not size_kb else "")
                  + f"{binary} run {scenario} --out {disk}/out; code=$?; "
                  f"[[ $code == 0 ]] || ls {disk}/out >{directory}/there; exit $code")
        done = subprocess.run(["unshare", "-rm", "bash", "-c", script], capture_output=True, text=True, timeout=120)
        if "unshare" in done.stderr or "mount:" in done.stderr:
            print(f"not tried on a full disk: {done.stderr.strip()}")
            return
        said = [line for line in done.stderr.splitlines() if not line.startswith(("note: ", "simulated "))]
        check(done.returncode == 1 and len(said) == 1 and "No space left on device" in said[0],
              f"a disk of {size_kb} kB: code {done.returncode}: {' | '.join(said)}")
        there = (directory / "there").read_text().split()
        for line in done.stdout.splitlines():
            if line.startswith(("open ", "or ")):
                check(line.rsplit("/", 1)[1] in there or "frame-" in line, f"it is there: {line}")


def test(binary, directory):
    scenario = write_scenario(directory, duration_s=60)
    reference = directory / "reference"
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0, "an undisturbed run is complete")
    beside_each_other(binary, directory, scenario, reference)
    at_the_same_moment(binary, directory, scenario, reference)
    after_a_kill(binary, directory, scenario, reference)
    of_others(binary, directory, scenario, reference)
    joined_elsewhere(binary, directory, scenario)
    where_nothing_can_be_written(binary, directory, scenario)


if __name__ == "__main__":
    main(test)
