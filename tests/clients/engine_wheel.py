"""The wheel with the engine: made, installed into a fresh environment of this system and used there, as wheel_root.sh does it in bare
ones. Where those are tried (DMISE_BARE_ROOT=1) they are enough.

    engine_wheel.py TREE     the built tree (build/release)
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_MB = 60

if os.environ.get("DMISE_BARE_ROOT") == "1":
    print("skipped: system.wheel_root_bookworm and _trixie do more")
    sys.exit(77)
if not (ROOT / "build/engine-venv/packages.sha256").exists():
    print("skipped: auditwheel is not installed (./dmise setup --tests)")
    sys.exit(77)
with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
    make = [ROOT / "build/engine-venv/bin/python", ROOT / "launch/package/wheel.py", sys.argv[1], directory]
    wheel = pathlib.Path(subprocess.run(make, check=True, stdout=subprocess.PIPE, text=True).stdout.strip())
    if not re.fullmatch(r"dmise-[\d.]+-(cp311-cp311|cp312-abi3)-manylinux_2_36_x86_64\.whl", wheel.name):
        sys.exit(f"FAIL: {wheel.name}")
    program = shutil.copy(ROOT / "tests/system/wheel_root.py", directory)
    sys.exit(subprocess.run(["/usr/bin/python3", program, str(MOST_MB)]).returncode)
