"""Nodes that are started elsewhere join a run: by slot, or by what is free; the same bytes.

    join.py DMISE
"""

import os
import pathlib
import signal
import socket
import subprocess
import sys
import time

from harness import Run, check, check_same, first_frame, main, wait_until, write_scenario

HERE = pathlib.Path(__file__).resolve().parent
NODES = ("broker", "orbit-node", "environment-node")
NOT_NEEDED = ("positions-node", "fusion-node", "own-node")  # by the scenario; a stack starts them all the same


def free_address():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp://127.0.0.1:{probe.getsockname()[1]}"


class Stack:
    """A launch without nodes, and nodes that join it, each a process of its own."""

    def __init__(self, binary, scenario, out, keys):
        self.binary, self.scenario, self.out = binary, scenario, out
        self.address = free_address()
        self.keys = ("--keys", keys)
        self.runs = {}

    def __enter__(self):
        return self

    def __exit__(self, *error):
        for run in self.runs.values():
            run.__exit__(*error)

    def launch(self):
        self.runs["launch"] = Run(self.binary, "launch", self.scenario, "--nodes-elsewhere", "--bind", self.address,
                                  "--out", self.out, *self.keys)

    def join(self, node, *more, called=None):
        run = Run(self.binary, "join", self.scenario, node, "--master", self.address, "--out", self.out,
                  *self.keys, *more)
        self.runs[called or node] = run
        return run

    def finish(self):
        return {name: run.finish()[0] for name, run in self.runs.items()}


def joins_as(run, program="dmise-sensor-node"):
    """The node that a joined process is, once it is one."""
    def name():
        command = pathlib.Path(f"/proc/{run.process.pid}/cmdline").read_bytes().decode().split("\0")
        return command[0].endswith("/" + program) and command[command.index("--name") + 1]
    return wait_until(name, f"the program {program}")


