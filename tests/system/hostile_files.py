"""Files made to hurt are refused in one clear line: quickly, in little memory, and without obeying them.

    hostile_files.py DMISE
"""

import os
import pathlib
import resource
import subprocess

from harness import check, main, write_scenario

PATIENCE_S = 120.0
MOST_MB = 600  # resident memory; a list of 15 MB took 3300

SIMULATION = "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5}\n"


def limited():
    """An address space that a runaway reader leaves soon, also on a machine with much memory."""
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))


def ended(command, directory, stdin=subprocess.DEVNULL):
    """(exit code, lines on stderr but notes, all that it said as bytes) of a command."""
    out, err = directory / "stdout", directory / "stderr"
    with open(out, "wb") as to, open(err, "wb") as errors:
        process = subprocess.Popen([str(c) for c in command], stdin=stdin, stdout=to, stderr=errors,
                                   preexec_fn=limited, cwd=directory)
        try:
            process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return "still running", [], out.read_bytes() + err.read_bytes()
    said = err.read_bytes()
    lines = [line for line in said.decode(errors="replace").splitlines() if not line.startswith("note: ")]
    return process.returncode, lines, out.read_bytes() + said


def peak_mb():
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024


def refused(directory, command, what, *words):
    code, lines, said = ended(command, directory)
    check(code in (1, 2) and len(lines) == 1 and all(w in lines[0] for w in words),
          f"{what}: code {code}: {' | '.join(lines)[:300]}")
    check(not any(c < 0x20 and c != 0x0a or c == 0x7f for c in said), f"{what}: no control character is shown")


def laughs(lines):
    text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
    for k in range(1, lines):
        text += f"a{k}: &a{k} [" + ", ".join([f"*a{k - 1}"] * 10) + "]\n"
    return text


def hostile_yaml(binary, directory):
    long_key = "k" * 5_000_000
    for name, text, words in [
        ("circle", "a: &a [*a]\n", ["circle.yaml:1:8: an alias within its own anchor"]),
        ("circle-of-two", "a: &a {b: &b [*a]}\n", ["circle-of-two.yaml:1:15: an alias"]),
        ("laughs", laughs(12), ["laughs.yaml:6:", "more than 500000 values"]),
        ("list", "a: [" + "1, " * 5_000_000 + "1]\n", ["list.yaml:1:", "more than 500000 values"]),
        ("lines", "a:\n" + "- 1\n" * 3_000_000, ["lines.yaml:", "more than 500000 values"]),
        ("keys", "".join(f"k{k}: 1\n" for k in range(200_000)), ["keys.yaml:1:1: simulation: is missing"]),
        ("deep", "a: " + "[" * 1_000_000, ["deep.yaml:1:", "deeper than 64"]),
        ("deep-maps", "a: " + "{a: " * 100_000, ["deep-maps.yaml:1:", "deeper than 64"]),
        ("deep-blocks", "".join(" " * k + "a:\n" for k in range(1000)), ["deep-blocks.yaml:", "deeper than 64"]),
        ("long-key", f"? {long_key}\n: [" + "1, " * 400_000 + "1]\n", ["long-key.yaml:1:1: simulation: is missing"]),
        ("long-word", SIMULATION + "sensors: " + "x" * 10_000_000, ["long-word.yaml:2:10: sensors: must be a list"]),
        ("big", "# " + "x" * (17 << 20), ["big.yaml: larger than 16777216 bytes"]),
        ("two", SIMULATION + "---\na: 1\n", ["two.yaml:2:1: must be one YAML document"]),
        ("zeros", "\0" * 100_000, ["zeros.yaml"]),
        ("escapes", SIMULATION.replace("tick_s", '"\\e[2J\\nforged: line": 1, tick_s'), ["\\x1b[2J\\nforged: line: unknown key"]),
        ("value", SIMULATION.replace("5}", '"\\e]0;x\\a\\n"}'), ["value.yaml:1:", "got \\x1b]0;x\\x07\\n"]),
        ("anchors", "".join(f"k{k}: &x{k} 1\n" for k in range(100_000)), ["anchors.yaml:1:1: simulation: is missing"]),
    ]:
        path = directory / f"{name}.yaml"
        path.write_text(text)
        refused(directory, [binary, "check", path], name, *words)
        path.unlink()
    check(peak_mb() < MOST_MB, f"readers of hostile YAML took {peak_mb():.0f} MB at most, {MOST_MB} allowed")
    refused(directory, [binary, "check", "/dev/zero"], "a device", "/dev/zero: is a device, not a regular file")
    os.mkfifo(directory / "fifo")
    refused(directory, [binary, "check", directory / "fifo"], "a FIFO", "fifo: is a FIFO, not a regular file")
    odd = directory / "a\x1b[31m\nb.yaml"
    odd.write_text("a: [\n")
    refused(directory, [binary, "check", odd], "a name of a file", "a\\x1b[31m\\nb.yaml:")


