#!/usr/bin/env python3
"""Checks that every file that names flaunay's version, what depends on it, or what flaunay is, agrees with
CMakeLists.txt.

The others read it from there.

    versions.py SOURCE VERSION DESCRIPTION
"""

import pathlib
import re
import sys

source, version, description = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
major, minor, patch = version.split(".")
# What ends the name of the shared library: before 1.0.0, each minor version has another interface.
interface = f"0.{minor}" if major == "0" else major
# A text in which the only group is the version, or a part of it.
PLACES = [
    ("CHANGELOG.md", r"\n## \[([^\]]*)\]", version),
    ("CITATION.cff", r"\nversion: (.*)\n", version),
    ("packaging/conda/recipe.yaml", r'version: "([^"]*)"', version),
    ("packaging/debian/changelog", r"flaunay \(([^)-]*)-\d+\)", version),
    ("packaging/debian/control", r"Package: libflaunay([0-9.]+)", interface),
    ("packaging/debian/control", r"Depends: libflaunay([0-9.]+) ", interface),
    ("packaging/qgis/flaunay/metadata.txt", r"\nversion=(.*)\n", version),
    ("packaging/vcpkg/ports/flaunay/vcpkg.json", r'"version": "([^"]*)"', version),
    ("docs/packages.md", r"`libflaunay([0-9.]+)`", interface),
    ("src/include/flaunay/version.h", r"FLAUNAY_VERSION_MAJOR (\d+)\n", major),
    ("src/include/flaunay/version.h", r"FLAUNAY_VERSION_MINOR (\d+)\n", minor),
    ("src/include/flaunay/version.h", r"FLAUNAY_VERSION_PATCH (\d+)\n", patch),
    ("src/include/flaunay/version.h", r'FLAUNAY_VERSION "([^"]*)"', version),
]
# Files that say in this sentence what flaunay is, in one line or more, at the beginning or as a description.
DESCRIBED = (
    "CITATION.cff", "README.md", "packaging/conan/conanfile.py", "packaging/conda/recipe.yaml", "packaging/debian/control",
    "packaging/vcpkg/ports/flaunay/vcpkg.json", "pyproject.toml", "python/flaunay/__init__.py", "python/pypi.md",
    "site/index.md", "site/mkdocs.yml", "src/include/flaunay/flaunay.h", "src/include/flaunay/flaunay.hpp",
)
failed = not (source / f"packaging/debian/libflaunay{interface}.install").exists()
if failed:
    print(f"packaging/debian has no libflaunay{interface}.install")
for place, pattern, expected in PLACES:
    found = re.search(pattern, (source / place).read_text(encoding="utf-8"))
    if found is None or found.group(1) != expected:
        print(f"{place} names {found and found.group(1)}, but CMakeLists.txt {version}, so that this must be {expected}")
        failed = True
for place in DESCRIBED:
    if description not in " ".join((source / place).read_text(encoding="utf-8").split()):
        print(f"{place} does not say: {description}")
        failed = True
sys.exit(failed)
