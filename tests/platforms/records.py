#!/usr/bin/env python3
"""Checks that scripts/platform-test.sh found the same bytes on each platform that docs/platforms.md says it tests.

    tests/platforms/records.py REPOSITORY
"""
import json
import pathlib
import re
import sys

repository = pathlib.Path(sys.argv[1])
records = json.loads((repository / "bench/results/platforms.json").read_text())
page = (repository / "docs/platforms.md").read_text()
rows = re.findall(r"`cmake --preset (\w+)`[^|]*\|([^|]*)\|", page)
platforms = {name for name, tested in rows if "not yet" not in tested} - {"release"}
failed = False
if platforms != records.keys():
    print(f"docs/platforms.md has {sorted(platforms)}, the records have {sorted(records)}")
    failed = True
for hashed in "sha256_of_the_library", "sha256_of_the_command":
    if len({record[hashed] for record in records.values()}) != 1:
        print(hashed, {platform: (record[hashed], record["commit"]) for platform, record in records.items()})
        failed = True
sys.exit(failed)
