#!/usr/bin/env python3
"""The types of clients are those of the messages: each record of the Python package (`records.py`, `world.py`) has the fields
of its message in proto/dmise/v1 and nothing else, with their types, and each interface of the live view (`messages.ts`) has what
the gateway writes.

    client_types.py     exits 1 and names what is wrong
"""
import ast
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PYTHON = ROOT / "clients/python/src/dmise"
FLOATS, INTEGERS = {"double", "float"}, {"uint32", "uint64", "sint64", "int64", "fixed64", "int32"}
# Fields that a record has beyond its message: of its fourth frame, and what the client adds.
BEYOND = {"ObjectRoster": {"elements"},
          "ObjectStates": {"position_m", "slope_m_per_s", "velocity_m_per_s", "code", "attitude_object", "gcrs_from_body",
                           "attitude_rate_rad_per_s", "albedo", "roster"}}
LAYOUT = {"arrays"}  # how that frame is laid out
# Interfaces of the objects in a message of the gateway, by its type.
INTERFACES = {"run": ["Run"], "status": ["Status", "NodeState"], "sensors": ["Sensor"], "detections": ["Detection"],
              "truth": ["Truth"], "tracks": ["Track"], "tasks": ["Task"]}


def messages():
    """Fields of messages as (label, type, name), and words of enumerations, by name."""
    fields, words = {}, {}
    for path in sorted((ROOT / "proto/dmise/v1").glob("*.proto")):
        text = re.sub(r"//.*", "", path.read_text())
        for name, body in re.findall(r"^message (\w+) \{(.*?)^\}", text, re.M | re.S):
            fields[name] = re.findall(r"^  (repeated |optional |)([\w.]+) (\w+) = \d+;", body, re.M)
        for name, body in re.findall(r"^enum (\w+) \{(.*?)^\}", text, re.M | re.S):
            prefix = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).upper() + "_"
            words[name] = [word.removeprefix(prefix).lower() for word in re.findall(r"(\w+) = \d+;", body)]
    return fields, words


def records():
    """Types of the fields of records, by class; a name for a type stands for it."""
    found, names = {}, {}
    for module in ("records", "world"):
        for node in ast.parse((PYTHON / f"{module}.py").read_text()).body:
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
                names[node.targets[0].id] = ast.unparse(node.value)
            if isinstance(node, ast.ClassDef) and node.decorator_list:
                types = [(line.target.id, ast.unparse(line.annotation)) for line in node.body if isinstance(line, ast.AnnAssign)]
                found[node.name] = {name: names.get(type_, type_) if "Literal" in names.get(type_, "") else type_ for name, type_ in types}
    return found


def type_of(label, kind, words):
    """The type of a record's field."""
    if kind in words:
        return f"Literal{words[kind]}"
    one = "float" if kind in FLOATS else "int" if kind in INTEGERS else {"string": "str", "bool": "bool"}.get(kind, kind)
    if label == "repeated ":
        return "Floats" if kind in FLOATS else f"list[{one}]"
    return f"{one} | None" if label == "optional " or one == kind and kind[0].isupper() else one


def faults_of_records():
    fields, words = messages()
    for name, has in records().items():
        if name not in fields:
            yield f"clients/python: {name}: no message of proto/dmise/v1 has this name"
            continue
        wanted = {field: type_of(label, kind, words) for label, kind, field in fields[name] if field not in LAYOUT}
        beyond = BEYOND.get(name, set())
        for field in sorted(wanted.keys() - has.keys()):
            yield f"clients/python: {name} lacks {field}: {wanted[field]}"
        for field in sorted(has.keys() - wanted.keys() - beyond):
            yield f"clients/python: {name}.{field} is no field of its message"
        for field in wanted.keys() & has.keys() - beyond:
            if has[field] != wanted[field]:
                yield f"clients/python: {name}.{field} is {has[field]}, its message says {wanted[field]}"


def faults_of_view():
    text = (ROOT / "clients/dashboard/src/messages.ts").read_text()
    members = {name: set(re.findall(r"(\w+)\??:", body))
               for name, body in re.findall(r"^export interface (\w+) \{(.*?)\}(?=\n(?:export|//|\n))", text, re.M | re.S)}
    code = (ROOT / "nodes/gateway/live_view.cpp").read_text()
    for body in re.findall(r"^\S[^\n]* LiveView::\w+\(.*?^\}", code, re.M | re.S):
        kind = re.search(r'\.field\("type", "(\w+)"\)', body)
        if not kind or kind[1] not in INTERFACES:
            continue
        wrote = set(re.findall(r'(?:\b(?:field|key|list)\(|put\(json, )"(\w+)"', body))
        said = set().union(*(members[name] for name in INTERFACES[kind[1]]))
        for name in sorted((wrote ^ said) - {"type", kind[1], kind[1] + "s"}):  # the last are the list itself
            yield f"messages.ts and live_view.cpp: only one of them has {name} in {', '.join(INTERFACES[kind[1]])}"


def main():
    wrong = [*faults_of_records(), *faults_of_view()]
    print("\n".join(wrong) or f"ok: {len(records())} records and {sum(map(len, INTERFACES.values()))} interfaces have the fields of their messages")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
