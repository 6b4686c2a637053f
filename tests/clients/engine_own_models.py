"""Models of one's own in the process of `dmise.Simulation`: the products of a run with the same models as programs.

    engine_own_models.py [DMISE [TEST..]]
"""
import asyncio
import gc
import importlib.util
import itertools
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import traceback
import unittest
import warnings

import package
from package import DMISE, PACKAGE, ROOT, SANITIZED

package.require("numpy", "dmise.engine")
import numpy as np  # noqa: E402

import dmise  # noqa: E402

PATIENCE_S = 300.0  # on a loaded machine

# As a program, and as a module of the test.
MODELS = """\
import json, math
import dmise
import numpy as np

A, RATE, TILT = 7_178_137.0, 1.0381e-3, math.radians(98.6)


def state_at(t_s, **more):
    u = math.radians(0.15) + RATE * t_s
    along = lambda c, s: [A * c, A * s * math.cos(TILT), A * s * math.sin(TILT)]
    return dmise.State(along(math.cos(u), math.sin(u)), [RATE * x for x in along(-math.sin(u), math.cos(u))], **more)


@dmise.actor("probe")
def orbit(t_s, world, options):
    return state_at(t_s, albedo=options.get("albedo"))


@dmise.actor("probe")
class Walk:
    '''Remembers where it was, and that nobody else has called it.'''
    def __init__(self):
        self.calls, self.drift_m, self.drift_m_per_s = 0, np.zeros(3), np.zeros(3)

    def __call__(self, t_s, world, options):
        assert self.calls == world.tick, (self.calls, world.tick)
        if self.calls > 0:
            acceleration = np.array([0.5, -0.3, 0.1]) * self.calls
            self.drift_m += self.drift_m_per_s + 0.5 * acceleration
            self.drift_m_per_s += acceleration
        self.calls += 1
        state = state_at(t_s)
        return dmise.State(state.position_m + self.drift_m, state.velocity_m_per_s + self.drift_m_per_s)


@dmise.actor()
def tumble(t_s, world, options):
    angle = options["rate_rad_per_s"] * t_s
    return dmise.State(gcrs_from_body=[math.cos(angle / 2), 0, 0, math.sin(angle / 2)], rate_rad_per_s=[0, 0, options["rate_rad_per_s"]])


@dmise.actor("probe")
class Tells:
    '''Writes what it is told.'''
    def __call__(self, t_s, world, options):
        with open(options["told"], "a") as file:
            told = [t_s, world.tick, world.time_ns, world.node, world.objects, world.seed, str(world.time_utc), options,
                    world.environment.sun_m.tolist(), repr(world.environment.earth), len(world.messages)]
            file.write(json.dumps(told) + chr(10))
        return state_at(t_s)


@dmise.actor("probe")
class Wrong:
    def __call__(self, t_s, world, options):
        state = state_at(t_s)
        if world.tick == 3:
            match options["fault"]:
                case "nan": state.position_m[1] = math.nan
                case "shape": state.position_m = state.position_m[:2]
                case "far": state.position_m[1] = 1e16
                case "fast": state.velocity_m_per_s[0] = 3e8
                case "nothing": return dmise.State()
                case "text": return "here"
                case "ghost": return {"ghost": state}
                case "two": return [state, state]
                case "albedo": state.albedo = -2.0
                case "words": state.position_m = ["a", "b", "c"]
                case "attitude": state.gcrs_from_body = [0, 0]
        return state


@dmise.detector
def peaks(frame, options):
    light_e = (frame.counts - np.median(frame.counts)) * frame.gain_e_per_dn
    y, x = (int(i) for i in np.unravel_index(np.argmax(light_e), light_e.shape))
    return [dmise.Found(x_px=x, y_px=y, sigma_px=0.3, flux_e=light_e[y, x], snr=9.0 + options["step"])]


@dmise.detector
class Counts:
    '''Says by its SNR which of its frames it is.'''
    def __init__(self):
        self.frames = []

    def __call__(self, frame, options):
        self.frames.append(frame)
        assert {f.sensor for f in self.frames} == {frame.sensor} and frame.number == len(self.frames), frame
        return dmise.Found(x_px=np.arange(2.0) + 50, y_px=np.arange(2.0) + 40, sigma_px=0.4, flux_e=5000.0,
                           snr=10.0 * len(self.frames) + frame.exposure_s)


@dmise.detector
def wrong_find(frame, options):
    found = dmise.Found(x_px=10, y_px=10, sigma_px=0.3, flux_e=5000, snr=9)
    if frame.number == 2:
        match options["fault"]:
            case "nan": found.x_px = math.nan
            case "outside": found.x_px = 4000
            case "sigma": found.sigma_px = None
            case "type": return 5
    return [found]


if __name__ == "__main__":
    import sys
    dmise.serve(globals()[sys.argv[1]])
"""
CAMERA = """\
name: small
optics: {projection: gnomonic, columns: 128, rows: 96, pixel_pitch_m: 5.4e-6, field_of_view_deg: 3, aperture_m: 0.02}
detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
"""
ORBIT = "semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0"
SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 1, seed: 1}}
nodes:
{nodes}
objects:
  - {{catalogue: demo, only: [GOES 14, GOES 16], radius_m: 3}}
  - {{name: watcher, motion: {{two_body: {{{orbit}, true_anomaly_deg: 0}}}}}}
  - {{name: probe, motion: {motion}, radius_m: 0.3{more}}}
