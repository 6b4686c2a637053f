#!/usr/bin/env python3
"""Holds documents and code to docs/glossary.md: its words are in order, each once, each is said in what its row points at and
in another document, and nobody says what a row has under `not`. No comment of the program begins with "of", "the same" or "likewise": it names its subject.

    glossary.py        exits 1 and names what is wrong
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
GLOSSARY = ROOT / "docs/glossary.md"
ROW = re.compile(r"^\| ([^|]+) \| [^|]+ \| \[`[^`]+`\]\(\.\./([^)]+)\) \| ([^|]*)\|$", re.M)
CODE = ("broker", "clients", "core", "launch", "nodes", "orbit-node", "proto", "sensors", "time-master")
SUFFIXES = (".h", ".cpp", ".proto", ".py", ".ts", ".md")
# Texts of others: names in their formats, records of what was once decided, figures by machines.
SKIPPED = ("docs/decisions/", "docs/site/", "docs/notebooks/", "node_modules", "__pycache__")


def texts():
    """(path, text in which words of names stand apart) of each document and source."""
    paths = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")]
    for folder in CODE:
        paths += [path for path in sorted((ROOT / folder).rglob("*")) if path.suffix in SUFFIXES]
    for path in paths:
        name = str(path.relative_to(ROOT))
        if path != GLOSSARY and not any(skipped in name for skipped in SKIPPED):
            yield name, re.sub(r"(?<=[a-z])(?=[A-Z])", " ", path.read_text(errors="replace")).replace("_", " ").lower()


def says(word):
    """A pattern of the word, in singular and plural, with blanks or hyphens."""
    parts = (re.escape(part) for part in word.lower().split())
    return re.compile(r"(?<![a-z])" + r"[\s-]+".join(parts) + r"(?:s|es|ed|d)?(?![a-z])")


def said_in(place, word):
    files = [place] if place.is_file() else [path for path in place.rglob("*") if path.suffix in (".h", ".cpp")]
    stem = re.sub(r"[\s-]", "", word)[:6]
    return any(stem in re.sub(r"[\s_-]", "", str(path) + path.read_text()).lower() for path in files)


def faults():
    rows = ROW.findall(GLOSSARY.read_text())
    lines = [line for line in GLOSSARY.read_text().splitlines() if line.startswith("| ")]
    if len(rows) != len(lines) - 1:
        yield f"docs/glossary.md: {len(lines) - 1} rows, of which {len(rows)} have the form | word | meaning | [`name`](../place) | not |"
    words = [word.strip() for word, _, _ in rows]
    if words != sorted(set(words)):
        yield "docs/glossary.md: the words must be in order, each once"
    everything = list(texts())
    for word, place, instead in rows:
        if not (ROOT / place).exists():
            yield f"docs/glossary.md: {word}: {place} is not there"
        elif not said_in(ROOT / place, word):
            yield f"docs/glossary.md: {word}: {place} does not say it"
        pattern = says(word)
        if not any(pattern.search(text) for name, text in everything if name.endswith(".md")):
            yield f"docs/glossary.md: {word}: no other document says it"
        for wrong in filter(None, (part.strip() for part in instead.split(","))):
            pattern = says(wrong)
            for name, text in everything:
                if found := pattern.search(text):
                    yield f"{name}:{text[:found.start()].count(chr(10)) + 1}: says {wrong!r} for {word!r} (docs/glossary.md)"


def has_subject(line, before):
    """Whether the comment in a line, if there is one, names its subject. It may go on in small letters where the line before has a comment."""
    begun = re.search(r"//+<? ?(of|the same|likewise)\b", line, re.I)
    continues = "//" in before and line.lstrip().startswith("//") and "///<" not in line
    return not begun or continues and begun[1][0].islower()


def faults_of_comments():
    """Comments without a subject."""
    for folder in (*CODE, "bench", "tests"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".h", ".cpp", ".proto", ".ts") and "node_modules" not in str(path):
                lines = path.read_text().splitlines()
                for number, (before, line) in enumerate(zip(["", *lines], lines), 1):
                    if not has_subject(line, before):
                        yield f"{path.relative_to(ROOT)}:{number}: the comment has no subject"


def main():
    wrong = [*faults(), *faults_of_comments()]
    print("\n".join(wrong) or "ok: documents and code keep to the glossary")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
