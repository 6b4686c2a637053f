"""`dmise dataset` leaves the same bytes for any number of workers and tasks, and after any number of kills; what can't be made is
refused in one line before a frame is made.

    dataset.py DMISE
"""

import filecmp
import os
import pathlib
import resource
import signal
import subprocess
import textwrap
import time

from harness import Run, check, main, wait_until

SCENARIO = """simulation: {start: {uniform: [2018-01-21T03:00:00Z, 2018-01-21T09:00:00Z]}, duration_s: 20, tick_s: 10}
objects:
  - {catalogue: demo, only: [GOES 13, GOES 14, GOES 15], radius_m: {log_uniform: [1, 8]}}
stars: {catalogue: kstars}
sensors:
  - name: eye
    site: {latitude_deg: {uniform: [25, 40]}, longitude_deg: -100, height_m: 300}
    camera:
      optics: {columns: 128, rows: 96, pixel_pitch_m: 9e-6, focal_length_m: 0.2, aperture_m: 0.1, psf_fwhm_px: 2}
      detector: {read_noise_e: 5, full_well_e: 60000, gain_e_per_dn: 1, bias_dn: 100}
      band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}
    pointing: {target: {one_of: [GOES 13, GOES 14, GOES 15]}, tracking: fixed}
    exposure_s: {log_uniform: [1, 8]}
    cadence_s: 10
"""
LAUNCH = pathlib.Path(__file__).resolve().parents[2] / "launch"
SLURM, SHIPPED = LAUNCH / "stack/slurm/samples.sbatch", LAUNCH / "scenarios/dataset.yaml"
SEEDS, PER_SHARD = "5..94", 20


def dataset(binary, scenario, out, *more, **options):
    usual = () if "--seeds" in more else ("--seeds", SEEDS, "--per-shard", PER_SHARD)
    return subprocess.run([str(a) for a in (binary, "dataset", scenario, *usual, "--out", out, *more)], capture_output=True, text=True,
                          **options)


def done(result, what):
    check(result.returncode == 0, f"{what}: {result.stdout.strip() or result.stderr.strip()}")


def same(ours, reference, what):
    names = sorted(p.name for p in reference.iterdir())
    check(sorted(p.name for p in ours.iterdir()) == names and
          all(filecmp.cmp(ours / name, reference / name, shallow=False) for name in names), f"{what}: the same bytes")


def any_workers_and_tasks(binary, scenario, directory):
    reference = directory / "reference"
    done(dataset(binary, scenario, reference, "--workers", 1), "one worker")
    check(sorted(p.name for p in reference.glob("*.tar")) == [f"dataset-{k:06d}.tar" for k in range(5)], "five archives")
    done(dataset(binary, scenario, directory / "three", "--workers", 3), "three workers")
    same(directory / "three", reference, "three workers")
    out = directory / "tasks"
    for i in (2, 3, 1):
        result = dataset(binary, scenario, out, "--shard", f"{i}/3", "--workers", 2)
        done(result, f"task {i} of 3")
        check((out / "dataset.json").exists() == (i == 1), "complete with the last task")
    same(out, reference, "three tasks")
    out = directory / "array"
    for task in (7, 8):
        environment = dict(os.environ, DMISE=str(binary), SLURM_ARRAY_TASK_ID=str(task), SLURM_ARRAY_TASK_MIN="7",
                           SLURM_ARRAY_TASK_COUNT="2", SLURM_CPUS_PER_TASK="2")
        subprocess.run(["bash", SLURM, scenario, out, "5..24"], check=True, env=environment, capture_output=True)
    check((out / "dataset.json").exists(), "a job array makes a data set")
    return reference


