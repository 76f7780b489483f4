#!/usr/bin/env python3
"""Checks that every file that names flaunay's version names the one of CMakeLists.txt; others read it from there.

    versions.py SOURCE VERSION
"""

import pathlib
import re
import sys

source, version = pathlib.Path(sys.argv[1]), sys.argv[2]
# A text in which the version is the only group.
PLACES = {
    "packaging/conda/recipe.yaml": r'version: "([^"]*)"',
    "packaging/debian/changelog": r"flaunay \(([^)-]*)-\d+\)",
    "packaging/vcpkg/ports/flaunay/vcpkg.json": r'"version": "([^"]*)"',
}
failed = False
for place, pattern in PLACES.items():
    found = re.search(pattern, (source / place).read_text(encoding="utf-8"))
    if found is None or found.group(1) != version:
        print(f"{place} names {found and found.group(1)}, CMakeLists.txt {version}")
        failed = True
sys.exit(failed)
