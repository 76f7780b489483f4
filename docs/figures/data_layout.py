#!/usr/bin/env python3
"""Draws docs/data-layout.svg from the arrays that are printed in docs/data-layout.md, which a test compares with what
the library returns.

    data_layout.py PAGE.md FILE.svg
"""

import math
import re
import sys

SCALE = 50
LEFT, BOTTOM = 34, 366  # where the plane's origin lies
WIDTH, HEIGHT = 760, 404
INSET = 0.17  # of halfedges, in units of the plane
TABLE_LEFT, TABLE_TOP, ROW = 478, 66, 26
COLUMNS = [("t", 0), ("triangles", 34), ("neighbors", 124), ("halfedges", 214)]
ORANGE, BLUE, GREY, INK = "#c2570c", "#1d5fb4", "#6b7280", "#1f2937"
TRIANGLE, CORNER = 1, 1  # whose neighbour is shown
HALFEDGE = 8  # whose twin is shown
DUPLICATE = 6


def read_arrays(page):
    """The first of each name; values without the gaps between groups."""
    with open(page, encoding="utf-8") as file:
        block = re.search(r"```text\n(.*?)```", file.read(), re.DOTALL).group(1)
    arrays = {}
    for line in block.splitlines():
        name, *values = line.split()
        arrays.setdefault(name, [float(v) if "." in v else int(v) for v in values])
    return arrays


class Drawing:
    def __init__(self):
        self.parts = []

    def add(self, text):
        self.parts.append(text)

    def text(self, x, y, text, size=13, fill=INK, anchor="middle", weight="normal", family="sans-serif"):
        self.add(
            f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{fill}" text-anchor="{anchor}" '
            f'font-weight="{weight}" font-family="{family}">{text}</text>'
        )

    def line(self, a, b, color, width, extra=""):
        self.add(
            f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" stroke="{color}" '
            f'stroke-width="{width}" {extra}/>'
        )

    def arrow(self, a, b, color, width, extra=""):
        """With a head of its own, which every viewer draws alike."""
        length = math.dist(a, b)
        dx, dy = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        size = 7
        neck = (b[0] - size * dx, b[1] - size * dy)
        self.line(a, neck, color, width, extra)
        sides = [(neck[0] + s * 0.45 * size * dy, neck[1] - s * 0.45 * size * dx) for s in (1, -1)]
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in [b, *sides])
        self.add(f'<polygon points="{points}" fill="{color}"/>')


def on_page(point):
    return LEFT + SCALE * point[0], BOTTOM - SCALE * point[1]


def inset_corners(corners, inset):
    """Where lines parallel to the sides, so far inside, meet."""
    moved = []
    for k in range(3):
        before, at, after = corners[k - 1], corners[k], corners[(k + 1) % 3]
        u = [(at[i] - before[i]) / math.dist(at, before) for i in (0, 1)]
        v = [(after[i] - at[i]) / math.dist(after, at) for i in (0, 1)]
        sine = u[0] * v[1] - u[1] * v[0]
        moved.append([at[i] + inset * (v[i] - u[i]) / sine for i in (0, 1)])
    return moved


def between(a, b, share):
    return [a[i] + share * (b[i] - a[i]) for i in (0, 1)]


