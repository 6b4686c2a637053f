#!/usr/bin/env python3
"""Makes the wheel of the Python package: the engine, the programs, their libraries, cameras, sites and catalogues.

    wheel.py TREE OUT    of a built tree (build/release) that has target dmise_engine

Run by ./dmise wheel, in build/engine-venv.
"""
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLATFORM = "manylinux_2_36_x86_64"
PROJECT = tomllib.loads((ROOT / "clients/python/pyproject.toml").read_text())["project"]
NAME = f"{PROJECT['name']}-{PROJECT['version']}"
# Programs and what they read are kept; manuals and completions are for a system's package.
KEPT = {"bin": "bin", "lib/dmise": "lib/dmise", "share/dmise": "share/dmise"}
WHEN = (1980, 1, 1, 0, 0, 0)  # equal content gives equal bytes


def installed(tree, stage):
    """The package's directory, with the programs in it."""
    subprocess.run(["cmake", "--install", tree, "--component", "runtime", "--prefix", stage, "--strip"], check=True,
                   stdout=subprocess.DEVNULL)
    package = stage / "lib/python3/dist-packages/dmise"
    for source, to in KEPT.items():
        (package / to).parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(stage / source, package / to, dirs_exist_ok=True)
    shutil.copy(tree / "lib/libdmise_pictures_png.so", package / "lib/dmise/libdmise_pictures.so")
    return package


def engine_of(package_in_tree):
    """The newest module of the engine, and the tags of a wheel that has it."""
    engine = max(package_in_tree.glob("_engine.*.so"), key=lambda path: path.stat().st_mtime)
    if ".abi3." in engine.name:
        return engine, "cp312-abi3"
    python = re.search(r"cpython-(\d+)", engine.name)[1]
    return engine, f"cp{python}-cp{python}"


def libraries_of(files):
    """Packages of Debian that the wheel's libraries come from, by the names of the libraries' files."""
    paths = set()
    for file in files:
        for line in subprocess.run(["ldd", file], capture_output=True, text=True).stdout.splitlines():
            if match := re.search(r"=> (/\S+)", line):
                paths.add(os.path.realpath(match[1]))
    owners = {}
    for path in sorted(paths):
        found = subprocess.run(["dpkg", "-S", path], capture_output=True, text=True).stdout
        if not found:  # where /lib is /usr/lib
            found = subprocess.run(["dpkg", "-S", path.removeprefix("/usr")], capture_output=True, text=True).stdout
        if found:
            owners[pathlib.Path(path).name] = found.split(":")[0]
    return owners


def write_licences(info, bundled, owners):
    """What the wheel's parts are under: the copyright files of the libraries in it, beside ours."""
    licences = info / "licenses"
    licences.mkdir()
    for name in ("LICENSE", "NOTICE"):
        shutil.copy(ROOT / name, licences / name)
    shutil.copy(ROOT / "launch/package/copyright", licences / "copyright")
    lines = ["Libraries in this wheel, from Debian, and where their licences are. FFTW is under the GPL-2.0-or-later: with it,",
             "this wheel as a whole is under the GPL-3.0-or-later. The source of DMISE stays under the Apache-2.0.", ""]
    for library in sorted(bundled):
        package = owners.get(re.sub(r"-[0-9a-f]{8}(?=\.)", "", library))
        text = pathlib.Path(f"/usr/share/doc/{package}/copyright")
        if package is None or not text.exists():
            raise SystemExit(f"wheel: {library}: no licence was found for it")
        shutil.copyfile(text, licences / f"{package}.copyright")
        lines.append(f"{library}: {package}.copyright")
    (licences / "LIBRARIES").write_text("\n".join(lines) + "\n")


def write_metadata(info, tag):
    info.mkdir()
    extras = PROJECT["optional-dependencies"]
    lines = ["Metadata-Version: 2.4", f"Name: {PROJECT['name']}", f"Version: {PROJECT['version']}",
             "Summary: simulator of optical sensors that watch near-Earth space", "Requires-Python: >=3.11",
             "License-Expression: GPL-3.0-or-later", "License-File: LICENSE", "License-File: NOTICE", "License-File: LIBRARIES",
             *(f"Requires-Dist: {need}" for need in PROJECT["dependencies"])]
    for extra, needs in extras.items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {need}; extra == "{extra}"' for need in needs)]
    description = (ROOT / "docs/python.md").read_text()
    (info / "METADATA").write_text("\n".join([*lines, "Description-Content-Type: text/markdown", "", description]))
    (info / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: dmise\nRoot-Is-Purelib: false\nTag: {tag}-linux_x86_64\n")
    (info / "entry_points.txt").write_text("[console_scripts]\ndmise = dmise.commands:main\n")


def packed(content, path, level):
    """Writes a wheel of a directory, with the digests of its files."""
    record = next(content.glob("*.dist-info")) / "RECORD"
    files = sorted(file for file in content.rglob("*") if file.is_file() and file != record)
    lines = []
    for file in files:
        digest = base64.urlsafe_b64encode(hashlib.sha256(file.read_bytes()).digest()).rstrip(b"=").decode()
        lines.append(f"{file.relative_to(content)},sha256={digest},{file.stat().st_size}")
    record.write_text("\n".join([*lines, f"{record.relative_to(content)},,"]) + "\n")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=level) as wheel:
        for file in [*files, record]:
            member = zipfile.ZipInfo(str(file.relative_to(content)), WHEN)
            member.external_attr = (file.stat().st_mode & 0xFFFF) << 16
            member.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(member, file.read_bytes())


def repaired(wheel, out):
    """The wheel with its libraries inside, by auditwheel."""
    environment = {**os.environ, "PATH": f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"}
    done = subprocess.run([sys.executable, "-m", "auditwheel", "repair", "--plat", PLATFORM, "--only-plat", "-w", out, wheel],
                          env=environment, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"wheel: auditwheel: {done.stderr.strip()}")
    (made,) = out.glob("*.whl")
    return made


def make(tree, out, work):
    engine, tag = engine_of(ROOT / "build/python/dmise")
    package = installed(tree, work / "stage")
    shutil.copy(engine, package / engine.name)
    subprocess.run(["strip", package / engine.name], check=True)
    owners = libraries_of([package / engine.name, *(package / "bin").iterdir(), *(package / "lib/dmise").iterdir()])
    content = work / "content"
    content.mkdir()
    shutil.move(package, content / "dmise")
    info = content / f"{NAME}.dist-info"
    write_metadata(info, tag)
    plain = work / f"{NAME}-{tag}-linux_x86_64.whl"
    packed(content, plain, 1)
    with_libraries = work / "repaired"
    with_libraries.mkdir()
    made = repaired(plain, with_libraries)
    # Which libraries it holds is known now.
    final = work / "final"
    with zipfile.ZipFile(made) as wheel:
        for member in wheel.infolist():
            path = pathlib.Path(wheel.extract(member, final))
            path.chmod(member.external_attr >> 16 & 0o777 or 0o644)
    write_licences(final / info.name, [path.name for path in (final / "dmise.libs").iterdir()], owners)
    out.mkdir(parents=True, exist_ok=True)
    packed(final, out / made.name, 9)
    return out / made.name


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="dmise-wheel-") as work:
        print(make(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(work)))
