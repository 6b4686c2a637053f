"""Reads C++ files with clang-tidy (.clang-tidy says for what); exits 1 on any warning.

    tidy.py BUILD_DIRECTORY [--all | --since COMMIT | FILE..]

A file that was found clean is not read again until it, what it includes from this tree, its flags or
.clang-tidy change: BUILD_DIRECTORY/tidy.json remembers their digest. A file that was never read here is
read if it differs from COMMIT: unless given, where this branch left main, on main the commit before. A
header is read with one file that includes it. --all reads every file that is not known to be clean.
"""
import concurrent.futures
import hashlib
import json
import os
import re
import subprocess
import sys
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
    head = git("rev-parse", "HEAD")
    return left if left and left != head else git("rev-parse", "HEAD^1")


def touched(commit, commands, includes):
    """Files that differ from the commit, and for each such header one that includes it; None: all."""
    listed = git("diff", "--name-only", commit) if commit else None
    if listed is None:
        return None
    names = set(listed.split("\n")) | set((git("ls-files", "-o", "--exclude-standard") or "").split("\n"))
    if ".clang-tidy" in names:
        return None
    files = names & commands.keys()
    for header in (name for name in names if name.endswith(".h")):
        readers = sorted(path for path in commands if header in includes.of(path))
        own = header[:-2] + ".cpp"
        if own not in files and not files & set(readers):
            files.update([own] if own in readers else readers[:1])
    return files


def read(path, build):
    done = subprocess.run(["clang-tidy", "--quiet", "-p", str(build / "tidy"), path], cwd=ROOT,
                          capture_output=True, text=True)
    return path, done.returncode, done.stdout, done.stderr


def main():
    build, *arguments = sys.argv[1:]
    for name in arguments:
        if name != "--all" and arguments[0] != "--since" and not Path(name).is_file():
            print(f"tidy: {name}: no such file; usage: ./dmise tidy [--all | FILE..]", file=sys.stderr)
            return 2
    build = Path(build).resolve()
    commands, includes = commands_of(build), Includes()
    (build / "tidy").mkdir(exist_ok=True)
    (build / "tidy/compile_commands.json").write_text(json.dumps(
        [{"directory": str(build), "file": str(ROOT / path), "arguments": words} for path, words in commands.items()]))
    common = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    common += (ROOT / ".clang-tidy").read_bytes()
    record = build / "tidy.json"
    clean = json.loads(record.read_text()) if record.exists() else {}
    digests = {path: digest(path, words, includes, common) for path, words in commands.items()}

    changed = [path for path in commands if clean.get(path) != digests[path]]
    if arguments[:1] == ["--all"]:
        wanted = changed
    elif arguments and arguments[0] != "--since":
        wanted = [os.path.relpath(Path(name).resolve(), ROOT) for name in arguments]
    else:
        commit = git("rev-parse", arguments[1]) if arguments else commit_before()
        since = touched(commit, commands, includes)
        wanted = [path for path in changed if since is None or path in clean or path in since]
    wanted.sort(key=lambda path: -(ROOT / path).stat().st_size)

    said, bad = set(), 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for path, code, out, errors in pool.map(lambda name: read(name, build), wanted):
            if code == 0:
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
    print(f"clang-tidy: {len(wanted)} of {len(commands)} files read, {bad} with warnings; "
          f"{sum(clean.get(path) == digests[path] for path in commands)} are known to be clean")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
