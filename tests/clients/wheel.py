"""Wheel and source distribution of the Python package: built, installed into a fresh environment, and used there.

    wheel.py RECORDING     of clients.recording, which the installed package replays
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/system"))
from harness import Failure, check  # noqa: E402

USE = """\
import pathlib, sys, threading
import dmise
replay = dmise.Replay(sys.argv[1], speed=float("inf"))
thread = threading.Thread(target=replay.run)
thread.start()
detections = list(dmise.subscribe(replay.address, "detection/"))
thread.join()
print(pathlib.Path(dmise.__file__).parent, len(detections), len({d.id for d in detections}))
"""


def run(*command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=100, **options)
    check(done.returncode == 0, f"{' '.join(map(str, command))[:80]}: code {done.returncode} "
          f"{(done.stdout + done.stderr)[-1500:] if done.returncode else ''}")
    return done.stdout


def members(wheel, source):
    """Names of files in both, without the directory of the source distribution."""
    with zipfile.ZipFile(wheel) as packed:
        wheel_names = set(packed.namelist())
    with tarfile.open(source) as packed:
        return wheel_names, {name.partition("/")[2] for name in packed.getnames()}


def test(directory, recording):
    shutil.copytree(ROOT / "clients/python", directory / "clients/python", ignore=shutil.ignore_patterns("build", "*.egg-info"))
    shutil.copytree(ROOT / "proto", directory / "proto")
    built = directory / "built"
    # The wheel is built from the source distribution; what compiles the messages is protoc, for there is no grpcio-tools.
    run(sys.executable, "-m", "build", "--no-isolation", "--skip-dependency-check", "--outdir", built,
        directory / "clients/python")
    (wheel,), (source,) = built.glob("*.whl"), built.glob("*.tar.gz")
    in_wheel, in_source = members(wheel, source)
    protos = {path.stem for path in (ROOT / "proto/dmise/v1").glob("*.proto")}
    modules = {path.name for path in (ROOT / "clients/python/src/dmise").glob("*.py")}
    lacking = ({f"dmise/v1/{name}_pb2.py" for name in protos} | {f"dmise/{name}" for name in (*modules, "py.typed")}) - in_wheel
    check(not lacking, f"{wheel.name} has {len(modules)} modules, {len(protos)} files of messages and py.typed {lacking or ''}")
    lacking = {f"proto/dmise/v1/{name}.proto" for name in protos} - in_source
    check(not lacking, f"{source.name} has the definitions of messages {lacking or ''}")

    fresh = directory / "fresh"
    run(sys.executable, "-m", "venv", fresh)
    python = fresh / "bin/python"
    run(python, "-m", "pip", "install", "-q", "--no-index", "--no-deps", wheel)
    site = pathlib.Path(run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    where, heard, distinct = run(python, "-c", USE, recording, cwd=directory, env=environment).split()
    check(pathlib.Path(where) == site / "dmise" and int(heard) == int(distinct) > 0, f"installed, it hears {heard} detections")
    help_text = run(python, "-m", "dmise", "--help", cwd=directory, env=environment)
    check("record" in help_text and "replay" in help_text, "python -m dmise has its commands")


if __name__ == "__main__":
    if not importlib.util.find_spec("build") or not importlib.util.find_spec("mcap"):
        print("skipped: build and mcap are not installed (./dmise setup --tests)")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="dmise-test-") as temporary:
        try:
            test(pathlib.Path(temporary), pathlib.Path(sys.argv[1]).resolve())
        except Failure as failure:
            sys.exit(f"FAIL: {failure}")