def says(binary, *arguments):
    done = subprocess.run([str(binary), *map(str, arguments)], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stderr.strip()


def show_keys(keys, shown):
    """As a container has them: some files, and nobody's keys but its own."""
    shown.mkdir()
    for ring in ("everybody.pubs", "sensors.keys", "own-nodes.keys"):
        (shown / ring).symlink_to(keys / "rings" / ring)
    for name in (*NODES, "time-master", "operator"):
        (shown / f"{name}.key").symlink_to(keys / f"{name}.key")


def own_nodes(binary, directory):
    """Nodes of one's own are any free one of the scenario, too, and need the word for programs."""
    directory.mkdir()
    for file in (HERE / "own_actor").iterdir():
        (directory / file.name).write_bytes(file.read_bytes())
    scenario = write_scenario(directory, duration_s=150, name="own.yaml", on_silent_node="restart", network=", join_within_s: 60")
    scenario.write_text(scenario.read_text().replace("{catalogue: demo}", "{catalogue: demo}, {name: probe, motion: {node: gnc}}")
                        + f"nodes: [{{name: gnc, run: [{sys.executable}, walk.py], options: {{sleep_s: 0.05}}}}]\n")
    keys, shown, out = directory / "own-keys", directory / "own-secrets", directory / "own"
    check(says(binary, "keygen", keys, "--scenario", scenario, "--rings")[0] == 0, "keygen makes rings")
    show_keys(keys, shown)
    with Run(binary, "run", scenario, "--allow-programs", "--out", directory / "own-reference") as run:
        check(run.finish()[0] == 0, f"a run of one process is complete {run.stderr[-300:]}")
    with Stack(binary, scenario, out, shown) as stack:
        stack.launch()
        refused = stack.join("own-node", called="refused")
        code, _ = refused.finish()
        check(code == 2 and "--allow-programs" in refused.stderr, f"the word for programs is needed: {refused.stderr.strip()}")
        first = stack.join("own-node", "--allow-programs", called="first")
        check(joins_as(first, "dmise-own-node") == "gnc", "it is the node of the scenario")
        spare = stack.join("own-node", "--allow-programs", called="spare")
        os.environ["DMISE_SLOT"] = "1"  # is for nodes that have no name
        for node in (*NODES, "alpha", "beta"):
            stack.join(node)
        del os.environ["DMISE_SLOT"]
        first_frame(out, "alpha")
        os.kill(first.process.pid, signal.SIGKILL)
        check(joins_as(spare, "dmise-own-node") == "gnc", "a spare takes the place of an own node that was killed")
        codes = stack.finish()
        check(codes["launch"] == 0, f"the run is complete: {codes} {stack.runs['launch'].stderr[-300:]}")
    check_same(out, directory / "own-reference", "with a node of one's own")


def test(binary, directory):
    os.environ["PYTHONPATH"] = str(HERE.parents[1] / "build/python")
    own_nodes(binary, directory / "own-nodes")
    scenario = write_scenario(directory, duration_s=30, network=", join_within_s: 60")
    keys, reference = directory / "keys", directory / "reference"
    check(says(binary, "keygen", keys, "--scenario", scenario, "--rings")[0] == 0, "keygen makes rings")
    ring = keys / "rings/sensors.keys"
    check(oct(ring.stat().st_mode & 0o777) == "0o600", "their owner alone may read the sensors' keys")
    with Run(binary, "run", scenario, "--out", reference) as run:
        check(run.finish()[0] == 0, "a run of one process is complete")

    shown = directory / "secrets"
    show_keys(keys, shown)

    out = directory / "slots"
    with Stack(binary, scenario, out, shown) as stack:
        for slot in (2, 1):  # before there is anybody to join
            stack.join("sensor", "--slot", str(slot), called=f"slot {slot}")
        stack.launch()
        code, err = says(binary, "join", scenario, "alpha", "--seed", 9, "--master", stack.address, "--out", out, "--keys", shown)
        check(code == 2 and "seed" in err, f"who has another seed or scenario can't join: {err}")
        code, err = says(binary, "join", scenario, "broker", "--slot", 1, "--master", stack.address)
        check(code == 2 and "--slot" in err, f"a node with a name has no slot: {err}")
        for node in (*NODES, *NOT_NEEDED):
            stack.join(node)
        codes = stack.finish()
        check(set(codes.values()) == {0}, f"all end with 0: {codes} {stack.runs['launch'].stderr[-300:]}")
        idle = [node for node in NOT_NEEDED if "standing by" in stack.runs[node].stderr]
        check(idle == [*NOT_NEEDED], f"nodes that the scenario does not need stand by: {idle}")
    check_same(out, reference, "by slot, with rings of keys")

    out = directory / "free"
    with Stack(binary, scenario, out, shown) as stack:
        stack.launch()
        for called in ("first", "second", "spare"):
            stack.join("sensor", called=called)
        for node in NODES:
            stack.join(node)
        codes = stack.finish()
        check(set(codes.values()) == {0}, f"one sensor too many stands by: {codes}")
        spares = [name for name, run in stack.runs.items() if "standing by" in run.stderr]
        check(len(spares) == 1, f"one stood by: {spares}")
    check_same(out, reference, "by what is free")

    slow = write_scenario(directory, duration_s=3600, network=", join_within_s: 60, real_time: 5",
                          name="slow.yaml", on_silent_node="restart")
    out = directory / "replaced"
    with Stack(binary, slow, out, shown) as stack:
        stack.launch()
        sensors = {joins_as(run): run for run in (stack.join("sensor", called="first"), stack.join("sensor", called="second"))}
        check(set(sensors) == {"alpha", "beta"}, f"two are the two sensors: {sorted(sensors)}")
        spare = stack.join("sensor", called="spare")
        for node in NODES:
            stack.join(node)
        first_frame(out, "alpha")
        os.kill(sensors["alpha"].process.pid, signal.SIGKILL)
        check(joins_as(spare) == "alpha", "a spare takes the place of a sensor that was killed")
        wait_until(lambda: "resumes at tick" in (out / "logs/time-master.log").read_text()
                   or "process 2 of its name" in (out / "logs/time-master.log").read_text(),
                   "the time-master to take it")
        began = time.monotonic()
        for run in stack.runs.values():
            if run.process.poll() is None:
                run.process.send_signal(signal.SIGTERM)
        codes = stack.finish()
        check(codes["launch"] == 130, f"SIGTERM ends all {time.monotonic() - began:.1f} s later: {codes}")
        for run in stack.runs.values():
            check(not run.living(), "no process is left")

    with Stack(binary, scenario, directory / "alone", shown) as stack:
        waiting = stack.join("sensor", called="waiting")
        wait_until(lambda: (directory / "alone/.nodes/alpha.lock").exists(), "a sensor that waits")
        waiting.process.send_signal(signal.SIGINT)
        code, _ = waiting.finish()
        check(code == 130, f"one that waits for a run can be interrupted: {code}")
        code, err = says(binary, "join", scenario, "sensor", "--slot", 3, "--master", stack.address, *stack.keys)
        check(code == 0 and "nothing to do" in err, f"a slot too many ends at once: {err}")
        code, err = says(binary, "join", scenario, "gamma", "--master", stack.address, *stack.keys)
        check(code == 2 and "not a node of" in err, f"a node that nobody knows is refused: {err}")
        code, err = says(binary, "join", scenario, "alpha", "--master", "tcp://10.9.8.7:1")
        check(code == 2 and "keys" in err, f"no keys, no other address than loopback: {err}")


if __name__ == "__main__":
    main(test)
