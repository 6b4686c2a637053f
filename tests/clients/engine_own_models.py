"""Models of one's own in the process of `dmise.Simulation`: the products of a run with the same models as programs.

    engine_own_models.py [DMISE [TEST..]]
"""
import asyncio
import gc
import json
import os
import re
import subprocess
import sys
import textwrap
import threading
import unittest
import warnings

import package

package.require("numpy", "dmise.engine")
import numpy as np  # noqa: E402

import dmise  # noqa: E402
import own_models  # noqa: E402
from own_cases import MOTION, OwnModelCase  # noqa: E402
from package import PACKAGE, ROOT, SANITIZED, resident_mb  # noqa: E402


class Actors(OwnModelCase):
    def test_frames_are_those_of_a_run(self):
        """Several sensors, one of them aboard what the model moves, and models with and without a memory."""
        for model, options in (("orbit", {}), ("orbit", {"albedo": 0.9}), ("Walk", {})):
            path = self.write(self.node(model, **options))
            simulation = dmise.Simulation(path, nodes={"gnc": getattr(own_models, model)})
            frames = self.check_same_as_run(simulation, self.run_of(path))
            self.assertEqual(len(frames), 4)
            self.assertGreater(sum((frame.truth["name"] == "probe").sum() for frame in frames), 0)

    def test_also_where_sensors_take_states(self):
        path = self.write(self.node("Walk"), network="sensors_propagate: off")
        self.check_same_as_run(dmise.Simulation(path, nodes={"gnc": own_models.Walk}), self.run_of(path))

    def test_steps_far_apart_and_attitudes_of_another_node(self):
        path = self.write(self.node("orbit", more=", period_ticks: 7"), self.node("tumble", "spin", rate_rad_per_s=0.2),
                          more=", attitude: {node: spin}")
        simulation = dmise.Simulation(path, nodes={"spin": own_models.tumble, "gnc": own_models.orbit})
        self.check_same_as_run(simulation, self.run_of(path))

    def test_one_node_moves_and_turns(self):
        @dmise.actor("probe")
        def both(t_s, world, options):
            return own_models.state_at(t_s, gcrs_from_body=[1, 0, 0, 0])

        path = self.write("name: gnc", more=", attitude: {node: gnc}")
        self.assertEqual(len(list(dmise.Simulation(path, nodes={"gnc": both}).frames())), 4)

    def test_each_iteration_has_a_model_of_its_own(self):
        simulation = dmise.Simulation(self.write("name: gnc"), nodes={"gnc": own_models.Walk})
        first = [frame.to_fits() for frame in simulation.frames()]
        self.assertEqual(first, [frame.to_fits() for frame in simulation.frames()])
        together = [[frame.to_fits() for frame in pair] for pair in zip(simulation.frames(), simulation.frames(), strict=True)]
        self.assertEqual(together, [[fits, fits] for fits in first])

    def test_frames_do_not_depend_on_who_else_is_made(self):
        simulation = dmise.Simulation(self.write("name: gnc"), nodes={"gnc": own_models.Walk})
        both = [frame for frame in simulation.frames()]
        for sensor in ("eye", "aboard"):
            alone = [frame.to_fits() for frame in simulation.frames(sensor, threads=3, layers=True)]
            self.assertEqual(alone, [frame.to_fits() for frame in both if frame.sensor == sensor])

    def test_it_is_told_what_a_program_is_told(self):
        told = self.base / "told"
        path = self.write(self.node("Tells", told=str(told), number=1.5, flag=True, words=["a", "b"]), duration_s=12)
        self.run_of(path)
        by_program = told.read_text()
        told.unlink()
        list(dmise.Simulation(path, nodes={"gnc": own_models.Tells}).frames())
        self.assertEqual(told.read_text(), by_program)
        ticks = [json.loads(line)[1] for line in by_program.splitlines()]
        self.assertEqual(ticks, list(range(13)))

    def test_an_iteration_that_is_left_ends(self):
        simulation = dmise.Simulation(self.write("name: gnc", duration_s=100), nodes={"gnc": own_models.Walk})
        for _ in range(5):
            for frame in simulation.frames("eye"):
                break
        frames = simulation.frames("eye")
        next(frames)
        frames.close()
        self.assertTrue(dmise.engine.core.wait_for_detached(60.0))

    def test_it_is_called_by_the_thread_that_asks(self):
        threads = set()

        @dmise.actor("probe")
        def orbit(t_s, world, options):
            threads.add(threading.current_thread())
            return own_models.state_at(t_s)

        simulation = dmise.Simulation(self.write("name: gnc"), nodes={"gnc": orbit})
        list(simulation.frames("eye"))
        self.assertEqual(threads, {threading.current_thread()})
        threads.clear()
        made = {}
        workers = [threading.Thread(target=lambda i=i: made.update({i: [f.to_fits() for f in simulation.frames("eye")]})) for i in range(3)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.assertEqual(threads, set(workers))
        self.assertEqual(made[0], made[1])
        self.assertEqual(made[0], made[2])

    def test_a_model_may_be_a_coroutine_also_within_a_loop(self):
        @dmise.actor("probe")
        async def orbit(t_s, world, options):
            await asyncio.sleep(0)
            return own_models.state_at(t_s)

        path = self.write("name: gnc")
        expected = [f.to_fits() for f in dmise.Simulation(path, nodes={"gnc": own_models.orbit}).frames("eye")]

        async def notebook():
            return [f.to_fits() for f in dmise.Simulation(path, nodes={"gnc": orbit}).frames("eye")]

        self.assertEqual([f.to_fits() for f in dmise.Simulation(path, nodes={"gnc": orbit}).frames("eye")], expected)
        self.assertEqual(asyncio.run(notebook()), expected)

    def test_what_a_run_notes_is_a_warning(self):
        @dmise.actor("probe")
        def kilometres(t_s, world, options):
            state = own_models.state_at(t_s)
            return dmise.State(np.array(state.position_m) / 1e3, np.array(state.velocity_m_per_s) / 1e3)

        path = self.write("name: gnc", motion="{node: gnc}").with_name("under.yaml")
        path.write_text(self.write("name: gnc").read_text().replace("target: probe", "target: GOES 14").replace("platform: probe", "platform: watcher"))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            list(dmise.Simulation(path, nodes={"gnc": kilometres}).frames("eye"))
        texts = [str(warning.message) for warning in caught if warning.category is RuntimeWarning]
        self.assertEqual(len(texts), 1, texts)
        self.assertRegex(texts[0], r"gnc: probe is not in the scene at tick 0: .* is under the ground; are its positions in m\?")
        self.assertEqual(caught[0].filename, __file__)

    @unittest.skipIf(SANITIZED, "memory that was freed is kept for a while")
    def test_memory_is_flat(self):
        simulation = dmise.Simulation(self.write("name: gnc", duration_s=10, cadence_s=5), nodes={"gnc": own_models.Walk})

        def iterate(times):
            for _ in range(times):
                for frame in simulation.frames():
                    pass
            gc.collect()
            return resident_mb()

        before = iterate(30)
        self.assertLess(iterate(150) - before, 2.0)


class Detectors(OwnModelCase):
    def test_detections_are_those_of_a_run(self):
        for model in ("peaks", "Counts"):
            path = self.write(self.node(model, "finder", step=2.0), motion=MOTION, eye="{node: finder}",
                              aboard="{node: finder}")
            simulation = dmise.Simulation(path, nodes={"finder": getattr(own_models, model)})
            frames = self.check_same_as_run(simulation, self.run_of(path))
            self.assertGreater(sum(len(frame.detections) for frame in frames), 3)
            self.assertEqual([frame.report for frame in frames], [frame.report for frame in simulation.frames()])

    def test_together_with_an_actor(self):
        path = self.write(self.node("Walk"), self.node("Counts", "finder"), eye="{node: finder}")
        nodes = {"gnc": own_models.Walk, "finder": own_models.Counts}
        self.check_same_as_run(dmise.Simulation(path, nodes=nodes), self.run_of(path))

    def test_wrong_answers_have_the_line_of_a_run(self):
        for fault, words in (("nan", "must be"), ("outside", "must be"), ("sigma", "sigma_px or covariance_px2: is needed"),
                             ("type", "a detector returns dmise.Found")):
            path = self.write(self.node("wrong_find", "finder", fault=fault), motion=MOTION, eye="{node: finder}")
            with self.assertRaises(dmise.EngineError) as caught:
                list(dmise.Simulation(path, nodes={"finder": own_models.wrong_find}).frames())
            self.assertIn(words, str(caught.exception))
            self.assertTrue(str(caught.exception).startswith("eye: finder: frame 2 (tick "), str(caught.exception))
            self.assertIn(str(caught.exception), self.run_of(path, code=1))

    def test_exceptions_have_a_note(self):
        @dmise.detector
        def find(frame, options):
            raise LookupError(frame.sensor)

        path = self.write("name: finder", motion=MOTION, eye="{node: finder}")
        with self.assertRaises(LookupError) as caught:
            list(dmise.Simulation(path, nodes={"finder": find}).frames())
        self.assertEqual(caught.exception.__notes__, ["node finder at frame 1 of eye (tick 1)"])


class Package(unittest.TestCase):
    def test_no_socket_is_needed(self):
        """What a model needs is imported without pyzmq, with few modules and little memory."""
        needed = "numpy, numpy.typing, google.protobuf.message, google.protobuf.descriptor_pool"
        code = f"""
            import sys
            import {needed}
            before = len(sys.modules)
            sys.modules["zmq"] = None  # an ImportError for who wants it
            import dmise
            dmise.actor, dmise.detector, dmise.State, dmise.World, dmise.Simulation
            import dmise.own_in_process
            most_kb = next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM"))
            print(len(sys.modules) - before, int(most_kb) / 1024)
            try:
                dmise.serve
            except ImportError as missing:
                print(missing)
        """
        done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, check=True,
                              env={**os.environ, "PYTHONPATH": PACKAGE})
        numbers, missing = done.stdout.splitlines()
        self.assertIn("dmise.serve needs pyzmq", missing)
        modules, megabytes = map(float, numbers.split())
        self.assertLess(modules, 150, "beside those of numpy and protobuf")
        if not SANITIZED:
            self.assertLess(megabytes, 60.0)

    def test_the_example_of_the_document(self):
        text = (ROOT / "docs/python.md").read_text()
        section = text[text.index("## Models of your own"):]
        code = re.search(r"(?s)```python\n(.*?)```", section)[1]
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": PACKAGE})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(done.stdout.splitlines()), 3, done.stdout)


if __name__ == "__main__":
    package.main()
