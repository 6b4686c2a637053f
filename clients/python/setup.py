"""Makes dmise.v1 from proto/ when a wheel is built; a source distribution carries proto/ with it."""
import pathlib
import shutil
import subprocess
import sys

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

HERE = pathlib.Path(__file__).resolve().parent
PROTO = next(p for p in (HERE / "proto", HERE.parent.parent / "proto") if (p / "dmise/v1").is_dir())


class BuildWithMessages(build_py):
    def run(self):
        super().run()
        files = sorted(map(str, (PROTO / "dmise/v1").glob("*.proto")))
        try:
            import grpc_tools  # noqa: F401
            compiler = [sys.executable, "-m", "grpc_tools.protoc"]
        except ImportError:
            compiler = ["protoc"]
        subprocess.run([*compiler, f"--proto_path={PROTO}", f"--python_out={self.build_lib}", *files], check=True)


class SdistWithProto(sdist):
    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        shutil.copytree(PROTO / "dmise", pathlib.Path(base_dir) / "proto/dmise", dirs_exist_ok=True)


setup(cmdclass={"build_py": BuildWithMessages, "sdist": SdistWithProto})
