#!/usr/bin/env python3
"""The site of the documents: build/site, made by MkDocs of docs/, the README and what they link to. A link that leads nowhere,
to a page or to a heading, is an error.

    make.py [--serve]      --serve: shows it at http://127.0.0.1:8000 and follows changes of docs/

Called by `./dmise docs`.
"""
import pathlib
import posixpath
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
STAGED = ROOT / "build/site-pages"
SITE = ROOT / "build/site"
BESIDE = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")  # pages outside of docs/
LINK = re.compile(r"(\]\()([^)\s#]+)(#[^)\s]*)?(\))")
# Chapters of the site; what no chapter names stands in the last one.
CHAPTERS = (
    ("Getting started", ("README.md", "docs/install.md", "docs/tutorial.md", "docs/gallery.md")),
    ("How to", ("docs/howto/design-a-sensor.md", "docs/howto/calibrate-a-camera.md", "docs/howto/manoeuvre-objects.md", "docs/howto/write-a-tracker.md", "docs/howto/plug-in-a-model.md",
                "docs/howto/worked-examples.md", "docs/howto/make-a-data-set.md", "docs/howto/operate-a-network.md",
                "docs/howto/test-your-observatory-software.md")),
    ("Reference", ("docs/reference/scenario.md", "docs/reference/camera.md", "docs/reference/site.md",
                   "docs/reference/materials.md", "docs/wire.md", "docs/python.md", "docs/clients.md", "docs/exchange.md", "docs/detection.md",
                   "docs/datasets.md", "docs/operations.md", "docs/stack.md")),
    ("Models", ("docs/models/*.md",)),
    ("Results", ("docs/accuracy.md", "docs/benchmarks.md", "docs/scaling.md", "docs/paper.md")),
    ("Internals", ("docs/architecture.md", "CONTRIBUTING.md", "docs/**/*.md", "CHANGELOG.md", "SECURITY.md")),
)


def place_of(source):
    """Where a file of the tree lies on the site: docs/ is its root, the README its first page."""
    if source == "README.md":
        return "index.md"
    if source.startswith("docs/"):
        return source[len("docs/"):]
    return source if source in BESIDE else "files/" + source


def pages():
    return [*BESIDE, *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md"))]


class Stage:
    """Copies pages and what they link to below STAGED."""

    def __init__(self):
        self.copied = set()
        self.broken = []

    def link(self, page, target):
        """The link of a page on the site to what `target` is in the tree."""
        source = posixpath.normpath(posixpath.join(posixpath.dirname(page), target))
        path = ROOT / source
        if not path.exists():
            self.broken.append(f"{page}: {target}")
            return target
        if path.is_dir():
            readme = source + "/README.md"
            if (ROOT / readme).exists():
                source = readme
            else:
                self.listing(source)
                source += "/index.md"
        elif source not in pages():
            self.copy(source)
        return posixpath.relpath(place_of(source), posixpath.dirname(place_of(page)) or ".")

    def copy(self, source):
        if source not in self.copied:
            self.copied.add(source)
            target = STAGED / place_of(source)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / source, target)

    def listing(self, source):
        """A page that lists the files of a directory."""
        text = f"# {source}\n\n"
        for path in sorted((ROOT / source).iterdir()):
            if path.is_file():
                self.copy(str(path.relative_to(ROOT)))
                text += f"- [{path.name}]({path.name})\n"
        target = STAGED / place_of(source + "/index.md")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)

    def page(self, page):
        parts = re.split(r"(```.*?```|`[^`\n]*`)", (ROOT / page).read_text(), flags=re.S)
        for i in range(0, len(parts), 2):  # code stays as it is
            parts[i] = LINK.sub(
                lambda m: m[0] if re.match(r"[a-z]+:", m[2]) else m[1] + self.link(page, m[2]) + (m[3] or "") + m[4],
                parts[i])
        target = STAGED / place_of(page)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text("".join(parts))


def navigation():
    named, chapters = set(), []
    for title, patterns in CHAPTERS:
        found = []
        for pattern in patterns:
            for path in sorted(ROOT.glob(pattern)):
                source = str(path.relative_to(ROOT))
                if source not in named and not source.startswith("docs/decisions/0"):
                    named.add(source)
                    found.append(place_of(source))
        chapters.append((title, found))
    return chapters


def configuration():
    lines = ["site_name: DMISE", "site_description: a simulator of optical sensors that watch near-Earth space",
             f"docs_dir: {STAGED}", f"site_dir: {SITE}", "use_directory_urls: false",
             "theme: {name: readthedocs, highlightjs: false, navigation_depth: 3}", "plugins: [search]", "extra_css: [site.css]",
             "markdown_extensions: [tables, fenced_code, toc, attr_list, md_in_html]", "strict: true", "validation:",
             "  omitted_files: ignore", "  links: {not_found: warn, absolute_links: warn, unrecognized_links: warn,"
             " anchors: warn}", "nav:"]
    for title, places in navigation():
        lines.append(f"  - {title}:")
        lines += [f"    - {place}" for place in places]
    return "\n".join(lines) + "\n"


def main():
    shutil.rmtree(STAGED, ignore_errors=True)
    shutil.copytree(ROOT / "docs", STAGED, ignore=shutil.ignore_patterns("*.py", "*.toml", "site", "__pycache__"))
    shutil.copyfile(ROOT / "docs/site/site.css", STAGED / "site.css")
    stage = Stage()
    for page in pages():
        stage.page(page)
    for link in stage.broken:
        print(f"dead link in {link}", file=sys.stderr)
    file = STAGED.parent / "mkdocs.yml"
    file.write_text(configuration())
    serve = sys.argv[1:] == ["--serve"]
    command = ["serve", "--dev-addr", "127.0.0.1:8000"] if serve else ["build", "--clean"]
    words = [sys.executable, "-m", "mkdocs", *command, "--config-file", str(file)]
    if serve:
        return subprocess.run(words, check=False).returncode
    done = subprocess.run(words, capture_output=True, text=True, check=False)  # quiet, it would not count warnings
    for line in done.stderr.splitlines():
        if not line.startswith("INFO"):
            print(line, file=sys.stderr)
    if done.returncode == 0 and not stage.broken:
        print(f"written: {SITE}/index.html, {len(pages())} pages")
    return 1 if done.returncode or stage.broken else 0


if __name__ == "__main__":
    sys.exit(main())
