#!/usr/bin/env python3
"""Holds every include line against docs/layers.toml: a directory includes only what stands in its entry, all of
which stands above it, and nothing stands there that it does not include. No more sources see a header that is slow to
compile, by way of others or not, than stand there. What has one answer is said in its files alone. Directories are
in at most 12 boxes that do not use each other in a circle, and have at most 20 pairs of files.

    layers.py            exits 1 and names what is wrong
    layers.py --write    writes the table of docs/architecture.md anew
"""
import pathlib
import re
import sys
import tomllib
from graphlib import CycleError, TopologicalSorter

ROOT = pathlib.Path(__file__).resolve().parents[2]
LAYERS = ROOT / "docs/layers.toml"
DOCUMENT = ROOT / "docs/architecture.md"
MARKS = "<!-- from docs/layers.toml -->\n", "<!-- to here -->\n"
# Libraries by how their headers begin.
LIBRARIES = {"zmq.": "ZeroMQ", "spdlog/": "spdlog", "CLI/": "CLI11", "fitsio": "CFITSIO", "png.h": "libpng",
             "fftw3": "FFTW", "erfa": "ERFA", "yaml-cpp/": "yaml-cpp", "nlohmann/": "nlohmann/json",
             "pugixml": "pugixml", "GeographicLib/": "GeographicLib", "glm/": "GLM", "GL/": "OpenGL", "EGL/": "EGL",
             "google/protobuf/": "Protocol Buffers", "dmise/v1/": "Protocol Buffers", "prometheus/": "prometheus-cpp",
             "zlib.h": "zlib", "zstd.h": "zstd", "sodium.h": "libsodium", "OpenImageIO/": "OpenImageIO",
             "nanobind/": "nanobind", "Eigen/": "Eigen", "unsupported/Eigen/": "Eigen", "boost/": "Boost"}
MOST_BOXES = 12  # that a person can hold in mind
MOST_PAIRS = 20  # a header and its source in a directory
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.M)


def sources():
    for top in sorted({pathlib.PurePath(layer["folder"]).parts[0] for layer in read()}):
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield path


def read(rows="layer"):
    return tomllib.loads(LAYERS.read_text())[rows]


def who_sees(header):
    """The sources that include a header, directly or by others."""
    by_file = {str(path.relative_to(ROOT)): set(INCLUDE.findall(path.read_text())) for path in sources()}
    seeing, wanted = set(), {header}
    while wanted:
        found = {name for name, includes in by_file.items() if includes & wanted} - seeing
        seeing |= found
        wanted = {name for name in found if name.endswith(".h")}
    return sorted(name for name in seeing if name.endswith(".cpp"))


def faults(layers):
    place = {layer["folder"]: number for number, layer in enumerate(layers)}
    for layer in layers:
        for used in layer["uses"]:
            if place.get(used, len(layers)) >= place[layer["folder"]]:
                yield f"docs/layers.toml: {layer['folder']} uses {used}, which is not above it"
            if used in layer.get("never", ()):
                yield f"docs/layers.toml: {layer['folder']} uses {used}, which it must never"
    seen = {layer["folder"]: set() for layer in layers}
    by_folder = {layer["folder"]: set(layer["uses"]) | set(layer.get("libraries", ())) for layer in layers}
    for path in sources():
        folder = str(path.parent.relative_to(ROOT))
        name = path.relative_to(ROOT)
        if folder not in place:
            yield f"{name}: docs/layers.toml does not know {folder}"
            continue
        for header in INCLUDE.findall(path.read_text()):
            used = next((library for begin, library in LIBRARIES.items() if header.startswith(begin)), None)
            if used is None:
                used = str(pathlib.PurePath(header).parent)
                if used not in place or used == folder:
                    continue
            seen[folder].add(used)
            if used not in by_folder[folder]:
                yield f"{name}: includes {header}, and docs/layers.toml does not let {folder} use {used}"
    for folder, uses in by_folder.items():
        for unused in sorted(uses - seen[folder]):
            yield f"docs/layers.toml: {folder} does not use {unused}"


def boxes(layers):
    """The boxes of the picture, lowest first, each with its rows."""
    found = {}
    for layer in layers:
        found.setdefault(layer["box"], []).append(layer)
    return found


def used_boxes(layers):
    """The others that the directories of each box use."""
    box_of = {layer["folder"]: layer["box"] for layer in layers}
    return {box: {box_of[used] for row in rows for used in row["uses"] if used in box_of} - {box} for box, rows in boxes(layers).items()}


def box_faults(layers):
    uses = used_boxes(layers)
    if len(uses) > MOST_BOXES:
        yield f"docs/layers.toml: {len(uses)} boxes, {MOST_BOXES} at most"
    try:
        TopologicalSorter(uses).prepare()
    except CycleError as error:
        yield f"docs/layers.toml: boxes use each other: {' -> '.join(error.args[1])}"
    for layer in layers:
        pairs = {path.stem for path in (ROOT / layer["folder"]).glob("*") if path.suffix in (".h", ".cpp")}
        if len(pairs) > layer.get("pairs", MOST_PAIRS):
            yield f"{layer['folder']}: {len(pairs)} pairs of files, {layer.get('pairs', MOST_PAIRS)} at most"


def said_elsewhere():
    """Lines that only the files of an `only` row may have, elsewhere in the program."""
    for row in read("only"):
        says = re.compile(row["says"])
        for path in sources():
            name = str(path.relative_to(ROOT))
            if name in row["files"] or name.startswith("bench/"):
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if says.search(line):
                    yield f"{name}:{number}: {row['what']}, for which docs/layers.toml names {', '.join(row['files'])}"


def table(layers):
    rows = ["| box | directories | uses |", "|---|---|---|"]
    uses = used_boxes(layers)
    for box, of_box in boxes(layers).items():
        directories = "<br>".join(f"`{layer['folder']}` {layer['what']}" for layer in of_box)
        rows.append(f"| **{box}** | {directories} | {', '.join(other for other in uses if other in uses[box])} |")
    return "\n".join(rows) + "\n"


def document(layers):
    before, found, rest = DOCUMENT.read_text().partition(MARKS[0])
    after = rest.partition(MARKS[1])[2]
    if not found:
        raise ValueError(f"docs/architecture.md has no line {MARKS[0]!r}")
    return before + MARKS[0] + "\n" + table(layers) + "\n" + MARKS[1] + after


def main():
    layers = read()
    text = document(layers)
    if sys.argv[1:] == ["--write"]:
        DOCUMENT.write_text(text)
        return 0
    wrong = [*faults(layers), *box_faults(layers), *said_elsewhere()]
    for row in read("slow"):
        if len(seeing := who_sees(row["header"])) > row["sources"]:
            wrong.append(f"{len(seeing)} sources see {row['header']}, more than the {row['sources']} of docs/layers.toml: "
                         "declare its types forward in headers")
    if text != DOCUMENT.read_text():
        wrong.append("docs/architecture.md has not the table of docs/layers.toml: run tests/docs/layers.py --write")
    print("\n".join(wrong) or f"ok: {len(layers)} directories, no circle, no include line beside them")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
