#!/usr/bin/python3
"""No function and no class has two definitions: one that the linker would take in place of another, without a word.

    symbols.py BUILD CHECKOUT

Reads the objects of the libraries of BUILD with `nm`. A function of namespace dmise that one object defines as its own
(T) may be defined in no other, neither so nor as inline (W). Reads the sources of CHECKOUT, tests and fuzz targets apart,
which are programs of one file: a class outside of unnamed namespaces has a name of its own.
"""
import collections
import pathlib
import re
import subprocess
import sys


def definitions(library):
    """Pairs of name and kind, with the object, of what a library defines."""
    printed = subprocess.run(["nm", "--defined-only", "-A", library], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                             text=True, check=True).stdout
    for line in printed.splitlines():
        place, _, name = line.rpartition(" ")
        if name.startswith(("_ZN5dmise", "_ZNK5dmise")) and "_GLOBAL__N_" not in name and place[-1] in "TW":
            yield name, place[-1], place.split(" ")[0].rsplit(":", 1)[0]


def classes(path):
    """Classes that a source defines in namespaces that have names."""
    inside, unnamed = [], 0
    for line in path.read_text(encoding="utf-8").splitlines():
        if opened := re.match(r"(?:inline )?namespace\s*([\w:]*)\s*\{", line):
            inside.append(opened[1])
        elif re.match(r"\}\s*// namespace", line) and inside:
            inside.pop()
        elif "" not in inside and (found := re.match(r"(?:template <[^;]*> )?(?:class|struct|union|enum class) (\w+)"
                                                     r"(?: final)?(?: : [^;]*)? \{", line)):
            yield "::".join([*inside, found[1]])


def main():
    own, shared = collections.defaultdict(set), collections.defaultdict(set)
    libraries = [path for path in sorted(pathlib.Path(sys.argv[1]).rglob("*.a")) if "CMakeFiles" not in path.parts]
    for library in libraries:
        for name, kind, place in definitions(library):
            (own if kind == "T" else shared)[name].add(place)
    twice = [name for name, places in own.items() if len(places | shared[name]) > 1]
    for name in twice:
        print(f"{name}: {' '.join(sorted(own[name] | shared[name]))}")
    print(f"{len(own)} functions of {len(libraries)} libraries, {len(twice)} defined twice")
    places = collections.defaultdict(list)
    checkout = pathlib.Path(sys.argv[2])
    for folder in ("bench", "broker", "core", "launch", "nodes", "orbit-node", "sensors", "time-master"):
        for path in sorted([*(checkout / folder).rglob("*.h"), *(checkout / folder).rglob("*.cpp")]):
            for name in classes(path):
                places[name].append(str(path.relative_to(checkout)))
    homonyms = {name: where for name, where in places.items() if len(where) > 1}
    for name, where in homonyms.items():
        print(f"{name}: {' '.join(where)}")
    print(f"{len(places)} classes, {len(homonyms)} names of two")
    return 1 if twice or homonyms or not own or not places else 0


if __name__ == "__main__":
    sys.exit(main())
