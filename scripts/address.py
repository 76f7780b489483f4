#!/usr/bin/env python3
"""Writes the address of the public repository into every file that names it, in place of an earlier one.

    scripts/address.py https://HOST/OWNER/flaunay    the place where it is published
    scripts/address.py                               prints the address that the files name, if any

No other file names it. tests/release.py checks that either all of these do, or none.
"""

import pathlib
import re
import sys

SOURCE = pathlib.Path(__file__).resolve().parent.parent
# Each file with the line behind which the address stands, and the line that has it.
PLACES = {
    "CITATION.cff": ("license: MIT", "repository-code: ADDRESS"),
    "CMakeLists.txt": (r"  DESCRIPTION .*", '  HOMEPAGE_URL "ADDRESS"'),
    "CONTRIBUTING.md": ("## Reporting a fault\n", "Reports go to <ADDRESS>."),
    "javascript/package.json": (r'  "description": .*', '  "repository": { "type": "git", "url": "git+ADDRESS.git" },'),
    "packaging/conan/conanfile.py": (r"    description = .*", '    url = "ADDRESS"'),
    "packaging/conda/recipe.yaml": (r"about:", "  repository: ADDRESS"),
    "packaging/qgis/flaunay/metadata.txt": ("category=Analysis", "repository=ADDRESS"),
    "packaging/debian/control": (r"Rules-Requires-Root: .*", "Homepage: ADDRESS"),
    "packaging/vcpkg/ports/flaunay/vcpkg.json": (r'  "description": .*', '  "homepage": "ADDRESS",'),
    "pyproject.toml": (r'license = "MIT"', 'urls = { Source = "ADDRESS" }'),
    "site/mkdocs.yml": (r"site_description: .*", "repo_url: ADDRESS"),
}


def pattern(line):
    return re.compile("^" + re.escape(line).replace("ADDRESS", r"(https://[\w./-]+\w)") + "\n", re.MULTILINE)


def named(source):
    """The address that each file names; None for one that names none."""
    found = {path: pattern(line).search((source / path).read_text()) for path, (_, line) in PLACES.items()}
    return {path: match and match.group(1) for path, match in found.items()}


def write(source, address):
    for path, (before, line) in PLACES.items():
        text = pattern(line).sub("", (source / path).read_text())
        text, count = re.subn(
            f"^{before}\n", lambda match: match[0] + line.replace("ADDRESS", address) + "\n", text, flags=re.MULTILINE
        )
        if count != 1:
            sys.exit(f"{path} has {count} lines like: {before}")
        (source / path).write_text(text)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        if not pattern("ADDRESS").fullmatch(sys.argv[1] + "\n"):
            sys.exit(f"address: {sys.argv[1]} does not begin with https://, or has a slash at its end")
        write(SOURCE, sys.argv[1])
    print(*sorted({address for address in named(SOURCE).values() if address}))
