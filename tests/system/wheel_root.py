"""What a user of the wheel does first, in a bare Debian (wheel_root.sh): installs it, makes a frame, runs a shipped scenario.

    wheel_root.py MOST_MB      the wheel is the one beside this file

Only the standard library is used, and no part of the checkout.
"""
import pathlib
import subprocess
import sys
import tempfile
import time
import zipfile

FIRST_FRAME = """\
import pathlib, dmise
scenario = pathlib.Path(dmise.__file__).parent / "share/dmise/launch/scenarios/three-sites.yaml"
frame = next(dmise.Simulation(scenario).frames())
print(*frame.counts.shape, frame.counts.any(), dmise.check(scenario)["objects"])
"""
IMPORT_S = """\
import time; begin = time.perf_counter(); import dmise; dmise.Simulation; print(time.perf_counter() - begin)
"""


def run(*command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=900, **options)
    if done.returncode:
        sys.exit(f"FAIL: {' '.join(map(str, command))[:80]}: code {done.returncode} {(done.stdout + done.stderr)[-1500:]}")
    return done.stdout


def check(holds, what):
    print("ok:" if holds else "FAIL:", what)
    if not holds:
        sys.exit(1)


def whole_demonstration(out):
    """Its report, and a frame with pictures of each sensor."""
    sensors = [path.parent for path in out.glob("*/frame-000001.fits")]
    pictures = [path for sensor in sensors for path in (sensor / "frame-000001.png", sensor / "frame-000001-marked.png")]
    files = [*pictures, out / "index.html", out / "detections.jsonl", out / "truth.jsonl"]
    return len(sensors) == 4 and all(path.stat().st_size > 0 for path in files)


def check_licences(wheel):
    with zipfile.ZipFile(wheel) as packed:
        names = packed.namelist()
        libraries = [name.split("/")[1] for name in names if name.startswith("dmise.libs/")]
        licences = packed.read(next(name for name in names if name.endswith("licenses/LIBRARIES"))).decode()
    lacking = [name for name in libraries if f"{name}: " not in licences]
    check(libraries and not lacking, f"each of {len(libraries)} libraries has a licence {lacking or ''}")


def main(most_mb):
    (wheel,) = pathlib.Path(__file__).parent.glob("*.whl")
    check_licences(wheel)
    mb = wheel.stat().st_size / 1e6
    check(mb <= most_mb, f"size {mb:.1f} MB, asked <= {most_mb:.0f} ({wheel.name})")
    with tempfile.TemporaryDirectory() as directory:
        home = pathlib.Path(directory)
        begin = time.monotonic()
        run(sys.executable, "-m", "venv", home / "venv")
        python = home / "venv/bin/python"
        run(python, "-m", "pip", "install", "-q", wheel)
        installed = time.monotonic()
        environment = {"PATH": f"{home / 'venv/bin'}:/usr/bin:/bin", "HOME": directory, "LANG": "C.UTF-8"}
        rows, columns, lit, objects = run(python, "-c", FIRST_FRAME, cwd=home, env=environment).split()
        seconds = time.monotonic() - begin
        check(int(rows) * int(columns) > 0 and lit == "True" and int(objects) > 0, f"a frame of {rows} x {columns}")
        print(f"pip install and first frame: {seconds:.1f} s, of which venv and pip {installed - begin:.1f} s (asked: <= 60 s)")
        import_s = min(float(run(python, "-c", IMPORT_S, cwd=home, env=environment)) for _ in range(3))
        print(f"import with the engine: {import_s:.2f} s (asked: <= 0.3 s)")
        run("dmise", "demo", "--out", "demo", cwd=home, env=environment)
        check(whole_demonstration(home / "demo"), "dmise demo leaves frames of 4 sensors, pictures and its report")
        run("dmise", "demo", "--out", "demo", cwd=home, env=environment)
        check("Run of" in run(python, "-c", "import dmise; print(dmise.open_run('demo')._repr_html_())", cwd=home, env=environment),
              "a run is read in Python")


if __name__ == "__main__":
    main(float(sys.argv[1]))
