"""States of catalogues at any times.

    engine_catalogues.py [DMISE [TEST..]]
"""
import subprocess
import sys
import unittest

import package
from package import DMISE, ROOT

sys.path += map(str, (ROOT / "build/venv/lib").glob("python3*/site-packages"))  # for sgp4 alone
package.require("numpy", "dmise.engine")
import numpy as np  # noqa: E402

import dmise  # noqa: E402


class Catalogues(unittest.TestCase):
    TLE = ("VANGUARD 1\n"
           "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753\n"
           "2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667\n")

    def test_states_are_those_of_the_sgp4_package(self):
        """Reference: sgp4 of PyPI, Vallado's code; 1e-8 km."""
        from sgp4.api import Satrec, jday

        times = np.datetime64("2000-06-27T18:50:19.733571") + np.arange(0, 4320, 360).astype("timedelta64[m]")
        states = dmise.propagate(self.TLE, times, axes="teme")
        self.assertEqual((states.positions_m.shape, states.codes.shape), ((1, 12, 3), (1, 12)))
        satellite = Satrec.twoline2rv(*self.TLE.splitlines()[1:])
        for k, time_ in enumerate(times.tolist()):
            seconds = time_.second + time_.microsecond * 1e-6
            code, r, v = satellite.sgp4(*jday(time_.year, time_.month, time_.day, time_.hour, time_.minute, seconds))
            self.assertEqual((code, states.codes[0, k]), (0, 0))
            np.testing.assert_allclose(states.positions_m[0, k], np.array(r) * 1e3, atol=2e-3)
            np.testing.assert_allclose(states.velocities_m_per_s[0, k], np.array(v) * 1e3, atol=2e-6)

    def test_states_are_those_of_the_command(self):
        path = ROOT / "launch/catalogues/demo.tle"
        for axes in ("teme", "gcrs", "itrs"):
            printed = subprocess.run([DMISE, "catalogue", "states", path, "--at", "2018-01-21T00:30:00Z", "--frame", axes],
                                     check=True, capture_output=True, text=True).stdout.splitlines()[1:]
            states = dmise.propagate(path, "2018-01-21T00:30:00Z", axes=axes, threads=2)
            self.assertEqual(len(printed), len(states.numbers))
            for i in (0, 100, len(printed) - 1):
                number, code, *state = printed[i].split(",")
                self.assertEqual((int(number), int(code)), (states.numbers[i], states.codes[i, 0]))
                np.testing.assert_array_equal(np.array(state[:3], float), states.positions_m[i, 0] / 1e3)

    def test_times_are_of_any_unit_and_byte_order(self):
        """A time beyond 2262 has no nanoseconds of 64 bits."""
        for time_, text in ((np.datetime64("2300-01-01"), "2300-01-01T00:00:00Z"), (np.datetime64("2018-01"), "2018-01-01T00:00:00Z"),
                            (np.array("2018-01-01T00:00:00.5", ">M8[ms]"), "2018-01-01T00:00:00.5Z")):
            ours, theirs = (dmise.propagate(ROOT / "launch/catalogues/demo.tle", t, axes="teme") for t in (time_, text))
            np.testing.assert_array_equal(ours.codes, theirs.codes)
            np.testing.assert_array_equal(ours.positions_m, theirs.positions_m)

    def test_bad_input(self):
        for what, times, axes, reason in ((self.TLE, "2000-13-01", "gcrs", "2000-13-01"), (self.TLE, "2001-01-01", "xyz", "axes"),
                                          ("a\nb\n", "2001-01-01", "gcrs", "catalogue"), (self.TLE, [5], "gcrs", "times"),
                                          (self.TLE, np.array(["NaT"], "datetime64[s]"), "gcrs", "NaT"), (self.TLE, 5, "gcrs", "times"),
                                          ("/nonexistent.tle", "2001-01-01", "gcrs", "nonexistent")):
            with self.assertRaisesRegex(dmise.InputError, reason):
                dmise.propagate(what, times, axes=axes)
        self.assertEqual(dmise.propagate(self.TLE, []).positions_m.shape, (1, 0, 3))
        for threads in (0, 10**6, 1.5):
            with self.assertRaises((dmise.InputError, TypeError)):
                dmise.propagate(self.TLE, "2001-01-01", threads=threads)

    def test_times_in_any_memory(self):
        times = np.datetime64("2000-06-28") + np.arange(12).astype("timedelta64[h]")
        read_only = times[::-3]
        read_only.flags.writeable = False
        usual = dmise.propagate(self.TLE, times.tolist())
        np.testing.assert_array_equal(dmise.propagate(self.TLE, read_only).positions_m, usual.positions_m[:, ::-3])
        np.testing.assert_array_equal(dmise.propagate(self.TLE, times.reshape(3, 4)).positions_m, usual.positions_m)


if __name__ == "__main__":
    package.main()