def kills(binary, scenario, directory, reference):
    out = directory / "killed"
    arguments = (binary, "dataset", scenario, "--seeds", SEEDS, "--per-shard", PER_SHARD, "--out", out, "--workers", 2)

    def samples():
        return len(list(out.glob("parts/sample-*.tar"))) + PER_SHARD * len(list(out.glob("*.tar")))

    for least, how in ((3, signal.SIGKILL), (15, signal.SIGINT), (30, signal.SIGKILL), (55, signal.SIGTERM)):
        with Run(*arguments) as run:
            wait_until(lambda: samples() >= least or run.process.poll() is not None, f"{least} samples")
            os.kill(run.process.pid, how)
            code = run.process.wait(timeout=20)
            check(code == (-9 if how == signal.SIGKILL else 130), f"{how.name} after {samples()} samples: it ends with {code}")
            wait_until(lambda: not run.living(), "the workers' end")
        check(not (out / "dataset.json").exists(), "it is not complete")
    before = samples()
    done(dataset(binary, scenario, out, "--workers", 2), f"continued with {before} samples")
    same(out, reference, "four times stopped")


def directories(binary, scenario, directory, reference):
    result = dataset(binary, scenario, reference)
    check(result.returncode == 0 and "complete; --force repeats it" in result.stdout, "what is complete is not made again")
    other = directory / "other.yaml"
    other.write_text(scenario.read_text().replace("[25, 40]", "[25, 41]"))
    refused(dataset(binary, other, reference), "contains another data set; --force replaces it")
    done(dataset(binary, other, reference, "--force"), "with --force it is replaced")
    mine = directory / "mine"
    (mine / "parts").mkdir(parents=True)
    files = {"scenario.yaml": "# mine\n", "coco.json": "{}", "dataset-backup.tar": "x", "parts/my-file": "y"}
    for name, text in files.items():
        (mine / name).write_text(text)
    few = ("--seeds", "1..2")
    refused(dataset(binary, scenario, mine, *few), "mine: contains coco.json, which is of no data set there")
    check(all((mine / name).read_text() == text for name, text in files.items()), "files of no data set are kept")
    done(dataset(binary, scenario, mine, *few, "--force"), "with --force those of such names are replaced")
    check(all((mine / name).read_text() == files[name] for name in ("dataset-backup.tar", "parts/my-file")), "and no others")


def more_seeds(binary, scenario, directory):
    once, grown = directory / "once", directory / "grown"
    done(dataset(binary, scenario, once, "--seeds", "1..7", "--per-shard", 2), "seven seeds at once")
    done(dataset(binary, scenario, grown, "--seeds", "1..4", "--per-shard", 2), "the first four")
    kept = (grown / "dataset-000001.tar").stat().st_mtime_ns
    done(dataset(binary, scenario, grown, "--seeds", "5..7", "--per-shard", 2), "three more")
    same(grown, once, "four seeds and three more")
    check((grown / "dataset-000001.tar").stat().st_mtime_ns == kept, "archives that are there are kept")
    refused(dataset(binary, scenario, grown, "--seeds", "9..12", "--per-shard", 2), "has seeds 1..7; more must begin with one of these")


def together(binary, scenario, directory):
    """Processes that would disturb each other are refused, and what is made is as if they had never begun."""
    other, out = directory / "other.yaml", directory / "together"
    arguments = ("--seeds", "1..1000", "--per-shard", "4", "--workers", "1")
    with Run(binary, "dataset", scenario, "--out", out, *arguments) as run:
        wait_until(lambda: len(list(out.glob("dataset-*.tar"))) > 1, "archives")
        refused(dataset(binary, other, out, *arguments, "--force"), "together: another process works in this directory")
        refused(dataset(binary, other, out, *arguments), "together: contains another data set")
        refused(dataset(binary, scenario, out, *arguments), "together: another process works on --shard 1/1")
        refused(dataset(binary, scenario, out, *arguments, "--shard", "1/2"), "with another n of --shard i/n, got 1/2")
        os.kill(run.process.pid, signal.SIGINT)
        check(run.process.wait(timeout=20) == 130, "the first goes on until it is stopped")
    out = directory / "choices"
    cameras = [directory / f"camera-{k}.yaml" for k in range(3)]
    text = SCENARIO
    begin, end = text.index("    camera:\n"), text.index("    pointing:")
    for camera in cameras:
        camera.write_text(textwrap.dedent("\n".join(text[begin:end].splitlines()[1:])))
    path = directory / "choices.yaml"
    path.write_text(text[:begin] + f"    camera: {{one_of: [{', '.join(c.name for c in cameras)}]}}\n" + text[end:])
    done(dataset(binary, path, out, "--seeds", "1..2"), "a choice of cameras")
    for camera in cameras:
        before = camera.read_text()
        camera.write_text(before.replace("bias_dn: 100", "bias_dn: 101"))
        refused(dataset(binary, path, out, "--seeds", "1..2"), "choices: contains another data set")
        camera.write_text(before)
    check("complete; --force" in dataset(binary, path, out, "--seeds", "1..2").stdout, "the files of every choice are in the digest")


