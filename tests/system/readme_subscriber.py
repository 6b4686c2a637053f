"""The subscriber printed in README.md, run as it stands there, hears detections of a launched run.

    readme_subscriber.py DMISE
"""

import pathlib
import re
import subprocess
import sys
import threading

from harness import Failure, Run, check, first_frame, main, write_scenario

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE_S = 60.0


def test(binary, directory):
    code = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL).group(1)
    out = directory / "out"
    announced = out / "logs/master.address"
    with Run(binary, "launch", write_scenario(directory), "--out", out) as run:
        first_frame(out)
        with subprocess.Popen([sys.executable, "-u", "-c", code, announced.read_text().strip()],
                              cwd=ROOT, stdout=subprocess.PIPE, text=True) as subscriber:
            guard = threading.Timer(PATIENCE_S, subscriber.kill)
            guard.start()
            line = subscriber.stdout.readline()
            guard.cancel()
            subscriber.kill()
        if not line:
            raise Failure(f"it heard nothing within {PATIENCE_S:g} s")
        check(re.fullmatch(r"(alpha|beta)/\d+/\d+ [0-9.]+( -?[0-9.e+-]+){3}\n", line), f"it heard: {line.strip()}")
        run.interrupt()
        run.finish()


if __name__ == "__main__":
    main(test)
