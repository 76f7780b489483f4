#!/usr/bin/env python3
"""Checks what a release needs besides its version: that all files name the address of the repository or none, that
scripts/address.py writes it where it belongs, that dates agree, and that licences of data are listed.

    release.py SOURCE
"""

import fnmatch
import importlib.util
import json
import pathlib
import re
import shutil
import sys
import tempfile

source = pathlib.Path(sys.argv[1])
specification = importlib.util.spec_from_file_location("address", source / "scripts/address.py")
address = importlib.util.module_from_spec(specification)
specification.loader.exec_module(address)


def read(path):
    return (source / path).read_text(encoding="utf-8")


def problems():
    named = address.named(source)
    if len(set(named.values())) != 1:
        yield f"these name the repository differently: {named}"

    # Written twice, only the second address is left, in files that still can be read.
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for path in address.PLACES:
            (copy / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source / path, copy / path)
        for wanted in "https://one.example/flaunay", "https://two.example/group/flaunay":
            address.write(copy, wanted)
            if set(address.named(copy).values()) != {wanted}:
                yield f"after {wanted} was written, files name {address.named(copy)}"
        for path in address.PLACES:
            text = (copy / path).read_text(encoding="utf-8")
            if "one.example" in text or text.count("two.example") != 1:
                yield f"{path} does not have the last address once"
            if path.endswith(".json"):
                json.loads(text)

    # The changelog has a day as soon as the version has been released, and then others have the same.
    day = re.search(r"^## \[[0-9.]+\] - (\d{4}-\d\d-\d\d)$", read("CHANGELOG.md"), re.MULTILINE)
    day = day and day.group(1)
    cited = re.search(r"^date-released: (.*)$", read("CITATION.cff"), re.MULTILINE)
    if day != (cited and cited.group(1)):
        yield f"CHANGELOG.md says {day}, CITATION.cff {cited and cited.group(1)}"
    if (day is None) != (" UNRELEASED; " in read("packaging/debian/changelog").splitlines()[0]):
        yield f"CHANGELOG.md says {day}, packaging/debian/changelog {read('packaging/debian/changelog').splitlines()[0]}"

    # Of the data of tests, what others made.
    listed = re.findall(r"^Files: (.*(?:\n [^\n]*)*)", read("packaging/debian/copyright"), re.MULTILINE)
    patterns = [pattern for files in listed for pattern in files.split() if pattern != "*"]
    for pattern in patterns:
        if not any(source.glob(pattern)):
            yield f"packaging/debian/copyright lists {pattern}, of which there is none"
    described = ""
    for row in re.findall(r"^\| (`.*?) \|.*\| (.*?) \|$", read("tests/data/README.md"), re.MULTILINE):
        described += row[0]
        ours = re.match("made for|its formula", row[1])
        for name in re.findall(r"`([\w.]+)`", row[0]):
            path = f"tests/data/{name.replace('1..4', '1')}"
            if not (source / path).is_file():
                yield f"tests/data/README.md describes {path}, which there is not"
            if not ours and not any(fnmatch.fnmatch(path, pattern) for pattern in patterns):
                yield f"packaging/debian/copyright does not list {path}"
    for file in sorted((source / "tests/data").iterdir()):
        name = re.sub(r"^robustness\d", "robustness1..4", file.name)
        if f"`{name}`" not in described and file.suffix not in (".md", ".txt"):
            yield f"tests/data/README.md does not describe {file.name}"


found = list(problems())
print("\n".join(found), end="\n" if found else "")
sys.exit(bool(found))
