"""The Python package under test: where it and its program are, and what its tests need.

Tests of the engine are `TEST_PROGRAM [DMISE [TEST..]]`, where a TEST is such as Frames.test_wcs_is_astropys.
"""
import ctypes
import importlib
import os
import pathlib
import signal
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SANITIZED = "DMISE_TEST_PACKAGE" in os.environ  # by tests/sanitizers/engine.sh, with a module of its own
PACKAGE = os.environ.get("DMISE_TEST_PACKAGE", str(ROOT / "build/python"))
DMISE = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build/release/bin/dmise"
sys.path.insert(0, PACKAGE)
signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell's job in the background ignores
os.environ["PATH"] = f"{DMISE.parent}:{os.environ['PATH']}"  # where the package finds the program, as an installed one does


def require(*modules, how="./dmise setup --tests"):
    """Ends the test as skipped unless all modules are installed; `how` installs them."""
    for name in modules:
        try:
            importlib.import_module(name)
        except ImportError as missing:
            print(f"skipped: {missing}" if name.startswith("dmise") else f"skipped: {missing.name or missing} is not installed ({how})")
            sys.exit(77)


def run_python(code):
    """Words that another process of Python prints."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120,
                          env={**os.environ, "PYTHONPATH": PACKAGE}).stdout.split()


def resident_mb():
    """Without what has been freed and the allocator keeps, which threads that meet by chance make more or less."""
    ctypes.CDLL(None).malloc_trim(0)
    status = pathlib.Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) / 1024 for line in status if line.startswith("VmRSS"))


def main():
    """Runs the tests of the program, or those that are named behind DMISE."""
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
