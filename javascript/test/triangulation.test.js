import assert from 'node:assert/strict';
import test from 'node:test';
import {setImmediate} from 'node:timers/promises';
import {setFlagsFromString} from 'node:v8';
import {runInNewContext} from 'node:vm';

import Delaunator, {
  ConstrainedTriangulation, DynamicTriangulation, FlaunayError, Triangulation, version, wrongEdges,
} from 'flaunay';

import {pairs, random, readPoints, uniform} from './points.js';

const SQUARE = [0, 0, 4, 0, 4, 4, 0, 4, 2, 2];

function fails(work, kind, message) {
  assert.throws(work, (error) => {
    assert.ok(error instanceof FlaunayError, `${error.stack}`);
    assert.equal(error.kind, kind);
    assert.match(error.message, message);
    return true;
  });
}

// The triangles of a mesh as a set of texts, whatever their rows and first corners.
function setOf(triangles) {
  const found = [];
  for (let i = 0; i < triangles.length; i += 3) {
    const corners = [...triangles.slice(i, i + 3)];
    if (corners[0] < 0) continue;
    const k = corners.indexOf(Math.min(...corners));
    found.push([corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]].join());
  }
  return found.sort();
}

function area(vertices) {
  let twice = 0;
  for (let i = 0, j = vertices.length - 2; i < vertices.length; j = i, i += 2) {
    twice += vertices[j] * vertices[i + 1] - vertices[i] * vertices[j + 1];
  }
  return twice / 2;
}

test('arrays of a triangulation', () => {
  const mesh = new Triangulation([...SQUARE, 4, 4], {areas: true});
  assert.equal(mesh.pointCount, 6);
  assert.deepEqual(setOf(mesh.triangles), ['0,1,4', '0,4,3', '1,2,4', '2,3,4']);
  assert.deepEqual([...mesh.hull], [0, 1, 2, 3]);
  assert.deepEqual([...mesh.representatives], [0, 1, 2, 3, 4, 2]);
  assert.deepEqual([...mesh.areas], [4, 4, 4, 4]);
  for (const [i, twin] of mesh.halfedges.entries()) {
    assert.equal(mesh.neighbors[3 * Math.floor(i / 3) + (i + 2) % 3], twin === -1 ? -1 : Math.floor(twin / 3));
  }
  assert.deepEqual([...mesh.coords], [...SQUARE, 4, 4]);
  assert.match(version(), /^\d+\.\d+\.\d+$/);
  assert.equal(new Triangulation(SQUARE, {halfedges: false}).halfedges.length, 0);
});

test('the drop-in has the same triangles, turned', () => {
  const coords = uniform(5000);
  const drop = new Delaunator(coords), mesh = new Triangulation(coords);
  assert.equal(drop.triangles.length, mesh.triangles.length);
  for (let i = 0; i < mesh.triangles.length; i += 3) {
    const [a, b, c] = mesh.triangles.subarray(i, i + 3);
    assert.deepEqual([...drop.triangles.subarray(i, i + 3)], [a, c, b]);
  }
  assert.deepEqual([...drop.hull], [mesh.hull[0], ...[...mesh.hull.subarray(1)].reverse()]);
});

test('views see memory that has grown, and copies stay', () => {
  const mesh = new Triangulation(SQUARE);
  const view = mesh.triangles, copy = view.slice();
  for (let n = 100_000; view.length > 0; n *= 2) new Delaunator(uniform(n));
  assert.equal(view.length, 0);
  assert.deepEqual(mesh.triangles, copy);
});

test('free', () => {
  const mesh = new Triangulation(SQUARE);
  mesh.nearest(1, 1);
  mesh.free();
  mesh.free();
  fails(() => mesh.triangles, 'usage', /freed/);
  fails(() => mesh.locate(1, 1), 'usage', /freed/);
});

