#!/usr/bin/env python3
"""Makes the pictures of the gallery in docs/python.md small enough to be kept: gallery.py PICTURES

The folder PICTURES is one that tests/gallery.py has filled. Writes palette images beside this program.
"""

import io
import pathlib
import sys

from PIL import Image

WIDTH = 640
BYTES = 150_000
COLOURS = (256, 128, 64, 32, 16)


def palette_image(picture):
    """The file's bytes with as many colours as fit."""
    for colours in COLOURS:
        buffer = io.BytesIO()
        # Colours of few pixels, as in the scale of a map, are kept as those of many.
        small = picture.quantize(colours, Image.Quantize.MAXCOVERAGE, kmeans=2, dither=Image.Dither.NONE)
        small.save(buffer, "png", optimize=True)
        if buffer.tell() <= BYTES:
            break
    return buffer.getvalue()


def main(pictures):
    for path in sorted(pictures.glob("*.png")):
        picture = Image.open(path).convert("RGB")
        if picture.width > WIDTH:
            height = round(picture.height * WIDTH / picture.width)
            picture = picture.resize((WIDTH, height), Image.LANCZOS)
        small = pathlib.Path(__file__).parent / f"gallery-{path.name.replace('_', '-')}"
        small.write_bytes(palette_image(picture))
        print(f"{small.name}: {small.stat().st_size // 1000} kB")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
