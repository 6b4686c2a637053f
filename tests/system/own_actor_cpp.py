"""A program in C++, built against what is installed, moves an object as the scenario's own two_body does: the same bytes.

    own_actor_cpp.py DMISE BUILD CXX
"""

import pathlib
import subprocess
import sys

from harness import check, main
from own_actor import ROOT, check_like, dmise, write

EXAMPLE = ROOT / "clients/cpp/examples"
ORBIT = "position_m: [7178112.401, -2810.113, 18581.004], velocity_m_per_s: [-19.5088, -1114.308, 7368.021]"
PUBLIC = ["node.h"]  # in include/dmise, beside core


def call(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    said = (done.stdout + done.stderr)[-2000:] if done.returncode else ""
    check(done.returncode == 0, f"{' '.join(map(str, command[:2]))} {said}")


def built_elsewhere(build, compiler, directory):
    """The program, of a project that knows nothing but the installed package."""
    prefix, project = directory / "prefix", directory / "project"
    call("cmake", "--install", build, "--prefix", prefix, "--component", "development")
    headers = sorted(path.name for path in (prefix / "include/dmise").iterdir())
    check(headers == sorted([*PUBLIC, "core"]), f"include/dmise has {headers}")
    call("cmake", "-G", "Ninja", "-S", EXAMPLE, "-B", project, f"-DCMAKE_PREFIX_PATH={prefix}",
         f"-DCMAKE_CXX_COMPILER={compiler}")
    call("cmake", "--build", project)
    return project / "my_actor"


def test(binary, directory):
    build, compiler = pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
    lines = len((EXAMPLE / "my_actor.cpp").read_text().splitlines())
    check(lines <= 40, f"the example has {lines} lines")
    program = built_elsewhere(build, compiler, directory)
    program.rename(directory / "my_actor")
    by_file = write(directory, "file.yaml", motion=f"{{two_body: {{{ORBIT}}}}}", output=", positions: [csv, jsonl]")
    dmise(binary, "run", by_file, "--out", directory / "file")
    for command in ("run", "launch"):
        by_node = write(directory, "node.yaml", node=f"run: [./my_actor], options: {{{ORBIT}}}",
                        output=", positions: [csv, jsonl]")
        dmise(binary, command, by_node, "--allow-programs", "--out", directory / command)
        check_like(directory / command, directory / "file", f"{command}: a node in C++ that moves by two_body is two_body")
    wrong = write(directory, "wrong.yaml", node="run: [./my_actor]")
    said = dmise(binary, "run", wrong, "--allow-programs", "--out", directory / "wrong", code=1)
    check("gnc: tick 0: option position_m: is missing" in said, said.strip().splitlines()[-1])


if __name__ == "__main__":
    main(test)
