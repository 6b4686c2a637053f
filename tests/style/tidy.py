"""Reads C++ files with clang-tidy (.clang-tidy says for what); exits 1 on any warning.

    tidy.py BUILD_DIRECTORY [--seconds S] [--all | --since COMMIT | FILE..]

A file that was found clean is not read again until it, what it includes from this tree, its flags or
.clang-tidy change: BUILD_DIRECTORY/tidy.json remembers their digest. A file that was never read here is
read if it differs from COMMIT: unless given, where this branch left main, on main ten commits before. A
header is read with one file that includes it. --all reads every file that is not known to be clean.
What changed last is read first; after S seconds no further file is begun, and those left are counted.
"""
import concurrent.futures
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def git(*arguments):
    done = subprocess.run(["git", "-c", "safe.directory=*", *arguments], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def commands_of(build):
    """{file: arguments}, without compiler cache and precompiled headers."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = Path(entry["file"])
        if not path.is_relative_to(ROOT) or path.is_relative_to(ROOT / "build"):
            continue
        words = entry["command"].replace('\\"', '"').split()
        words = words[next(i for i, word in enumerate(words) if "clang" in word):]
        while "-Xclang" in words:
            at = words.index("-Xclang")
            del words[at:at + 2]
        commands.setdefault(str(path.relative_to(ROOT)), words)
    return commands


class Includes:
    """What a file includes from this tree, itself first."""

    def __init__(self):
        self.direct = {}

    def of(self, path):
        if path not in self.direct:
            text = (ROOT / path).read_text(errors="replace")
            found = [re.sub(r"^dmise/v1/(\w+)\.pb\.h$", r"proto/dmise/v1/\1.proto", name)
                     for name in INCLUDE.findall(text)]
            near = [str(Path(path).parent / name) for name in found]
            self.direct[path] = [a if (ROOT / a).is_file() else b for a, b in zip(found, near)
                                 if (ROOT / a).is_file() or (ROOT / b).is_file()]
        return self.direct[path]

    def all_of(self, path):
        seen, waiting = {path: None}, [path]
        while waiting:
            for name in self.of(waiting.pop()):
                if name not in seen:
                    seen[name] = None
                    waiting.append(name)
        return list(seen)


def digest(path, words, includes, common):
    state = hashlib.sha256(common)
    state.update(" ".join(words).encode())
    for name in sorted(includes.all_of(path)):
        state.update(name.encode() + b"\0" + (ROOT / name).read_bytes())
    return state.hexdigest()


def commit_before():
    left = git("merge-base", "HEAD", "origin/main") or git("merge-base", "HEAD", "main")
    if left and left != git("rev-parse", "HEAD"):
        return left
    commits = (git("rev-list", "--first-parent", "-n", "11", "HEAD") or "").split()
    return commits[-1] if len(commits) > 1 else None


def changed_last(commit):
    """Names of files that differ from the commit (None: all that have a history), the last changed first."""
    here = [*(git("diff", "--name-only", "HEAD") or "").split("\n"),
            *(git("ls-files", "-o", "--exclude-standard") or "").split("\n")]
    history = git("log", "--format=", "--name-only", "-m", "--first-parent", f"{commit}..HEAD" if commit else "HEAD")
    return list(dict.fromkeys(name for name in [*here, *(history or "").split("\n")] if name))


def touched(names, commands, includes):
    """The named files, and for each header among them one that includes it, in their order."""
    files = {name: None for name in names if name in commands}
    for header in (name for name in names if name.endswith(".h")):
        readers = (sorted(path for path in commands if header in includes.of(path))
                   or sorted(path for path in commands if header in includes.all_of(path)))
        own = header[:-2] + ".cpp"
        if own not in files and not files.keys() & set(readers):
            files.update(dict.fromkeys([own] if own in readers else readers[:1]))
    return list(files)


def read(path, build, end):
    if time.monotonic() > end:
        return path, None, "", ""
    done = subprocess.run(["clang-tidy", "--quiet", "-p", str(build / "read"), path], cwd=ROOT,
                          capture_output=True, text=True)
    return path, done.returncode, done.stdout, done.stderr


def main():
    build, *arguments = sys.argv[1:]
    usage = "usage: ./dmise tidy [--seconds S] [--all | FILE..]"
    end = float("inf")
    if arguments[:1] == ["--seconds"]:
        if len(arguments) < 2 or not re.fullmatch(r"[1-9]\d*", arguments[1]):
            print(f"tidy: --seconds: must be a whole number > 0; {usage}", file=sys.stderr)
            return 2
        end = time.monotonic() + int(arguments[1])
        del arguments[:2]
    for name in arguments:
        if name != "--all" and arguments[0] != "--since" and not Path(name).is_file():
            print(f"tidy: {name}: no such file; {usage}", file=sys.stderr)
            return 2
    build = Path(build).resolve()
    commands, includes = commands_of(build), Includes()
    (build / "read").mkdir(exist_ok=True)
    (build / "read/compile_commands.json").write_text(json.dumps(
        [{"directory": str(build), "file": str(ROOT / path), "arguments": words} for path, words in commands.items()]))
    if not shutil.which("clang-tidy"):
        print("tidy: clang-tidy is missing: ./dmise setup --tests fetches it from PyPI", file=sys.stderr)
        return 2
    common = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    common += b"".join((ROOT / name).read_bytes() for name in (git("ls-files", "*.clang-tidy") or "").split())
    record = build / "tidy.json"
    clean = json.loads(record.read_text()) if record.exists() else {}
    digests = {path: digest(path, words, includes, common) for path, words in commands.items()}

    changed = [path for path in commands if clean.get(path) != digests[path]]
    if arguments and not arguments[0].startswith("--"):
        named = [os.path.relpath(Path(name).resolve(), ROOT) for name in arguments]
        for name in named:
            if not touched([name], commands, includes):
                print(f"tidy: {name}: no source that is compiled here, nor a header of one; {usage}", file=sys.stderr)
                return 2
        wanted = touched(named, commands, includes)
    else:
        every = arguments[:1] == ["--all"]
        commit = None if every else git("rev-parse", arguments[1]) if arguments else commit_before()
        names = changed_last(commit)
        every = every or commit is None or any(name.endswith(".clang-tidy") for name in names)
        first = touched(changed_last(None) if every else names, commands, includes)
        wanted = [path for path in [*first, *(path for path in commands if every or path in clean)] if path in changed]
        wanted = list(dict.fromkeys(wanted))

    said, bad, left = set(), 0, 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for path, code, out, errors in pool.map(lambda name: read(name, build, end), wanted):
            if code is None:
                left += 1
            elif code == 0:
                clean[path] = digests[path]
            else:
                bad += 1
                clean.pop(path, None)
                blocks = re.split(r"(?m)^(?=/\S+:\d+:\d+: (?:warning|error):)", out) if out.strip() else [errors]
                for block in blocks:
                    if block.strip() and block not in said:
                        said.add(block)
                        print(block.replace(str(ROOT) + "/", "").rstrip(), flush=True)
            if code == 0 or len(wanted) > 20:
                record.write_text(json.dumps(clean, indent=0))
    record.write_text(json.dumps(clean, indent=0))
    print(f"clang-tidy: {len(wanted) - left} of {len(commands)} files read, {bad} with warnings; "
          + (f"{left} that changed are left for ./dmise tidy; " if left else "") +
          f"{sum(clean.get(path) == digests[path] for path in commands)} are known to be clean")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
