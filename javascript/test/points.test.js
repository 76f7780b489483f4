// flaunay/points, in a process of its own, where no other module is ready.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import test from 'node:test';
import {brotliCompressSync} from 'node:zlib';

import Delaunator, {FlaunayError, Triangulation, wrongEdges} from 'flaunay/points';
import {ConstrainedTriangulation, DynamicTriangulation} from 'flaunay/flaunay.js';

import {uniform} from './points.js';

test('what it has', () => {
  const coords = uniform(1000);
  const {triangles, halfedges} = new Delaunator(coords);
  assert.ok(wrongEdges(coords, triangles, halfedges).every((wrong) => wrong === 0));
  const mesh = new Triangulation(coords);
  assert.equal(mesh.nearest(coords[10], coords[11]), 5);
  assert.ok(mesh.locate(0.5, 0.5) >= 0);
  assert.equal(mesh.voronoi().circumcentres.length, 2 * triangles.length / 3);
  assert.ok(Math.abs(mesh.clippedVoronoi([0, 0, 1, 1]).areas.reduce((a, b) => a + b) - 1) < 1e-12);
});

test('what it has not', () => {
  const coords = [0, 0, 1, 0, 0, 1];
  for (const [name, work] of Object.entries({
    interpolate: () => new Triangulation(coords).interpolate([1, 2, 3], [0.2, 0.2]),
    ConstrainedTriangulation: () => new ConstrainedTriangulation(coords),
    DynamicTriangulation: () => new DynamicTriangulation(coords),
  })) assert.throws(work, {name: 'FlaunayError', kind: 'usage', message: `${name} is in flaunay, not in flaunay/points`});
});

test('its size on the way to a browser', (t) => {
  const bytes = brotliCompressSync(readFileSync(createRequire(import.meta.url).resolve('flaunay/points.wasm'))).length;
  t.diagnostic(`points.wasm has ${bytes} bytes when it is compressed`);
  assert.ok(bytes <= 180_000, `${bytes}`);
});

test('it comes after flaunay, or without it', async () => {
  await assert.rejects(import('flaunay').then(({ready}) => ready), (error) => error instanceof FlaunayError && error.kind === 'usage');
  // Its calls say why they cannot be had.
  assert.throws(() => new DynamicTriangulation([]), /^FlaunayError: DynamicTriangulation is in flaunay, not in flaunay\/points; .*import flaunay first$/);
});
