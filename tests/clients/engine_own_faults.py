"""Models of one's own in process that fail, answer wrongly or do not fit their scenario, and what its digest covers.

    engine_own_faults.py [DMISE [TEST..]]
"""
import json
import os
import re
import signal
import threading
import traceback
import warnings

import package

package.require("numpy", "dmise.engine")
import numpy as np  # noqa: E402

import dmise  # noqa: E402
import own_models  # noqa: E402
from own_cases import MOTION, OwnModelCase  # noqa: E402


class Unmarked:
    pass


class Faults(OwnModelCase):
    def test_exceptions_come_out_as_they_are(self):
        class Fuel(Exception):
            pass

        for error in (Fuel("no fuel"), ValueError("no fuel"), KeyboardInterrupt(), SystemExit(3), dmise.InputError("no fuel")):
            @dmise.actor("probe")
            def orbit(t_s, world, options):
                if world.tick == 7:
                    raise error
                return own_models.state_at(t_s)

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
            return own_models.state_at(t_s)

        with self.assertRaises(KeyboardInterrupt) as caught:
            list(dmise.Simulation(self.write("name: gnc"), nodes={"gnc": orbit}).frames())
        self.assertEqual(where, ["in the model", "ended"])
        self.assertEqual(caught.exception.__notes__, ["node gnc at tick 4"])

    def test_wrong_answers_have_the_line_of_a_run(self):
        for fault in ("nan", "shape", "far", "fast", "nothing", "text", "ghost", "two", "albedo", "words"):
            path = self.write(self.node("Wrong", fault=fault))
            with self.assertRaises(dmise.EngineError) as caught:
                list(dmise.Simulation(path, nodes={"gnc": own_models.Wrong}).frames())
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
        actor, detector = own_models.orbit, own_models.peaks
        anyone = dmise.actor()(lambda t_s, world, options: None)
        good = self.node("orbit")
        finder = {"motion": MOTION, "eye": "{node: gnc}"}
        for nodes, given, more, words in (
                ([good], None, {}, r"PATH:3:5: nodes\[0\]: its model is not given: dmise\.Simulation\(\.\., nodes=\{\"gnc\": \.\.\}\)"),
                ([good], {}, {}, r"PATH:3:5: nodes\[0\]: its model is not given.*"),
                (["name: gnc"], {}, {}, r"PATH:3:5: nodes\[0\]: its model is not given.*"),
                (["name: gnc"], {"gcn": anyone}, {}, r"PATH:3:5: nodes\[0\]: its model is not given.*"),
                ([good], {"g\0c": anyone}, {}, "nodes: has NUL, or a character that UTF-8 cannot encode"),
                ([good], {"\ud800": anyone}, {}, "nodes: has NUL, or a character that UTF-8 cannot encode"),
                (["name: spin", good], {"gnc": actor, "spin": anyone}, {}, r"PATH:3:5: nodes\[0\]: moves and turns no object.*"),
                ([good, "name: spin"], {"gnc": actor}, {"more": ", attitude: {node: spin}"}, r"PATH:4:5: nodes\[1\]: its model is not given: .*\{\"spin\": \.\.\}\)"),
                ([good], {"gnc": actor, "gncc": actor}, {}, r"PATH: nodes: no node has this name, did you mean gnc\?, got gncc"),
                ([good], {"gnc": lambda t_s, world, options: None}, {},
                 r"PATH:3:5: nodes\[0\]: its model must be what @dmise\.actor marks, got function"),
                ([good], {"gnc": Unmarked}, {}, r"PATH:3:5: nodes\[0\]: its model must be what @dmise\.actor marks, got class Unmarked"),
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
                ([self.node("orbit")], {"gnc": anyone}, {"motion": MOTION, "end": "fusion: {node: gnc}"},
                 r"PATH:3:5: nodes\[0\]: the engine in Python runs no sensors and trackers of one's own; dmise run and dmise launch can"),
                (["name: gnc, fmu: small.yaml, outputs: {position_m: [x, y, z]}"], {"gnc": anyone}, {},
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
            dmise.engine.core.Simulation.drawn_of_file(str(self.write(good)), 1)  # `dmise.inject` draws by it


class Digests(OwnModelCase):
    def test_a_digest_covers_the_scenario_but_no_program(self):
        def digest(node, model=own_models.orbit):
            return dmise.Simulation(self.write(node), nodes={"gnc": model}).digest

        plain = digest("name: gnc")
        self.assertEqual(plain, digest(self.node("orbit")))
        self.assertEqual(plain, digest("name: gnc, elsewhere: on", own_models.Walk))
        self.assertNotEqual(plain, digest("name: gnc, options: {a: 1}"))
        self.assertNotEqual(plain, digest("name: gnc, period_ticks: 2"))
        path = self.write(self.node("orbit"))
        simulation = dmise.Simulation(path, nodes={"gnc": own_models.orbit})
        self.assertNotEqual(simulation.digest, json.loads((self.run_of(path).directory / "run.json").read_text())["digest"])
        self.assertEqual(next(simulation.frames("eye")).header["SCENARIO"], simulation.digest)


if __name__ == "__main__":
    package.main()
