#!/usr/bin/env python3
"""The page of benchmarks is what its figures say, short, and no measurement loses the figures of others.

    benchmarks.py [DMISE]     with the program a cheap benchmark is measured, too
"""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import report  # noqa: E402

PAGE, DATA = ROOT / "docs/benchmarks.md", ROOT / "docs/benchmarks.json"


def check(holds, what):
    if not holds:
        sys.exit(f"FAIL: {what}")
    print(f"ok: {what}")


def main():
    kept = report.read(DATA)
    check(report.page(kept, DATA.name) == PAGE.read_text(), "docs/benchmarks.md is of docs/benchmarks.json (report.py --render)")
    check(report.as_json(kept) == DATA.read_text(), "whose entries stand one a line")
    rows = sum(len(wanted) for wanted in report.PAGE.values())
    check(rows <= 45 and len(PAGE.read_text().splitlines()) < 120, f"a page of {rows} figures at most")
    check(all(m["date"] and m["machine"] and m["commit"] for entries in kept.values() for m in entries),
          "each figure and claim has its date, commit and machine")

    when = {"date": "2030-01-01 00:00 UTC", "commit": "abc", "load": 0.0, "machine": "another"}
    new = report.merged(kept, "build", [report.figure("demo_from_clone_s", 250.0, "s", 300)], when)
    text = report.page(new, DATA.name)
    check(len(new["figures"]) == len([m for m in kept["figures"] if m["bench"] != "build"]) + 1 and new["claims"] == kept["claims"],
          "what is measured anew leaves other figures as they are")
    check("| `demo_from_clone_s` | 250 | s |  | 300 reached | 2030-01-01 | " in text and ". another\n" in text,
          "and has its own date and machine on the page")
    check(report.merged(new, "build", [], when) == new, "a measurement that fails loses nothing")
    if len(sys.argv) > 1:
        with tempfile.TemporaryDirectory(prefix="dmise-benchmarks-") as name:
            page = pathlib.Path(name) / "benchmarks.md"
            page.with_suffix(".json").write_text(DATA.read_text())
            done = subprocess.run(["/usr/bin/python3", ROOT / "bench/report.py", "--only", "interpolation", "--output", page],
                                  capture_output=True, text=True, check=False)
            measured = json.loads(page.with_suffix(".json").read_text())["figures"]
            anew = [m for m in measured if m["bench"] == "interpolation"]
            check(done.returncode == 0 and len(measured) == len(kept["figures"]), f"a benchmark is measured {done.stderr[-300:]}")
            check(anew and all(m not in kept["figures"] for m in anew), f"{len(anew)} figures of it are new")


if __name__ == "__main__":
    main()
