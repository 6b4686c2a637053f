#!/usr/bin/env python3
"""Pins the packages of a list by digest: pin.py LIST writes, after each "name==version", the SHA-256 of its wheels that the
systems of releases.txt may install, as pip's index states them. Run it after changing a version."""

import pathlib
import re
import sys
import urllib.parse
import urllib.request

from fetch_source import index_url

PYTHONS = ("cp311", "cp312", "cp313")
MACHINES = ("x86_64", "aarch64")


def fits(wheel):
    """Whether a wheel is for a Python and a machine of ours."""
    pythons, abi, platform = wheel.removesuffix(".whl").split("-")[-3:]
    of_python = "py3" in pythons or any(p in pythons.split(".") for p in PYTHONS) or abi == "abi3"
    of_machine = platform == "any" or "manylinux" in platform and platform.endswith(MACHINES)
    return of_python and of_machine and not abi.endswith("t")


def digests(name, version):
    """SHA-256 of the wheels of a version, in the order of their names."""
    url = f"{index_url().rstrip('/')}/{re.sub(r'[-_.]+', '-', name).lower()}/"
    with urllib.request.urlopen(url, timeout=60) as page:
        links = re.findall(r'href="([^"]+)"', page.read().decode())
    found = {}
    for link in links:
        file = urllib.parse.unquote(urllib.parse.urlsplit(link).path.rsplit("/", 1)[-1])
        digest = re.search(r"#sha256=([0-9a-f]{64})", link)
        if file.endswith(".whl") and file.split("-")[1] == version and fits(file) and digest:
            found[file] = digest.group(1)
    if not found:
        raise OSError(f"the index has no wheel of {name} {version}")
    return [found[file] for file in sorted(found)]


def main(path):
    text = []
    for line in pathlib.Path(path).read_text().splitlines():
        if line.startswith(" ") or not line:
            continue
        if line.startswith("#"):
            text.append(line)
            continue
        name, version = line.removesuffix("\\").strip().split("==")
        hashes = [f"    --hash=sha256:{digest}" for digest in digests(name, version)]
        text.append(" \\\n".join([f"{name}=={version}", *hashes]))
    pathlib.Path(path).write_text("\n".join(text) + "\n")


if __name__ == "__main__":
    try:
        main(sys.argv[1])
    except OSError as error:
        sys.exit(f"{error}")
