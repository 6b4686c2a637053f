"""A run that is cut short at any of its ticks goes on and gives the bytes of an undisturbed one: with fusion and cues, by Ctrl-C,
by the death of the launcher, by a full disk.

    young.py DMISE [--all]

Without --all each tick has one of the causes, in turns; with it each tick has all.
"""

import argparse
import contextlib
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import tempfile

from harness import Failure, Run, check_same, wait_until

TICKS = 5
SCENARIO = """\
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5, seed: 1}
objects: [{catalogue: newcomer.tle, radius_m: 4}]
stars: {catalogue: kstars}
fusion: {not_in_catalogue: [NEWCOMER], cue_delay_ticks: 2}
network: {silent_after_s: 60, join_within_s: 300, window_ticks: 1}
sensors:
  - {name: atlanta, site: atlanta, camera: wide.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark}
  - {name: huntsville, site: huntsville, camera: wide.yaml, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: dark}
  - name: telescope
    site: atlanta
    camera: wide.yaml
    pointing: {cued: {slew_deg_per_s: 5, slew_deg_per_s2: 3, limiting_magnitude: 12, exposures: 4, least_gain_nats: 0}}
    exposure_s: 0.5
    cadence_s: 2.5
    sky: dark
output: {png: false}
"""
FILES = {
    "wide.yaml": """\
name: wide
optics: {projection: gnomonic, columns: 64, rows: 64, pixel_pitch_m: 43.2e-6, field_of_view_deg: 15, aperture_m: 0.02}
detector: {full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100}
band: {centre_m: 0.55e-6, width_m: 0.128e-6}
""",
    # 900 km above the two sites after a minute.
    "newcomer.tle": """\
NEWCOMER
1 99999U 18001A   18021.01041667  .00000000  00000-0  00000-0 0  9992
2 99999  66.0000  22.9510 0000001   0.0000  33.5590 13.98200000000018
"""}
CAUSES = ("interrupt", "kill", "full disk")


def lines(path):
    return path.read_bytes().count(b"\n") if path.exists() else 0


def cut_short(binary, scenario, out, cause, tick):
    """Ends a run when a sensor has made `tick` frames, or a moment later; its exit code."""
    with Run(binary, "launch", scenario, "--out", out) as run:
        frames = out / "atlanta/frames.jsonl"
        wait_until(lambda: lines(frames) >= tick or run.process.poll() is not None, f"tick {tick}")
        if cause == "interrupt":
            run.interrupt()
        elif cause == "kill":
            with contextlib.suppress(ProcessLookupError):
                os.kill(run.process.pid, signal.SIGKILL)
        code, _ = run.finish()
        wait_until(lambda: not run.living(), "its processes to end")
        return code


def no_room(binary, scenario, out, bytes_a_file):
    """A launch none of whose files can grow beyond a number of bytes, as on a disk that fills."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_a_file, bytes_a_file))

    done = subprocess.run([binary, "launch", scenario, "--out", out], capture_output=True, text=True, check=False,
                          preexec_fn=limit, restore_signals=False)
    return done.returncode


def play(binary, scenario, out, cause, tick, reference):
    if cause == "full disk":
        # What the first `tick` frames of a sensor take, and half a line of the next.
        rows = (reference / "atlanta/frames.jsonl").read_bytes().splitlines(keepends=True)
        code = no_room(binary, scenario, out, sum(map(len, rows[:tick])) + len(rows[0]) // 2)
    else:
        code = cut_short(binary, scenario, out, cause, tick)
    with Run(binary, "launch", scenario, "--out", out) as run:
        again, _ = run.finish()
        if again != 0:
            raise Failure(f"{cause} at tick {tick} (code {code}): the same command again ends with {again}: {run.stderr[-400:]}")
        how = "goes on" if "continuing" in run.stdout else "begins anew" if code else "was over"
    check_same(out, reference, f"{cause} at tick {tick} (code {code}) {how}")
    if not (out / "index.html").exists():
        raise Failure(f"{cause} at tick {tick}: no report")
    shutil.rmtree(out)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmise")
    parser.add_argument("--all", action="store_true")
    options = parser.parse_args()
    binary = pathlib.Path(options.dmise).resolve()
    with tempfile.TemporaryDirectory(prefix="dmise-young-") as name:
        work = pathlib.Path(name)
        for file, text in FILES.items():
            (work / file).write_text(text)
        scenario = work / "young.yaml"
        scenario.write_text(SCENARIO)
        reference = work / "reference"
        with Run(binary, "launch", scenario, "--out", reference) as run:
            if run.finish()[0] != 0:
                raise Failure(f"the undisturbed run: {run.stderr[-400:]}")
        for tick in range(TICKS):
            for number, cause in enumerate(CAUSES):
                if options.all or tick % len(CAUSES) == number:
                    play(binary, scenario, work / "run", cause, tick, reference)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        raise SystemExit(f"FAIL: {failure}") from None
