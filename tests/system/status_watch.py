"""`dmise status --watch` on a terminal: every node's row, at the terminal's size, without colours where NO_COLOR says so; q and
Ctrl-C end it and leave the terminal as it was; elsewhere it prints once.

    status_watch.py DMISE
"""

import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import termios
import time

from harness import PATIENCE_S, Run, check, main, wait_until, write_scenario


class Terminal:
    """A command on a terminal of a size."""

    def __init__(self, command, columns, rows, **more):
        self.master, slave = pty.openpty()
        self.resize(columns, rows)
        self.before = termios.tcgetattr(slave)
        environment = {k: v for k, v in os.environ.items() if k != "NO_COLOR"} | {"TERM": "xterm"} | more
        self.process = subprocess.Popen([str(c) for c in command], stdin=slave, stdout=slave, stderr=slave, env=environment,
                                        start_new_session=True)
        self.slave, self.text = slave, ""

    def resize(self, columns, rows):
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def read(self):
        while select.select([self.master], [], [], 0)[0]:
            self.text += os.read(self.master, 65536).decode(errors="replace")
        return self.text

    def screens(self):
        return self.read().split("\x1b[H")[1:]

    def press(self, keys):
        os.write(self.master, keys.encode())

    def end(self):
        deadline = time.monotonic() + PATIENCE_S
        while self.process.poll() is None and time.monotonic() < deadline:
            self.read()
            time.sleep(0.01)
        self.read()
        same = termios.tcgetattr(self.slave) == self.before
        self.process.kill()
        return self.process.wait(), same


def lines_of(screen):
    return [line.replace("\x1b[K", "").strip("\r") for line in screen.split("\n")]


def test(binary, directory):
    scenario = write_scenario(directory, network=", real_time: 1")
    out = directory / "out"
    with Run(binary, "launch", scenario, "--out", out) as run:
        address = wait_until(lambda: (out / "logs/master.address").exists() and (out / "logs/master.address").read_text().strip(),
                             "the master's address")
        watch = (binary, "status", address, "--watch")
        once = subprocess.run([str(c) for c in watch], capture_output=True, text=True, timeout=60, check=False)
        check(once.returncode == 0 and "\x1b" not in once.stdout and "node" in once.stdout, f"without a terminal it prints once {once.stderr}")

        terminal = Terminal(watch, 100, 30)
        wait_until(lambda: any("alpha" in s and "beta" in s and "\x1b[32m" in s for s in terminal.screens()), "a table in colours")
        check(all(len(line) <= 100 + 9 for s in terminal.screens()[:-1] for line in lines_of(s)), "its lines fit the terminal")
        seen = len(terminal.screens())
        terminal.resize(50, 8)
        wait_until(lambda: len(terminal.screens()) > seen + 3, "more tables")
        small = lines_of(terminal.screens()[-2])
        check(len(small) <= 8 and all(len(line) <= 50 + 9 for line in small), f"and follow its size: {len(small)} lines")
        terminal.press("q")
        code, same = terminal.end()
        check(code == 0 and same and terminal.text.rstrip().endswith("\x1b[?1049l"), f"q ends it, the terminal is as before: {code}")

        terminal = Terminal(watch, 100, 30, NO_COLOR="1")
        wait_until(lambda: any("alpha" in s for s in terminal.screens()), "a table")
        check("\x1b[3" not in terminal.text and "\x1b[1m" not in terminal.text, "NO_COLOR is kept")
        os.killpg(terminal.process.pid, signal.SIGINT)
        code, same = terminal.end()
        check(code == 0 and same, f"Ctrl-C ends it: {code}")

        terminal = Terminal(watch, 100, 30)
        wait_until(lambda: any("alpha" in s for s in terminal.screens()), "a table")
        subprocess.run([binary, "clock", "abort", address], capture_output=True, timeout=60, check=True)
        code, same = terminal.end()
        last = terminal.text.split("\x1b[?1049l")[-1]
        check(same and "node" in last and "\x1b[3" not in last, "the run's end leaves the last table as plain lines")
        run.finish()


if __name__ == "__main__":
    main(test)
