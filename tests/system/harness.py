"""What the system tests share: scenarios of small cameras, a launched run, its processes."""

import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: 5, seed: 1}}
objects: [{{catalogue: {objects}}}]
stars: {{catalogue: kstars}}
sensors:
  - {{name: {first}, site: atlanta, camera: small.yaml, pointing: zenith, exposure_s: 2, cadence_s: 5}}
  - {{name: {second}, site: savannah, camera: small.yaml, pointing: zenith, exposure_s: 2, cadence_s: 5}}
network: {{on_silent_node: {on_silent_node}, silent_after_s: {silent_after_s}{network}}}
output: {{png: false}}
"""

CAMERA = """\
name: small
optics: {projection: gnomonic, columns: 512, rows: 384, pixel_pitch_m: 5.4e-6, field_of_view_deg: 15,
         aperture_m: 0.02}
detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
"""

PATIENCE_S = 150.0  # for what has no deadline of its own, on a loaded machine


class Failure(Exception):
    pass


def check(holds, claim):
    if not holds:
        raise Failure(claim)
    print(f"ok: {claim}")


def main(test):
    """Runs test(binary, directory) in a fresh directory; the binary is the first argument."""
    with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
        try:
            test(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(directory))
        except Failure as failure:
            sys.exit(f"FAIL: {failure}")


def write_scenario(directory, duration_s=3600, objects="demo", first="alpha", second="beta",
                   on_silent_node="fail", silent_after_s=5.0, network="", name="scenario.yaml"):
    """`network`: further keys of that section, ", key: value"."""
    directory.mkdir(exist_ok=True)
    (directory / "small.yaml").write_text(CAMERA)
    path = directory / name
    path.write_text(SCENARIO.format(
        duration_s=duration_s, objects=objects, first=first, second=second,
        on_silent_node=on_silent_node, silent_after_s=silent_after_s, network=network))
    return path


def without_rights(binary, directory):
    """Words before a command that let a user without rights run it, who may read `directory`; None where this user is no root, or
    where the program or what is beside it is closed to others, as in a home."""
    words = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
    if os.geteuid() != 0 or not shutil.which("setpriv"):
        return None
    directory.chmod(0o755)
    opened = subprocess.run([*words, binary, "list", "sites"], capture_output=True).returncode == 0
    catalogue = pathlib.Path(__file__).resolve().parents[2] / "launch/catalogues/demo.tle"
    return words if opened and subprocess.run([*words, "test", "-r", catalogue]).returncode == 0 else None


def session_of(pid):
    """Session of a process, or None for one that is gone or a zombie."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return None
    return None if fields[0] in "ZX" else int(fields[3])


def command_of(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().decode().split("\0")[:-1]
    except OSError:
        return []


def wait_until(condition, what, patience_s=PATIENCE_S):
    """The first true value of condition(), looked at every 10 ms; Failure after `patience_s`."""
    deadline = time.monotonic() + patience_s
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            raise Failure(f"waited {patience_s:g} s in vain for {what}")
        time.sleep(0.01)


class Run:
    """`dmise ARGUMENTS` in a session of its own, with all processes that it starts."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([str(a) for a in arguments], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True, start_new_session=True)
        self.stdout = self.stderr = ""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for pid in self.living():
            os.kill(pid, signal.SIGKILL)
        self.process.communicate()

    def living(self):
        """All processes of the session that live."""
        pids = [int(p.name) for p in pathlib.Path("/proc").iterdir() if p.name.isdigit()]
        return {pid for pid in pids if session_of(pid) == self.process.pid}

    def node(self, name):
        """pid of the sensor of that name, or of the program dmise-NAME; None if it does not run."""
        for pid in self.living():
            command = command_of(pid)
            if ("--name", name) in zip(command, command[1:]):
                return pid
            if command and command[0].endswith(f"/dmise-{name}"):
                return pid
        return None

    def interrupt(self):
        """Ctrl-C: SIGINT to all of the terminal's foreground group."""
        os.killpg(self.process.pid, signal.SIGINT)

    def finish(self, patience_s=PATIENCE_S):
        """Waits for the end; returns (exit code, seconds waited)."""
        began = time.monotonic()
        try:
            self.stdout, self.stderr = self.process.communicate(timeout=patience_s)
        except subprocess.TimeoutExpired:
            raise Failure(f"still runs after {patience_s:g} s") from None
        return self.process.returncode, time.monotonic() - began

    def nothing_left(self):
        left = [" ".join(command_of(pid)) for pid in self.living()]
        check(not left, f"{len(left)} processes are left running {left}")


def tell_figures(figures, path=None):
    """Prints a line of figures, and appends it to the file if there is one."""
    line = json.dumps(figures)
    print(line)
    if path:
        with open(path, "a", encoding="utf-8") as file:
            file.write(line + "\n")


def products(out):
    """The bytes of everything that must not depend on how a run went, by path."""
    paths = [*out.glob("*/frame-*.fits"), *out.glob("*/*.jsonl"), *out.glob("*.jsonl"), *out.glob("positions.*")]
    return {str(p.relative_to(out)): p.read_bytes() for p in paths if p.name != "cost.jsonl"}


def check_same(out, reference, claim):
    ours, theirs = products(out), products(reference)
    differ = sorted(p for p in ours.keys() | theirs.keys() if ours.get(p) != theirs.get(p))
    check(not differ and theirs, f"{claim}: {len(theirs)} files, {len(differ)} differ {differ[:3]}")


def truth_at(time_ns, truth):
    """Where the one object of lines of truth.jsonl is: from the nearest exposure, in the field of a point mass: to 1 m in 5 s."""
    near = min(truth, key=lambda t: abs(t["middle_ns"] - time_ns))
    place, velocity = near["true_position_gcrs_m"], near["true_velocity_gcrs_m_per_s"]
    s, r = 1e-9 * (time_ns - near["middle_ns"]), math.hypot(*place)
    return [x + v * s - 0.5 * 3.986004418e14 * x / r**3 * s * s for x, v in zip(place, velocity)]


def first_frame(out, sensor="*"):
    """Waits for the first frame of a sensor, or of any."""
    return wait_until(lambda: list(out.glob(f"{sensor}/frame-000001.fits")), f"a first frame in {out}")
