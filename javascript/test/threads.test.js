// With threads: the same bytes as without, and a process that ends. In browsers: browser.test.js.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {existsSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import test from 'node:test';

// Prints what a program finds of 300,000 points, twice, for which the memory has to grow.
const PROGRAM = (name) => `
  import {createHash} from 'node:crypto';
  import Delaunator, {ConstrainedTriangulation, Triangulation} from '${name}';
  const coords = Float64Array.from({length: 600_000}, (_, i) => Math.sin(i * i) * 1e4);
  const hash = createHash('sha256');
  for (const again of [0, 1]) {
    const {triangles, halfedges, hull} = new Delaunator(coords);
    const mesh = new Triangulation(coords);
    const cells = mesh.clippedVoronoi([-9, -9, 9, 9]);
    const constrained = new ConstrainedTriangulation(coords.subarray(0, 20_000), {segments: [0, 1, 2, 3]});
    for (const array of [triangles, halfedges, hull, mesh.neighbors, cells.areas, constrained.triangles]) {
      hash.update(array.slice());
    }
  }
  try {
    new Delaunator([0, NaN]);
  } catch ({kind, message}) {
    console.log(hash.digest('hex'), kind, message);
  }
`;

function printed(program) {
  return execFileSync(process.execPath, ['--input-type=module', '--eval', program],
    {cwd: fileURLToPath(new URL('.', import.meta.url)), encoding: 'utf8', timeout: 120_000});
}

// Where scripts/javascript.sh has made their module.
const settings = {skip: !existsSync(new URL('../threads', import.meta.url))};

test('threads', settings, () => {
  const alone = printed(PROGRAM('flaunay'));
  assert.match(alone, /^[0-9a-f]{64} input .*nan/im);
  assert.equal(printed(PROGRAM('flaunay/threads')), alone);
});

test('flaunay before flaunay/threads, and while that loads', settings, () => {
  for (const first of ["import 'flaunay';", `
    import {readFileSync} from 'node:fs';
    import {start} from 'flaunay/flaunay.js';
    const module = new WebAssembly.Module(readFileSync('../flaunay.wasm'));
    process.once('worker', () => start(module));
  `]) {
    assert.match(printed(`${first} await import('flaunay/threads').catch(({message}) => console.log(message));`),
      /import that alone$/m);
  }
});
