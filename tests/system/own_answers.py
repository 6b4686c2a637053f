"""Answers of a user's program in Python to steps that are sent ahead: in order, none is lost or late. This test plays the run's part.

    own_answers.py
"""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "build/python"))
import zmq  # noqa: E402
from dmise.v1 import environment_pb2, own_node_pb2, state_pb2  # noqa: E402
from harness import PATIENCE_S, Failure, check  # noqa: E402

STEPS = 65  # as many as a run sends ahead
FAULT_AT = 40
MODEL = """\
import asyncio, os, signal, sys, time
import dmise

@dmise.actor("probe")
class Model:
    def __call__(self, t_s, world, options):
        if world.tick == options["at"]:
            {fault}
        return dmise.State(position_m=[7e6, 0, 0], velocity_m_per_s=[0, 7e3, 0])

    def checkpoint(self):
        return b"so far"

dmise.serve(Model)
"""


class Program:
    """A program of the user's that has begun."""

    def __init__(self, directory, fault):
        (directory / "model.py").write_text(MODEL.format(fault=fault))
        self.socket = zmq.Context.instance().socket(zmq.PAIR)
        self.socket.rcvtimeo = int(1000 * PATIENCE_S)
        address = f"ipc://{directory}/socket"
        self.socket.bind(address)
        self.log = directory / "log"
        with self.log.open("w") as log:
            self.process = subprocess.Popen([sys.executable, "model.py"], cwd=directory, stdout=log, stderr=log,
                                            env={**os.environ, "DMISE_OWN_NODE": address, "PYTHONPATH": str(ROOT / "build/python")})
        begin = own_node_pb2.OwnNodeBegin(schema_version=1, node="gnc", alive_every_s=0.2, start_utc="2018-01-21T00:15:00Z",
                                          options_json=f'{{"at": {FAULT_AT}}}', objects=[{"name": "probe", "moved": True}])
        self.socket.send(own_node_pb2.OwnNodeRequest(begin=begin).SerializeToString())
        ready = self.answer()[0]
        if not ready.HasField("ready"):
            raise Failure(f"it is not ready: {ready}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.socket.close(linger=0)

    def answer(self):
        frames = self.socket.recv_multipart()
        return own_node_pb2.OwnNodeAnswer.FromString(frames[0]), frames[1:]

    def ask(self, ticks):
        """Until the program has ended, for nobody hears the rest."""
        for tick in ticks:
            step = own_node_pb2.OwnNodeStep(tick=tick, time_ns=tick * 10**9, give_checkpoint=tick % 64 == 63)
            environment = environment_pb2.EnvironmentState(tick=tick, time_ns=tick * 10**9)
            frames = [own_node_pb2.OwnNodeRequest(step=step).SerializeToString(), environment.SerializeToString()]
            try:
                self.socket.send_multipart(frames, zmq.NOBLOCK)
            except zmq.Again:
                return

    def heard(self):
        """What it says until it has answered all steps or failed: ticks, "alive" and what failed."""
        said = []
        while not said or said[-1] not in (STEPS - 1, "failed"):
            head, more = self.answer()
            kind = head.WhichOneof("body")
            said.append(state_pb2.ObjectStates.FromString(more[0]).tick if kind == "stepped" else kind)
            if kind == "stepped":
                check_checkpoint(head.stepped, said[-1])
        return said


def check_checkpoint(stepped, tick):
    if stepped.HasField("checkpoint") != (tick % 64 == 63):
        raise Failure(f"tick {tick}: {stepped}")


def ticks_of(said):
    return [one for one in said if isinstance(one, int)]


def keeps_none_back(directory):
    """What was quick goes before a slow step is over, with a sign of life."""
    with Program(directory, "time.sleep(1.5)") as program:
        program.ask(range(STEPS))
        said = program.heard()
        check(ticks_of(said) == list(range(STEPS)), "each step is answered once, in order")
        last_alive = max(i for i, one in enumerate(said) if one == "alive")
        check(said.index(FAULT_AT - 1) < last_alive < said.index(FAULT_AT), f"answers before the slow one are not kept for it: {said}")


def answers_one_by_one(directory):
    """Steps that come alone, as in a run that keeps time; also of a model that waits and prints."""
    for fault in ("pass", "print('half way')", "asyncio.run(asyncio.sleep(0.01))"):
        with Program(directory, fault) as program:
            for tick in range(STEPS):
                program.ask([tick])
                head, more = program.answer()
                if state_pb2.ObjectStates.FromString(more[0]).tick != tick:
                    raise Failure(f"tick {tick}: {head}")
            check(program.log.read_text() == ("half way\n" if "print" in fault else ""), f"{fault}: each step is answered, alone")
            program.socket.send(own_node_pb2.OwnNodeRequest(end={}).SerializeToString())
            check(program.process.wait(PATIENCE_S) == 0, "it ends")


def loses_none_at_its_end(directory):
    for fault in ("sys.exit(3)", "raise KeyboardInterrupt", "raise ValueError('no fuel')", "asyncio.run(asyncio.sleep('x'))"):
        with Program(directory, fault) as program:
            program.ask(range(STEPS))
            check(program.process.wait(PATIENCE_S) != 0, f"{fault}: it ends")
            program.socket.rcvtimeo = 1000
            said = []
            try:
                while True:
                    head, more = program.answer()
                    said.append(state_pb2.ObjectStates.FromString(more[0]).tick if more else head.WhichOneof("body"))
            except zmq.Again:
                pass
            told = ["failed"] if "Error" in fault or "'x'" in fault else []
            check([one for one in said if one != "alive"] == [*range(FAULT_AT), *told], f"{fault}: what it said before has come")


def stops_and_goes_on(directory):
    with Program(directory, "os.kill(os.getpid(), signal.SIGSTOP)") as program:
        program.ask(range(STEPS))
        os.waitid(os.P_PID, program.process.pid, os.WSTOPPED | os.WNOWAIT)
        program.process.send_signal(signal.SIGCONT)
        check(ticks_of(program.heard()) == list(range(STEPS)), "stopped, and continued: each step is answered once, in order")


if __name__ == "__main__":
    try:
        for test in (keeps_none_back, answers_one_by_one, loses_none_at_its_end, stops_and_goes_on):
            with tempfile.TemporaryDirectory(prefix="dmise-test-") as directory:
                test(pathlib.Path(directory))
    except Failure as failure:
        sys.exit(f"FAIL: {failure}")
