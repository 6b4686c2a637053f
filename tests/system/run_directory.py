"""A run replaces its own products, and touches nothing else; commands say when their output is lost.

    run_directory.py DMISE
"""

import json
import os
import pathlib
import shutil
import signal
import subprocess

from harness import PATIENCE_S, Run, check, check_same, first_frame, main, without_rights, write_scenario


def made(*command):
    with Run(*command) as run:
        code, _ = run.finish()
        return code, run.stdout, run.stderr


def other_runs_stay(binary, directory, scenario):
    out = directory / "out"
    check(made(binary, "run", scenario, "--out", out / "first")[0] == 0, "a run in out/first")
    before = {path: path.read_bytes() for path in (out / "first").rglob("*") if path.is_file()}
    check(made(binary, "run", scenario, "--out", out)[0] == 0, "a run in out")
    check(all(path.read_bytes() == content for path, content in before.items()), f"the {len(before)} files in out/first are there")
    code, _, said = made(binary, "run", scenario, "--out", out, "--seed", "2", "--force")
    check(code == 0 and (out / "first/run.json").exists(), f"and after --force: {said[-200:]}")

    inner = directory / "inner"
    check(made(binary, "run", scenario, "--out", inner / "alpha")[0] == 0, "a run in a sensor's name")
    for more in ((), ("--force",)):
        code, _, said = made(binary, "run", scenario, "--out", inner, *more)
        check(code == 2 and "inner/alpha: is the directory of a run" in said, f"code {code}: {said}")


def files_of_users_stay(binary, directory, scenario):
    for command in ("run", "launch"):
        out = directory / f"project-{command}"
        (out / "alpha").mkdir(parents=True)
        thesis, page = out / "alpha/thesis.txt", out / "index.html"
        thesis.write_text("thesis")
        page.write_text("mine")
        for text in ("index.html: is in the way", "alpha: is in the way"):
            code, _, said = made(binary, command, scenario, "--out", out)
            check(code == 2 and text in said and thesis.read_text() == "thesis", f"code {code}: {said}")
            check(not page.exists() or page.read_text() == "mine", "the page is the user's")
            page.unlink(missing_ok=True)
        code, _, said = made(binary, command, scenario, "--out", out, "--force")
        check(code == 0 and thesis.read_text() == "thesis", f"with --force the thesis stays: {said[-200:]}")
        code, _, said = made(binary, command, scenario, "--out", out, "--seed", "2", "--force")
        check(code == 0 and thesis.read_text() == "thesis", f"and again: {said[-200:]}")


def killed_while_clearing(binary, directory, scenario):
    reference, out = directory / "out/first", directory / "half"
    shutil.copytree(reference, out)
    (out / "run.json").write_text('{"status":"clearing"}\n')
    check(made(binary, "run", scenario, "--out", out)[0] == 0, "a directory that was being cleared is taken")
    check_same(out, reference, "the products are those of an undisturbed run")


def check_leaves_nothing(binary, directory):
    scenario = write_scenario(directory, duration_s=10, first="nothing-of-this-name-1",
                              second="nothing-of-this-name-2", name="check.yaml")
    code, _, said = made(*(without_rights(binary, directory) or []), binary, "check", scenario)
    check(code == 0, f"any user may check: code {code}: {said}")
    code, _, said = made(binary, "check", scenario, "--json")
    left = list(pathlib.Path("/").glob("nothing-of-this-name-*"))
    check(code == 0 and not left, f"check leaves nothing behind: {left}")


def lost_output(binary, directory, scenario):
    frame = next((directory / "out/first/alpha").glob("frame-*1.fits"))
    for command in (("detect", frame, "--report"), ("check", scenario), ("schema", "scenario"), ("list", "sites"), ("man",),
                    ("completion", "bash"), ("--help",), ("--version",)):
        command = [str(word) for word in (binary, *command)]
        with open("/dev/full", "w") as full:
            done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=PATIENCE_S)
        said = [line for line in done.stderr.splitlines() if not line.startswith("note: ")]
        check(done.returncode == 1 and len(said) == 1 and said[0].startswith("dmise: standard output can't be written"),
              f"{command[1]} to a full disk: code {done.returncode}: {done.stderr}")
        headed = subprocess.run(["bash", "-c", '"$@" | true', "-", *command], capture_output=True, text=True,
                                timeout=PATIENCE_S)
        check("written" not in headed.stderr, "a reader that goes away is no error")


