"""What the package costs to import, and its names.

    engine_package.py [DMISE [TEST..]]
"""
import ast
import pathlib
import unittest

import package

package.require("numpy", "dmise.engine")
import dmise  # noqa: E402
from package import SANITIZED, run_python  # noqa: E402


class Package(unittest.TestCase):
    @unittest.skipIf(SANITIZED, "the sanitizer itself is large")
    def test_importing_is_small(self):
        """60 MB and few modules beside numpy's, with the engine."""
        modules, mb = map(float, run_python(
            "import sys, numpy; before = len(sys.modules); import dmise; dmise.Simulation; print(len(sys.modules) - before);"
            "print(next(int(l.split()[1]) for l in open('/proc/self/status') if l.startswith('VmHWM')) / 1024)"))
        self.assertLess(modules, 100)
        self.assertLess(mb, 60.0)

    def test_simulating_needs_no_wire(self):
        self.assertEqual(run_python("import sys, dmise; dmise.Simulation, dmise.detect, dmise.check;"
                                    "print(*[m for m in ('zmq', 'google.protobuf') if m in sys.modules])"), [])

    def test_type_checkers_see_the_same_names(self):
        stub = ast.parse(pathlib.Path(dmise.__file__).with_suffix(".pyi").read_text())
        names = {(name.asname, line.module) for line in stub.body if isinstance(line, ast.ImportFrom) for name in line.names}
        self.assertEqual(names, {*dmise._MODULE_OF.items(), *((name, None) for name in dmise._MODULES)})

    def test_all_names_are_there(self):
        for name in dmise.__all__:
            self.assertIsNotNone(getattr(dmise, name))
        self.assertRaises(AttributeError, lambda: dmise.nothing)


if __name__ == "__main__":
    package.main()
