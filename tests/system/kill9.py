"""A sensor node killed with -9: named within silent_after_s, and the run ends by its policy.

    kill9.py DMISE
"""

import os
import signal

from harness import Run, check, first_frame, main, write_scenario

SILENT_AFTER_S = 2.0
MARGIN_S = 2.5  # to stop the other nodes and write what is finished


def fails(binary, directory):
    scenario = write_scenario(directory, silent_after_s=SILENT_AFTER_S)
    with Run(binary, "launch", scenario, "--out", directory / "fail") as run:
        first_frame(directory / "fail", "beta")
        os.kill(run.node("beta"), signal.SIGKILL)
        code, waited_s = run.finish()
        check(code not in (0, 130), f"policy fail: the run ends with code {code}")
        check(waited_s < SILENT_AFTER_S + MARGIN_S, f"it ends after {waited_s:.2f} s")
        check("beta" in run.stderr.strip().splitlines()[-1],
              f"its last line names beta: {run.stderr.strip().splitlines()[-1]}")
        run.nothing_left()


def drops(binary, directory):
    scenario = write_scenario(directory, duration_s=200, on_silent_node="drop",
                              silent_after_s=SILENT_AFTER_S)
    out = directory / "drop"
    with Run(binary, "launch", scenario, "--out", out) as run:
        first_frame(out, "beta")
        os.kill(run.node("beta"), signal.SIGKILL)
        code, _ = run.finish()
        check(code == 0, f"policy drop: the run ends with code {code}: {run.stderr[-300:]}")
        frames = len(list((out / "alpha").glob("frame-*.fits")))
        check(frames == 40, f"alpha goes on to its frame {frames} of 40")
        check("beta" in run.stderr + run.stdout + (out / "run.json").read_text(), "beta is named")
        run.nothing_left()


def test(binary, directory):
    fails(binary, directory)
    drops(binary, directory)


if __name__ == "__main__":
    main(test)
