"""Writes the figures of fault runs into docs/faults.md, below its last heading.

    fault_figures.py FIGURES.jsonl

The lines are those that faults.py, schedules.py, deaths.py, soak.py and tests/fuzz/run.sh append with --json; lines of
schedules are added up.
"""

import datetime
import json
import os
import pathlib
import platform
import sys

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/faults.md"
MARK = "## Measured\n"
KINDS = ("kill", "stop", "slow", "cut", "narrow")
POLICIES = ("policy_fail", "policy_wait", "policy_restart", "policy_drop")


def schedules_text(lines):
    total = {key: sum(line.get(key, 0) for line in lines)
             for key in ("value", "left_out", "ended_complete", "ended_failed", *KINDS, *POLICIES)}
    failed = sum(len(line["failed"]) for line in lines)
    kinds = ", ".join(f"{total[k]} {k}" for k in KINDS)
    policies = ", ".join(f"{total[p]} {p.removeprefix('policy_')}" for p in POLICIES)
    seeds = sorted({line["seed"] for line in lines})
    return (f"- {total['value']} random schedules (seed {', '.join(map(str, seeds))}; policies: {policies}; "
            f"{total['left_out']} left out) with faults that met a living process: {kinds}. "
            f"{total['ended_complete']} runs were complete, {total['ended_failed']} failed as their policy says and were "
            f"taken up again; {failed} did what they should not.")


def resumption_text(lines):
    failed = [number for line in lines for number in line["failed"]]
    return (f"- {sum(line['value'] for line in lines)} random schedules with fusion, agents, keys, full disks and resumption (seed "
            f"{', '.join(sorted({str(line['seed']) for line in lines}))}): {len(failed)} did what they should not.")


def deaths_text(line):
    kinds = ", ".join(f"{line[k]} {k}" for k in KINDS if k in line)
    return (f"- {line['named_in_time']} of {line['trials']} deaths ({kinds}) named within {line['target']:g} s: "
            f"worst {line['value']:g} s, median {line['median_s']:g} s.")


def soak_text(line):
    grown = "; ".join(f"{name} {early:.0f} -> {late:.0f}" for name, (early, late) in
                      ((k, v) for k, v in line.items() if isinstance(v, list)))
    return (f"- {line['ticks']} ticks, window {line['window']}, at {line['ticks_per_s']} a second: largest growth of resident memory after the first "
            f"tenth {100 * line['value']:.2f} % (KiB: {grown}).")


def fuzz_text(lines):
    targets = sorted({line["target"] for line in lines})
    return (f"- {min(line['value'] for line in lines)} mutated messages and more for each of {', '.join(targets)} under "
            f"ASan and UBSan: {sum(line['findings'] for line in lines)} findings.")


def main():
    lines = [json.loads(line) for line in pathlib.Path(sys.argv[1]).read_text().splitlines()]
    named = lambda name: [line for line in lines if line["name"] == name]
    parts = [schedules_text(named("fault_schedules"))] if named("fault_schedules") else []
    parts += [resumption_text(named("schedules"))] if named("schedules") else []
    parts += [deaths_text(line) for line in named("death_named_worst_s")[-1:]]
    parts += [soak_text(line) for line in named("soak_growth_worst")[-1:]]
    if named("fuzz"):
        parts.append(fuzz_text(named("fuzz")))
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
               platform.processor())
    where = f"{datetime.datetime.now(datetime.UTC):%Y-%m-%d}, {os.cpu_count()} cores ({cpu}), Linux {platform.release().split('-')[0]}, load {os.getloadavg()[2]:.1f} before:"
    text = PAGE.read_text()
    PAGE.write_text(text[: text.index(MARK)] + MARK + "\n" + where + "\n\n" + "\n".join(parts) + "\n")


if __name__ == "__main__":
    main()
