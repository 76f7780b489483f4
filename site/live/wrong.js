// The edges of a triangulation that are wrong, by robust-predicates, which shares no code with flaunay.
import {incircle} from '../vendor/robust-predicates/incircle.js';
import {orient2d} from '../vendor/robust-predicates/orient2d.js';

/** Ends of the edges with the vertex beyond them inside the circle of a triangle beside them, or with a flat triangle. */
export function wrongEdges(coords, {triangles, neighbors}, isConstraint = () => false) {
  const wrong = [];
  const x = (i) => coords[2 * i], y = (i) => coords[2 * i + 1];
  for (let t = 0; 3 * t < triangles.length; t++) {
    if (triangles[3 * t] < 0) continue;
    for (let k = 0; k < 3; k++) {
      const other = neighbors[3 * t + k];
      if (other < t) continue;
      const a = triangles[3 * t + ((k + 1) % 3)], b = triangles[3 * t + ((k + 2) % 3)], c = triangles[3 * t + k];
      if (isConstraint(a, b)) continue;
      const back = [0, 1, 2].find((j) => neighbors[3 * other + j] === t);
      const d = triangles[3 * other + back];
      // The sign of incircle is the same from both sides. The triangles turn in different directions where they overlap.
      const inside = SIGN * Math.sign(incircle(x(a), y(a), x(b), y(b), x(c), y(c), x(d), y(d)));
      const turn = orient2d(x(a), y(a), x(b), y(b), x(c), y(c)), turnBeyond = orient2d(x(b), y(b), x(a), y(a), x(d), y(d));
      if (turn === 0 || turnBeyond === 0 || turn * inside > 0 || turnBeyond * inside > 0) wrong.push(a, b);
    }
  }
  return Int32Array.from(wrong);
}

// The sign of incircle for a point inside of a triangle that orient2d finds positive.
const SIGN = Math.sign(incircle(0, 0, 1, 0, 0, 1, 0.3, 0.3) * orient2d(0, 0, 1, 0, 0, 1));

/** Delaunator's result with the neighbour opposite to each corner, as flaunay's rows have them. */
export function meshOf({triangles, halfedges}) {
  const neighbors = new Int32Array(halfedges.length);
  halfedges.forEach((twin, e) => {
    neighbors[e - (e % 3) + ((e + 2) % 3)] = twin < 0 ? -1 : Math.floor(twin / 3);
  });
  return {triangles, neighbors};
}
