"""Threads, forks, signals and memory of processes that make frames.

    engine_processes.py [DMISE [TEST..]]
"""
import gc
import os
import signal
import threading
import time
import unittest

import package

package.require("numpy", "dmise.engine")
import numpy as np  # noqa: E402

import dmise  # noqa: E402
from package import ROOT, SANITIZED, resident_mb, run_python  # noqa: E402
from scenarios import NIGHT  # noqa: E402

LARGE = NIGHT.replace("columns: 160, rows: 120", "columns: 6000, rows: 6000").replace("pixel_pitch_m: 9e-6", "pixel_pitch_m: 3e-6")


class Processes(unittest.TestCase):
    def test_an_iteration_may_end_early(self):
        for _ in range(20):
            frames = dmise.Simulation(NIGHT).frames("west")
            next(frames)
            frames.close()
        dmise.Simulation(NIGHT).frames("west")  # never asked
        self.assertTrue(dmise.engine.core.wait_for_detached(20.0))

    def test_threads_make_frames_at_once(self):
        expected = [f.to_fits() for f in dmise.Simulation(NIGHT).frames("west")]
        simulation, found = dmise.Simulation(NIGHT), []
        threads = [threading.Thread(target=lambda: found.append([f.to_fits() for f in simulation.frames("west")]))
                   for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [expected] * 4)

    def test_a_forked_process_makes_frames_of_its_own(self):
        simulation = dmise.Simulation(NIGHT)
        begun = simulation.frames("west")
        first = next(begun)
        read, write = os.pipe()
        child = os.fork()
        if child == 0:
            said = b"error"
            try:
                try:
                    next(begun)
                except dmise.EngineError as error:
                    said = b"refused" if "forked" in str(error) else said
                if next(simulation.frames("west")).to_fits() == first.to_fits():
                    said += b", same"
            finally:
                os.write(write, said)
                os._exit(0)
        os.close(write)
        with os.fdopen(read, "rb") as answers:
            self.assertEqual(answers.read(), b"refused, same")
        os.waitpid(child, 0)
        self.assertEqual(next(begun).number, 2)

    def interrupted(self, after_s, work):
        """Seconds of a processor from Ctrl-C to the end of `work`: a busy machine takes longer, but not more of them."""
        sent = []
        timer = threading.Timer(after_s, lambda: (sent.append(time.process_time()), os.kill(os.getpid(), signal.SIGINT)))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while not sent or time.process_time() < sent[0] + 60:  # a quick machine needs several calls
                work()
        return time.process_time() - sent[0]

    def test_ctrl_c_ends_a_large_frame(self):
        frames = dmise.Simulation(LARGE).frames("west")
        begin = time.process_time()
        next(frames)
        whole_s = time.process_time() - begin
        self.assertLess(self.interrupted(0.1, lambda: list(frames)), 0.5 * whole_s)
        self.assertTrue(dmise.engine.core.wait_for_detached(20.0))
        self.assertEqual(next(dmise.Simulation(NIGHT).frames("west")).number, 1)

    def test_ctrl_c_ends_other_calls(self):
        times = np.datetime64("2018-01-21") + np.arange(4000).astype("timedelta64[m]")
        image = np.random.default_rng(1).normal(1000, 10, (5000, 5000)).astype(np.float32)
        header = {"DATE-OBS": "2018-01-21T03:00:00", "EXPTIME": 8.0, "FOCALLEN": 200.0, "XPIXSZ": 3.0, "YPIXSZ": 3.0, "RA": 100.0,
                  "DEC": 10.0, "SITELAT": 33.0, "SITELONG": -100.0}
        for work in (lambda: dmise.propagate(ROOT / "launch/catalogues/demo.tle", times), lambda: dmise.detect(image, header)):
            self.assertLess(self.interrupted(0.5, work), 2.0)
            self.assertTrue(dmise.engine.core.wait_for_detached(60.0))

    @unittest.skipIf(SANITIZED, "what is freed is kept")
    def test_memory_is_flat_over_seeds(self):
        def make(seeds):
            for seed in seeds:
                for frame in dmise.Simulation(tiny, seed=seed).frames("west"):
                    frame.counts, frame.truth, frame.detections
            gc.collect()
            self.assertTrue(dmise.engine.core.wait_for_detached(20.0))
            return resident_mb()

        tiny = NIGHT.replace("duration_s: 30", "duration_s: 10").replace("catalogue: demo", "catalogue: demo, only: [GOES 13, GOES 14]")
        count = int(os.environ.get("DMISE_TEST_SEEDS", "300"))
        before = make(range(100))
        self.assertLess(make(range(100, 100 + count)) - before, 5.0)


class Programs(unittest.TestCase):
    def test_a_program_may_end_in_the_middle_of_an_iteration(self):
        self.assertEqual(run_python(f"import dmise; sim = dmise.Simulation({NIGHT!r}); frames = sim.frames('west');"
                                    "never = sim.frames('east'); print(next(frames).number)"), ["1"])

    def test_a_forked_process_may_end_in_the_middle_of_an_iteration(self):
        """Neither the parent's threads are waited for nor is its own left running."""
        self.assertEqual(run_python(
            f"import dmise, os; sim = dmise.Simulation({NIGHT!r}); frames = sim.frames('west'); next(frames)\n"
            "if os.fork() == 0:\n    mine = sim.frames('east'); next(mine)\n"
            "else:\n    print(os.waitstatus_to_exitcode(os.wait()[1]))"), ["0"])


if __name__ == "__main__":
    package.main()