def goes_on_without_a_node(binary, directory):
    """What was dropped is told, and is made by the same command."""
    scenario = write_scenario(directory, duration_s=100, on_silent_node="drop", silent_after_s=2.0, name="drop.yaml")
    reference, out = directory / "drop-reference", directory / "drop"
    check(made(binary, "run", scenario, "--out", reference)[0] == 0, "an undisturbed run")
    with Run(binary, "launch", scenario, "--out", out) as run:
        first_frame(out, "beta")
        os.kill(run.node("beta"), signal.SIGKILL)
        code, _ = run.finish()
    record = json.loads((out / "run.json").read_text())
    check(code == 0 and record["status"] == "incomplete" and record["dropped"] == ["beta"],
          f"code {code}, {record['status']}, dropped: {record['dropped']}")
    check("not complete: lost and dropped: beta" in run.stderr, f"stderr: {run.stderr[-300:]}")
    check("\nincomplete in " in run.stdout, f"summary: {run.stdout}")
    check("lost and dropped: beta" in (out / "index.html").read_text(), "the report says so")
    code, said, _ = made(binary, "launch", scenario, "--out", out)
    check(code == 0 and "continuing at tick" in said, f"the same command goes on: {said}")
    check_same(out, reference, "to the products of an undisturbed run")


def ends_on_request(binary, directory):
    scenario = write_scenario(directory, duration_s=200, network=", real_time: 20", name="end.yaml")
    out = directory / "end"
    with Run(binary, "launch", scenario, "--out", out) as run:
        first_frame(out)
        address = (out / "logs/master.address").read_text().strip()
        check(made(binary, "clock", "end", address, "--reason", "clouds")[0] == 0, "clock end")
        code, _ = run.finish()
    record = json.loads((out / "run.json").read_text())
    check(code == 0 and record["status"] == "ended" and record["reason"] == "ended on request: clouds",
          f"code {code}, {record['status']}: {run.stderr[-300:]}")
    code, said, _ = made(binary, "run", scenario, "--out", out)
    check(code == 0 and "continuing at tick" in said, f"the same run goes on: {said}")


def hangs_up(binary, directory, scenario):
    for command in ("run", "launch"):
        out = directory / f"hangup-{command}"
        with Run(binary, command, scenario, "--out", out) as run:
            first_frame(out)
            os.killpg(run.process.pid, signal.SIGHUP)
            code, _ = run.finish()
            run.nothing_left()
        status = json.loads((out / "run.json").read_text())["status"]
        check(code == 130 and status == "interrupted", f"{command}: SIGHUP: code {code}, {status}")
    out = directory / "nohup"
    short = write_scenario(directory, duration_s=60, name="nohup.yaml")
    with Run("nohup", binary, "launch", short, "--out", out) as run:
        first_frame(out)
        os.killpg(run.process.pid, signal.SIGHUP)
        code, _ = run.finish()
        check(code == 0, f"nohup: code {code}: {run.stderr[-300:]}")


def test(binary, directory):
    scenario = write_scenario(directory, duration_s=10, name="short.yaml")
    other_runs_stay(binary, directory, scenario)
    files_of_users_stay(binary, directory, scenario)
    killed_while_clearing(binary, directory, scenario)
    check_leaves_nothing(binary, directory)
    lost_output(binary, directory, scenario)
    goes_on_without_a_node(binary, directory)
    ends_on_request(binary, directory)
    hangs_up(binary, directory, write_scenario(directory))


if __name__ == "__main__":
    main(test)
