#!/usr/bin/env python3
"""Checks that no file includes a header of a layer above its own, and no mode that of another one.

    layers.py SOURCE
"""

import pathlib
import re
import sys

# From the lowest layer to the highest, above the kernels. Rooms of one layer may include each other.
LAYERS = (
    ("host",),
    ("statistics", "geometry", "mesh", "points", "tuning", "files"),
    ("blocks",),
    ("call",),
    ("space", "constrained", "updates", "derived", "large", "modes", "prove"),
    ("c",),
    ("app",),
)
LAYER = {room: layer for layer, rooms in enumerate(LAYERS) for room in rooms}
INCLUDE = re.compile(r'^#include "([\w/]+\.hpp)"', re.MULTILINE)


def faults(source):
    for folder in source / "host", source / "src":
        for path in sorted(folder.rglob("*.[ch]pp")):
            room = path.relative_to(source).parts[0 if folder.name == "host" else 1]
            if room == "include":
                continue
            mode = path.relative_to(folder).parent.parts
            for included in INCLUDE.findall(path.read_text(encoding="utf-8")):
                of = included.split("/")
                if LAYER.get(of[0], 0) > LAYER[room]:
                    yield f"{path.relative_to(source)} includes {included}: {of[0]} is above {room}"
                if of[0] == "modes" == room and len(mode) >= 2 and len(of) >= 3 and mode[1] != of[1]:
                    yield f"{path.relative_to(source)} includes {included}: modes do not know each other"


if __name__ == "__main__":
    found = list(faults(pathlib.Path(sys.argv[1])))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(bool(found))