test('memory is used again', () => {
  const used = () => new Triangulation(SQUARE).triangles.buffer.byteLength;
  const coords = uniform(20_000);
  const work = () => {
    const mesh = new Triangulation(coords);
    const results = [mesh, mesh.voronoi(), mesh.clippedVoronoi([0, 0, 1, 1])];
    mesh.locate(coords);
    for (const result of results.reverse()) result.free();
    new Delaunator(coords);
    const moving = new DynamicTriangulation(coords);
    moving.rows();
    moving.free();
    fails(() => new Triangulation([0, 0, 1, Infinity]), 'input', /not finite/);
  };
  work();
  work();
  const before = used();
  for (let i = 0; i < 30; i++) work();
  assert.equal(used(), before);
});

test('what is not freed is collected, but not while a view is there', async () => {
  setFlagsFromString('--expose-gc');
  const collect = runInNewContext('gc');
  const coords = uniform(5000);
  // Memory that grows takes views away. It has room for some of the triangulations below, and not for all.
  new Triangulation(uniform(300_000)).free();
  const {triangles} = new Triangulation(coords), copy = triangles.slice();
  const cell = new Triangulation(coords).clippedVoronoi([0, 0, 1, 1]).cell(7), copied = cell.slice();
  const bytes = triangles.buffer.byteLength;
  for (let i = 0; i < 100; i++) {
    for (let k = 0; k < 5; k++) new Triangulation(coords).nearest(0, 0);
    collect();
    await setImmediate();
  }
  assert.equal(triangles.buffer.byteLength, bytes);
  assert.deepEqual(triangles, copy);
  assert.deepEqual(cell, copied);
});

test('many sets in one call', () => {
  const sets = Array.from({length: 50}, (_, s) => uniform(s, s + 1));
  const all = Triangulation.batch(sets);
  let points = 0;
  for (const [s, coords] of sets.entries()) {
    const one = new Triangulation(coords);
    const moved = one.triangles.map((i) => i + points);
    assert.deepEqual(all.triangles.subarray(3 * all.triangleOffsets[s], 3 * all.triangleOffsets[s + 1]), moved);
    assert.deepEqual(all.hull.subarray(all.hullOffsets[s], all.hullOffsets[s + 1]), one.hull.map((i) => i + points));
    points += s;
  }
  const offsets = sets.map((_, s) => s);
  offsets.push(sets.length);
  const nearest = all.nearest(sets.flatMap(() => [0.5, 0.5]), {offsets});
  assert.equal(nearest[0], -1);
  assert.equal(nearest[1], 0);
  fails(() => new Triangulation(SQUARE, {offsets: [0, 3]}), 'usage', /offsets/);
});

test('Voronoi diagram', () => {
  const {circumcentres, offsets, cells, unbounded} = new Triangulation(SQUARE).voronoi();
  assert.deepEqual([...unbounded], [1, 1, 1, 1, 0]);
  const corners = [...cells.subarray(offsets[4], offsets[5])].map((t) => [circumcentres[2 * t], circumcentres[2 * t + 1]]);
  assert.equal(area(corners.flat()), 8);
});

test('clipped Voronoi cells', () => {
  const mesh = new Triangulation(uniform(1000));
  const cells = mesh.clippedVoronoi([0, 0, 1, 1]);
  assert.ok(Math.abs(cells.areas.reduce((a, b) => a + b) - 1) < 1e-12);
  for (const i of [0, 500, 999]) assert.ok(Math.abs(area(cells.cell(i)) - cells.areas[i]) < 1e-15);
  assert.equal(cells.centroids.length, 2000);
  const triangle = mesh.clippedVoronoi([0, 0, 1, 0, 0, 1]);
  assert.ok(Math.abs(triangle.areas.reduce((a, b) => a + b) - 0.5) < 1e-12);
  fails(() => mesh.clippedVoronoi([0, 0, 0, 1, 1, 0]), 'input', /corner/);
});

