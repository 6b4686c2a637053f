#!/usr/bin/env python3
"""Types of scenarios for Python's type checkers and editors, from the schema that the program prints.

    scenario_types.py [DMISE] > src/dmise/scenario.py

A test compares the module with what this prints.
"""
import json
import keyword
import subprocess
import sys
import textwrap

HEAD = '''\
"""Scenarios as typed mappings: keys, ranges and units as in docs/reference/scenario.md.

    night: Scenario = {"simulation": {"start": "2018-01-21T03:00:00Z", "duration_s": 60, "tick_s": 5}, "sensors": [west]}
    dmise.Simulation(night)

Written by clients/python/scenario_types.py from `dmise schema scenario`.
"""
from __future__ import annotations

import datetime
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict

if TYPE_CHECKING:
    from typing import Required

Text = str | os.PathLike[str]
Utc = str | datetime.datetime
Switch = bool | Literal["on", "off", "yes", "no"]
'''
SWITCH = [True, False, "on", "off", "yes", "no"]
PLAIN = {"number": "float", "integer": "int", "string": "str", "boolean": "bool", "object": "Mapping[str, Any]", "null": "None"}


def class_of(section):
    return "".join(word.capitalize() for word in section.split("_"))


def union(types):
    return " | ".join(dict.fromkeys(types))


def type_of(form):
    """The type of a value of the schema."""
    if "$ref" in form:
        return class_of(form["$ref"].rpartition("/")[2])
    if "anyOf" in form:
        return union(type_of(one) for one in form["anyOf"])
    if "enum" in form:
        return type_of_choice(form["enum"])
    kind = form.get("type")
    if kind == "array":
        return f"Sequence[{type_of(form['items'])}]" if "items" in form else "Sequence[Any]"
    if kind == ["string", "number"]:
        return "Text"
    if kind == "string" and "pattern" in form and "[0-9]{4}-" in form["pattern"]:
        return "Utc"
    if isinstance(kind, list):
        return union(PLAIN[one] for one in kind)
    return PLAIN[kind] if kind else "Any"


def type_of_choice(values):
    switch = all(any(one is value for value in values) for one in (True, False))
    rest = [value for value in values if not isinstance(value, bool) and not (switch and value in SWITCH)]
    words = [f"Literal[{', '.join(json.dumps(value) for value in rest)}]"] if rest else []
    return union(["Switch"] * switch + words)


def field_of(name, form, required):
    kind = type_of(form)
    lines = [f"    {name}: {f'Required[{kind}]' if required else kind}"]
    return lines + documented(form.get("description", ""))


def documented(text):
    if not text:
        return []
    text = text.replace("\\", "\\\\").replace('"', "'")
    return textwrap.wrap(f'"""{text}"""', 126, initial_indent="    ", subsequent_indent="    ")


def class_text(section, form):
    name, keys = class_of(section), form["properties"]
    if patterns := form.get("patternProperties"):
        kinds = union([type_of(one) for one in [*keys.values(), *patterns.values()]])
        return "\n".join([*textwrap.wrap(f"# {form['description']}", 126, subsequent_indent="# "),
                          *textwrap.wrap(f"{name} = Mapping[str, {quoted(kinds)}]", 126, subsequent_indent="    ")]) + "\n"
    if any(not key.isidentifier() or keyword.iskeyword(key) for key in keys):
        raise SystemExit(f"{section}: a key is no name in Python")
    lines = [f"class {name}(TypedDict, total=False):", *documented(form["description"]), ""]
    for key, value in keys.items():
        lines += field_of(key, value, key in form["required"])
    return "\n".join(lines) + "\n"


def quoted(kinds):
    """A type as an alias, which is evaluated, may name it."""
    return json.dumps(kinds) if any(one[:1].isupper() for one in kinds.split(" | ")) and "Literal" not in kinds else kinds


def module_of(schema):
    texts = [class_text(section, form) for section, form in schema["definitions"].items()]
    return HEAD + "".join(f"\n\n{text}" for text in texts)


if __name__ == "__main__":
    program = sys.argv[1] if len(sys.argv) > 1 else "dmise"
    print(module_of(json.loads(subprocess.run([program, "schema", "scenario"], check=True, capture_output=True).stdout)), end="")
