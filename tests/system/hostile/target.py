"""A launched run as a stranger meets it: an address, and whatever its time-master tells anybody."""

import os
import time

import zmq

from harness import Failure, Run, first_frame, wait_until
from hostile.wire import node_pb2, time_pb2

PATIENCE_S = 60.0


class Target:
    """`context`, `address`, `endpoints`: what anybody may have. `run`, `out`: of the test alone."""

    def __init__(self, binary, scenario, out, keys=None, hosts=0):
        self.out, self.keys = out, keys
        more = (["--keys", keys] if keys else []) + (["--hosts", hosts] if hosts else [])
        self.run = Run(binary, "launch", scenario, "--out", out, *more)
        self.context = zmq.Context()
        self.endpoints = None

    def __enter__(self):
        try:
            first_frame(self.out)
            self.address = (self.out / "logs/master.address").read_text().strip()
            self.endpoints = self.hello()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self.context.destroy(linger=0)
        self.run.__exit__()

    def ended(self):
        return self.run.process.poll() is not None

    def socket(self, kind, address, peer="time-master", **options):
        """A socket connected to `address`; with keys as the stranger's, who knows the server keys. `options`: those
        of ZeroMQ."""
        socket = self.context.socket(kind)
        socket.linger = 0
        socket.sndtimeo = int(1000 * PATIENCE_S)  # to a run that has ended
        for name, value in options.items():
            setattr(socket, name, value)
        if self.keys:
            socket.curve_publickey, socket.curve_secretkey = self._pair("stranger")
            socket.curve_serverkey = self._public(peer)
        socket.connect(address)
        return socket

    def _pair(self, name):
        words = dict(line.split()[:2] for line in (self.keys / f"{name}.key").read_text().splitlines()
                     if len(line.split()) >= 2)
        return words["public"].encode(), words["secret"].encode()

    def _public(self, name):
        for file in (f"{name}.pub", f"{name}.key"):
            if (self.keys / file).exists():
                for line in (self.keys / file).read_text().splitlines():
                    if line.startswith("public "):
                        return line.split()[1].encode()
        raise Failure(f"no public key of {name}")

    def hello(self):
        """Endpoints, as anybody is told; the last known ones of a run that ends meanwhile."""
        master = self.socket(zmq.DEALER, self.address)
        try:
            master.send(node_pb2.NodeMessage(hello=node_pb2.Hello()).SerializeToString())
            deadline = time.monotonic() + PATIENCE_S
            while not master.poll(100):
                if self.ended() and self.endpoints is not None:
                    return self.endpoints
                if time.monotonic() > deadline:
                    raise Failure("the time-master does not answer")
            return time_pb2.MasterMessage.FromString(master.recv()).endpoints
        finally:
            master.close(0)

    def in_child(self, attack):
        """attack(self) in a process of its own, which may crash: what harms the run may harm it as well."""
        child = os.fork()
        if child == 0:
            try:
                self.context = zmq.Context()
                attack(self)
            finally:
                os._exit(0)  # no farewell: its connections break
        os.waitpid(child, 0)

    def publisher(self, name):
        return next(p for p in self.endpoints.publishers if p.name == name)

    def connected(self, socket):
        """Waits until a socket that was connected just now has shaken hands, or was turned away."""
        monitor = socket.get_monitor_socket()
        deadline = time.monotonic() + 5.0
        done = {zmq.EVENT_HANDSHAKE_SUCCEEDED: True, zmq.EVENT_HANDSHAKE_FAILED_AUTH: False,
                zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL: False, zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL: False}
        try:
            while time.monotonic() < deadline:
                if monitor.poll(100):
                    event = int.from_bytes(monitor.recv_multipart()[0][:2], "little")
                    if event in done:
                        return done[event]
            return False
        finally:
            socket.disable_monitor()

    def wait_for_tick(self, tick):
        wait_until(lambda: self.ended() or self.hello().granted_tick >= tick, f"tick {tick}", PATIENCE_S)
