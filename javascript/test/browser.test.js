// The package in headless Chromium, in a page and in a worker. FLAUNAY_PACKAGE: its folder.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {extname, join} from 'node:path';
import test from 'node:test';

const folder = process.env.FLAUNAY_PACKAGE;
const TYPES = {
  '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm',
};
// What each triangulates, with counts that it reports.
const WORK = (module) => `
  import Delaunator, {Triangulation} from '${module}';
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
const page = (program) => `<!doctype html><script>
    const report = (body) => fetch('/done', {method: 'POST', body});
    addEventListener('error', ({message}) => report(message));
    addEventListener('unhandledrejection', ({reason}) => report(String(reason)));
  </script><script type="module">${program}</script>`;
const PAGES = {
  '/page.html': page(`
    ${WORK('./index.js')}
    const worker = new Worker('worker.js', {type: 'module'});
    worker.onerror = ({message}) => report(message);
    worker.onmessage = ({data}) => report(done + ' ' + data);
  `),
  '/worker.js': `${WORK('./index.js')} postMessage(done);`,
  '/threads.html': page(`${WORK('./threads.js')} report(done);`),
};
const COUNTS = '19974,24,3,FlaunayError';

// What the page reports.
async function reported(path, headers = {}) {
  let resolve;
  const report = new Promise((to) => (resolve = to));
  const server = createServer((request, response) => {
    if (request.url === '/done') {
      request.on('data', (data) => resolve(String(data)));
      response.end();
      return;
    }
    try {
      const body = PAGES[request.url] ?? readFileSync(join(folder, request.url));
      response.writeHead(200, {...headers, 'Content-Type': TYPES[extname(request.url)]}).end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  const profile = mkdtempSync(join(tmpdir(), 'flaunay-chromium-'));
  const browser = spawn('chromium', ['--headless', '--no-sandbox', '--disable-gpu', `--user-data-dir=${profile}`,
    `http://127.0.0.1:${server.address().port}${path}`], {stdio: 'ignore'});
  try {
    return await report;
  } finally {
    await new Promise((over) => {
      browser.on('exit', over);
      browser.kill();
    });
    server.close();
    server.closeAllConnections();
    rmSync(profile, {recursive: true, force: true, maxRetries: 20});
  }
}

const settings = {skip: !folder, timeout: 60_000};

test('page and worker', settings, async () => {
  assert.equal(await reported('/page.html'), `${COUNTS} ${COUNTS}`);
});

test('threads, in a page that is cross-origin isolated', settings, async () => {
  const isolated = {'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp'};
  assert.equal(await reported('/threads.html', isolated), COUNTS);
});

test('threads, in another page', settings, async () => {
  assert.match(await reported('/threads.html'), /FlaunayError: .*cross-origin isolated/);
});
