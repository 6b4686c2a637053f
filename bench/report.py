"""Measures, and writes docs/benchmarks.md, a section for each measurement.

    report.py [--only NAME ..] [--also NAME ..] [--output FILE] [--json FILE]

Runs every `dmise bench NAME --json`, the demonstration, and the referees on its products. A section
says when, at which commit and under which load it was measured; --only writes the sections that it
names anew and leaves the others as they are. What fails is reported as failed.
"""

import argparse
import collections
import datetime
import fnmatch
import json
import os
import pathlib
import platform
import re
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BINARY = ROOT / "build/release/bin/dmise"
REGISTRATION = ROOT / "build/release/bin/test_pipeline"
DEMO = ROOT / "launch/scenarios/demo.yaml"
RUN = ROOT / "build/benchmark-run"
# A document of its own, by bench/scaling.py; a part of frame; a section of its own.
ELSEWHERE = ("scaling", "all-sky", "detect")
LONG = ("network",)  # real time, a quarter of an hour
SHORTER = {"effects": ("--scenes", "30")}  # as in the tests
DETECTION = {  # figures of the detector and what they are; * stands for anything
    "frame_s": "an all-sky frame, one thread, s",
    "frame_*_s": "the same, another sky",
    "frame*_peak_mb": "memory of the search beyond the frame, MB",
    "frame*_stars": "stars in it",
    "false_alarms_per_frame*": "in such frames",
    "pd_shift_points_snr": "SNR at which half of all points are found, beyond the threshold",
    "pd_shift_streaks_snr": "the same, the worst length of streaks",
    "pd_shift_streak_*_snr": "the same, streaks of that many px",
    "position_over_crlb_*": "rms error of place over the Cramer-Rao bound",
    "nees_*": "squared error of place over its covariance; 1 if honest",
    "magnitude_bias_sigma_*": "bias of electrons over their standard error",
    "sensors_real_time_detecting": "all-sky sensors with a frame every 10 s that keep up",
    "network_frame_cpu_detecting_s": "processors' time of one of their frames, s",
    "network_cpu_share_detecting": "share of the processors that they took",
    "network_overruns_detecting": "frames of theirs that were late",
    "network_start_detecting_s": "until all of them were ready, s",
}
REFEREES = ("solve_field", "source_extractor_magnitudes", "skyfield_directions", "erfa_directions",
            "fitsverify_frames")


def output_of(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False,
                          cwd=ROOT)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]) + "\n"


def number(x):
    """Three significant digits, thousands apart."""
    if x is None or x == "":
        return ""
    if not isinstance(x, (int, float)) or isinstance(x, bool):
        return {True: "yes", False: "no"}.get(x, str(x))
    return f"{x:,.0f}" if abs(x) >= 1000 or x == int(x) else f"{x:.3g}"


def machine():
    """What all figures depend on."""
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo")
                if line.startswith("model name")), platform.machine())
    memory_kb = int(re.search(r"MemTotal: *(\d+)", open("/proc/meminfo").read()).group(1))
    system = re.search(r'PRETTY_NAME="(.*)"', open("/etc/os-release").read()).group(1)
    return (f"{cpu}, {os.cpu_count()} cores, {memory_kb / 2**20:.0f} GiB; {system}, "
            f"{output_of('g++', '--version').stdout.splitlines()[0]}")


def occasion():
    """When and of what a section is."""
    commit = output_of("git", "rev-parse", "--short", "HEAD").stdout.strip() or "unknown"
    ours = ("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/benchmarks.md")
    if output_of(*ours).stdout.strip():
        commit += " and changes"
    date = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    return f"{date}, commit {commit}, load before {os.getloadavg()[0]:.2f}"


def bench_names():
    """The subcommands that `dmise bench --help` lists."""
    listed = output_of(BINARY, "bench", "--help").stdout.partition("Subcommands:")[2]
    return [name for name in re.findall(r"^  ([\w-]+)", listed, re.MULTILINE)
            if name not in ELSEWHERE + LONG]


def measure(name, *arguments):
    """The figures of a benchmark, as its --json prints them, and why there are none."""
    print(f"measuring {name}", file=sys.stderr)
    done = output_of(BINARY, "bench", name, "--json", *SHORTER.get(name, ()), *arguments)
    figures = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"name":')]
    reason = (done.stderr.strip() or "no reason given").splitlines()[-1][-100:]
    return figures, "" if done.returncode == 0 or figures else reason


