"""The jobs of launch/stack/kubernetes: valid by the schemas of Kubernetes, and what their pods run makes the same bytes as one process.

    kubernetes.py DMISE
"""
import os
import pathlib
import subprocess
import sys
import tempfile

from harness import Failure, check

try:
    import kubernetes_validate
    import yaml
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
JOBS = ROOT / "launch/stack/kubernetes"
SCENARIO = """\
simulation: {start: 2018-01-21T03:00:00Z, duration_s: 30, tick_s: 10}
objects: [{catalogue: demo, only: [GOES 13, GOES 14]}]
detection: off
sensors:
  - name: watcher
    site: {latitude_deg: 33, longitude_deg: -100, height_m: 300}
    camera:
      optics: {columns: 32, rows: 32, pixel_pitch_m: 9e-6, focal_length_m: 0.2, aperture_m: 0.1, psf_fwhm_px: 2}
      detector: {quantum_efficiency: 0.6, read_noise_e: 5, full_well_e: 60000, gain_e_per_dn: 1, bias_dn: 100}
      band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}
    pointing: {target: GOES 13, tracking: fixed}
    exposure_s: 4
    cadence_s: 30
output: {fits: off}
"""


def job(name):
    return next(one for one in yaml.safe_load_all((JOBS / name).read_text()) if one["kind"] == "Job")


def pod(job_, index, dmise, **values):
    """Runs what the container of a pod runs."""
    (container,) = job_["spec"]["template"]["spec"]["containers"]
    given = {one["name"]: one["value"] for one in container["env"]}
    if set(values) - set(given):
        raise Failure(f"{job_['metadata']['name']}: has no {set(values) - set(given)}")
    done = subprocess.run([*container["command"], *container["args"]], capture_output=True, text=True, timeout=300,
                          env={**os.environ, **given, **values, "JOB_COMPLETION_INDEX": str(index),
                               "PATH": f"{dmise.parent}:/usr/bin:/bin"})
    if done.returncode:
        raise Failure(f"pod {index} of {job_['metadata']['name']}: {done.stderr.strip()[-300:]}")


def files_are_valid():
    for path in sorted(JOBS.glob("*.yaml")):
        for one in yaml.safe_load_all(path.read_text()):
            kubernetes_validate.validate(one, "1.37", strict=True)
        print(f"ok: {path.name} is valid")
    samples = job("samples.yaml")
    shards = next(one["value"] for one in samples["spec"]["template"]["spec"]["containers"][0]["env"] if one["name"] == "SHARDS")
    check(int(shards) == samples["spec"]["completions"], "there is a pod for each share")


def samples_are_those_of_one_process(dmise, directory):
    (directory / "scenario.yaml").write_text(SCENARIO)
    for index in (1, 0):
        pod(job("samples.yaml"), index, dmise, SCENARIO=f"{directory}/scenario.yaml", OUT=f"{directory}/pods", SEEDS="1..101",
            SHARDS="2", WORKERS="1")
    subprocess.run([dmise, "dataset", directory / "scenario.yaml", "--seeds", "1..101", "--out", directory / "one"], check=True,
                   capture_output=True)
    names = {path.name for path in (directory / "one").iterdir() if path.is_file() and not path.name.startswith(".")}
    check({"dataset-000000.tar", "dataset-000001.tar", "dataset.json"} <= names, "two archives and the manifest")
    differ = [name for name in names if (directory / "one" / name).read_bytes() != (directory / "pods" / name).read_bytes()]
    check(not differ, f"the pods make the bytes of one process {differ or ''}")


def surveys_are_of_each_scenario(dmise, directory):
    scenarios = directory / "scenarios"
    scenarios.mkdir()
    for name in "ab":
        (scenarios / f"{name}.yaml").write_text(SCENARIO)
    for index in (0, 1):
        pod(job("surveys.yaml"), index, dmise, SCENARIOS=str(scenarios), OUT=f"{directory}/surveys")
    check(all((directory / "surveys" / name / "survey.json").exists() for name in "ab"), "a survey of each scenario")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="dmise-test-") as temporary:
        try:
            files_are_valid()
            samples_are_those_of_one_process(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary))
            surveys_are_of_each_scenario(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary))
        except Failure as failure:
            sys.exit(f"FAIL: {failure}")
