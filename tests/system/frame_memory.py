"""The paper's all-sky frame takes at most 80 MB of memory, each time: what libraries share with other processes of the
machine is counted whole, so that it does not matter who else runs.

    frame_memory.py DMISE [--runs N]
"""

import json
import subprocess
import sys

from harness import check, main

MOST_MB = 80.0


def test(binary, directory):
    runs = int(sys.argv[sys.argv.index("--runs") + 1]) if "--runs" in sys.argv else 20
    peaks = []
    for _ in range(runs):
        done = subprocess.run([binary, "bench", "all-sky", "--json"], capture_output=True, text=True, timeout=120,
                              check=True)
        figures = {line["name"]: line["value"] for line in map(json.loads, done.stdout.splitlines())}
        if not figures:
            print("skipped: no star catalogue is installed")
            sys.exit(77)
        peaks.append(figures["all_sky_peak_mb"])
    check(max(peaks) <= MOST_MB, f"all_sky_peak_mb: {min(peaks):.1f} to {max(peaks):.1f} in {runs} runs, at most {MOST_MB:g}")
    check(max(peaks) - min(peaks) < 2.0, "and it does not depend on chance")


if __name__ == "__main__":
    main(test)
