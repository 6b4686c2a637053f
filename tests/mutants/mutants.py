#!/usr/bin/python3
"""Makes small wrong changes, one at a time, and sees whether a test notices.

    mutants.py [own.toml ...]          builds, tests, prints a table and the share that was noticed
    mutants.py --check                 that each change still fits the tree in one place; builds nothing

Each [[mutant]] has a name, a file, the text before (once in the file) and after, and `programs`: targets that are built
and tested one after the other, until a test fails. Of a test program all tests are run, or those of `filter` (--gtest_filter);
`tests` is a ctest regex of those that any other target needs.

Works on a copy of the tree (a git worktree of HEAD) with a build of its own under --work, or with --build in this tree,
each file put back after its turn. Results are kept in --work as JSON lines: what is decided about a mutant, as it is
written, in a tree is not done again.
"""
import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def load(paths):
    mutants = []
    for path in paths:
        for mutant in tomllib.loads(path.read_text())["mutant"]:
            mutants.append(mutant | {"group": path.stem})
    names = [m["name"] for m in mutants]
    assert len(set(names)) == len(names), "two mutants have one name"
    return mutants


def misfits(mutants, root):
    """Mutants whose text is not in the tree in just one place, or that change nothing."""
    for m in mutants:
        path = root / m["file"]
        count = path.read_text().count(m["before"]) if path.exists() else 0
        if count != 1 or m["before"] == m["after"]:
            yield f"{m['group']}: {m['name']}: its text is {count} times in {m['file']}"


def run(command, cwd, timeout_s, log):
    log.write(f"\n$ {' '.join(command)}\n")
    log.flush()
    try:
        return subprocess.run(command, cwd=cwd, stdout=log, stderr=subprocess.STDOUT, timeout=timeout_s).returncode
    except subprocess.TimeoutExpired:
        return 124


class Workshop:
    """A copy of the tree with a build of its own."""

    def __init__(self, work, build, jobs, timeout_s):
        self.tree, self.build = (ROOT, build) if build else (work / "tree", work / "build")
        self.jobs, self.timeout_s = jobs, timeout_s
        self.log = open(work / "log", "a")
        if build:
            return
        head = subprocess.check_output(["git", "rev-parse", "HEAD"], cwd=ROOT, text=True).strip()
        if not self.tree.exists():
            subprocess.check_call(["git", "worktree", "add", "--detach", "--force", str(self.tree), head], cwd=ROOT,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        subprocess.check_call(["git", "checkout", "--quiet", "--force", "--detach", head], cwd=self.tree)
        if not (self.build / "build.ninja").exists():
            options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"]
            if run(["cmake", "-S", str(self.tree), "-B", str(self.build), *options], work, 600, self.log):
                sys.exit(f"mutants: the tree can't be configured: see {work}/log")
        data = ROOT / "build/data"
        if data.exists() and not (self.tree / "build").exists():
            (self.tree / "build").mkdir()
            (self.tree / "build/data").symlink_to(data)

    def make(self, targets):
        return run(["ninja", "-C", str(self.build), f"-j{self.jobs}", *targets], self.tree, 3600, self.log) == 0

    def failing(self, command):
        """The first test that fails; None when all pass."""
        with open(self.log.name) as read:
            read.seek(0, os.SEEK_END)
            code = run(command, self.tree, self.timeout_s, self.log)
            said = read.read()
        if code == 0:
            return None
        if code == 124:
            raise TimeoutError
        failed = re.findall(r"^\[  FAILED  \] (\S+?),? |^\s*\d+ - (\S+) \(", said, re.M)
        return next((name for pair in failed for name in pair if name), "ends badly")

    def command_of(self, program, m):
        if program.startswith("test_"):
            chosen = [f"--gtest_filter={m['filter']}"] if "filter" in m else []
            return [str(self.build / "bin" / program), "--gtest_fail_fast", *chosen]
        return ["ctest", "--test-dir", str(self.build), "--stop-on-failure", "--output-on-failure", "-R", m["tests"]]

    def verdict(self, m):
        path = self.tree / m["file"]
        text = path.read_text()
        path.write_text(text.replace(m["before"], m["after"]))
        try:
            for program in m["programs"]:
                if not self.make([program]):
                    return "does not build", ""
                if by := self.failing(self.command_of(program, m)):
                    return "noticed", by
            return "survived", ""
        except TimeoutError:
            return "timeout", ""
        finally:
            path.write_text(text)


def key_of(mutant):
    """Hash of the mutant as it is written, and of the tree that it changes."""
    tree = subprocess.check_output(["git", "rev-parse", "HEAD^{tree}"], cwd=ROOT, text=True)
    text = json.dumps(mutant, sort_keys=True) + tree
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lists", nargs="*", type=Path, default=sorted(HERE.glob("*.toml")))
    parser.add_argument("--check", action="store_true", help="only that the mutants fit the tree")
    parser.add_argument("--only", default="", help="regex of the mutants' names")
    parser.add_argument("--work", type=Path, default=ROOT / "build/mutants", help="copy of the tree, build, results")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--timeout", type=float, default=900, help="[s] for the tests of one mutant")
    parser.add_argument("--least", type=float, default=0.95, help="share that must be noticed, else exit 1")
    parser.add_argument("--build", type=Path, help="a build directory of this tree, which is worked on in place")
    parser.add_argument("--any-tree", action="store_true", help="results of another tree count too")
    options = parser.parse_args()
    mutants = load(options.lists)
    wrong = list(misfits(mutants, ROOT))
    for line in wrong:
        print(line)
    if options.check or wrong:
        print(f"{len(mutants) - len(wrong)} of {len(mutants)} mutants fit the tree")
        sys.exit(bool(wrong))
    mutants = [m for m in mutants if re.search(options.only, m["name"])]

    options.work.mkdir(parents=True, exist_ok=True)
    results = options.work / "results.jsonl"
    known = {}
    for line in results.read_text().splitlines() if results.exists() else ():
        result = json.loads(line)
        known[result["name"] if options.any_tree else result["key"]] = result
    workshop = None
    table = []
    for m in mutants:
        key = key_of(m)
        result = known.get(m["name"] if options.any_tree else key)
        if not result:
            if not workshop:
                workshop = Workshop(options.work.resolve(), options.build and options.build.resolve(), options.jobs,
                                    options.timeout)
                needed = sorted({p for mutant in mutants for p in mutant["programs"]})
                if not workshop.make(needed):
                    sys.exit(f"mutants: the tree does not build: see {options.work}/log")
                for program in needed:
                    if program.startswith("test_") and (by := workshop.failing(workshop.command_of(program, m))):
                        sys.exit(f"mutants: {by} fails without any change: see {options.work}/log")
            verdict, by = workshop.verdict(m)
            result = {"key": key, "group": m["group"], "name": m["name"], "verdict": verdict, "by": by}
            if verdict != "timeout":
                with open(results, "a") as file:
                    file.write(json.dumps(result) + "\n")
        table.append(result)
        print(f"{result['verdict']:14} {m['group']:6} {m['name']:70} {result['by']}", flush=True)

    share = 1.0
    for group in sorted({r["group"] for r in table}):
        rows = [r for r in table if r["group"] == group]
        noticed = sum(r["verdict"] == "noticed" for r in rows)
        print(f"{group}: {noticed} noticed of {len(rows)}")
        share = min(share, noticed / len(rows))
    sys.exit(share < options.least)


if __name__ == "__main__":
    main()
