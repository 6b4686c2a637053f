"""The referees pass frames that are right and refuse frames that are wrong by a known amount."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import referee
import synthetic_run

HERE = pathlib.Path(__file__).resolve().parent


def verdict(script, run):
    """(exit code, last line) of a referee."""
    environment = {k: v for k, v in os.environ.items() if k != "DMISE_DATA"}
    done = subprocess.run([sys.executable, HERE / script, run], capture_output=True, text=True,
                          env=environment, check=False)
    if done.returncode == 77:
        raise referee.Missing(done.stdout.strip())
    return done.returncode, (done.stdout + done.stderr).strip().splitlines()[-1]


class Referees(unittest.TestCase):
    def judge(self, script, passes, says, **wrong):
        with tempfile.TemporaryDirectory() as run:
            synthetic_run.write(run, **wrong)
            code, last = verdict(script, run)
        self.assertEqual(code == 0, passes, last)
        self.assertIn(says, last)

    def test_astrometry_net_agrees_with_a_right_wcs(self):
        self.judge("solve_field.py", True, "px rms from astrometry.net")

    def test_astrometry_net_refuses_a_wcs_half_a_pixel_off(self):
        self.judge("solve_field.py", False, "px rms from astrometry.net", shift_px=0.5)

    def test_source_extractor_agrees_with_right_magnitudes(self):
        self.judge("source_extractor_magnitudes.py", True, "most stars in one frame")

    def test_source_extractor_refuses_magnitudes_a_tenth_off(self):
        self.judge("source_extractor_magnitudes.py", False, "mag rms", magnitude_error=0.1)

    def test_skyfield_agrees_with_sgp4_and_erfa(self):
        self.judge("skyfield_directions.py", True, "worst")

    def test_skyfield_refuses_a_clock_five_milliseconds_late(self):
        self.judge("skyfield_directions.py", False, "from skyfield's", clock_error_s=0.005)

    def test_fitsverify_accepts_a_frame(self):
        self.judge("fitsverify_frames.py", True, ": 0 errors or warnings")

    def test_fitsverify_refuses_a_frame_cut_short(self):
        with tempfile.TemporaryDirectory() as run:
            synthetic_run.write(run)
            frame = pathlib.Path(run) / "camera/frame-000001.fits"
            frame.write_bytes(frame.read_bytes()[:-4000])
            self.assertNotEqual(verdict("fitsverify_frames.py", run)[0], 0)


def judge():
    program = unittest.main(argv=sys.argv[:1], exit=False, warnings="ignore")
    errors = program.result.errors + program.result.failures
    if any("referee.Missing" in text for _, text in errors):
        raise referee.Missing("a referee is not installed: see above")
    referee.check(not errors, f"{program.result.testsRun} tests of the referees")


if __name__ == "__main__":
    referee.main(judge)
