"""fitsverify finds neither error nor warning in any frame of a run.

    fitsverify_frames.py RUN
"""

import re
import subprocess
import sys

import referee


def judge(run):
    paths = sorted(referee.need_file(run).glob("*/frame-*.fits"))
    referee.check(len(paths) > 0, f"{run} holds {len(paths)} frames")
    done = subprocess.run([referee.need("fitsverify"), "-q", *map(str, paths)], capture_output=True,
                          text=True, check=False)
    bad = [line for line in done.stdout.splitlines() if not re.match(r"verification OK: ", line)]
    referee.check(not bad and done.returncode == 0,
                  f"fitsverify on {len(paths)} frames: {len(bad)} with errors or warnings {bad[:3]}")


if __name__ == "__main__":
    referee.main(judge, sys.argv[1])
