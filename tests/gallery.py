#!/usr/bin/env python3
"""Runs each program in a folder, which must write a picture that is not blank: gallery.py PROGRAMS PICTURES

Each is called in the folder PICTURES without an argument, and writes a picture of its own name there.
"""

import pathlib
import sys
import time

import matplotlib.image
import numpy as np
from programs import run

# Text on an empty page has less than this part of pixels of other colours, and a single-coloured map fewer colours.
DRAWN = 0.02
COLOURS = 4


def problem(picture):
    """What is wrong with a picture, or None."""
    if not picture.exists():
        return "has made no picture"
    pixels = np.round(matplotlib.image.imread(picture)[..., :3] * 255).astype(np.int64)
    colours, counts = np.unique(pixels @ [1 << 16, 1 << 8, 1], return_counts=True)
    drawn = 1 - counts.max() / counts.sum()
    if drawn < DRAWN or len(colours) < COLOURS:
        return f"has made a blank picture: {drawn:.1%} drawn, {len(colours)} colours"
    return None


def main(programs, pictures):
    pictures.mkdir(parents=True, exist_ok=True)
    failed = False
    paths = sorted(programs.glob("*.py"))
    for program in paths:
        picture = pictures / f"{program.stem}.png"
        picture.unlink(missing_ok=True)
        started = time.monotonic()
        status = run(program.resolve(), folder=pictures)
        wrong = f"ended with {status}" if status else problem(picture)
        print(f"{program.name}: {wrong or 'ok'}, {time.monotonic() - started:.1f} s", flush=True)
        failed = failed or wrong is not None
    if failed or not paths:
        sys.exit(f"gallery.py: failures in {programs}" if paths else f"gallery.py: no programs in {programs}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
