"""Does what a schedule says, at its moments, and notes what was really done."""

import heapq
import itertools
import os
import signal
import time

from disturbance.schedule import FOR_EVER
from harness import command_of, wait_until

DUTY_ON_S, DUTY_OFF_S = 0.05, 0.08  # a process that is slowed runs and rests
AGAIN_S = 0.3  # between two tries to start a process again


class Attack:
    """`done`: the faults that met a living process, in their order, with the moment of each."""

    def __init__(self, network, schedule, hosts=None):
        self.network, self.schedule, self.hosts = network, schedule, hosts
        self.done = []
        self._events = []
        self._order = itertools.count()
        self._stopped = set()

    def run(self):
        """Until the run has ended, or nothing is left to do."""
        if not self.schedule.early:
            out = self.network.out
            wait_until(lambda: self.network.ended() or list(out.glob("*/frames.jsonl")), "a first frame")
        self._began = time.monotonic()
        for fault in self.schedule.faults:
            self._at(fault.at_s, self._begin, fault)
        while self._events and not self.network.ended():
            due = self._events[0][0]
            if time.monotonic() < due:
                time.sleep(min(0.01, max(0.0, due - time.monotonic())))
                continue
            _, _, action, arguments = heapq.heappop(self._events)
            action(*arguments)

    def mend_all(self):
        for name, pid in self._stopped:
            self._signal(pid, signal.SIGCONT)
        if self.hosts:
            for fault in self.schedule.faults:
                self.hosts.mend(fault.victim)
                self.hosts.widen(fault.victim)

    def _at(self, after_s, action, *arguments):
        heapq.heappush(self._events, (time.monotonic() + after_s, next(self._order), action, arguments))

    @staticmethod
    def _signal(pid, what):
        try:
            os.kill(pid, what)
            return True
        except ProcessLookupError:
            return False

    def _begin(self, fault):
        pid = self.network.pid(fault.victim)
        if pid is None:  # it is being started again, or has left
            return
        getattr(self, f"_{fault.kind}")(fault, pid)
        self.done.append((fault, time.monotonic()))

    def _kill(self, fault, pid):
        command = command_of(pid)
        self._signal(pid, signal.SIGKILL)
        if self.schedule.policy == "wait" and fault.victim not in ("time-master", "dmise"):
            self._at(fault.lasts_s, self._again, fault.victim, command)

    def _again(self, name, command):
        if self.network.pid(name) is not None:
            return
        self.network.start_again(name, command)
        self._at(AGAIN_S, self._look, name, command)

    def _look(self, name, command):
        """As a supervisor does: once more when it has ended while the run has not."""
        if self.network.has_failed(name):
            self._again(name, command)
        elif self.network.pid(name) is not None and not self.network.ended():
            self._at(AGAIN_S, self._look, name, command)

    def _stop(self, fault, pid):
        self._signal(pid, signal.SIGSTOP)
        self._stopped.add((fault.victim, pid))
        if fault.lasts_s != FOR_EVER:
            self._at(fault.lasts_s, self._signal, pid, signal.SIGCONT)

    def _slow(self, fault, pid):
        end = time.monotonic() + fault.lasts_s

        def off():
            if time.monotonic() < end and self._signal(pid, signal.SIGSTOP):
                self._at(DUTY_OFF_S, on)

        def on():
            if self._signal(pid, signal.SIGCONT):
                self._at(DUTY_ON_S, off)

        off()

    def _cut(self, fault, pid):
        self.hosts.cut(fault.victim)
        if self.schedule.policy == "wait":  # it ends when it has not heard the master for too long
            self._at(fault.lasts_s, self._look, fault.victim, command_of(pid))
        if fault.lasts_s != FOR_EVER:
            self._at(fault.lasts_s, self.hosts.mend, fault.victim)

    def _narrow(self, fault, _):
        self.hosts.narrow(fault.victim, 3)
        self._at(fault.lasts_s, self.hosts.widen, fault.victim)
