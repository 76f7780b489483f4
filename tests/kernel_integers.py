#!/usr/bin/env python3
"""Checks that kernels write int64 and uint64 (kernels/arithmetic/language.h) in place of what has 32 bits in the C++ of
some platforms: long, and literals with L that fit 32 bits.

    tests/kernel_integers.py REPOSITORY
"""
import pathlib
import re
import sys

kernels = pathlib.Path(sys.argv[1]) / "kernels"
found = []
files = sorted([*kernels.rglob("*.cl"), *kernels.rglob("*.h")])
assert len(files) > 100, f"{len(files)} kernel files in {kernels}"
for path in files:
    for number, line in enumerate(path.read_text().splitlines(), 1):
        code = line.split("//")[0]
        words = re.findall(r"\bu?long\b", code) if not code.startswith("typedef") else []
        words += [text for text in re.findall(r"\b(?:0[xX][0-9a-fA-F]+|[0-9]+)[uU]?[lL]\b", code)
                  if int(text.rstrip("uUlL"), 0) < 2**32]
        found += [f"{path.relative_to(kernels)}:{number}: {word}" for word in words]
print("\n".join(found))
sys.exit(1 if found else 0)
