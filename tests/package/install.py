#!/usr/bin/env python3
"""What `cmake --install` puts into a prefix works from there, wherever the prefix is moved, and is all that another project
needs: programs find their files and modules, manual pages render without a warning, shells complete, and a project that
finds the libraries by find_package computes an orbit as python3-sgp4 does.

    install.py BUILD CTEST_CXX
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from sgp4.api import Satrec

BUILD = pathlib.Path(sys.argv[1]).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
TLE = ("1 25544U 98067A   18020.51782528  .00002182  00000-0  40768-4 0  9991",
       "2 25544  51.6425  58.2840 0003417  29.1970  63.2050 15.54138710 95594")
SCENARIO = """
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 5, tick_s: 5, seed: 1}
objects:
  - {name: near, motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6}}, attitude: nadir, geometry: {model: box-wing}}
  - {name: platform, motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, true_anomaly_deg: -0.002}}}
stars: {catalogue: kstars}
sensors: [{name: eye, platform: platform, camera: wide-field-cmos, pointing: {target: near}, effects: {evaluator: opengl}, exposure_s: 0.1, cadence_s: 5, sky: space}]
"""


def check(holds, what):
    if not holds:
        sys.exit(f"FAIL: {what}")
    print(f"ok: {what}")


def call(*command, **more):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("DMISE_")}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env=environment, check=False,
                          **more)
    if done.returncode:
        sys.exit(f"FAIL: {' '.join(map(str, command))}: {done.returncode}: {(done.stdout + done.stderr)[-2000:]}")
    return done.stdout


def programs_work(prefix, directory):
    dmise = prefix / "bin/dmise"
    check(call(dmise, "list", "cameras") == call(BUILD / "bin/dmise", "list", "cameras"), "it finds its cameras")
    check(str(prefix) in call(dmise, "list", "catalogues").splitlines()[0], "and its catalogues, in the prefix")
    commit = r"\(commit ([0-9a-f]{12}(-dirty)?|unknown), (sse2|avx2|avx512|generic)\)\n"
    for program in sorted((prefix / "bin").iterdir()):
        check(re.fullmatch(program.name + r" [0-9.]+ " + commit, call(program, "--version")), f"{program.name} --version")
    (directory / "one.yaml").write_text(SCENARIO)
    call(dmise, "run", "one.yaml", "--out", "out", cwd=directory)
    check((directory / "out/eye/frame-000001.png").exists(), "it loads its modules for drawing and pictures")


def manuals_render(prefix):
    pages = sorted((prefix / "share/man/man1").iterdir())
    names = {page.name.removesuffix(".1.gz") for page in pages}
    commands = call(prefix / "bin/dmise", "man", "--list").split()
    wanted = {"dmise"} | {f"dmise-{name}" for name in commands} | {p.name for p in (prefix / "bin").iterdir()}
    check(names == wanted, f"a manual page for each command and program: {len(pages)}, {names ^ wanted}")
    for page in pages:
        done = subprocess.run(["man", "--warnings", "-l", page], capture_output=True, text=True, check=False,
                              env={**os.environ, "MANWIDTH": "80", "LC_ALL": "C.UTF-8"})
        if done.returncode or done.stderr or "SYNOPSIS" not in done.stdout:
            sys.exit(f"FAIL: {page.name}: {done.stderr}")
    check(True, "and none has a warning")


def shells_complete(prefix):
    bash = prefix / "share/bash-completion/completions/dmise"
    zsh = prefix / "share/zsh/vendor-completions/_dmise"
    for words, wanted in ((["che"], ["check"]), (["list", "cam"], ["cameras"]), (["run", "--thr"], ["--threads"]),
                          (["schema", "camera", "--m"], ["--markdown"]), (["run", "ni"], [])):
        typed = " ".join(["dmise", *words])
        script = f'source {bash}; COMP_WORDS=({typed}); COMP_CWORD={len(words)}; _dmise; printf "%s\\n" "${{COMPREPLY[@]}}"'
        check(call("bash", "-c", script).split() == wanted, f"bash completes {typed} to {wanted}")
        # Outside of a completion the functions of zsh's system are these:
        script = (f'_describe() {{ shift $(($# - 1)); print -l -- ${{(P)1}}; }}; _files() {{ print FILES; }}; '
                  f'words=({typed}); CURRENT={len(words) + 1}; source {zsh}')
        offered = [line.split(":")[0] for line in call("zsh", "-f", "-c", script).splitlines()]
        if wanted:
            check(all(word in offered for word in wanted), f"zsh offers {wanted} for {typed}")
        else:
            check(offered == ["FILES"], f"zsh offers files for {typed}")


def another_project(prefix, directory):
    build = directory / "example"
    call("cmake", "-G", "Ninja", "-S", ROOT / "tests/package/example", "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}",
         "-DCMAKE_BUILD_TYPE=Debug", f"-DCMAKE_CXX_COMPILER={sys.argv[2]}")
    call("cmake", "--build", build)
    words = call(build / "example", *TLE).split()
    code, reference, _ = Satrec.twoline2rv(*TLE).sgp4_tsince(1440.0)
    check(code == 0 and all(abs(float(word) - x) < 1e-6 for word, x in zip(words, reference)),
          f"a project by find_package(dmise) has the orbit of python3-sgp4: {' '.join(words[:3])} km")
    text = (prefix / "lib/cmake/dmise/dmiseTargets.cmake").read_text() + call("ldd", build / "example")
    check(str(ROOT) not in text, "and needs nothing of the source tree")


def main():
    with tempfile.TemporaryDirectory(prefix="dmise-install-") as name:
        directory = pathlib.Path(name)
        call("cmake", "--install", BUILD, "--prefix", directory / "first", "--strip")
        prefix = (directory / "first").rename(directory / "moved")
        programs_work(prefix, directory)
        manuals_render(prefix)
        shells_complete(prefix)
        another_project(prefix, directory)


if __name__ == "__main__":
    main()
