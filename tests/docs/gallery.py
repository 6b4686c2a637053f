#!/usr/bin/env python3
"""docs/gallery holds the pictures that docs/gallery/make.py makes and the documents show, and it makes one.

    gallery.py DMISE
"""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
GALLERY = ROOT / "docs/gallery"
MAKE = GALLERY / "make.py"


def check(holds, what):
    if not holds:
        sys.exit(f"FAIL: {what}")
    print(f"ok: {what}")


def main():
    listed = subprocess.run([sys.executable, MAKE, "--list"], capture_output=True, text=True, check=True).stdout
    made = dict(line.split(" ", 1) for line in listed.splitlines())
    there = {path.name for path in GALLERY.iterdir() if path.suffix in (".png", ".svg", ".jpg")}
    check(set(made) == there, f"the pictures of docs/gallery are those that make.py makes {sorted(set(made) ^ there)}")
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    shown = set(re.findall(r"!\[[^\]]*\]\([^)]*?gallery/([^/)]+)\)", "".join(page.read_text() for page in pages)))
    check(shown == there, f"and the documents show all of them {sorted(shown ^ there)}")
    in_gallery = set(re.findall(r"\(gallery/([^/)]+)\)", (ROOT / "docs/gallery.md").read_text()))
    check(in_gallery <= set(made), f"those of gallery.md too {sorted(in_gallery - set(made))}")
    check(all((ROOT / script).exists() for script in made.values()), "the scripts that make them are there")
    with tempfile.TemporaryDirectory(prefix="dmise-gallery-test-") as name:
        done = subprocess.run([sys.executable, MAKE, "--dmise", sys.argv[1], "--out", name, "psf.png"], capture_output=True, text=True,
                              check=False)
        picture = pathlib.Path(name) / "psf.png"
        check(done.returncode == 0 and picture.exists() and picture.read_bytes()[:4] == b"\x89PNG", f"make.py makes psf.png {done.stderr[-300:]}")


if __name__ == "__main__":
    main()
