// Pages in headless Chromium, for tests.
import {spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {extname, join} from 'node:path';

const TYPES = {
  '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm',
};

/** The text of a page with these elements, which calls report(text), and reports errors. */
export const page = (elements) => `<!doctype html><script>
    const report = (body) => fetch('/done', {method: 'POST', body});
    addEventListener('error', ({message}) => report(message));
    addEventListener('unhandledrejection', ({reason}) => report(String(reason)));
  </script>${elements}`;

/** What the page at this path reports. pages: texts by paths, null for none; all other files are in the folder. */
export async function reported(path, pages, folder, headers = {}) {
  let resolve, late;
  const report = new Promise((to, fail) => {
    resolve = to;
    late = setTimeout(() => fail(new Error(`${path} has reported nothing`)), 50_000);
  });
  const server = createServer((request, response) => {
    if (request.url === '/done') {
      request.on('data', (data) => resolve(String(data)));
      response.end();
      return;
    }
    try {
      const body = request.url in pages ? pages[request.url] : readFileSync(join(folder, request.url));
      if (body === null) throw new Error('none');
      response.writeHead(200, {...headers, 'Content-Type': TYPES[extname(request.url)]}).end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  const profile = mkdtempSync(join(tmpdir(), 'flaunay-chromium-'));
  const browser = spawn('chromium', ['--headless', '--no-sandbox', '--disable-gpu', `--user-data-dir=${profile}`,
    `http://127.0.0.1:${server.address().port}${path}`], {stdio: 'ignore', detached: true});
  try {
    return await report;
  } finally {
    clearTimeout(late);
    await new Promise((over) => {
      browser.on('exit', over);
      process.kill(-browser.pid, 'SIGKILL'); // with those that it has begun, which write to its profile
    });
    server.close();
    server.closeAllConnections();
    rmSync(profile, {recursive: true, force: true, maxRetries: 20});
  }
}
