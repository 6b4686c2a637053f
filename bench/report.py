"""Measures, and writes docs/benchmarks.json, all figures, and docs/benchmarks.md, those that matter.

    report.py [--only NAME ..] [--also NAME ..] [--output FILE] [--json FILE]
    report.py --render            writes the page anew from the figures that are there, measures nothing

Runs every `dmise bench NAME --json`, the demonstration, and the referees on its products. Each figure keeps the date, commit,
load and machine of its measurement; --only replaces the figures of the measurements that it names and leaves the others as
they are. What fails is reported as failed, and its earlier figures stay.
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
BUILD = ROOT / "bench/build.py"
DEMO = ROOT / "launch/scenarios/demo.yaml"
RUN = ROOT / "build/benchmark-run"
# A document of its own, by bench/scaling.py; a part of frame.
ELSEWHERE = ("scaling", "all-sky")
LONG = ("network", "build")  # a quarter of an hour of real time; builds of fresh clones
SHORTER = {"effects": ("--scenes", "30")}  # as in the tests
# The figures of the page, and what each is. * stands for anything: the worst of what it matches.
PAGE = {
    "Frames": {
        "all_sky_s": "an all-sky frame of 3326 x 2504 pixels, processor",
        "all_sky_peak_mb": "its memory",
        "full_chain_4096_ratio": "a frame of 4096 x 4096 blurred by diffraction, over two transforms of FFTW",
        "poisson_1e4_mpx_per_s": "Poisson deviates of mean 10,000, a core",
        "all_parts_ms": "all parts of the sky over a frame",
        "tile_ms": "a shape of 10,000 facets, 512 x 512 pixels, 16 samples each",
    },
    "Accuracy": {
        "scenes_within_budget": "random scenes whose planned frames keep their budgets",
        "scenes_bounds_hold": "random scenes in which all stated bounds hold",
        "all_sky_thrift": "an all-sky frame at `standard`, of the time of the reference",
        "registration_worst_px_*": "rendered light from its label, the worst",
    },
    "Detection": {
        "frame_s": "detection in an all-sky frame, one thread",
        "frame_peak_mb": "its memory beyond the frame",
        "false_alarms_per_frame": "false alarms in such a frame",
        "pd_shift_points_snr": "SNR by which half of all points come late, from theory",
        "pd_shift_streaks_snr": "of streaks, at the worst length",
    },
    "Orbits and visibility": {
        "near_m_per_s": "SGP4, near the Earth, a core",
        "deep_m_per_s": "SGP4, deep space, a core",
        "max_error_km": "from the reference implementation, the worst",
        "memory_1e6_mb": "a million objects with their results",
        "cone_61k_x_100_ms": "61,000 objects against 100 fields",
        "figure5_s": "a day of 18,470 objects over a field",
        "interpolation_order7_60s_max_mm": "objects between ticks of 60 s by order 7, the worst",
        "flight_1000_objects_1_h_s": "a thousand objects by numerical integration, 1 h at 5 s, a core",
        "flight_orekit_*_m": "flights of a day from Orekit's with the same forces, the worst of seven",
        "flight_sentinel3a_day_rms_*_m": "Sentinel-3A, 24 h from a first state, root mean square, the worst of seven days",
        "flight_jason1_day_rms_*_m": "Jason-1, of eight days",
    },
    "Tracks": {
        "filter_end_error_m": "a low orbit after 60 detections of three sites at 1 arcsec",
        "filter_nees": "its squared error over the covariance",
        "tick_s": "a tick of fusion with 3,000 detections of 200 sensors",
    },
    "Network": {
        "ratio_16": "ticks of 16 nodes, of a bare ZeroMQ exchange",
        "curve_ratio_16": "encrypted",
        "master_cpu_us_per_tick_200": "the time-master, 200 nodes behind agents, a tick",
        "python_actor_ticks_per_s": "ticks of a run with an actor in Python",
        "python_actor_20000_ticks_per_s": "with one of 20,000 objects",
        "nodes_16_ratio": "ticks of 16 actors in Python, of as many nodes that do nothing",
        "sensors_real_time": "all-sky sensors that keep up with real time, without detection",
        "sensors_real_time_detecting": "with detection",
        "sensor_pss_mb": "memory of one of them",
    },
    "From nothing to a picture": {
        "demo_wall_s": "the demonstration, 20 frames of four sensors",
        "demo_from_clone_s": "from a clone to the end of the demonstration",
        "build_processor_s": "processors' time to compile what the demonstration runs",
        "test_build_processor_s": "and all tests",
        "tests_s": "from there until ./dmise test has built and passed everything",
        "incremental_s": "a change of one file of core, to a running test",
        "ci_minutes": "all checks of a commit",
    },
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
    """When, of what and where a figure is measured."""
    commit = output_of("git", "rev-parse", "--short", "HEAD").stdout.strip() or "unknown"
    ours = ("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/benchmarks.md", ":!docs/benchmarks.json")
    if output_of(*ours).stdout.strip():
        commit += " and changes"
    date = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    return {"date": date, "commit": commit, "load": round(os.getloadavg()[0], 2), "machine": machine()}


def bench_names():
    """The subcommands that `dmise bench --help` lists, and the build."""
    listed = output_of(BINARY, "bench", "--help").stdout.partition("Subcommands:")[2]
    names = [name for name in re.findall(r"^  ([\w-]+)", listed, re.MULTILINE) if name not in ELSEWHERE] + ["paper"]
    return names + (["build"] if BUILD.exists() and "build" not in names else [])


def measure(name, *arguments):
    """The figures of a benchmark, as its --json prints them; throws RuntimeError if there are none."""
    print(f"measuring {name}", file=sys.stderr)
    command = ("/usr/bin/python3", BUILD) if name == "build" else (BINARY, "bench", name)
    done = output_of(*command, "--json", *SHORTER.get(name, ()), *arguments)
    figures = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"name":')]
    if not figures:
        raise RuntimeError((done.stderr.strip() or "no reason given").splitlines()[-1][-100:])
    return figures


def figure(name, value, unit="", target=None, less_is_better=True):
    met = None if target is None else value <= target if less_is_better else value >= target
    return {"name": name, "value": value, "unit": unit, "anchor": None, "anchor_value": None, "ratio": None, "target": target, "met": met}


def demonstration():
    """Runs the demonstration: its time, that of each sensor's frames and effects, and of each node."""
    print("running the demonstration", file=sys.stderr)
    done = output_of(BINARY, "launch", DEMO, "--out", RUN, "--force")
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().splitlines()[-1][-100:])
    record = json.loads((RUN / "run.json").read_text())
    figures = [figure("demo_wall_s", record["wall_s"], "s", 60)]
    frames = collections.defaultdict(list)
    for costs in RUN.glob("*/cost.jsonl"):
        frames[costs.parent.name] = [json.loads(line) for line in costs.read_text().splitlines()]
    for sensor, costs in sorted(frames.items()):
        figures += [figure(f"demo_{sensor}_frame_s", statistics.median(c["total_s"] for c in costs), "s"),
                    figure(f"demo_{sensor}_detection_s", statistics.median(c["detection_s"] for c in costs), "s"),
                    figure(f"demo_{sensor}_pss_mb", max(c["pss_mb"] for c in costs), "MB")]
        figures += [figure(f"demo_{sensor}_{effect}_ms", 1e3 * statistics.median(c["effects_s"].get(effect, 0.0) for c in costs), "ms")
                    for effect, took in costs[0]["effects_s"].items() if took]
    figures += [figure(f"demo_{n['name']}_{part}", n[part], "s") for n in record["nodes"]
                for part in ("compute_s", "messaging_s", "waiting_s")]
    return figures