test('queries', () => {
  const coords = uniform(2000), queries = uniform(500, 2);
  const mesh = new Triangulation(coords);
  const triangles = mesh.locate(queries), nearest = mesh.nearest(queries);
  for (const [q, [x, y]] of pairs(queries).entries()) {
    let best = Infinity;
    for (const [px, py] of pairs(coords)) best = Math.min(best, (px - x) ** 2 + (py - y) ** 2);
    const [px, py] = coords.subarray(2 * nearest[q]);
    assert.equal((px - x) ** 2 + (py - y) ** 2, best);
    assert.equal(mesh.nearest(x, y), nearest[q]);
    assert.equal(mesh.locate(x, y), triangles[q]);
  }
  assert.equal(mesh.locate(2, 2), -1);
  fails(() => mesh.locate([NaN, 0]), 'input', /not finite/);
});

test('interpolation', () => {
  const coords = uniform(300);
  const mesh = new Triangulation(coords);
  const values = pairs(coords).flatMap(([x, y]) => [2 * x - y, x + 3 * y]);
  const queries = [0.5, 0.5, 0.4, 0.6];
  for (const method of ['linear', 'clough-tocher', 'sibson', 'laplace']) {
    const [a, b, c, d] = mesh.interpolate(values, queries, {method, columns: 2});
    for (const [found, expected] of [[a, 0.5], [b, 2], [c, 0.2], [d, 2.2]]) {
      assert.ok(Math.abs(found - expected) < 1e-6, `${method}: ${found} is not ${expected}`);
    }
  }
  const first = values.filter((_, i) => i % 2 === 0);
  assert.equal(mesh.interpolate(first, queries, {method: 'nearest'})[0], first[mesh.nearest(0.5, 0.5)]);
  assert.ok(Number.isNaN(mesh.interpolate(first, [9, 9])[0]));
  assert.equal(mesh.interpolate(first, [9, 9], {fill: 7})[0], 7);
  fails(() => mesh.interpolate(first, queries, {method: 'cubic'}), 'usage', /method/);
  fails(() => mesh.interpolate([1], queries), 'usage', /1 values/);
});

test('segments', () => {
  const mesh = new ConstrainedTriangulation([0, 0, 4, -1, 8, 0, 4, 1], {segments: [0, 2]});
  assert.deepEqual(setOf(mesh.triangles), ['0,1,2', '0,2,3']);
  assert.deepEqual([...mesh.constraintEdges], [0, 2]);
  assert.deepEqual([...mesh.edgeSegments], [0]);
  assert.equal(mesh.constrained.reduce((a, b) => a + b), 2);
  const crossing = {segments: [0, 2, 1, 3]};
  fails(() => new ConstrainedTriangulation(SQUARE.slice(0, 8), crossing), 'input', /cross/);
  const split = new ConstrainedTriangulation(SQUARE.slice(0, 8), {...crossing, crossings: 'split', labels: true});
  assert.deepEqual([...split.addedPoints], [2, 2]);
  assert.deepEqual([...split.addedOffsets], [0, 1]);
  assert.deepEqual([...split.pieceOffsets], [0, 2, 4]);
  assert.deepEqual([...split.pieceEdges], [0, 1, 3, 4, 1, 2, 2, 3]);
  assert.equal(split.pointCount, 5);
  assert.equal(split.regions.length, 4);
  assert.equal(split.depths.length, 4);
  fails(() => new ConstrainedTriangulation(SQUARE, {segments: [0, 9]}), 'usage', /9/);
  fails(() => new ConstrainedTriangulation(SQUARE, {...crossing, crossings: 'maybe'}), 'usage', /maybe/);
});

test('polygons', () => {
  const ring = (low, high) => [[low, low], [high, low], [high, high], [low, high], [low, low]];
  const one = ConstrainedTriangulation.polygons([[ring(0, 10), ring(4, 6)]], {areas: true});
  assert.equal(one.areas.reduce((a, b) => a + b), 96);
  const two = ConstrainedTriangulation.polygons([[ring(0, 10), ring(4, 6)], [ring(4, 6)]], {areas: true, map: true});
  const areas = [0, 0];
  for (const [t, polygon] of two.polygons.entries()) areas[polygon] += two.areas[t];
  assert.deepEqual(areas, [96, 4]);
  assert.equal(ConstrainedTriangulation.polygons([]).triangles.length, 0);
});

