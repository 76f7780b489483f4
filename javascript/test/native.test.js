// The same bytes as the native library: FLAUNAY_COMMAND is its command.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import test from 'node:test';
import {fileURLToPath} from 'node:url';

import {Triangulation} from 'flaunay';

import {DATA, readPoints} from './points.js';

const command = process.env.FLAUNAY_COMMAND;
const folder = mkdtempSync(join(tmpdir(), 'flaunay-'));
process.on('exit', () => rmSync(folder, {recursive: true}));
const FILES = [
  'airports.txt', 'issue13.xy', 'issue43.xy', 'issue44.xy', 'robustness1.xy', 'robustness2.xy', 'robustness3.xy',
  'robustness4.xy', 'ukraine.xy',
];
const DISTRIBUTIONS = [
  'uniform', 'normal', 'kuzmin', 'line', 'grid', 'rotated-grid', 'hexagonal', 'circle', 'integer-circle',
  'nested-circles', 'columns', 'small-integers', 'half-duplicates', 'collinear', 'parabola', 'clusters', 'spiral',
  'horizontal', 'thirty-lines', 'power-of-two-span', 'one-ulp', 'mostly-equal', 'two-clusters',
];

function run(...given) {
  execFileSync(command, given, {env: {...process.env, FLAUNAY_DEVICE: 'host'}});
}

function readArray(path, type) {
  const bytes = readFileSync(path);
  const begin = 10 + bytes.readUInt16LE(8);
  return new type(bytes.buffer.slice(bytes.byteOffset + begin, bytes.byteOffset + bytes.length));
}

function compare(points, coords) {
  const arrays = ['triangles', 'neighbors', 'hull', 'duplicates'];
  const path = (name) => join(folder, `${name}.npy`);
  run('triangulate', points, ...arrays.flatMap((name) => [`--${name}`, path(name)]));
  const mesh = new Triangulation(coords);
  for (const name of arrays) {
    assert.deepEqual(mesh[name === 'duplicates' ? 'representatives' : name], readArray(path(name), Int32Array), name);
  }
  mesh.free();
}

for (const name of FILES) {
  test(name, {skip: !command}, () => {
    compare(fileURLToPath(new URL(name, DATA)), readPoints(name));
  });
}

for (const name of DISTRIBUTIONS) {
  for (const [k, n] of [10, 200, 1000, 5000, 40_000].entries()) {
    test(`${name}, ${n} points`, {skip: !command}, () => {
      const points = join(folder, 'points.npy');
      run('generate', name, String(n), '--seed', String(k + 1), '-o', points);
      compare(points, readArray(points, Float64Array));
    });
  }
}