def refused(result, message):
    lines = result.stderr.strip().splitlines()
    check(result.returncode == 2 and len(lines) == 1 and message in lines[0], f"refused: {lines[-1] if lines else result}")


def bad_input(binary, directory):
    path, out = directory / "bad.yaml", directory / "bad"

    def of(what, replacement, message):
        path.write_text(SCENARIO.replace(what, replacement, 1))
        refused(dataset(binary, path, out), message)
        check(not out.exists(), "nothing is made")

    of("[25, 40]", "[25, 95]", "bad.yaml:7:26: sensors[0].site.latitude_deg: must be <= 90, got 95 (the most of its uniform)")
    of("[25, 40]", "[40, 25]", "bad.yaml:7:41: sensors[0].site.latitude_deg.uniform[1]: must be > 40, got 25")
    of("[1, 8]}}", "[0, 8]}}", "objects[0].radius_m.log_uniform[0]: must be > 0, got 0")
    of("GOES 15]}, tr", "GOES 99]}, tr", "sensors[0].pointing.target")
    of("cadence_s: 10", "cadence_s: {uniform: [2, 10]}", "must be <= cadence_s")
    of("one_of: [GOES 13", "one_off: [GOES 13", "sensors[0].pointing.target.one_off: unknown key, did you mean one_of?")
    of("uniform: [2018-01-21T03", "uniform: [2018-02-30T03", "simulation.start.uniform[0]: must be a UTC time such as")
    for more, message in (("output: {planes: [noise]}", "output.planes: is for runs"),
                          ("output: {star_truth: on}", "output.star_truth: is for runs"),
                          ("output: {positions: [csv, oem]}", "output.positions: is for runs"),
                          ("fusion: on", ": fusion: is for runs, not for data sets (as drawn for seed 5)")):
        path.write_text(SCENARIO + more + "\n")
        refused(dataset(binary, path, out), message)
    short_trajectory(binary, directory, out)
    path.write_text(SCENARIO)
    for more, message in ((("--shard", "4/3"), "--shard: must be i/n with i from 1 to n, got 4/3"),
                          (("--shard", "0/3"), "got 0/3"), (("--seeds", "9..3"), "--seeds: must be A..B"),
                          (("--seeds", "-3..3"), "--seeds"), (("--seeds", "1..1e9"), "got 1..1e9")):
        arguments = dict(zip(("--seeds", "--out"), ("1..3", str(out))), **dict([more]))
        refused(subprocess.run([str(binary), "dataset", str(path), *(f"{k}={v}" for k, v in arguments.items())],
                               capture_output=True, text=True), message)
    refused(dataset(binary, path, out, "--shard", "1/2", "--force"), "--force: would remove what other tasks have made")
    for command in ("run", "check"):
        refused(subprocess.run([str(binary), command, str(path)], capture_output=True, text=True, cwd=directory),
                "bad.yaml:1:21: simulation.start: is a distribution (uniform): dmise dataset draws a value for each seed")
    result = dataset(binary, path, out, "--check")
    check(result.returncode == 0 and "can be made" in result.stdout and not out.exists(), "--check makes nothing")