def claims(commands):
    """What test programs say, each claim an entry; `commands`: {name: command}."""
    said = []
    for name, command in commands.items():
        print(f"asking {name}", file=sys.stderr)
        done = output_of(*command)
        verdict = {0: "holds", 77: "not measured"}.get(done.returncode, "fails")
        for line in (line for line in (done.stdout + done.stderr).splitlines() if line):
            text = re.sub(r"^\w+: ", "", re.sub(r" \(logs in [^)]*\)", "", line)).replace(str(ROOT), ".")
            said.append({"judge": name, "claim": text, "verdict": "holds" if line.startswith("ok: ") else verdict})
    return said


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
    output_of(REGISTRATION, "--gtest_filter=Registration.*", f"--gtest_output=json:{results}")
    tests = json.loads(results.read_text())["testsuites"][0]["testsuite"]
    return [figure(f"registration_worst_px_{t['name']}", float(t["worst_px"]), "px", 0.01) for t in tests if t.get("worst_px")]


def continuous_integration():
    """What .ci/run took when it last ran here."""
    seconds = ROOT / "build/ci-seconds"
    if not seconds.exists():
        raise RuntimeError("not run here")
    return [figure("ci_minutes", int(seconds.read_text()) / 60, "min", 45)]


OTHERS = {  # measurements that are no `dmise bench NAME`
    "demonstration": demonstration,
    "referees": referees,
    "registration": registration,
    "whole-runs": whole_runs,
    "ci": continuous_integration,
}


def read(path):
    return json.loads(path.read_text()) if path.exists() else {"figures": [], "claims": []}


