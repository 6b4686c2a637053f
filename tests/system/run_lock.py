"""A directory is written by one run at a time: the second says whose it is and exits with 2, and the products of the
first are those of an undisturbed run, whatever command the two are.

    run_lock.py DMISE
"""

import json
import os
import pathlib
import re
import signal
import socket
import subprocess

from harness import Run, check, check_same, first_frame, main, wait_until, without_rights, write_scenario


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
        worked = [words for words in first_words if "contains this run, complete" not in words]
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


def left_by_others(binary, directory, scenario, reference):
    """A lock file that no process holds is in nobody's way, whatever it says."""
    out = directory / "others"
    out.mkdir()
    holder = {"host": "observatory-2", "pid": os.getpid(), "since": "2026-01-01T00:00:00Z", "command": "dmise run", "run": "0" * 16}
    (out / ".run-lock").write_text(json.dumps(holder) + "\n")
    with Run(binary, "run", scenario, "--out", out, "--force") as run:
        check(run.finish()[0] == 0, f"it is taken over: {run.stderr[-300:]}")
    check_same(out, reference, "the products are those of an undisturbed run")


def joined_elsewhere(binary, directory, scenario):
    """A node of one run does not write into the directory of another."""
    mine, theirs = directory / "mine", directory / "theirs"
    with Run(binary, "launch", scenario, "--out", mine, "--nodes-elsewhere") as launch, \
            Run(binary, "launch", scenario, "--out", theirs, "--nodes-elsewhere"):
        address = mine / "logs/master.address"
        wait_until(lambda: address.exists() and address.read_text().strip(), "the time-master")
        lock = theirs / ".run-lock"
        wait_until(lambda: lock.exists() and json.loads(lock.read_text())["run"].strip("0"), "the other run's name")
        refused(binary, ("join", scenario, "alpha", "--master", address.read_text().strip(), "--out", theirs),
                f"{theirs}: is in use by pid", "--nodes-elsewhere")
        launch.interrupt()
        launch.finish()


def where_nothing_can_be_written(binary, directory, scenario):
    """One line, and what is said to be there is there."""
    if words := without_rights(binary, directory):
        with Run(*words, binary, "run", scenario, "--out", "/") as run:
            code, _ = run.finish()
            check(code == 1 and run.stderr == "dmise: /: can't be written: Permission denied\n", run.stderr)


FULL_DISK = """\
mount -t tmpfs -o size={size}k none {disk} || exit 99
[[ {size} != 4 ]] || cat /dev/zero >{disk}/fill 2>/dev/null
{binary} run {scenario} --out {disk}/out >{disk}.said
code=$?
sed -nE 's/^(open|or) +//p' {disk}.said | while read -r file; do [[ -e $file ]] || echo "not there: $file" >&2; done
rm -f {disk}/fill
mount -o remount,size=64m {disk}
echo again >&2
{binary} run {scenario} --out {disk}/out | sed -nE 's/^(open|or) +//p' | while read -r file; do
  [[ -e $file ]] || echo "not there: $file" >&2
done
cp -r {disk}/out {disk}.after
exit $code
"""


def on_a_full_disk(binary, directory):
    """Full from the start, after some frames, and when lines are merged and pages are written at the end."""
    scenario = write_scenario(directory, duration_s=10, name="short.yaml")
    reference = directory / "short"
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0, "an undisturbed run is complete")
    needed_kb = sum(-(-path.stat().st_size // 4096) * 4 for path in reference.rglob("*") if path.is_file())
    for number, size_kb in enumerate((4, 64, needed_kb // 2, needed_kb - 16, needed_kb - 8, needed_kb - 4, needed_kb)):
        disk = directory / f"disk-{number}"
        disk.mkdir()
        script = FULL_DISK.format(size=size_kb, disk=disk, binary=binary, scenario=scenario)
        done = subprocess.run(["unshare", "-rm", "bash", "-c", script], capture_output=True, text=True, timeout=120)
        if done.returncode == 99 or "unshare" in done.stderr:
            print(f"not tried on a full disk: {done.stderr.strip()}")
            return
        first, after = done.stderr.split("again\n")
        said = [line for line in first.splitlines() if not line.startswith(("note: ", "simulated "))]
        fits = done.returncode == 0 and not said
        check(fits or (done.returncode == 1 and len(said) == 1 and "No space left on device" in said[0]),
              f"a disk of {size_kb} kB, of {needed_kb}: code {done.returncode}: {' | '.join(said)}")
        if 64 <= size_kb <= needed_kb // 2:
            check(".fits:" in said[0], "the frame that could not be written is the reason, not what failed after it")
        check("not there" not in after, f"what is offered to be opened is there {after[-200:]}")
        check_same(pathlib.Path(f"{disk}.after"), reference, "with room again the run goes on to the same products")

    (reference / "index.html").unlink()  # as a disk that was full at the very end left a complete run
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0 and "contains this run, complete" in run.stdout, run.stdout.splitlines()[0])
        for file in re.findall(r"^(?:open|or) +(.*)$", run.stdout, re.MULTILINE):
            check(pathlib.Path(file).exists(), f"what is offered to be opened is there: {file}")
        check((reference / "index.html").exists(), "the page is made again")


def test(binary, directory):
    scenario = write_scenario(directory, duration_s=60)
    reference = directory / "reference"
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0, "an undisturbed run is complete")
    beside_each_other(binary, directory, scenario, reference)
    at_the_same_moment(binary, directory, scenario, reference)
    after_a_kill(binary, directory, scenario, reference)
    left_by_others(binary, directory, scenario, reference)
    joined_elsewhere(binary, directory, scenario)
    where_nothing_can_be_written(binary, directory, scenario)
    on_a_full_disk(binary, directory)


if __name__ == "__main__":
    main(test)