def hostile_inputs(binary, directory):
    """Frames, catalogues, stars: no regular file is waited for or read without end."""
    fifo = directory / "fifo"
    for what in [fifo, "/dev/zero", "/dev/tty", "/proc/self/environ", "/proc/kmsg", directory]:
        refused(directory, [binary, "detect", what], f"detect {what}", str(what))
        refused(directory, [binary, "detect", "--sequence", what, what, what], f"detect --sequence {what}", str(what))
        refused(directory, [binary, "catalogue", "info", what], f"catalogue info {what}", str(what))
    for key, line in [("objects", "objects: [{catalogue: %s}]\n"), ("stars", "stars: {catalogue: %s}\n")]:
        good = write_scenario(directory).read_text().splitlines(keepends=True)
        for what in ["/proc/self/environ", "/dev/zero", fifo]:
            path = directory / "scenario.yaml"
            path.write_text("".join(line % what if text.startswith(key) else text for text in good))
            for command in (["check", path], ["run", path, "--out", directory / "out"]):
                refused(directory, [binary, *command], f"{command[0]}: {key} {what}", "scenario.yaml:", f"{key}")
    check(not (directory / "out").exists(), "a refused run leaves no directory")
    with open("/dev/zero", "rb") as zero:
        code, lines, _ = ended([binary, "catalogue", "info", "-"], directory, stdin=zero)
    check(code == 2 and "larger than" in lines[0], f"endless standard input is cut: {lines}")


def damaged_stars(binary, directory):
    scenario = write_scenario(directory)
    for name, content, words in [("empty.csv", b"", []), ("noise.csv", os.urandom(100_000), []),
                                 ("text.csv", b"no,star,catalogue\n" * 100, [])]:
        (directory / name).write_bytes(content)
        path = directory / "stars.yaml"
        path.write_text(scenario.read_text().replace("catalogue: kstars", f"catalogue: {name}"))
        refused(directory, [binary, "check", path], f"stars from {name}", "stars.yaml:3:20: stars.catalogue", name, *words)


def names(binary, directory):
    scenario = write_scenario(directory)
    for name, why in [("operator", "another node has this name"), ("Operator", "another node has this name"),
                      ("logs", "a directory of the run"), ("LOGS", "a directory of the run"),
                      ("positions", "a directory of the run"), ("Time-Master", "another node has this name"),
                      ("broker", "another node has this name"), ("-alpha", "must not begin with -"),
                      ("--force", "must not begin with -"), ("Beta", "but for upper and lower case"),
                      ('"a/b"', "letters, digits, - and _"), ('"a\\nb"', "letters, digits, - and _")]:
        path = directory / "names.yaml"
        path.write_text(scenario.read_text().replace("name: alpha", f"name: {name}"))
        refused(directory, [binary, "check", path], f"a sensor called {name}", "names.yaml:", ".name: ", why)
    for name in ["-x", "../x", "a b", "x" * 65]:
        refused(directory, [binary, "keygen", directory / "keys", "--", name], f"a key called {name}", name[:20])


LINE1 = "1 43226U 18022A   18020.50000000  .00000000  00000-0  00000-0 0  9990"
LINE2 = "2 43226   0.0500 100.0000 0001000 100.0000 100.0000  1.00270000    10"


def with_checksums(line):
    total = sum(int(c) if c.isdigit() else c == "-" for c in line[:68])
    return line[:68] + str(total % 10)


def names_of_objects(binary, directory):
    """Names in a catalogue that a terminal would obey are told escaped, everywhere, and the run is as usual."""
    name = b"GOES \x1b[2J\x9b31m\x07 17"
    (directory / "odd.tle").write_bytes(
        name + b"\n" + with_checksums(LINE1).encode() + b"\n" + with_checksums(LINE2).encode() + b"\n")
    path = write_scenario(directory, objects="odd.tle", duration_s=10)
    path.write_text(path.read_text() + "#\n")
    own = '  - {name: "a\\e[31m\\nb", motion: {fixed: {latitude_deg: 33.8, longitude_deg: -84.4, height_m: 400000}}}\n'
    text = path.read_text().replace("objects: [{catalogue: odd.tle}]", "objects:\n  - {catalogue: odd.tle}\n" + own)
    path.write_text(text.replace("output: {png: false}", "output: {png: false, positions: [csv, jsonl, oem]}"))
    for command in (["check", path], ["run", path, "--out", directory / "odd"],
                    ["launch", path, "--out", directory / "odd-network"]):
        code, lines, said = ended([binary, *command], directory)
        check(code == 0, f"{command[0]}: odd names of objects: code {code} {lines[-1:]}")
        check(b"\x1b" not in said and b"\x07" not in said and b"\x9b" not in said,
              f"{command[0]}: nothing that a terminal obeys is shown")
    for out in (directory / "odd", directory / "odd-network"):
        for file in [p for p in out.rglob("*") if p.suffix in (".jsonl", ".json", ".html", ".csv", ".oem", ".log")]:
            content = file.read_bytes()
            content.decode("utf-8")
            check(b"\x1b" not in content and b"\x07" not in content, f"{file.relative_to(directory)} is plain text")


def test(binary, directory):
    directory = pathlib.Path(directory)
    os.environ["XDG_CACHE_HOME"] = str(directory / "cache")
    hostile_yaml(binary, directory)
    hostile_inputs(binary, directory)
    damaged_stars(binary, directory)
    names(binary, directory)
    names_of_objects(binary, directory)


if __name__ == "__main__":
    main(test)