def benchmark(name, measured):
    """The table of a benchmark; adds its figures to `measured`."""
    figures, reason = measure(name, *(["--without-detection-only"] if name == "network" else []))
    measured += figures
    rows = [[m["name"], number(m["value"]), m.get("unit") or "", m.get("anchor") or "", number(m.get("anchor_value")),
             number(m.get("ratio")), number(m.get("target")), number(m.get("met"))] for m in figures]
    if reason:
        rows.append([name, "failed", "", reason, "", "", "", "no"])
    return table(("figure", "value", "unit", "anchor", "anchor's", "ratio", "target", "met"), rows)


def detection(measured):
    """The table of the detector: `dmise bench detect`, and how many sensors keep up with it."""
    rows = []
    for name, *arguments in (("detect",), ("network", "--detection-only")):
        figures, reason = measure(name, *arguments)
        measured += figures
        for m in figures:
            what = next((what for name_of, what in DETECTION.items() if fnmatch.fnmatch(m["name"], name_of)), "")
            rows.append([f"`{m['name']}`", what, number(m["value"]), number(m.get("target")), number(m.get("met"))])
        if reason:
            rows.append([name, f"failed: {reason}", "", "", "no"])
    return table(("figure", "of", "measured", "asked", "reached"), rows)


def demonstration():
    """Runs the demonstration; returns its section."""
    print("running the demonstration", file=sys.stderr)
    done = output_of(BINARY, "launch", DEMO, "--out", RUN, "--force")
    if done.returncode != 0:
        return f"The demonstration failed: {done.stderr.strip().splitlines()[-1]}\n"
    record = json.loads((RUN / "run.json").read_text())
    frames = collections.defaultdict(list)
    for frame in record["frames"]:
        frames[frame["sensor"]].append(frame)
    rows = [[sensor, len(costs), number(statistics.median(c["total_s"] for c in costs)),
             number(statistics.median(c["detection_s"] for c in costs)),
             number(max(c["pss_mb"] for c in costs))] for sensor, costs in frames.items()]
    text = f"`dmise launch launch/scenarios/demo.yaml`: {record['wall_s']:.1f} s (at most 60 s on two cores).\n\n"
    text += table(("sensor", "frames", "s per frame, median", "of it detection", "largest PSS, MB"), rows)
    effects = list(record["frames"][0]["effects_s"])
    shares = [[effect] + [number(round(1e3 * statistics.median(c["effects_s"][effect] for c in costs), 2))
                          for costs in frames.values()] for effect in effects]
    text += "\nMilliseconds a frame by effect, median:\n\n" + table(("effect", *frames), shares)
    if record["nodes"]:
        rows = [[n["name"], *(number(round(n[k], 2)) for k in ("compute_s", "messaging_s", "waiting_s"))]
                for n in record["nodes"]]
        text += "\nWhere the nodes' time went, s:\n\n" + table(("node", "compute", "messaging", "waiting"), rows)
    return text


def claims(commands):
    """What test programs say, each claim a row; `commands`: {name: command}."""
    rows = []
    for name, command in commands.items():
        print(f"asking {name}", file=sys.stderr)
        done = output_of(*command)
        said = [line for line in (done.stdout + done.stderr).splitlines() if line]
        verdict = {0: "holds", 77: "not measured"}.get(done.returncode, "fails")
        rows += [[name, re.sub(r"^\w+: ", "", re.sub(r" \(logs in [^)]*\)", "", line)).replace(str(ROOT), "."),
                  "holds" if line.startswith("ok: ") else verdict] for line in said]
    return table(("judge", "claim", ""), rows)


def referees():
    """What other people's programs say of the demonstration's products."""
    if not (RUN / "run.json").exists():
        demonstration()
    judges = {name: ("/usr/bin/python3", ROOT / f"tests/reference/{name}.py", RUN)
              for name in REFEREES}
    judges["erfa_directions"] += ("--platform", "metop=29499")
    judges["streak_contrast"] = ("/usr/bin/python3", ROOT / "tests/reference/streak_contrast.py", BINARY)
    return claims(judges)


