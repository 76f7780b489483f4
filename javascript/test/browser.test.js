// The package in headless Chromium: in pages and a worker, as it is and in bundles. FLAUNAY_PACKAGE: its folder.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {copyFileSync, existsSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import test from 'node:test';

import {page, reported} from './browser.js';

const folder = process.env.FLAUNAY_PACKAGE;
// What each triangulates, with counts that it reports.
const WORK = `
  const coords = Float64Array.from({length: 20000}, (_, i) => Math.sin(i * i));
  const drop = new Delaunator(coords);
  const cells = Triangulation.from([[0, 0], [1, 0], [0, 1]]).clippedVoronoi([0, 0, 1, 1]);
  let message = '';
  try {
    new Delaunator([0, NaN]);
  } catch (error) {
    message = error.name;
  }
  const done = [drop.triangles.length / 3, drop.hull.length, cells.areas.length, message].join();
`;
const COUNTS = '19974,24,3,FlaunayError';
const READY = (module) => `
  import Delaunator, {Triangulation, ready} from '${module}';
  await ready;
  ${WORK}
`;
const script = (program) => page(`<script type="module">${program}</script>`);
const settings = {skip: !folder, timeout: 60_000};
const withThreads = {...settings, skip: !folder || !existsSync(join(folder, 'threads'))};

test('page and worker', settings, async () => {
  const pages = {
    '/page.html': script(`
      ${READY('./index.js')}
      const worker = new Worker('worker.js', {type: 'module'});
      worker.onerror = ({message}) => report(message);
      worker.onmessage = ({data}) => report(done + ' ' + data);
    `),
    '/worker.js': `${READY('./index.js')} postMessage(done);`,
  };
  assert.equal(await reported('/page.html', pages, folder), `${COUNTS} ${COUNTS}`);
});

test('before it is ready', settings, async () => {
  const pages = {'/page.html': script("import Delaunator from './points.js'; new Delaunator([0, 0]);")};
  assert.match(await reported('/page.html', pages, folder), /FlaunayError: .*await `ready`/);
});

test('threads, in a page that is cross-origin isolated', withThreads, async () => {
  const isolated = {'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp'};
  const pages = {'/page.html': script(`${READY('./threads.js')} report(done);`)};
  assert.equal(await reported('/page.html', pages, folder, isolated), COUNTS);
});

test('threads, in another page', withThreads, async () => {
  const pages = {'/page.html': script(`${READY('./threads.js')} report(done);`)};
  assert.match(await reported('/page.html', pages, folder), /FlaunayError: .*cross-origin isolated/);
});

test('one script, for a page without modules', settings, async () => {
  const pages = {'/page.html': page(`<script src="flaunay.min.js"></script>
    <script>const {Delaunator, Triangulation} = flaunay; ${WORK} report(done);</script>`)};
  assert.equal(await reported('/page.html', pages, folder), COUNTS);
});

// Bundles a program by esbuild, and puts files of the package beside it.
async function bundled(t, program, files, options, element) {
  const work = mkdtempSync(join(tmpdir(), 'flaunay-bundle-'));
  t.after(() => rmSync(work, {recursive: true}));
  mkdirSync(join(work, 'node_modules'));
  symlinkSync(folder, join(work, 'node_modules/flaunay'));
  writeFileSync(join(work, 'program.js'), program);
  execFileSync('esbuild', ['--bundle', '--minify', '--log-level=error', '--outdir=out', ...options, 'program.js'], {cwd: work});
  for (const file of files) copyFileSync(join(folder, file), join(work, 'out', file));
  return reported('/page.html', {'/page.html': page(element)}, join(work, 'out'));
}

test('a bundle that is a module, with points.wasm beside it', settings, async (t) => {
  const program = `${READY('flaunay/points')} report(done);`;
  assert.equal(await bundled(t, program, ['points.wasm'], ['--format=esm'], '<script type="module" src="program.js"></script>'),
    COUNTS);
});

test('a bundle that is a script, with a file of another name', settings, async (t) => {
  const program = `
    import address from 'flaunay/flaunay.wasm';
    import Delaunator, {Triangulation, init} from 'flaunay/flaunay.js';
    init(address).then(() => {${WORK} report(done);});
  `;
  const options = ['--format=iife', '--target=es2022', '--loader:.wasm=file'];
  assert.equal(await bundled(t, program, [], options, '<script src="program.js"></script>'), COUNTS);
});