stars: {{catalogue: kstars}}
sensors:
  - {{name: eye, platform: watcher, camera: small.yaml, pointing: {{target: probe}}, exposure_s: 0.02, cadence_s: {cadence_s}, sky: space, detection: {eye}}}
  - {{name: aboard, platform: probe, camera: small.yaml, pointing: {{ra_deg: 10, dec_deg: 5}}, exposure_s: 0.5, cadence_s: {cadence_s}, sky: space, detection: {aboard}}}
network: {{{network}}}
output: {{png: false}}
{end}
"""


def resident_mb():
    import ctypes

    ctypes.CDLL(None).malloc_trim(0)
    return next(int(line.split()[1]) / 1024 for line in pathlib.Path("/proc/self/status").read_text().splitlines()
                if line.startswith("VmRSS"))


def without_digest(fits):
    """The bytes of a frame without the digest of its scenario, and the sum of the header that it is in."""
    return re.sub(rb"(?s)(SCENARIO|CHECKSUM)= .{70}", b"", fits)


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="dmise-test-")
        cls.base = pathlib.Path(cls.temporary.name)
        cls.number = itertools.count()
        (cls.base / "small.yaml").write_text(CAMERA)
        (cls.base / "models.py").write_text(MODELS)
        spec = importlib.util.spec_from_file_location("models", cls.base / "models.py")
        cls.models = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(cls.models)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def setUp(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.base)

    def write(self, *nodes, motion="{node: gnc}", more="", eye="on", aboard="off", duration_s=20, cadence_s=10, network="", end=""):
        path = self.base / f"night-{next(self.number)}.yaml"
        path.write_text(SCENARIO.format(nodes="\n".join(f"  - {{{node}}}" for node in nodes), motion=motion, more=more, eye=eye,
                                        aboard=aboard, duration_s=duration_s, cadence_s=cadence_s, network=network, end=end,
                                        orbit=ORBIT))
        return path

    @staticmethod
    def node(model, name="gnc", more="", **options):
        return f"name: {name}, run: [{sys.executable}, models.py, {model}], options: {json.dumps(options)}{more}"

    def run_of(self, path, code=0):
        """The directory of a run with the models as programs; of one that fails what it says."""
        out = path.with_suffix("")
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "build/python")}
        done = subprocess.run([DMISE, "run", path, "--out", out, "--allow-programs"], capture_output=True, text=True,
                              timeout=PATIENCE_S, env=environment)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr if code else dmise.open_run(out)

    def check_same_as_run(self, simulation, run):
        frames = list(simulation.frames())
        self.assertGreater(len(frames), 0)
        for sensor in simulation.sensors:
            ours = [frame for frame in frames if frame.sensor == sensor]
            for frame, (number, path) in zip(ours, run.images(sensor), strict=True):
                self.assertEqual(frame.number, number)
                self.assertEqual(without_digest(frame.to_fits()), without_digest(path.read_bytes()))
            for name, tables, theirs in (("truth", [f.truth for f in ours], run.truth),
                                         ("detections", [f.detections for f in ours], run.detections)):
                table = np.concatenate(tables)
                records = [record for record in theirs if record.sensor == sensor]
                self.assertEqual(len(table), len(records), name)
                for row, record in zip(table, records):
                    for field in table.dtype.names:
                        value = getattr(record, field)
                        if np.size(value):
                            np.testing.assert_array_equal(row[field], np.nan if value is None else value, err_msg=f"{name}.{field}")
            self.assertEqual([f.report for f in ours], [r for r in run.frames if r.sensor == sensor])
        return frames


class Actors(Case):
    def test_frames_are_those_of_a_run(self):
        """Of several sensors, one of them aboard what the model moves, and of models with and without a memory."""
        for model, options in (("orbit", {}), ("orbit", {"albedo": 0.9}), ("Walk", {})):
            path = self.write(self.node(model, **options))
            simulation = dmise.Simulation(path, nodes={"gnc": getattr(self.models, model)})
            frames = self.check_same_as_run(simulation, self.run_of(path))
            self.assertEqual(len(frames), 4)
            self.assertGreater(sum((frame.truth["name"] == "probe").sum() for frame in frames), 0)

    def test_also_where_sensors_take_states(self):
        path = self.write(self.node("Walk"), network="sensors_propagate: off")
        self.check_same_as_run(dmise.Simulation(path, nodes={"gnc": self.models.Walk}), self.run_of(path))

    def test_steps_far_apart_and_attitudes_of_another_node(self):
        path = self.write(self.node("orbit", more=", period_ticks: 7"), self.node("tumble", "spin", rate_rad_per_s=0.2),
                          more=", attitude: {node: spin}")
        simulation = dmise.Simulation(path, nodes={"spin": self.models.tumble, "gnc": self.models.orbit})
        self.check_same_as_run(simulation, self.run_of(path))

    def test_one_node_moves_and_turns(self):
        @dmise.actor("probe")
        def both(t_s, world, options):
            return self.models.state_at(t_s, gcrs_from_body=[1, 0, 0, 0])

        path = self.write("name: gnc", more=", attitude: {node: gnc}")
        self.assertEqual(len(list(dmise.Simulation(path, nodes={"gnc": both}).frames())), 4)

    def test_each_iteration_has_a_model_of_its_own(self):
        simulation = dmise.Simulation(self.write("name: gnc"), nodes={"gnc": self.models.Walk})
        first = [frame.to_fits() for frame in simulation.frames()]
        self.assertEqual(first, [frame.to_fits() for frame in simulation.frames()])
        together = [[frame.to_fits() for frame in pair] for pair in zip(simulation.frames(), simulation.frames(), strict=True)]
        self.assertEqual(together, [[fits, fits] for fits in first])

    def test_frames_do_not_depend_on_who_else_is_made(self):
        simulation = dmise.Simulation(self.write("name: gnc"), nodes={"gnc": self.models.Walk})
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
        list(dmise.Simulation(path, nodes={"gnc": self.models.Tells}).frames())
        self.assertEqual(told.read_text(), by_program)
        ticks = [json.loads(line)[1] for line in by_program.splitlines()]
        self.assertEqual(ticks, list(range(13)))

    def test_an_iteration_that_is_left_ends(self):
        simulation = dmise.Simulation(self.write("name: gnc", duration_s=100), nodes={"gnc": self.models.Walk})
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
            return self.models.state_at(t_s)

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
            return self.models.state_at(t_s)

        path = self.write("name: gnc")
        expected = [f.to_fits() for f in dmise.Simulation(path, nodes={"gnc": self.models.orbit}).frames("eye")]

        async def notebook():
            return [f.to_fits() for f in dmise.Simulation(path, nodes={"gnc": orbit}).frames("eye")]

        self.assertEqual([f.to_fits() for f in dmise.Simulation(path, nodes={"gnc": orbit}).frames("eye")], expected)
        self.assertEqual(asyncio.run(notebook()), expected)

    def test_what_a_run_notes_is_a_warning(self):
        @dmise.actor("probe")
        def kilometres(t_s, world, options):
            state = self.models.state_at(t_s)
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
        simulation = dmise.Simulation(self.write("name: gnc", duration_s=10, cadence_s=5), nodes={"gnc": self.models.Walk})

        def iterate(times):
            for _ in range(times):
                for frame in simulation.frames():
                    pass
            gc.collect()
            return resident_mb()

        before = iterate(30)
        self.assertLess(iterate(150) - before, 2.0)


class Detectors(Case):
    MOTION = f"{{two_body: {{{ORBIT}, true_anomaly_deg: 0.15}}}}"

    def test_detections_are_those_of_a_run(self):
        for model in ("peaks", "Counts"):
            path = self.write(self.node(model, "finder", step=2.0), motion=self.MOTION, eye="{node: finder}",
                              aboard="{node: finder}")
            simulation = dmise.Simulation(path, nodes={"finder": getattr(self.models, model)})
            frames = self.check_same_as_run(simulation, self.run_of(path))
            self.assertGreater(sum(len(frame.detections) for frame in frames), 3)
            self.assertEqual([frame.report for frame in frames], [frame.report for frame in simulation.frames()])

    def test_together_with_an_actor(self):
        path = self.write(self.node("Walk"), self.node("Counts", "finder"), eye="{node: finder}")
        nodes = {"gnc": self.models.Walk, "finder": self.models.Counts}
        self.check_same_as_run(dmise.Simulation(path, nodes=nodes), self.run_of(path))

    def test_wrong_answers_have_the_line_of_a_run(self):
        for fault, words in (("nan", "must be"), ("outside", "must be"), ("sigma", "sigma_px or covariance_px2: is needed"),
                             ("type", "a detector returns dmise.Found")):
            path = self.write(self.node("wrong_find", "finder", fault=fault), motion=self.MOTION, eye="{node: finder}")
            with self.assertRaises(dmise.EngineError) as caught:
                list(dmise.Simulation(path, nodes={"finder": self.models.wrong_find}).frames())
            self.assertIn(words, str(caught.exception))
            self.assertTrue(str(caught.exception).startswith("eye: finder: frame 2 (tick "), str(caught.exception))
            self.assertIn(str(caught.exception), self.run_of(path, code=1))

    def test_exceptions_have_a_note(self):
        @dmise.detector
        def find(frame, options):
            raise LookupError(frame.sensor)

        path = self.write("name: finder", motion=self.MOTION, eye="{node: finder}")
        with self.assertRaises(LookupError) as caught:
            list(dmise.Simulation(path, nodes={"finder": find}).frames())
        self.assertEqual(caught.exception.__notes__, ["node finder at frame 1 of eye (tick 1)"])


class Faults(Case):
    def test_exceptions_come_out_as_they_are(self):
        class Fuel(Exception):
            pass

        for error in (Fuel("no fuel"), ValueError("no fuel"), KeyboardInterrupt(), SystemExit(3), dmise.InputError("no fuel")):
            @dmise.actor("probe")
            def orbit(t_s, world, options):
                if world.tick == 7:
                    raise error
                return self.models.state_at(t_s)

            frames = dmise.Simulation(self.write("name: gnc"), nodes={"gnc": orbit}).frames("eye")
            try:
                list(frames)
            except BaseException as raised:
                self.assertIs(raised, error)
                last = traceback.extract_tb(raised.__traceback__)[-1]
                self.assertEqual((last.filename, last.name), (__file__, "orbit"))
            self.assertEqual(error.__notes__, ["node gnc at tick 7"])
            self.assertEqual(list(frames), [])
        self.assertTrue(dmise.engine.core.wait_for_detached(60.0))

    def test_exceptions_as_it_is_made(self):
        @dmise.actor("probe")
        class Broken:
            def __init__(self):
                raise OSError("no licence")

        with self.assertRaisesRegex(OSError, "no licence") as caught:
            list(dmise.Simulation(self.write("name: gnc"), nodes={"gnc": Broken}).frames())
        self.assertEqual(caught.exception.__notes__, ["node gnc"])

    def test_a_signal_interrupts_the_model(self):
        where = []

        @dmise.actor("probe")
        def orbit(t_s, world, options):
            if world.tick == 4:
                threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
                try:
                    while True:
                        where[:] = ["in the model"]
                finally:
                    where.append("ended")
            return self.models.state_at(t_s)

        with self.assertRaises(KeyboardInterrupt) as caught:
            list(dmise.Simulation(self.write("name: gnc"), nodes={"gnc": orbit}).frames())
        self.assertEqual(where, ["in the model", "ended"])
        self.assertEqual(caught.exception.__notes__, ["node gnc at tick 4"])

    def test_wrong_answers_have_the_line_of_a_run(self):
        for fault in ("nan", "shape", "far", "fast", "nothing", "text", "ghost", "two", "albedo", "words"):
            path = self.write(self.node("Wrong", fault=fault))
            with self.assertRaises(dmise.EngineError) as caught:
                list(dmise.Simulation(path, nodes={"gnc": self.models.Wrong}).frames())
            text = str(caught.exception)
            self.assertTrue(text.startswith("gnc: tick 3: ") and "\n" not in text, text)
            self.assertIn(f"{text}\n", self.run_of(path, code=1))

    def test_any_answer_is_one_or_refused(self):
        """Nothing that a model returns ends the interpreter."""
        class Odd:
            def __iter__(self):
                raise RuntimeError("odd")

        answers = [0, b"", "", [], {}, (), [[]], object(), np.zeros(3), Odd(), lambda: 0, [dmise.State()] * 3, {"probe": 5}, {5: 5},
                   float("nan"), dmise.State, dmise.Found(1, 1, 1, 1)]
        for field in ("position_m", "velocity_m_per_s", "gcrs_from_body", "rate_rad_per_s", "slope_m_per_s", "albedo"):
            for value in (0, [], [[]], "x", [1, 2], [float("inf")] * 3, [1e300] * 3, np.zeros((3, 2)), np.zeros((0, 0)), [None] * 3,
                          np.array([1j] * 3), object(), float("nan"), [float("nan")] * 4, np.zeros((2, 2, 2)), -1e9):
                state = dmise.State([7e6, 0, 0], [0, 7e3, 0], [1, 0, 0, 0])
                setattr(state, field, value)
                answers.append(state)
        path = self.write("name: gnc", more=", attitude: {node: gnc}", duration_s=4, cadence_s=4)
        refused = 0
        for answer in answers:
            model = dmise.actor("probe")(lambda t_s, world, options: answer)
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # numpy's of complex numbers
                    list(dmise.Simulation(path, nodes={"gnc": model}).frames("eye"))
            except dmise.EngineError as error:
                self.assertNotIn("\n", str(error))
                refused += 1
        self.assertGreater(refused, 100)

    def test_scenarios_and_models_that_do_not_fit(self):
        actor, detector = self.models.orbit, self.models.peaks
        anyone = dmise.actor()(lambda t_s, world, options: None)
        good = self.node("orbit")
        finder = {"motion": Detectors.MOTION, "eye": "{node: gnc}"}
        for nodes, given, more, words in (
                ([good], None, {}, r"PATH:3:5: nodes\[0\]: its model is not given: dmise\.Simulation\(\.\., nodes=\{\"gnc\": \.\.\}\)"),
                ([good], {}, {}, r"PATH:3:5: nodes\[0\]: its model is not given.*"),
                (["name: spin", good], {"gnc": actor, "spin": anyone}, {}, r"PATH:3:5: nodes\[0\]: moves and turns no object.*"),
                ([good, "name: spin"], {"gnc": actor}, {"more": ", attitude: {node: spin}"}, r"PATH:4:5: nodes\[1\]: give either run.*"),
                ([good], {"gnc": actor, "gncc": actor}, {}, r"PATH: nodes: no node has this name, did you mean gnc\?, got gncc"),
                ([good], {"gnc": lambda t_s, world, options: None}, {},
                 r"PATH:3:5: nodes\[0\]: its model must be what @dmise\.actor marks, got function"),
                ([good], {"gnc": Case}, {}, r"PATH:3:5: nodes\[0\]: its model must be what @dmise\.actor marks, got class Case"),
                ([good], {"gnc": None}, {}, r"PATH:3:5: nodes\[0\]: its model must be what @dmise\.actor marks, got NoneType"),
                ([good], {"gnc": detector}, {},
                 r"PATH:3:5: nodes\[0\]: its model must be what @dmise\.actor marks, got what @dmise\.detector marks"),
                ([good], {"gnc": actor}, finder,
                 r"PATH:3:5: nodes\[0\]: its model must be what @dmise\.detector marks, got what @dmise\.actor marks"),
                ([good], {"gnc": dmise.actor("probe", "other")(lambda *told: None)}, {},
                 r"PATH:3:5: nodes\[0\]: its model moves probe, other, the scenario has it move probe"),
                (["name: gnc, consumes: [detection/eye]"], {"gnc": actor}, {},
                 r"PATH:3:5: nodes\[0\]: the engine in Python lets no model hear topics; dmise run and dmise launch can"),
                (["name: gnc, period_ticks: 2"], {"gnc": detector}, finder, r"PATH:3:5: nodes\[0\]\.period_ticks: a detector is asked.*"),
                ([self.node("orbit")], {"gnc": anyone}, {"motion": Detectors.MOTION, "end": "fusion: {node: gnc}"},
                 r"PATH:3:5: nodes\[0\]: the engine in Python runs no sensors and trackers of one's own; dmise run and dmise launch can"),
                (["name: gnc, fmu: models.py, outputs: {position_m: [x, y, z]}"], {"gnc": anyone}, {},
                 r"PATH:3:2\d: nodes\[0\]\.fmu: an FMU is no function of this process.*")):
            path = self.write(*nodes, **more)
            with self.assertRaises(dmise.ScenarioError) as caught:
                dmise.Simulation(path, nodes=given)
            self.assertRegex(str(caught.exception), "^" + words.replace("PATH", re.escape(str(path))) + "$")
            self.assertNotIn("\n", str(caught.exception))
        self.assertEqual(caught.exception.line, 3)
        for given in ([actor], ["gnc"], actor, 5):
            with self.assertRaisesRegex(TypeError, "^nodes: must be a mapping of names to models, got"):
                dmise.Simulation(self.write(good), nodes=given)
        for given in ({5: actor}, {None: actor}):
            with self.assertRaisesRegex(dmise.ScenarioError, "nodes: no node has this name, got (5|None)|is not given"):
                dmise.Simulation(self.write(good), nodes=given)
        with self.assertRaises(dmise.ScenarioError):
            dmise.engine.core.Simulation.drawn_of_file(str(self.write(good)), 1)  # of dmise.inject


class Digests(Case):
    def test_a_digest_covers_the_scenario_but_no_program(self):
        def digest(node, model=self.models.orbit):
            return dmise.Simulation(self.write(node), nodes={"gnc": model}).digest

        plain = digest("name: gnc")
        self.assertEqual(plain, digest(self.node("orbit")))
        self.assertEqual(plain, digest("name: gnc, elsewhere: on", self.models.Walk))
        self.assertNotEqual(plain, digest("name: gnc, options: {a: 1}"))
        self.assertNotEqual(plain, digest("name: gnc, period_ticks: 2"))
        path = self.write(self.node("orbit"))
        simulation = dmise.Simulation(path, nodes={"gnc": self.models.orbit})
        self.assertNotEqual(simulation.digest, json.loads((self.run_of(path).directory / "run.json").read_text())["digest"])
        self.assertEqual(next(simulation.frames("eye")).header["SCENARIO"], simulation.digest)


class Package(unittest.TestCase):
    def test_no_socket_is_needed(self):
        """What a model needs is imported without pyzmq, in little time and memory."""
        code = """
            import sys, time
            start = time.process_time()
            sys.modules["zmq"] = None  # an ImportError for who wants it
            import dmise
            dmise.actor, dmise.detector, dmise.State, dmise.World, dmise.Simulation
            import dmise.own_in_process
            most_kb = next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM"))
            print(time.process_time() - start, int(most_kb) / 1024)
            try:
                dmise.serve
            except ImportError as missing:
                print(missing)
        """
        measured = []
        for _ in range(3):
            done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, check=True,
                                  env={**os.environ, "PYTHONPATH": PACKAGE})
            numbers, missing = done.stdout.splitlines()
            self.assertIn("dmise.serve needs pyzmq", missing)
            measured.append([float(number) for number in numbers.split()])
        if not SANITIZED:
            seconds, megabytes = map(min, zip(*measured))
            self.assertLess(seconds, 0.3)
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
