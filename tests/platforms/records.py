#!/usr/bin/env python3
"""Checks that scripts/platform-test.sh found the same bytes on each platform that docs/platforms.md says it tests.

A record is of its commit, on which the script compares with this machine. Those of as many results agree.

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
for part in "of_the_library", "of_the_command":
    counts = {record["results_" + part] for record in records.values()}
    if len({(record["results_" + part], record["sha256_" + part]) for record in records.values()}) != len(counts):
        print(part, {platform: (record["sha256_" + part], record["commit"]) for platform, record in records.items()})
        failed = True
    if not all(f"{count:,}" in page for count in counts):
        print(f"docs/platforms.md does not say {sorted(counts)}, how many results {part} were compared")
        failed = True
sys.exit(failed)
