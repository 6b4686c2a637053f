"""Commands of `dmise` as functions: they run the program and return what it prints as JSON.

Options are those of the command (`dmise COMMAND --help`): `dmise.visible("night.yaml", sunlit=True)` is
`dmise visible night.yaml --sunlit`. Errors of input raise `ScenarioError`, others `EngineError`.
"""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from .errors import EngineError, ScenarioError
from .scenario_text import Scenario, source_of

_INVALID_INPUT = 2  # exit code of the program


def check(scenario: Scenario, **options: Any) -> dict[str, Any]:
    """Reads a scenario and all its files: what each sensor will see, notes and warnings."""
    found: dict[str, Any] = _answer("check", scenario, json=True, **options)
    return found


def visible(scenario: Scenario, **options: Any) -> list[dict[str, Any]]:
    """Passes of objects through the sensors' fields."""
    with tempfile.TemporaryDirectory() as directory:
        lines = _printed("visible", scenario, jsonl=True, **{"out": directory, **options}).splitlines()
        return [json.loads(line) for line in lines]


def survey(scenario: Scenario, **options: Any) -> dict[str, Any]:
    """What a network detects in whole nights."""
    with tempfile.TemporaryDirectory() as directory:
        found: dict[str, Any] = _answer("survey", scenario, json=True, **{"out": directory, **options})
        return found


def tradeoff(scenario: Scenario, **options: Any) -> dict[str, Any]:
    """What levels of effects and budgets cost and lack, against the reference."""
    with tempfile.TemporaryDirectory() as directory:
        out = pathlib.Path(options.pop("out", directory))
        _printed("tradeoff", scenario, out=out, **options)
        found: dict[str, Any] = json.loads((out / "tradeoff.json").read_text(encoding="utf-8"))
        return found


def score(run: str | os.PathLike[str] | None = None, **options: Any) -> dict[str, Any]:
    """Compares detections with truth, of the directory of a run, or with `frames` and `truth` of any FITS frames."""
    arguments = [] if run is None else [os.fspath(run)]
    found: dict[str, Any] = json.loads(run_command("score", arguments, {"json": True, **options}))
    return found


def program() -> str:
    """Path of the program `dmise`: the package's own, else the system's. Raises FileNotFoundError."""
    libraries = os.path.realpath(os.path.join(os.path.dirname(__file__), "lib"))
    own = os.path.join(os.path.dirname(libraries), "bin", "dmise")
    found = own if os.path.exists(own) else shutil.which("dmise")
    if not found:
        raise FileNotFoundError("dmise: the program is neither in the package nor in PATH")
    return found


def main() -> None:
    """The command `dmise` of a wheel: becomes the program."""
    os.execv(program(), ["dmise", *sys.argv[1:]])


def _answer(command: str, scenario: Scenario, **options: Any) -> Any:
    return json.loads(_printed(command, scenario, **options))


def _printed(command: str, scenario: Scenario, **options: Any) -> str:
    with file_of(scenario) as path:
        return run_command(command, [path], options)


@contextmanager
def file_of(scenario: Scenario) -> Iterator[str]:
    """A file of the scenario, in memory if it is none."""
    text, path = source_of(scenario)
    if text is None:
        yield f"./{path}" if path.startswith("-") else path  # which is no option
        return
    file = os.memfd_create("scenario", 0)  # which the program inherits
    try:
        os.write(file, text.encode())
        yield f"/proc/self/fd/{file}"
    finally:
        os.close(file)


def run_command(command: str, arguments: list[str], options: dict[str, Any]) -> str:
    """What the program prints. Raises `ScenarioError` for invalid input, `EngineError` for other failures."""
    words = [*arguments, *(word for name, value in options.items() for word in _words_of(name, value))]
    done = subprocess.run([program(), command, *words], capture_output=True, text=True, errors="replace",
                          close_fds=False, stdin=subprocess.DEVNULL)
    said = done.stdout
    if done.returncode != 0:
        said = (done.stderr.splitlines() or [f"dmise {command} ended with {done.returncode}"])[-1].removeprefix("dmise: ")
    for path in arguments:
        if path.startswith("/proc/"):  # a scenario in memory
            said = said.replace(path, "scenario")
    if done.returncode != 0:
        raise (ScenarioError if done.returncode == _INVALID_INPUT else EngineError)(said)
    return said


def _words_of(name: str, value: Any) -> list[str]:
    """An option of the command line."""
    option = "--" + name.rstrip("_").replace("_", "-")
    if isinstance(value, bool):
        return [option] if value else []
    if isinstance(value, (list, tuple)):
        return [word for one in value for word in (option, str(one))]
    return [] if value is None else [option, os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
