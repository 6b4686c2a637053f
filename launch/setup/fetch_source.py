#!/usr/bin/env python3
"""Downloads the source archive of a Python package from pip's index, without building it as `pip download` would.

    fetch_source.py REQUIREMENTS DIRECTORY

REQUIREMENTS has one line "name==version --hash=sha256:DIGEST", comments aside. Prints the path of the archive. What fails is
said in one line; nothing is left then.
"""

import hashlib
import os
import pathlib
import re
import subprocess
import sys
import urllib.parse
import urllib.request


def index_url():
    """The index that pip is told to use, else its own default."""
    told = subprocess.run([sys.executable, "-m", "pip", "config", "get", "global.index-url"], capture_output=True, text=True)
    if url := os.environ.get("PIP_INDEX_URL") or told.stdout.strip():
        return url
    from pip._internal.models.index import PyPI

    return PyPI.simple_url


def main(requirements, directory):
    lines = [line for line in pathlib.Path(requirements).read_text().splitlines() if line and not line.startswith("#")]
    name, version, digest = re.fullmatch(r"([\w.-]+)==([\w.]+) --hash=sha256:([0-9a-f]{64})", lines[0]).groups()
    page_url = f"{index_url().rstrip('/')}/{name.lower()}/"
    with urllib.request.urlopen(page_url, timeout=60) as page:
        links = re.findall(r'href="([^"]+)"', page.read().decode())
    wanted = f"{name}-{version}.tar.gz"
    link = next((link for link in links if urllib.parse.urlsplit(link).path.endswith("/" + wanted)), None)
    if link is None:
        raise OSError(f"the index has no {wanted}")
    with urllib.request.urlopen(urllib.parse.urljoin(page_url, link), timeout=60) as archive:
        content = archive.read()
    if (found := hashlib.sha256(content).hexdigest()) != digest:
        raise OSError(f"SHA-256 of {wanted} must be {digest}, got {found}")
    path = pathlib.Path(directory) / wanted
    path.write_bytes(content)
    print(path)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:3])
    except (OSError, ImportError) as error:
        sys.exit(f"{error}")