def whole_runs():
    """Same bytes however a scenario is run; nodes killed; runs interrupted."""
    system = ROOT / "tests/system"
    return claims({"run_identity": (system / "run_identity.sh", BINARY, DEMO, "40"),
                   "kill9": ("/usr/bin/python3", system / "kill9.py", BINARY),
                   "ctrl_c": ("/usr/bin/python3", system / "ctrl_c.py", BINARY, DEMO)})


def registration():
    """Distance of rendered light from its label, as the tests measure it."""
    print("measuring registration", file=sys.stderr)
    results = ROOT / "build/registration.json"
    output_of(REGISTRATION, "--gtest_filter=Registration.*",
              f"--gtest_output=json:{results}")
    tests = json.loads(results.read_text())["testsuites"][0]["testsuite"]
    rows = [[t["name"], t.get("sources", ""), t.get("worst_px", ""),
             "fails" if "failures" in t else "holds"] for t in tests]
    return table(("light of", "sources", "worst, px (< 0.01)", ""), rows)


def continuous_integration():
    """What .ci/run and the proof of the set-up took when they last ran here."""
    seconds = ROOT / "build/ci-seconds"
    cache = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "dmise"
    proofs = sorted(cache.glob("bare-root-*.proof"), key=lambda p: p.stat().st_mtime)
    rows = [[".ci/run, last run here", f"{int(seconds.read_text()) / 60:.1f} min (at most 45)"]] if seconds.exists() else []
    rows += [["./dmise demo in a bare Debian root, last proof", proofs[-1].read_text().strip()]] if proofs else []
    return table(("what", "result"), rows) if rows else "Not run here.\n"


OTHERS = {  # sections that are no `dmise bench NAME`
    "demonstration": ("The demonstration", demonstration),
    "referees": ("Referees", referees),
    "registration": ("Light against its label", registration),
    "whole-runs": ("Whole runs", whole_runs),
    "ci": ("Continuous integration", continuous_integration),
}


def kept_sections(path, on):
    """{title: text} of a report that was measured on the same machine, else {}."""
    if not path.exists():
        return {}
    head, *sections = path.read_text().split("\n## ")
    if on not in head:
        print(f"{path}: of another machine, so all its sections go", file=sys.stderr)
        return {}
    return dict(section.split("\n", 1) for section in sections)


def write(path, on, sections):
    """After each measurement, so that one that is cut short loses no other."""
    text = ("# Benchmarks\n\nWritten by `./dmise bench report`. An anchor is somebody else's program, or a floor of "
            f"the machine,\nmeasured beside ours. Machine of all sections: {on}.\n")
    path.parent.mkdir(exist_ok=True)
    path.write_text(text + "".join(f"\n## {title}\n{body.rstrip()}\n" for title, body in sections.items() if body))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    every = sorted({*OTHERS, "detect", *LONG})
    parser.add_argument("--only", nargs="+", metavar="NAME",
                        help="benchmarks to run, or " + ", ".join(every) + "; default all but " + ", ".join(LONG))
    parser.add_argument("--also", nargs="+", metavar="NAME", default=[], help="and these")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "docs/benchmarks.md")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write the figures of all benchmarks, too")
    options = parser.parse_args()
    for needed in (BINARY, REGISTRATION):
        if not needed.exists():
            sys.exit(f"{needed} is not built; run ./dmise bench report")
    order = [*bench_names(), *LONG, "detect", *OTHERS]
    names = (options.only or [name for name in order if name not in LONG]) + options.also
    if unknown := [name for name in names if name not in order]:
        sys.exit(f"--only, --also: no measurement called {', '.join(unknown)}; there are {', '.join(order)}")
    titles = {name: OTHERS[name][0] if name in OTHERS else "Detection" if name == "detect" else f"bench {name}"
              for name in order}
    measured, on = [], machine()
    sections = kept_sections(options.output, on)
    for name in (name for name in order if name in names):
        when = occasion()
        body = (OTHERS[name][1]() if name in OTHERS else
                detection(measured) if name == "detect" else benchmark(name, measured))
        sections[titles[name]] = f"\n{when}.\n\n{body}"
        write(options.output, on, {titles[name]: sections.get(titles[name]) for name in order})
    print(options.output)
    if options.json:
        options.json.write_text("".join(json.dumps(m) + "\n" for m in measured))


if __name__ == "__main__":
    main()
