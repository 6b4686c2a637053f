"""A sensor node killed with -9: named within silent_after_s, and the run ends by its policy.

    kill9.py DMISE
"""

import os
import signal

from harness import Run, check, first_frame, main, wait_until, write_scenario

SILENT_AFTER_S = 2.0


def tail_of(run, code):
    """What a run that failed said last."""
    return f": {run.stderr[-300:]}" if code else ""


def fails(binary, directory):
    scenario = write_scenario(directory, silent_after_s=SILENT_AFTER_S)
    with Run(binary, "launch", scenario, "--out", directory / "fail") as run:
        first_frame(directory / "fail", "beta")
        os.kill(run.node("beta"), signal.SIGKILL)
        code, waited_s = run.finish()
        check(code not in (0, 130), f"policy fail: the run ends with code {code}")
        print(f"it ends after {waited_s:.2f} s")  # deaths.py holds it to the declared time
        check("beta" in run.stderr.strip().splitlines()[-1],
              f"its last line names beta: {run.stderr.strip().splitlines()[-1]}")
        run.nothing_left()


def drops(binary, directory):
    scenario = write_scenario(directory, duration_s=100, on_silent_node="drop",
                              silent_after_s=SILENT_AFTER_S)
    out = directory / "drop"
    with Run(binary, "launch", scenario, "--out", out) as run:
        first_frame(out, "beta")
        os.kill(run.node("beta"), signal.SIGKILL)
        code, _ = run.finish()
        check(code == 0, f"policy drop: the run ends with code {code}{tail_of(run, code)}")
        frames = len(list((out / "alpha").glob("frame-*.fits")))
        check(frames == 20, f"alpha goes on to its frame {frames} of 20")
        check("beta" in run.stderr + run.stdout + (out / "run.json").read_text(), "beta is named")
        run.nothing_left()


def drops_who_stands_still(binary, directory):
    """Nobody waits for a process that was dropped and does not end."""
    scenario = write_scenario(directory, duration_s=60, on_silent_node="drop", silent_after_s=SILENT_AFTER_S)
    out = directory / "stopped"
    with Run(binary, "launch", scenario, "--out", out) as run:
        first_frame(out, "beta")
        os.kill(run.node("beta"), signal.SIGSTOP)
        code, _ = run.finish()
        check(code == 0, f"policy drop, stopped for ever: the run ends with code {code}{tail_of(run, code)}")
        run.nothing_left()


def loses_its_master(binary, directory):
    for how, words in ((signal.SIGKILL, "time-master was killed"), (signal.SIGSTOP, "time-master")):
        scenario = write_scenario(directory, on_silent_node="restart", silent_after_s=SILENT_AFTER_S)
        out = directory / how.name
        with Run(binary, "launch", scenario, "--out", out) as run:
            first_frame(out)
            os.kill(run.node("time-master"), how)
            code, _ = run.finish()
            last = run.stderr.strip().splitlines()[-1]
            check(code == 1 and words in last, f"{how.name} to the master: code {code}: {last}")
            run.nothing_left()


def dies_before_the_start(binary, directory):
    scenario = write_scenario(directory, silent_after_s=SILENT_AFTER_S)
    with Run(binary, "launch", scenario, "--out", directory / "early") as run:
        os.kill(wait_until(lambda: run.node("beta"), "beta"), signal.SIGKILL)
        code, _ = run.finish()
        last = run.stderr.strip().splitlines()[-1]
        check(code == 1 and "beta" in last, f"killed while it starts: code {code}: {last}")
        run.nothing_left()


def test(binary, directory):
    fails(binary, directory)
    drops(binary, directory)
    drops_who_stands_still(binary, directory)
    loses_its_master(binary, directory)
    dies_before_the_start(binary, directory)


if __name__ == "__main__":
    main(test)
