"""The jobs of launch/stack/kubernetes: valid by the schemas of Kubernetes, and what their pods run makes the same bytes as one process: each
its share, or a network of nodes.

    kubernetes.py DMISE
"""
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile

from harness import Failure, check, check_same, write_scenario

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


def jobs(name):
    return [one for one in yaml.safe_load_all((JOBS / name).read_text()) if one["kind"] == "Job"]


def job(name):
    (one,) = jobs(name)
    return one


def start(job_, index, dmise, **values):
    """What the container of a pod runs, as a process."""
    (container,) = job_["spec"]["template"]["spec"]["containers"]
    given = {one["name"]: one.get("value", "") for one in container["env"]}
    if set(values) - set(given):
        raise Failure(f"{job_['metadata']['name']}: has no {set(values) - set(given)}")
    return subprocess.Popen([*container["command"], *container["args"]], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                            env={**os.environ, **given, **values, "JOB_COMPLETION_INDEX": str(index),
                                 "PATH": f"{dmise.parent}:/usr/bin:/bin"})


def finish(process, what):
    try:
        said = process.communicate(timeout=300)[1]
    finally:
        process.kill()
    if process.returncode:
        raise Failure(f"{what}: {said.strip()[-300:]}")


def pod(job_, index, dmise, **values):
    finish(start(job_, index, dmise, **values), f"pod {index} of {job_['metadata']['name']}")


def files_are_valid():
    for path in sorted(JOBS.glob("*.yaml")):
        for one in yaml.safe_load_all(path.read_text()):
            kubernetes_validate.validate(one, "1.37", strict=True)
        print(f"ok: {path.name} is valid")
    samples = job("samples.yaml")
    shards = next(one["value"] for one in samples["spec"]["template"]["spec"]["containers"][0]["env"] if one["name"] == "SHARDS")
    check(int(shards) == samples["spec"]["completions"], "there is a pod for each share")
    (service,) = (one for one in yaml.safe_load_all((JOBS / "network.yaml").read_text()) if one["kind"] == "Service")
    labels = {one["metadata"]["name"]: one["spec"]["template"].get("metadata", {}).get("labels") for one in jobs("network.yaml")}
    check(labels["dmise-time-master"] == service["spec"]["selector"], "the service is of the launcher's pod")


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


def secrets_of(job_, keys, directory):
    """The files of a Secret that pods of the job see, as readable as they are there; and where a pod copies them."""
    volumes = job_["spec"]["template"]["spec"]["volumes"]
    (items,) = (one["secret"]["items"] for one in volumes if one["name"] == "secrets")
    shown = directory / job_["metadata"]["name"]
    shown.mkdir()
    for item in items:
        found = next(path / item["key"] for path in (keys, keys / "rings") if (path / item["key"]).exists())
        shutil.copy(found, shown / item["path"])
        (shown / item["path"]).chmod(0o440)
    return shown


def network_is_that_of_one_process(dmise, directory):
    """Each pod with the keys of its job alone; of the four sensors' pods two have none in this scenario, and end."""
    keys = directory / "keys"
    scenario = write_scenario(directory / "network", duration_s=30, silent_after_s=120.0, network=", join_within_s: 120")
    subprocess.run([dmise, "keygen", keys, "--scenario", scenario, "--rings"], check=True, capture_output=True)
    subprocess.run([dmise, "run", scenario, "--out", directory / "reference"], check=True, capture_output=True)
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    pods = []
    try:
        for job_ in reversed(jobs("network.yaml")):
            shown = secrets_of(job_, keys, directory)
            for index in range(job_["spec"].get("completions", 1)):
                own = directory / f"{shown.name}-{index}"
                own.mkdir(mode=0o700)
                clock = {"ADDRESS": "127.0.0.1", "PORT": str(port)}
                to = clock if shown.name == "dmise-time-master" else {"MASTER": f"tcp://127.0.0.1:{port}"}
                pods.append((own.name, start(job_, index, dmise, SCENARIO=str(scenario), OUT=f"{directory}/run", SECRETS=str(shown),
                                             KEYS=str(own), **to)))
        for name, process in reversed(pods):
            finish(process, name)
    finally:
        for _, process in pods:
            process.kill()
    check_same(directory / "run", directory / "reference", f"{len(pods)} pods make the bytes of one process")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="dmise-test-") as temporary:
        try:
            files_are_valid()
            samples_are_those_of_one_process(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary))
            surveys_are_of_each_scenario(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary))
            network_is_that_of_one_process(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary))
        except Failure as failure:
            sys.exit(f"FAIL: {failure}")
