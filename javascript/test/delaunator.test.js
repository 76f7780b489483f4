// The tests of delaunator 5.1.0 (ISC licence, Copyright (c) 2026, Mapbox), with the coordinates of its fixtures in
// tests/data. Where it allows two answers, either one is right.
import assert from 'node:assert/strict';
import test from 'node:test';

import Delaunator, {FlaunayError} from 'flaunay';

import {pairs, readPoints} from './points.js';

const points = pairs(readPoints('ukraine.xy'));

test('triangulates plain array', () => {
  const d = new Delaunator([].concat(...points));
  assert.deepEqual(d.triangles, Delaunator.from(points).triangles);
});

test('triangulates typed array', () => {
  for (const type of [Float64Array, Float32Array, Int32Array]) {
    const d = new Delaunator(type.from([].concat(...points)));
    assert.deepEqual(d.triangles, Delaunator.from(points).triangles);
    assert.equal(d.coords.constructor, type);
  }
});

test('constructor errors on invalid array', () => {
  assert.throws(() => new Delaunator({length: -1}), /Invalid typed array length/);
  assert.throws(() => new Delaunator(points), /Expected coords to contain numbers/);
});

test('produces correct triangulation', () => {
  validate(points);
});

test('produces correct triangulation after modifying coords in place', () => {
  const d = Delaunator.from(points);
  validate(points, d);
  assert.equal(d.trianglesLen, 5133);

  const p = [80, 220];
  d.coords[0] = p[0];
  d.coords[1] = p[1];
  d.update();
  validate([p].concat(points.slice(1)), d);
  assert.equal(d.trianglesLen, 5139);
});

test('issue #11', () => {
  validate([[516, 661], [369, 793], [426, 539], [273, 525], [204, 694], [747, 750], [454, 390]]);
});

test('issue #24', () => {
  validate([[382, 302], [382, 328], [382, 205], [623, 175], [382, 188], [382, 284], [623, 87], [623, 341], [141, 227]]);
});

for (const name of ['issue13', 'issue43', 'issue44', 'robustness1', 'robustness2', 'robustness3', 'robustness4']) {
  test(name, () => {
    const fixture = pairs(readPoints(`${name}.xy`));
    validate(fixture);
    validate(fixture.slice(0, 100));
    if (name !== 'robustness1') return;
    for (const scale of [1e-9, 1e-2, 1e2, 1e9]) validate(fixture.map(([x, y]) => [x * scale, y * scale]));
  });
}

test('returns empty triangulation for small number of points', () => {
  const hulls = [[], [0], [1, 0]];
  for (const [n, hull] of hulls.entries()) {
    const d = Delaunator.from(points.slice(0, n));
    assert.deepEqual([...d.triangles, ...d.halfedges], []);
    assert.deepEqual([...d.hull], hull);
  }
});

test('returns empty triangulation for all-collinear input', () => {
  const d = Delaunator.from([[0, 0], [1, 0], [3, 0], [2, 0]]);
  assert.deepEqual([...d.triangles], []);
  assert.deepEqual([...d.hull], [0, 1, 3, 2]);
});

test('supports custom point format', () => {
  const d = Delaunator.from([{x: 5, y: 5}, {x: 7, y: 5}, {x: 7, y: 6}], (p) => p.x, (p) => p.y);
  assert.deepEqual([...d.triangles], [0, 2, 1]);
});

test('skips duplicates, and refuses what is no place', () => {
  const d = new Delaunator([0, 0, 1, 0, 0, 1, 0, 0]);
  assert.deepEqual([...d.triangles], [0, 2, 1]);
  assert.throws(() => new Delaunator([0, 0, 1, NaN]), (error) => {
    assert.ok(error instanceof FlaunayError);
    assert.equal(error.kind, 'input');
    assert.match(error.message, /point 1 .*not finite/);
    return true;
  });
});

// Rounding as delaunator's test has it.
function orient([px, py], [rx, ry], [qx, qy]) {
  const l = (ry - py) * (qx - px);
  const r = (rx - px) * (qy - py);
  return Math.abs(l - r) >= 3.3306690738754716e-16 * Math.abs(l + r) ? l - r : 0;
}

function convex(r, q, p) {
  return (orient(p, r, q) || orient(r, q, p) || orient(q, p, r)) >= 0;
}

function validate(places, d = Delaunator.from(places)) {
  for (const [i, twin] of d.halfedges.entries()) {
    assert.ok(twin === -1 || d.halfedges[twin] === i, 'valid halfedge connection');
    // Twins join the same two points.
    if (twin !== -1) assert.equal(d.triangles[i], d.triangles[twin % 3 === 2 ? twin - 2 : twin + 1]);
  }

  const {hull} = d;
  const hullAreas = [];
  for (let i = 0, j = hull.length - 1; i < hull.length; j = i++) {
    const [x0, y0] = places[hull[j]];
    const [x, y] = places[hull[i]];
    hullAreas.push((x - x0) * (y + y0));
    assert.ok(convex(places[hull[j]], places[hull[(j + 1) % hull.length]], places[hull[(j + 3) % hull.length]]),
      `hull should be convex at ${j}`);
  }
  const triangleAreas = [];
  for (let i = 0; i < d.triangles.length; i += 3) {
    const [[ax, ay], [bx, by], [cx, cy]] = [0, 1, 2].map((k) => places[d.triangles[i + k]]);
    triangleAreas.push(Math.abs((by - ay) * (cx - bx) - (bx - ax) * (cy - by)));
  }
  const hullArea = sum(hullAreas);
  const error = Math.abs((hullArea - sum(triangleAreas)) / hullArea);
  assert.ok(error <= 2 ** -51, `triangulation should be valid; ${error} error`);
}

// Kahan and Babuska summation, Neumaier variant.
function sum(x) {
  let total = x[0];
  let err = 0;
  for (let i = 1; i < x.length; i++) {
    const next = total + x[i];
    err += Math.abs(total) >= Math.abs(x[i]) ? total - next + x[i] : x[i] - next + total;
    total = next;
  }
  return total + err;
}
