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

test('flaunay/points beside flaunay, before and after it', settings, async () => {
  // The larger module comes late.
  const late = `<script>
    const get = fetch;
    fetch = async (...given) => {
      if (String(given[0]).endsWith('flaunay.wasm')) await new Promise((over) => setTimeout(over, 500));
      return get(...given);
    };
  </script>`;
  const pages = {};
  for (const names of [['index', 'points'], ['points', 'index']]) {
    const imports = names.map((name) => `import {ready as ${name}} from './${name}.js';`).join('\n');
    pages[`/${names[0]}.html`] = late + script(`${imports}
      const ends = await Promise.allSettled([${names}]);
      report(ends.map(({status, reason}) => reason?.message ?? status).join());
    `);
  }
  assert.equal(await reported('/index.html', pages, folder), 'fulfilled,fulfilled');
  assert.match(await reported('/points.html', pages, folder), /^fulfilled,.*import flaunay first$/);
});

test('a module that is not there, and a page in its place', settings, async () => {
  for (const [wasm, reason] of [[null, '404'], ['<html>', 'magic word']]) {
    const pages = {
      '/page.html': script(`
        import Delaunator, {ready} from './points.js';
        const ended = await ready.catch((error) => error);
        try {
          new Delaunator([0, 0]);
        } catch (error) {
          report([ended.name, ended.message, error.message].join('|'));
        }
      `),
      '/points.wasm': wasm,
    };
    const [name, message, later] = (await reported('/page.html', pages, folder)).split('|');
    assert.equal(name, 'FlaunayError');
    assert.match(message, new RegExp(`points.wasm: .*${reason}.*; is points.wasm beside the bundle\\?$`));
    assert.equal(later, `the module could not be loaded: ${message}`);
  }
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
    <script>const {Delaunator, Triangulation, ready} = flaunay; ${WORK} ready.then(() => report(done));</script>`)};
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

test('a bundle that is a script and cannot find its module', settings, async (t) => {
  for (const name of ['flaunay', 'flaunay/points']) {
    const program = `import {ready} from '${name}'; ready.catch((error) => report(String(error)));`;
    const options = ['--format=iife', '--target=es2022', '--log-override:empty-import-meta=silent'];
    assert.match(await bundled(t, program, [], options, '<script src="program.js"></script>'),
      /^FlaunayError: this bundle has no import.meta.url/);
  }
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
