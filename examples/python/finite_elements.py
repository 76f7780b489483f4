#!/usr/bin/env python3
"""Twists a cracked shaft, with scikit-fem on meshes that are refined where it matters: finite_elements.py [PICTURE.png]

The stress function u has -laplace(u) = 2 in the cross-section, and is 0 on the border and on both sides of a crack; the
integral of 2 u is the torsion constant. For a crack from the border to the centre, Timoshenko and Goodier's Theory of
Elasticity has 0.878 r^4.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
import skfem
from skfem.models.poisson import laplace, unit_load

import flaunay

Doubles = npt.NDArray[np.float64]

CORNERS = 180
ROUNDS = 5
KNOWN = 0.878


def cross_section(
    areas: Doubles, mesh: flaunay.ConstrainedTriangulation
) -> flaunay.ConstrainedTriangulation:
    """The disc with its crack as a segment. areas: how large triangles may be where those of another mesh are."""
    angles = np.linspace(0, 2 * np.pi, CORNERS, endpoint=False)
    points = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    border = [[k, (k + 1) % CORNERS] for k in range(CORNERS)]
    return flaunay.refine(
        np.concatenate([points, [[0, 0]]]),
        [*border, [0, CORNERS]],
        min_angle=30,
        areas_at=lambda places: areas[mesh.find_simplex(places)],
    )


def stress_function(mesh: flaunay.ConstrainedTriangulation) -> tuple[Doubles, float]:
    """Its values at the points, and the torsion constant."""
    arrays = (np.ascontiguousarray(rows.T) for rows in (mesh.points, mesh.triangles))
    basis = skfem.Basis(skfem.MeshTri(*arrays), skfem.ElementTriP1())
    stiffness, load = laplace.assemble(basis), 2 * unit_load.assemble(basis)
    u: Doubles = skfem.solve(*skfem.condense(stiffness, load, D=np.unique(mesh.constraint_edges)))
    return u, float(load @ u)


def gradients(mesh: flaunay.ConstrainedTriangulation, u: Doubles) -> Doubles:
    """Of u in each triangle."""
    corners = mesh.points[mesh.triangles]
    opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    normals = np.stack([-opposite[..., 1], opposite[..., 0]], axis=2)
    of_values = u[mesh.triangles][..., None] * normals
    return np.asarray(of_values.sum(axis=1) / (2 * mesh.areas[:, None]))


def errors(mesh: flaunay.ConstrainedTriangulation, u: Doubles) -> Doubles:
    """How far gradients are from their averages around points, in each triangle (Zienkiewicz and Zhu)."""
    of_triangles = gradients(mesh, u)
    around = mesh.triangles.ravel()
    weights = np.bincount(around, np.repeat(mesh.areas, 3), len(u))
    sums = [np.bincount(around, np.repeat(mesh.areas * g, 3), len(u)) for g in of_triangles.T]
    averages = np.stack(sums, axis=1) / weights[:, None]
    differences = averages[mesh.triangles] - of_triangles[:, None]
    return np.asarray(np.sqrt(mesh.areas * (differences**2).sum(axis=(1, 2))))


def main(path: str = "finite_elements.png") -> None:
    square = flaunay.triangulate([[-2, -2], [2, -2], [2, 2], [-2, 2]], segments=[])
    mesh = cross_section(np.array([0.1, 0.1]), square)
    u, constant = stress_function(mesh)
    for _ in range(ROUNDS):
        print(f"{len(mesh.triangles)} triangles, torsion constant {constant:.4f}")
        error = errors(mesh, u)
        is_bad = error > np.quantile(error, 0.95)
        mesh = cross_section(np.where(is_bad, mesh.areas / 4, 2 * mesh.areas), mesh)
        u, constant = stress_function(mesh)
    print(f"{len(mesh.triangles)} triangles, torsion constant {constant:.4f}, known: {KNOWN}")
    if abs(constant - KNOWN) > 0.005:
        sys.exit("the torsion constant is wrong")

    figure, (left, right) = plt.subplots(1, 2, figsize=(8, 4.4), layout="constrained")
    triangles = mesh.to_matplotlib()
    stress = np.hypot(*gradients(mesh, u).T)
    shades = left.tripcolor(triangles, stress, cmap="YlOrRd", vmin=0, vmax=2)
    left.set_title(f"cracked shaft, {len(mesh.triangles):,} triangles", fontsize=11)
    mesh.plot(left, color="#555", linewidth=0.25, constraint_color="black", constraint_linewidth=1)
    lines = right.tricontourf(triangles, u, levels=np.linspace(0, 0.3, 25), cmap="YlGnBu_r")
    right.tricontour(triangles, u, levels=24, colors="white", linewidths=0.4)
    for axes, colours, label, ticks in (
        (left, shades, "shear stress", [0, 1, 2]),
        (right, lines, "stress function", [0, 0.1, 0.2, 0.3]),
    ):
        axes.set(aspect="equal", xlim=(-1.03, 1.03), ylim=(-1.03, 1.03))
        axes.set_axis_off()
        bar = figure.colorbar(
            colours, ax=axes, location="bottom", shrink=0.7, aspect=40, ticks=ticks
        )
        bar.set_label(label)
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