def draw_plane(drawing, arrays):
    points = list(zip(arrays["points"][::2], arrays["points"][1::2]))
    triangles, neighbors, halfedges, hull = (
        arrays[name] for name in ("triangles", "neighbors", "halfedges", "hull")
    )
    rows = [[points[i] for i in triangles[3 * t : 3 * t + 3]] for t in range(len(triangles) // 3)]
    outline = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(on_page, (points[i] for i in hull)))
    for corners in rows:
        shape = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(on_page, corners))
        drawing.add(f'<polygon points="{shape}" fill="#f8fafc" stroke="#9ca3af" stroke-width="1"/>')
    drawing.add(f'<polygon points="{outline}" fill="none" stroke="{INK}" stroke-width="2.4"/>')

    twins = (HALFEDGE, halfedges[HALFEDGE])
    for t, corners in enumerate(rows):
        moved = inset_corners(corners, INSET)
        for k in range(3):
            h = 3 * t + k
            color = BLUE if h in twins else GREY
            a, b = moved[k], moved[(k + 1) % 3]
            begin, end = between(a, b, 0.06), between(a, b, 0.94)
            drawing.arrow(on_page(begin), on_page(end), color, 1.6 if h in twins else 1.1)
            length = math.dist(a, b)
            left = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length]
            x, y = on_page([between(a, b, 0.5)[i] + 0.19 * left[i] for i in (0, 1)])
            drawing.text(x, y + 4, h, 11, color, weight="bold" if h in twins else "normal")

    # From the corner to the triangle opposite to it.
    corner = rows[TRIANGLE][CORNER]
    other = rows[neighbors[3 * TRIANGLE + CORNER]]
    target = [sum(c[i] for c in other) / 3 for i in (0, 1)]
    target = between(corner, target, 0.92)
    drawing.arrow(
        on_page(between(corner, target, 0.1)), on_page(target), ORANGE, 1.6, 'stroke-dasharray="5 4"'
    )
    for t, corners in enumerate(rows):
        center = [sum(c[i] for c in corners) / 3 for i in (0, 1)]
        x, y = on_page(center)
        if t == neighbors[3 * TRIANGLE + CORNER]:
            y -= 8
        drawing.text(x, y + 6, t, 18, INK, weight="bold")

    for i, point in enumerate(points):
        if i == DUPLICATE:
            continue
        x, y = on_page(point)
        drawing.add(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="10" fill="{INK}" stroke="white" stroke-width="1.5"/>')
        drawing.text(x, y + 4.5, i, 13, "white", weight="bold")
    x, y = on_page(points[DUPLICATE])
    drawing.add(
        f'<circle cx="{x - 17:.1f}" cy="{y:.1f}" r="8" fill="white" stroke="{INK}" stroke-width="1.2" '
        'stroke-dasharray="2 2"/>'
    )
    drawing.text(x - 17, y + 4, DUPLICATE, 11)


def draw_arrays(drawing, arrays):
    mono = "monospace"
    names = ("triangles", "neighbors", "halfedges")
    orange = ("neighbors", 3 * TRIANGLE + CORNER)
    twins = {("halfedges", h) for h in (HALFEDGE, arrays["halfedges"][HALFEDGE])}
    for name, x in COLUMNS:
        drawing.text(TABLE_LEFT + x, TABLE_TOP - 28, name, 12.5, GREY, "start")
        if name != "t":
            for k in range(3):
                drawing.text(TABLE_LEFT + x + 16 + 24 * k, TABLE_TOP - 12, k, 10, GREY, "end")
    drawing.line((TABLE_LEFT - 2, TABLE_TOP - 6), (TABLE_LEFT + 276, TABLE_TOP - 6), "#d1d5db", 1)
    count = len(arrays["triangles"]) // 3
    for t in range(count):
        y = TABLE_TOP + ROW * t + 14
        drawing.text(TABLE_LEFT, y, t, 15, INK, "start", "bold")
        for name, x in COLUMNS[1:]:
            for k in range(3):
                place = (name, 3 * t + k)
                color = ORANGE if place == orange else BLUE if place in twins else INK
                weight = "normal" if color == INK else "bold"
                drawing.text(
                    TABLE_LEFT + x + 16 + 24 * k, y, arrays[name][3 * t + k], 14, color, "end", weight, mono
                )
    y = TABLE_TOP + ROW * count + 28
    for name in ("hull", "representatives"):
        drawing.text(TABLE_LEFT, y, name, 12.5, GREY, "start")
        for i, value in enumerate(arrays[name]):
            drawing.text(TABLE_LEFT + 112 + 24 * i, y, value, 14, INK, "start", "normal", mono)
        y += ROW
    y += 10
    h, twin = HALFEDGE, arrays["halfedges"][HALFEDGE]
    t = arrays["neighbors"][orange[1]]
    for color, text in (
        (ORANGE, f"opposite to corner {CORNER} of triangle {TRIANGLE}: triangle {t}"),
        (BLUE, f"halfedges {h} and {twin} are twins"),
        (INK, f"point {DUPLICATE} is a duplicate of point {arrays['representatives'][DUPLICATE]}"),
        (INK, "thick: the hull, with point 1 on its edge"),
    ):
        drawing.text(TABLE_LEFT, y, text, 12.5, color, "start")
        y += 21


def main():
    page, path = sys.argv[1:]
    arrays = read_arrays(page)
    drawing = Drawing()
    draw_plane(drawing, arrays)
    draw_arrays(drawing, arrays)
    with open(path, "w", encoding="utf-8") as file:
        file.write(
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
            f'viewBox="0 0 {WIDTH} {HEIGHT}">\n<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n'
        )
        file.write("\n".join(drawing.parts))
        file.write("\n</svg>\n")


if __name__ == "__main__":
    main()
