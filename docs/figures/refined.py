#!/usr/bin/env python3
"""Draws the pictures of docs/refinement-gallery.md: refined.py FLAUNAY FOLDER

Refines drawings of tests/data with the command FLAUNAY, and writes a picture of each to FOLDER, with the triangles
coloured by their smallest angles.
"""

import math
import pathlib
import subprocess
import sys
import tempfile

DATA = pathlib.Path(__file__).resolve().parents[2] / "tests" / "data"
NAMES = ("key", "lake", "airfoil", "crack", "glyph")
ANGLES = (0, 20, 30, 33)

WIDTH, HEIGHT, MARGIN, CAPTION, LEGEND = 420, 400, 16, 26, 40
UNITS = 10  # of a pixel: paths have whole numbers
STEP = 3  # degrees of a colour
# The smallest angle from 0 to 60 degrees: from coral over sand to blue.
RAMP = (0xE3938A, 0xF6C89C, 0xF7ECC2, 0xCBE2C9, 0x93C4CB, 0x6F9FC4)
BACKGROUND, EDGES, SEGMENTS, TEXT = "#fdfcf9", "#6d8299", "#24405f", "#4a5d73"


def colour(angle):
    at = min(angle / 60, 1) * (len(RAMP) - 1)
    low = min(int(at), len(RAMP) - 2)
    parts = []
    for shift in (16, 8, 0):
        first, second = RAMP[low] >> shift & 255, RAMP[low + 1] >> shift & 255
        parts.append(f"{round(first + (at - low) * (second - first)):02x}")
    return "#" + "".join(parts)


def refined(command, name, angle, folder):
    """Points, and sorted by places triangles and the edges of segments."""
    output = folder / "mesh.obj"
    options = ["--min-angle", str(angle)] if angle else []
    drawing = DATA / f"{name}.poly"
    subprocess.run(
        [command, "triangulate", drawing, "--outside", "holes", *options, "--quiet", "-o", output], check=True
    )
    rows = {"v": [], "f": [], "l": [], "#": []}
    for line in output.read_text().splitlines():
        kind, *numbers = line.split()
        rows[kind].append(numbers)
    points = [(float(x), float(y)) for x, y, _ in rows["v"]]
    triangles, segments = (
        sorted(rotated([points[int(number) - 1] for number in row]) for row in rows[kind]) for kind in "fl"
    )
    return points, triangles, segments


def rotated(corners):
    """The same corners, from the first by x and y on."""
    first = corners.index(min(corners))
    return corners[first:] + corners[:first]


def smallest_angle(corners):
    """In degrees. What is added keeps right angles and others on their side of a colour's bound."""
    angles = []
    for k in range(3):
        (ax, ay), (bx, by), (cx, cy) = corners[k], corners[k - 1], corners[k - 2]
        ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
        angles.append(math.degrees(math.atan2(abs(ux * vy - uy * vx), ux * vx + uy * vy)))
    return min(angles) + 1e-9


class View:
    """Where the points of a drawing are in a picture."""

    def __init__(self, points):
        xs, ys = zip(*points)
        self.left, self.top = min(xs), max(ys)
        self.scale = min(WIDTH / (max(xs) - self.left), HEIGHT / (self.top - min(ys)))
        self.height = math.ceil(self.scale * (self.top - min(ys)))

    def path(self, lines, ending=""):
        """Lines of points, each relative to the one before."""
        text, pen = "", (0, 0)
        for line in lines:
            letter = "m"
            for x, y in line:
                place = round((x - self.left) * self.scale * UNITS), round((self.top - y) * self.scale * UNITS)
                step = f"{place[0] - pen[0]} {place[1] - pen[1]}"
                text += letter + (step if letter or step[0] == "-" else " " + step)
                if letter:
                    start = place
                letter, pen = "", place
            text += ending
            pen = start if ending else pen
        return text


def panel(view, mesh, angle):
    """The elements of one mesh, and its caption."""
    points, triangles, segments = mesh
    shades = {}
    worst = 60.0
    for triangle in triangles:
        smallest = smallest_angle(triangle)
        worst = min(worst, smallest)
        shades.setdefault(int(smallest // STEP), []).append(triangle)
    yield f'<g transform="scale({1 / UNITS:g})" stroke="{EDGES}" stroke-width="{0.5 * UNITS:g}">'
    for shade, members in sorted(shades.items()):
        yield f'<path fill="{colour((shade + 0.5) * STEP)}" d="{view.path(members, "z")}"/>'
    yield f'<path fill="none" stroke="{SEGMENTS}" stroke-width="{1.3 * UNITS:g}" d="{view.path(segments)}"/>'
    yield "</g>"
    asked = f"at least {angle}°" if angle else "no bound"
    counts = f"{len(points):,} points, {len(triangles):,} triangles, smallest angle {worst:.1f}°"
    yield f'<text y="{view.height + 18}"><tspan font-weight="bold">{asked}</tspan>: {counts}</text>'


def legend(y):
    """The colours from 0 to 60 degrees, and which angles they are."""
    cell, x = 12, MARGIN
    for shade in range(60 // STEP):
        yield f'<rect x="{x + cell * shade}" y="{y}" width="{cell}" height="8" fill="{colour((shade + 0.5) * STEP)}"/>'
    for angle in (0, 20, 30, 60):
        yield f'<text x="{x + cell * angle / STEP:g}" y="{y + 22}" text-anchor="middle">{angle}°</text>'
    yield f'<text x="{x + cell * 60 / STEP + 16:g}" y="{y + 8}">smallest angle of a triangle</text>'


def draw(command, name, folder):
    meshes = [refined(command, name, angle, folder) for angle in ANGLES]
    view = View(meshes[0][0])
    columns = 2
    width = columns * (WIDTH + MARGIN) + MARGIN
    row = view.height + CAPTION + MARGIN
    height = row * len(meshes) // columns + MARGIN + LEGEND
    yield f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">'
    yield f"<title>{name}.poly, refined to smallest angles of {', '.join(map(str, ANGLES))} degrees</title>"
    yield f'<rect width="100%" height="100%" rx="6" fill="{BACKGROUND}"/>'
    yield f'<g font-family="sans-serif" font-size="12" fill="{TEXT}" stroke-linejoin="round" stroke-linecap="round">'
    for place, (angle, mesh) in enumerate(zip(ANGLES, meshes)):
        x, y = MARGIN + place % columns * (WIDTH + MARGIN), MARGIN + place // columns * row
        yield f'<g transform="translate({x} {y})">'
        yield from panel(view, mesh, angle)
        yield "</g>"
    yield from legend(height - LEGEND + 4)
    yield "</g>\n</svg>"


def main(command, folder):
    with tempfile.TemporaryDirectory() as meshes:
        for name in NAMES:
            picture = "\n".join(draw(command, name, pathlib.Path(meshes))) + "\n"
            (folder / f"refined-{name}.svg").write_text(picture, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], pathlib.Path(sys.argv[2]))