def short_trajectory(binary, directory, out):
    """Each seed's times are compared with those of a trajectory, not the first seed's alone."""
    states = "".join(f"2018-01-21T00:{13 + k}:00.000 {7000 + k} 0 0 0 7.5 0\n" for k in range(7))
    (directory / "short.oem").write_text(
        "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2018-01-21T00:00:00\nORIGINATOR = TEST\nMETA_START\nOBJECT_NAME = sat\n"
        "OBJECT_ID = 2018-001A\nCENTER_NAME = EARTH\nREF_FRAME = GCRF\nTIME_SYSTEM = UTC\nSTART_TIME = 2018-01-21T00:13:00.000\n"
        f"STOP_TIME = 2018-01-21T00:19:00.000\nMETA_STOP\n{states}")
    path = directory / "short.yaml"
    objects = SCENARIO[SCENARIO.index("objects:"):SCENARIO.index("stars:")]
    text = SCENARIO.replace(objects, "objects: [{name: sat, motion: {oem: short.oem}}]\n")
    text = text.replace("{one_of: [GOES 13, GOES 14, GOES 15]}", "sat").replace("duration_s: 20", "duration_s: 30")
    path.write_text(text.replace("T03:00:00Z", "T00:15:00Z").replace("T09:00:00Z", "T00:19:20Z"))
    for more in ((), ("--check",)):
        result = dataset(binary, path, out, *more, "--seeds", "1..40")
        refused(result, "short.oem: the trajectory of sat spans")
        check("short.yaml:2:" in result.stderr and "(as drawn for seed " in result.stderr, "with place and seed")
        check(not out.exists(), "before a frame is made")


def failures(binary, scenario, directory):
    """What fails in a frame names its seed; a worker that somebody ends is told. Both are continued."""
    path, out = directory / "meeting.yaml", directory / "meeting"
    orbit = "motion: {two_body: {semi_major_axis_m: 7e6, eccentricity: 0, inclination_deg: 50}}"
    text = SCENARIO[:SCENARIO.index("    site:")] + SCENARIO[SCENARIO.index("    camera:"):]
    path.write_text(text.replace("objects:\n", f"objects:\n  - {{name: host, {orbit}}}\n  - {{name: guest, {orbit}}}\n")
                    .replace("    camera:", "    platform: host\n    camera:")
                    .replace("{target: {one_of: [GOES 13, GOES 14, GOES 15]}, tracking: fixed}", "{target: guest}"))
    result = dataset(binary, path, out)
    lines = result.stderr.strip().splitlines()
    check(result.returncode == 1 and len(lines) == 1 and ": eye: pointing.target: guest is where the sensor is" in lines[0] and
          "dmise: seed " in lines[0], f"a frame that can't be made: {lines[-1] if lines else result}")
    out = directory / "orphaned"
    with Run(binary, "dataset", scenario, "--seeds", "1..5000", "--out", out, "--workers", 2) as run:
        wait_until(lambda: len(list(out.glob("parts/sample-*.tar"))) > 3, "samples")
        worker = next(pid for pid in run.living() if pid != run.process.pid)
        os.kill(worker, signal.SIGKILL)
        code, _ = run.finish(20)
        check(code == 1 and "a worker was ended by signal 9: the same command continues" in run.stderr,
              f"a worker is ended: {run.stderr.strip()}")
        run.nothing_left()


def processor_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def in_time(binary, directory):
    """A busy machine takes longer: what counts is the time of two processors."""
    began, before_s = time.monotonic(), processor_s()
    done(subprocess.run([binary, "dataset", SHIPPED, "--seeds", "1..500", "--workers", "2", "--out", directory / "shipped"],
                        capture_output=True, text=True), "the shipped scenario")
    used_s, seconds = processor_s() - before_s, time.monotonic() - began
    check(used_s / 2 <= 60, f"500 labelled images of 512 x 512 pixels by two workers: {used_s:.1f} s of processors, {seconds:.1f} s")


def test(binary, directory):
    scenario = directory / "drawn.yaml"
    scenario.write_text(SCENARIO)
    reference = any_workers_and_tasks(binary, scenario, directory)
    kills(binary, scenario, directory, reference)
    directories(binary, scenario, directory, reference)
    more_seeds(binary, scenario, directory)
    together(binary, scenario, directory)
    bad_input(binary, directory)
    failures(binary, scenario, directory)
    in_time(binary, directory)


main(test)
