// The package in headless Chromium, in a page and in a worker. FLAUNAY_PACKAGE: its folder.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {extname, join} from 'node:path';
import test from 'node:test';

const folder = process.env.FLAUNAY_PACKAGE;
const TYPES = {'.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm'};
// What both triangulate, with a count that they report.
const WORK = `
  import Delaunator, {Triangulation} from './index.js';
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
const PAGES = {
  '/page.html': `<!doctype html><script type="module">
    addEventListener('unhandledrejection', ({reason}) => fetch('/done', {method: 'POST', body: String(reason)}));
    ${WORK}
    const worker = new Worker('worker.js', {type: 'module'});
    worker.onerror = ({message}) => fetch('/done', {method: 'POST', body: message});
    worker.onmessage = ({data}) => fetch('/done', {method: 'POST', body: done + ' ' + data});
  </script>`,
  '/worker.js': `${WORK} postMessage(done);`,
};

test('page and worker', {skip: !folder, timeout: 60_000}, async () => {
  const {promise, resolve} = (() => {
    let settle;
    const made = new Promise((to) => (settle = to));
    return {promise: made, resolve: settle};
  })();
  const server = createServer((request, response) => {
    if (request.url === '/done') {
      request.on('data', (data) => resolve(String(data)));
      response.end();
      return;
    }
    try {
      const body = PAGES[request.url] ?? readFileSync(join(folder, request.url));
      response.setHeader('Content-Type', TYPES[extname(request.url)]).end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  const profile = mkdtempSync(join(tmpdir(), 'flaunay-chromium-'));
  const browser = spawn('chromium', ['--headless', '--no-sandbox', '--disable-gpu', `--user-data-dir=${profile}`,
    `http://127.0.0.1:${server.address().port}/page.html`], {stdio: 'ignore'});
  try {
    const counts = '19974,24,3,FlaunayError';
    assert.equal(await promise, `${counts} ${counts}`);
  } finally {
    await new Promise((over) => {
      browser.on('exit', over);
      browser.kill();
    });
    server.close();
    server.closeAllConnections();
    rmSync(profile, {recursive: true, force: true, maxRetries: 5});
  }
});
