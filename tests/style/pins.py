"""What the set-up fetches from PyPI and npm is pinned by digest: every package of the lists and lock files.

    pins.py ROOT
"""

import json
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
SETUP = ROOT / "launch/setup"


def unpinned_of_pip(path):
    """Requirements without the digest of a file; continued lines are one."""
    text = re.sub(r"\\\n", " ", re.sub(r"(?m)^#.*\n", "", path.read_text()))
    return [line.split()[0] for line in text.splitlines() if line.strip() and not re.fullmatch(r"\S+==\S+( +--hash=sha256:[0-9a-f]{64})+", line)]


def unpinned_of_npm(path):
    packages = json.loads(path.read_text())["packages"]
    return [name for name, package in packages.items() if name and not package.get("integrity", "").startswith("sha512-")]


def main():
    lists = sorted(path for path in SETUP.glob("*.txt") if "==" in path.read_text())
    locks = [SETUP / "node/package-lock.json", ROOT / "clients/dashboard/package-lock.json"]
    if len(lists) < 4:
        sys.exit(f"only {len(lists)} lists of Python packages")
    for paths, unpinned in ((lists, unpinned_of_pip), (locks, unpinned_of_npm)):
        for path in paths:
            if found := unpinned(path):
                sys.exit(f"{path.relative_to(ROOT)}: without a digest: {', '.join(found)} (launch/setup/pin.py)")
    for command in re.findall(r"(?:npm install|pip install) .*", (SETUP / "install.sh").read_text()):
        if "-r " not in command and "--ignore-installed" not in command and "--no-deps" not in command:
            sys.exit(f"launch/setup/install.sh: without a list: {command}")


main()
