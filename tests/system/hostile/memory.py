"""Memory of the processes of a run while somebody attacks it."""

import pathlib
import threading

from harness import command_of

INTERVAL_S = 0.02


def resident_mib(pid):
    """(now, highest so far), or None for a process that has ended."""
    try:
        lines = pathlib.Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return None
    value = {line.split(":")[0]: line.split()[1] for line in lines if line.startswith(("VmRSS", "VmHWM"))}
    return (int(value["VmRSS"]) / 1024, int(value["VmHWM"]) / 1024) if len(value) == 2 else None


def title(pid):
    command = command_of(pid)
    name = pathlib.Path(command[0]).name if command else "?"
    return command[command.index("--name") + 1] if "--name" in command else name.removeprefix("dmise-")


class MemoryWatch:
    """Notes the highest resident memory of each process from `start` on."""

    def __init__(self, run):
        self._run, self._quit = run, threading.Event()
        self._at_start, self._peak, self._titles = {}, {}, {}
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def start(self):
        self._pids = self._run.living()
        for pid in self._pids:
            if memory := resident_mib(pid):
                self._at_start[pid] = self._peak[pid] = memory[1]
                self._titles[pid] = title(pid)
        self._thread.start()

    def _watch(self):
        while not self._quit.wait(INTERVAL_S):
            for pid in self._at_start:
                if memory := resident_mib(pid):
                    self._peak[pid] = max(self._peak[pid], memory[1])

    def stop(self):
        """(name, MiB at the start, highest MiB) of who has grown most."""
        self._quit.set()
        self._thread.join()
        worst = max(self._at_start, key=lambda pid: self._peak[pid] - self._at_start[pid])
        return self._titles[worst], self._at_start[worst], self._peak[worst]
