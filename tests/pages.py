#!/usr/bin/env python3
"""Checks the Markdown pages of the source tree: that links lead to files and headings that exist, that no two headings
of a page are equal, that files named in code spans exist, and that lines have at most 120 columns, except in tables, in
code, and on pages that programs write; that pages which are shown alone link to no file; and that there are not more
words than are read.

    pages.py SOURCE
"""

import pathlib
import re
import sys

COLUMNS = 120
PATTERNS = ("*.md", "docs/*.md", "javascript/*.md", "python/*.md", "docs/tutorials/*.md", "site/*.md", "bench/results/*.md", "tests/data/*.md")
# So many words at most, code and tables included: tutorials, which are read one by one, apart from the rest.
WORDS = {("*.md", "docs/*.md"): 49_500, ("docs/tutorials/*.md",): 4_000}
# npm and PyPI show these alone: no link to another file leads anywhere there.
SHOWN_ALONE = ("javascript/README.md", "python/pypi.md")
WRITTEN_BY_PROGRAMS = "bench/results"
FOLDERS = ("bench", "cmake", "docs", "examples", "host", "javascript", "kernels", "python", "scripts", "site", "src", "tests")
# A code span with a folder of the source tree, such as `src/call/parts.hpp`. Placeholders and patterns are no paths.
PATH = re.compile(rf"`((?:{'|'.join(FOLDERS)})/[\w./-]*)`")
# One with a source file by its name, or by the end of its path, such as `planar.h` or `blocks/merge.cl`.
SOURCE_FILE = re.compile(r"`([\w-][\w./-]*\.(?:cl|cmake|cpp|hpp|h|py|sh))`")
# A changelog has the same headings for each version.
REPEATS_HEADINGS = "CHANGELOG.md"
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
    """Its headings in their order, with the numbers of their lines."""
    return [(number, anchor(line.lstrip("#"))) for number, line in prose(page) if line.startswith("#")]


def repeated_headings(page):
    seen = set()
    for number, heading in headings(page):
        if heading in seen and page.name != REPEATS_HEADINGS:
            yield number, f"a second heading {heading}"
        seen.add(heading)


def path_ends(source):
    """All names by which pages may call files: their paths from any folder on."""
    ends = set()
    for folder in FOLDERS:
        for file in (source / folder).rglob("*.*"):
            parts = file.relative_to(source).parts
            ends.update("/".join(parts[k:]) for k in range(len(parts)))
    return ends


def problems(source, page, files):
    is_written_by_people = not page.is_relative_to(source / WRITTEN_BY_PROGRAMS)
    yield from repeated_headings(page)
    for number, line in prose(page):
        if len(line) > COLUMNS and is_written_by_people and not line.startswith("|"):
            yield number, f"{len(line)} columns"
        for link in LINK.findall(line):
            if re.match(r"\w+:", link):
                continue
            name, _, fragment = link.partition("#")
            if name and page.relative_to(source).as_posix() in SHOWN_ALONE:
                yield number, f"a link to another file, which is not there: {link}"
            target = page.parent / name if name else page
            if not target.exists():
                yield number, f"no file {link}"
            elif fragment and all(fragment != heading for _, heading in headings(target)):
                yield number, f"no heading {link}"
        for path in PATH.findall(line):
            if not (source / path).exists():
                yield number, f"no file {path}"
        for name in SOURCE_FILE.findall(line):
            if name not in files and name.split("/")[0] not in FOLDERS:
                yield number, f"no file is called {name}"


def main():
    source = pathlib.Path(sys.argv[1])
    files = path_ends(source)
    found = 0
    for pattern in PATTERNS:
        for page in sorted(source.glob(pattern)):
            for number, problem in problems(source, page, files):
                print(f"{page.relative_to(source)}:{number}: {problem}")
                found += 1
    for patterns, limit in WORDS.items():
        pages = [page for pattern in patterns for page in source.glob(pattern)]
        words = sum(len(page.read_text(encoding="utf-8").split()) for page in pages)
        if words > limit:
            print(f"{' '.join(patterns)}: {words} words, at most {limit}")
            found += 1
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
