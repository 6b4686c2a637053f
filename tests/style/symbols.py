#!/usr/bin/python3
"""No function has two definitions: one that the linker would take in place of another, without a word.

    symbols.py BUILD

Reads the objects of the libraries of BUILD with `nm`. A function of namespace dmise that one object defines as its own
(T) may be defined in no other, neither so nor as inline (W).
"""
import collections
import pathlib
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
    return 1 if twice or not own else 0


if __name__ == "__main__":
    sys.exit(main())
