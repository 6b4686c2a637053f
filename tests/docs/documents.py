#!/usr/bin/env python3
"""Checks the documents: the index of decisions is complete, and no link leads nowhere.

    documents.py            exits 1 and names what is wrong
    documents.py --write    writes docs/decisions/README.md anew
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
DECISIONS = ROOT / "docs/decisions"
INDEX = DECISIONS / "README.md"
SKIPPED = {"build", "out", ".git"}


def decisions():
    """(number, title, status, file name) of each decision, by number; raises ValueError on a wrong head."""
    for path in sorted(DECISIONS.glob("[0-9]*.md")):
        head = re.match(r"# (\d{4}) (\S.*)\n\nStatus: (\S.*)\.\n", path.read_text())
        if not head or not path.name.startswith(head[1] + "-"):
            raise ValueError(f"{path.relative_to(ROOT)}: must begin with '# NNNN Title', an empty line, "
                             "'Status: accepted.' and have the number in its name")
        yield head[1], head[2], head[3], path.name


def index():
    rows = list(decisions())
    numbers = [number for number, *_ in rows]
    for number in {n for n in numbers if numbers.count(n) > 1}:
        raise ValueError(f"docs/decisions: number {number} is taken twice")
    return ("# Decisions\n\nWhat was decided where there was a choice, why, and what it costs. Written by\n"
            "`tests/docs/documents.py --write`.\n\n| number | decision | status |\n|---|---|---|\n"
            + "".join(f"| [{number}]({name}) | {title} | {status} |\n" for number, title, status, name in rows))


def dead_links():
    """'file: link' of each relative link of a document that leads to no file."""
    for path in sorted(ROOT.rglob("*.md")):
        if SKIPPED & set(path.relative_to(ROOT).parts):
            continue
        text = re.sub(r"```.*?```", "", path.read_text(), flags=re.S)
        for link in re.findall(r"\]\(([^)\s]+)\)", text):
            target = link.partition("#")[0]
            if target and not re.match(r"[a-z]+:", target) and not (path.parent / target).exists():
                yield f"{path.relative_to(ROOT)}: {link}"


def wrong_in_gallery():
    """Shipped scenarios that the gallery does not show, and what it shows that is none."""
    shown = set(re.findall(r"^## (.*)$", (ROOT / "docs/gallery.md").read_text(), flags=re.M))
    shipped = {str(path.relative_to(ROOT / "launch/scenarios").with_suffix(""))
               for path in (ROOT / "launch/scenarios").rglob("*.yaml")
               if re.search("^simulation:", path.read_text(), flags=re.M)}
    return sorted(shown ^ shipped)


def main():
    try:
        text = index()
    except ValueError as error:
        print(error)
        return 1
    if sys.argv[1:] == ["--write"]:
        INDEX.write_text(text)
        return 0
    wrong = [f"dead link in {link}" for link in dead_links()]
    wrong += [f"docs/gallery.md is not of {name}, or lacks it: run docs/gallery/scenarios.py" for name in wrong_in_gallery()]
    if not INDEX.exists() or INDEX.read_text() != text:
        wrong.append("docs/decisions/README.md is not the index of the decisions: run tests/docs/documents.py --write")
    print("\n".join(wrong) or f"ok: {text.count('](')} decisions, no dead link")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
