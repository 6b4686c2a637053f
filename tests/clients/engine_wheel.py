"""The wheel with the engine: made, installed into a fresh environment without a compiler's or a library's path, and used there.

    engine_wheel.py TREE     the built tree (build/release)
"""
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import time
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/system"))
from harness import Failure, check  # noqa: E402

MOST_MB, MOST_S = 60.0, 60.0
FIRST_FRAME = """\
import pathlib, dmise
scenario = pathlib.Path(dmise.__file__).parent / "share/dmise/launch/scenarios/three-sites.yaml"
frame = next(dmise.Simulation(scenario).frames())
print(frame.counts.shape[0] * frame.counts.shape[1], frame.counts.any(), dmise.check(scenario)["objects"])
"""


def run(*command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=600, **options)
    if done.returncode:
        raise Failure(f"{' '.join(map(str, command))[:80]}: code {done.returncode} {(done.stdout + done.stderr)[-1500:]}")
    return done.stdout


def test(tree, directory):
    wheel = pathlib.Path(run(ROOT / "build/engine-venv/bin/python", ROOT / "launch/package/wheel.py", tree, directory).strip())
    check(re.fullmatch(r"dmise-[\d.]+-(cp311-cp311|cp312-abi3)-manylinux_2_36_x86_64\.whl", wheel.name), wheel.name)
    size_mb = wheel.stat().st_size / 1e6
    check(size_mb < MOST_MB, f"it has {size_mb:.1f} MB, at most {MOST_MB}")
    with zipfile.ZipFile(wheel) as packed:
        names = packed.namelist()
        libraries = [name.split("/")[1] for name in names if name.startswith("dmise.libs/")]
        licences = packed.read(next(name for name in names if name.endswith("licenses/LIBRARIES"))).decode()
    lacking = [name for name in libraries if f"{name}: " not in licences]
    check(libraries and not lacking, f"each of {len(libraries)} libraries has a licence {lacking or ''}")

    begin = time.monotonic()
    run("/usr/bin/python3", "-m", "venv", directory / "fresh")
    python = directory / "fresh/bin/python"
    run(python, "-m", "pip", "install", "-q", "--no-index", "--no-deps", wheel)
    site = pathlib.Path(run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    environment = {"PATH": f"{directory / 'fresh/bin'}:/usr/bin:/bin", "HOME": str(directory), "LANG": "C.UTF-8"}
    pixels, lit, objects = run(python, "-c", FIRST_FRAME, cwd=directory, env=environment).split()
    elapsed_s = time.monotonic() - begin
    check(int(pixels) > 0 and lit == "True" and int(objects) > 0, "a frame of a scenario that is in it")
    check(elapsed_s < MOST_S, f"{elapsed_s:.1f} s from pip install to the first frame")
    run("dmise", "demo", "--out", directory / "demo", cwd=directory, env=environment)
    made = {path.name for path in (directory / "demo").iterdir()}
    check({"index.html", "detections.jsonl", "run.json"} <= made, "dmise demo leaves its report")
    check(list((directory / "demo").glob("*/frame-*.png")), "and pictures")


if __name__ == "__main__":
    if not (ROOT / "build/engine-venv/packages.sha256").exists():
        print("skipped: auditwheel is not installed (./dmise setup --tests)")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="dmise-test-") as temporary:
        try:
            test(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary))
        except Failure as failure:
            sys.exit(f"FAIL: {failure}")