def merged(kept, name, measured, when):
    """The report with a measurement in the place of its earlier figures and claims."""
    result = {}
    for kind in ("figures", "claims"):
        new = [{"bench": name, **m, **when} for m in measured if ("judge" in m) == (kind == "claims")]
        result[kind] = [m for m in kept[kind] if m["bench"] != name] + new if measured else kept[kind]
    return result


def as_json(report):
    """One entry a line, so that a change shows what was measured anew."""
    parts = [json.dumps(kind) + ": [\n" + ",\n".join(json.dumps(m) for m in report[kind]) + "\n]" for kind in ("figures", "claims")]
    return "{\n" + ",\n".join(parts) + "\n}\n"


def worst(found):
    """The largest of several figures that one row stands for."""
    return max(found, key=lambda m: abs(m["value"])) if found else None


def page(report, data_name):
    machines, rows = [], 0

    def place(m):
        if m["machine"] not in machines:
            machines.append(m["machine"])
        return machines.index(m["machine"]) + 1

    text = ""
    for title, wanted in PAGE.items():
        table_rows = []
        for pattern, what in wanted.items():
            m = worst([f for f in report["figures"] if fnmatch.fnmatch(f["name"], pattern)])
            if m is None:
                continue
            anchor = f"{number(m['anchor_value'])}: {m['anchor']}" if m.get("anchor_value") else m.get("anchor") or ""
            target = number(m.get("target")) + ("" if m.get("met") is None else " reached" if m["met"] else " missed")
            table_rows.append([what, f"`{pattern}`", number(m["value"]), "" if m["unit"] == "1" else m["unit"], anchor, target,
                               m["date"][:10], place(m)])
        rows += len(table_rows)
        if table_rows:
            text += f"\n## {title}\n\n" + table(("", "figure", "value", "unit", "anchor", "target", "date", "machine"), table_rows)
    judges = collections.defaultdict(list)
    for claim in report["claims"]:
        judges[claim["judge"]].append(claim)
    if judges:
        text += "\n## Judges\n\nPrograms of others, and tests of whole runs, on the demonstration.\n\n"
        text += table(("judge", "claims that hold", "not measured", "date", "machine"), [
            [judge, f"{sum(c['verdict'] == 'holds' for c in of)} of {len(of)}", sum(c["verdict"] == "not measured" for c in of) or "",
             of[0]["date"][:10], place(of[0])] for judge, of in judges.items()])
    listed = "".join(f"{k}. {name}\n" for k, name in enumerate(machines, 1))
    return (f"# Benchmarks\n\nWritten by `./dmise bench report`: {rows} figures of {len(report['figures'])}. "
            f"[{data_name}]({data_name}) has all, each with its\ndate, commit, load and machine, and every claim of a judge. An "
            "anchor is somebody else's program, or a floor of the\nmachine, measured beside ours.\n\n"
            f"Machines:\n\n{listed}{text}")


def write(output, data, report):
    """After each measurement, so that one that is cut short loses no other."""
    output.parent.mkdir(exist_ok=True)
    data.write_text(as_json(report))
    output.write_text(page(report, data.name))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    every = sorted({*OTHERS, *LONG})
    parser.add_argument("--only", nargs="+", metavar="NAME",
                        help="benchmarks to run, or " + ", ".join(every) + "; default all but " + ", ".join(LONG))
    parser.add_argument("--also", nargs="+", metavar="NAME", default=[], help="and these")
    parser.add_argument("--render", action="store_true", help="write the page from the figures that are there")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "docs/benchmarks.md")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="all figures; default OUTPUT with the ending .json")
    options = parser.parse_args()
    data = options.json or options.output.with_suffix(".json")
    report = read(data)
    if options.render:
        write(options.output, data, report)
        print(options.output)
        return
    if not BINARY.exists():
        sys.exit(f"{BINARY} is not built; run ./dmise bench report")
    order = [*bench_names(), *OTHERS]
    names = (options.only or [name for name in order if name not in LONG]) + options.also
    if unknown := [name for name in names if name not in order]:
        sys.exit(f"--only, --also: no measurement called {', '.join(unknown)}; there are {', '.join(order)}")
    failed = []
    for name in (name for name in order if name in names):
        when = occasion()
        try:
            report = merged(report, name, OTHERS[name]() if name in OTHERS else measure(name), when)
        except (RuntimeError, OSError, ValueError) as error:
            failed.append(f"{name}: {error}")
        write(options.output, data, report)
    print(options.output)
    if failed:
        sys.exit("failed, earlier figures stay: " + "; ".join(failed))


if __name__ == "__main__":
    main()
