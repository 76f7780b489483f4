#!/usr/bin/env python3
"""Checks the Markdown pages of the source tree: that links lead to files and headings that exist, that paths in code
spans exist, and that lines have at most 120 columns, except in tables, in code, and on pages that programs write.

    pages.py SOURCE
"""

import pathlib
import re
import sys

COLUMNS = 120
PATTERNS = ("*.md", "docs/*.md", "bench/results/*.md", "tests/data/*.md")
WRITTEN_BY_PROGRAMS = "bench/results"
# A code span with a folder of the source tree, such as `src/call/parts.hpp`. Placeholders and patterns are no paths.
PATH = re.compile(r"`((?:bench|cmake|docs|examples|host|kernels|python|scripts|src|tests)/[\w./-]*)`")
LINK = re.compile(r"\]\(([^)\s]+)\)")


def anchor(heading):
    """What a heading is called in links, as GitHub and others name it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip()).lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def prose(page):
    """Its lines with their numbers, without code blocks."""
    inside = False
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if line.lstrip().startswith("```"):
            inside = not inside
        elif not inside:
            yield number, line


def headings(page):
    return {anchor(line.lstrip("#")) for _, line in prose(page) if line.startswith("#")}


def problems(source, page):
    is_written_by_people = not page.is_relative_to(source / WRITTEN_BY_PROGRAMS)
    for number, line in prose(page):
        if len(line) > COLUMNS and is_written_by_people and not line.startswith("|"):
            yield number, f"{len(line)} columns"
        for link in LINK.findall(line):
            if re.match(r"\w+:", link):
                continue
            name, _, fragment = link.partition("#")
            target = page.parent / name if name else page
            if not target.exists():
                yield number, f"no file {link}"
            elif fragment and fragment not in headings(target):
                yield number, f"no heading {link}"
        for path in PATH.findall(line):
            if not (source / path).exists():
                yield number, f"no file {path}"


def main():
    source = pathlib.Path(sys.argv[1])
    found = 0
    for pattern in PATTERNS:
        for page in sorted(source.glob(pattern)):
            for number, problem in problems(source, page):
                print(f"{page.relative_to(source)}:{number}: {problem}")
                found += 1
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
