"""tidy.py reads named sources, and a header with a source that includes it; any other file is one line."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CLANG_TIDY = '#!/bin/sh\n[ "$1" = --version ] || echo "$4" >>"${0%/*}/read"\n'


def tidy(directory, *names):
    """Exit code, what was said, and which files clang-tidy has read."""
    (directory / "read").unlink(missing_ok=True)
    done = subprocess.run([sys.executable, ROOT / "tests/style/tidy.py", directory / "build", *names], cwd=ROOT,
                          capture_output=True, text=True, env={"PATH": f"{directory}:/usr/bin:/bin"}, check=False)
    read = directory / "read"
    return done.returncode, done.stdout + done.stderr, read.read_text().split() if read.exists() else []


def main(directory):
    (directory / "build").mkdir()
    (directory / "clang-tidy").write_text(CLANG_TIDY)
    (directory / "clang-tidy").chmod(0o755)
    sources = ["core/base/printable.cpp", "nodes/own/mcap_file.cpp"]
    (directory / "build/compile_commands.json").write_text(json.dumps(
        [{"file": str(ROOT / name), "command": f"clang++ -c {ROOT / name}"} for name in sources]))
    for names, wanted in (([sources[0]], sources[:1]), (["core/base/printable.h"], sources[:1]),
                          (["nodes/own/mcap_file.h", sources[1]], sources[1:]), (["core/base/error.h"], sources[1:])):
        code, said, read = tidy(directory, *names)
        assert (code, read) == (0, wanted), (names, code, said, read)
    for name in ("README.md", "launch/run/node_makers.h"):
        code, said, read = tidy(directory, name)
        assert code == 2 and not read and said.startswith(f"tidy: {name}: no source") and said.count("\n") == 1, said


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        main(Path(scratch))
