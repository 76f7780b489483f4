// The package in headless Chromium: in pages and a worker, as it is and in bundles. FLAUNAY_PACKAGE: its folder.
import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
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

// What `ready` is rejected with, and that a call says it once more.
const FAILED = `
  ready.catch((error) => {
    try {
      new Delaunator([0, 0]);
    } catch ({message}) {
      report([error.name, error.message, message].join('|'));
    }
  });
`;
async function assertFailure(pages, reason, headers) {
  const [name, message, later] = (await reported('/page.html', pages, folder, headers)).split('|');
  assert.equal(name, 'FlaunayError');
  assert.match(message, reason);
  assert.equal(later, `the module could not be loaded: ${message}`);
}
const failing = (name) => script(`import Delaunator, {ready} from './${name}.js'; ${FAILED}`);

test('a module that is not there, and a page in its place', settings, async () => {
  for (const [name, file, wasm, reason] of [['index', 'flaunay.wasm', null, '404'], ['points', 'points.wasm', '<html>', 'magic word']]) {
    await assertFailure({'/page.html': failing(name), [`/${file}`]: wasm},
      new RegExp(`${file}: .*${reason}.*; is ${file} beside the bundle\\?$`));
  }
});

test('flaunay without its module, beside flaunay/points', settings, async () => {
  const pages = {
    '/page.html': script(`
      import {ConstrainedTriangulation, Triangulation, ready} from './index.js';
      import {ready as pointsReady} from './points.js';
      await Promise.allSettled([ready, pointsReady]);
      const count = Triangulation.from([[0, 0], [1, 0], [0, 1]]).triangles.length;
      try {
        new ConstrainedTriangulation([0, 0]);
      } catch (error) {
        report(count + error.message);
      }
    `),
    '/flaunay.wasm': null,
  };
  assert.match(await reported('/page.html', pages, folder), /^3ConstrainedTriangulation is in flaunay, .*; the module could not be loaded: .*flaunay.wasm: 404/);
});

const ISOLATED = {'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp'};

test('threads, in a page that is cross-origin isolated', withThreads, async () => {
  const pages = {'/page.html': script(`${READY('./threads.js')} report(done);`)};
  assert.equal(await reported('/page.html', pages, folder, ISOLATED), COUNTS);
});

test('threads that cannot be loaded', withThreads, async () => {
  const pages = {'/page.html': failing('threads')};
  await assertFailure(pages, /cross-origin isolated/);
  for (const [file, reason] of [['wasm', /browser.wasm: .*; is browser.wasm beside the bundle\?$/], ['worker.js', /a worker failed: are all files/]]) {
    await assertFailure({...pages, [`/threads/browser.${file}`]: null}, reason, ISOLATED);
  }
});

test('flaunay beside flaunay/threads, before and after it', withThreads, async () => {
  for (const [names, ends] of [
    [['threads', 'index'], /^fulfilled,fulfilled$/], [['index', 'threads'], /^fulfilled,.*import that alone$/],
  ]) {
    const imports = names.map((name) => `import {ready as ${name}} from './${name}.js';`).join('\n');
    const program = `${imports}
      const ends = await Promise.allSettled([${names}]);
      report(ends.map(({status, reason}) => reason?.message ?? status).join());
    `;
    assert.match(await reported('/page.html', {'/page.html': script(program)}, folder, ISOLATED), ends);
  }
});

test('one script, for a page without modules', settings, async () => {
  const pages = {'/page.html': page(`<script src="flaunay.min.js"></script>
    <script>const {Delaunator, Triangulation, ready} = flaunay; ${WORK} ready.then(() => report(done));</script>`)};
  assert.equal(await reported('/page.html', pages, folder), COUNTS);
});

test('one script, where WebAssembly is forbidden', settings, async () => {
  const script = `<script>const {Delaunator, ready} = flaunay; ${FAILED}</script>`;
  const pages = {'/page.html': `<script src="flaunay.min.js"></script>${page(script)}`};
  await assertFailure(pages, /^flaunay.min.js: .*Content Security Policy/,
    {'Content-Security-Policy': "script-src 'self' 'unsafe-inline'"});
});

// Bundles program.js by a command, and puts files of the package beside it.
async function bundled(t, program, files, [command, ...options], element) {
  const work = mkdtempSync(join(tmpdir(), 'flaunay-bundle-'));
  t.after(() => rmSync(work, {recursive: true}));
  mkdirSync(join(work, 'node_modules'));
  symlinkSync(folder, join(work, 'node_modules/flaunay'));
  writeFileSync(join(work, 'program.js'), program);
  execFileSync(command, options, {cwd: work});
  for (const file of files) copyFileSync(join(folder, file), join(work, 'out', file));
  return reported('/page.html', {'/page.html': page(element)}, join(work, 'out'));
}
const ESBUILD = ['esbuild', '--bundle', '--minify', '--log-level=error', '--outdir=out', 'program.js'];

test('a bundle that is a module, with points.wasm beside it', settings, async (t) => {
  const program = `${READY('flaunay/points')} report(done);`;
  assert.equal(await bundled(t, program, ['points.wasm'], [...ESBUILD, '--format=esm'], '<script type="module" src="program.js"></script>'),
    COUNTS);
});

test('a bundle that is a script and cannot find its module', settings, async (t) => {
  for (const name of ['flaunay', 'flaunay/points']) {
    const program = `import {ready} from '${name}'; ready.catch((error) => report(String(error)));`;
    const command = [...ESBUILD, '--format=iife', '--target=es2022', '--log-override:empty-import-meta=silent'];
    assert.match(await bundled(t, program, [], command, '<script src="program.js"></script>'),
      /^FlaunayError: this bundle has no import.meta.url/);
  }
});

test('a bundle that is a script, with a file of another name', settings, async (t) => {
  const program = `
    import address from 'flaunay/flaunay.wasm';
    import Delaunator, {Triangulation, init} from 'flaunay/flaunay.js';
    init(address).then(() => {${WORK} report(done);});
  `;
  const command = [...ESBUILD, '--format=iife', '--target=es2022', '--loader:.wasm=file'];
  assert.equal(await bundled(t, program, [], command, '<script src="program.js"></script>'), COUNTS);
});

test('a bundle by webpack', {...settings, skip: !folder || spawnSync('webpack', ['--version']).error}, async (t) => {
  const command = ['webpack', '--mode', 'production', '--entry', './program.js', '-o', 'out'];
  for (const name of ['flaunay', 'flaunay/points']) {
    const program = `import Delaunator, {Triangulation, ready} from '${name}'; ready.then(() => {${WORK} report(done);});`;
    assert.equal(await bundled(t, program, [], command, '<script src="main.js"></script>'), COUNTS);
  }
});