test('insert, move and remove', () => {
  const next = random(3);
  const coords = uniform(500);
  const moving = new DynamicTriangulation(coords);
  assert.equal(moving.insert([0.5, 0.5, 2, 2]), 500);
  moving.remove([7, 8]);
  for (let i = 0; i < 20; i++) {
    const point = [9, 100, 500][i % 3];
    moving.move([point], [next(), next()]);
    assert.deepEqual([...moving.changes.representatives], [point]);
    assert.equal(moving.changes.madeCorners.length, 3 * moving.changes.made.length);
  }
  moving.move([10, 11], [0.1, 0.1, 0.9, 0.9]);
  assert.ok(moving.has(501) && !moving.has(7) && !moving.has(502));
  assert.equal(moving.pointCount, 500);
  assert.equal(moving.numbers, 502);
  const places = moving.coordinates();
  assert.ok(Number.isNaN(places[14]));
  // The points that are left, triangulated anew.
  const left = Array.from({length: 502}, (_, i) => i).filter((i) => moving.has(i));
  const anew = new Triangulation(left.flatMap((i) => [places[2 * i], places[2 * i + 1]]));
  assert.deepEqual(setOf(moving.rows().triangles), setOf([...anew.triangles].map((i) => left[i])));
  assert.equal(moving.triangleCount, anew.triangles.length / 3);
  const {triangles, neighbors} = moving.rows();
  for (const [i, beyond] of neighbors.entries()) {
    if (beyond === -1) continue;
    const opposite = neighbors.subarray(3 * beyond, 3 * beyond + 3);
    assert.ok(opposite.includes(Math.floor(i / 3)) && triangles[3 * beyond] !== -1);
  }
  fails(() => moving.remove([7]), 'input', /7/);
  fails(() => moving.move([1], [0]), 'usage', /1 coordinates/);
  const with_segment = new DynamicTriangulation(SQUARE, {segments: [0, 2]});
  assert.deepEqual([...with_segment.constraints().edges].sort(), [0, 2, 4, 4]);
  assert.deepEqual([...with_segment.constraints().segments], [0, 0]);
  fails(() => with_segment.remove([0]), 'input', /0/);
  moving.free();
  fails(() => moving.rows(), 'usage', /freed/);
});

test('edges that are not Delaunay', () => {
  // A kite with the wrong diagonal, in both directions.
  const kite = [0, 0, 4, 1, 8, 0, 4, -1];
  assert.deepEqual([...wrongEdges(kite, [0, 1, 2, 0, 2, 3], [-1, -1, 3, 2, -1, -1])], [0, 0, 1, 1, 0, 0]);
  assert.deepEqual([...wrongEdges(kite, [0, 2, 1, 0, 3, 2], [5, -1, -1, -1, -1, 0])], [1, 0, 0, 0, 0, 1]);
  const coords = readPoints('robustness2.xy');
  const {triangles, halfedges} = new Delaunator(coords);
  assert.ok(wrongEdges(coords, triangles, halfedges).every((wrong) => wrong === 0));
  fails(() => wrongEdges(kite, [0, 1, 9], [-1, -1, -1]), 'usage', /9/);
});

test('no points', () => {
  const mesh = new Triangulation([]);
  for (const array of [mesh.triangles, mesh.neighbors, mesh.halfedges, mesh.hull, mesh.representatives, mesh.areas]) {
    assert.equal(array.length, 0);
  }
  assert.equal(mesh.nearest(0, 0), -1);
  assert.equal(mesh.clippedVoronoi([0, 0, 1, 1]).vertices.length, 0);
  assert.equal(new DynamicTriangulation([]).insert([1, 1]), 0);
});
