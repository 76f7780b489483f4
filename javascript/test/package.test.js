// What package.json names, by the rules that bundlers and TypeScript read it by, and the package as programs for Node and
// Deno load it. FLAUNAY_PACKAGE: its folder.
import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import test from 'node:test';

const folder = process.env.FLAUNAY_PACKAGE;

test('package.json', {skip: !folder}, () => {
  const {exports, files, main, types, sideEffects, unpkg, jsdelivr} = JSON.parse(readFileSync(join(folder, 'package.json')));
  const targets = Object.values(exports).flatMap((target) => {
    if (typeof target === 'string') return target;
    // The first condition that is met counts.
    const conditions = Object.keys(target);
    assert.equal(conditions[0], 'types');
    assert.equal(conditions.at(-1), 'default');
    return Object.values(target);
  });
  for (const path of [...targets, main, types, unpkg, jsdelivr]) {
    assert.match(path, /^\.\//);
    assert.ok(existsSync(join(folder, path)), path);
  }
  const notices = readFileSync(join(folder, unpkg), 'utf8').match(/^\/\*! flaunay \d+\.\d+\.\d+, MIT licence.* (\S+\.md) /);
  assert.ok(files.includes(notices[1]) && existsSync(join(folder, notices[1])));
  // Importing these loads a module; a bundler may drop the others.
  for (const name of ['.', './points']) {
    for (const condition of ['node', 'default']) assert.ok(sideEffects.includes(exports[name][condition]));
  }
});

// What a program prints that has a copy of the package, without one of its files.
function printed(t, name, program, command, without) {
  const work = mkdtempSync(join(tmpdir(), 'flaunay-package-'));
  t.after(() => rmSync(work, {recursive: true}));
  const copy = join(work, 'node_modules/flaunay');
  cpSync(folder, copy, {recursive: true});
  if (without) rmSync(join(copy, without));
  writeFileSync(join(work, name), program);
  const [file, ...options] = command;
  return execFileSync(file, [...options, name], {cwd: work, encoding: 'utf8'}).trim();
}
const COUNT = 'console.log(new Delaunator([0, 0, 4, 0, 4, 4, 0, 4, 2, 1]).triangles.length / 3);';

test('require', {skip: !folder || !process.features.require_module}, (t) => {
  const program = `const {default: Delaunator} = require('flaunay'); ${COUNT}`;
  assert.equal(printed(t, 'program.cjs', program, [process.execPath, '--no-warnings']), '4');
});

test('Deno', {skip: !folder || spawnSync('deno', ['--version']).error}, (t) => {
  for (const name of ['flaunay', 'flaunay/points']) {
    const program = `import Delaunator, {ready} from '${name}'; await ready; const n: number = 4; ${COUNT}`;
    assert.equal(printed(t, 'program.ts', program, ['deno', 'run', '--quiet', '--check', '--allow-read', '--node-modules-dir=manual']), '4');
  }
});

test('a module that is not there', {skip: !folder}, (t) => {
  const files = {flaunay: 'flaunay.wasm', 'flaunay/points': 'points.wasm'};
  if (existsSync(join(folder, 'threads'))) files['flaunay/threads'] = 'threads/browser.wasm';
  for (const [name, file] of Object.entries(files)) {
    const program = `
      import Delaunator from 'flaunay/flaunay.js';
      const {message} = await import('${name}').then(({ready}) => ready).catch((error) => error);
      try {
        new Delaunator([0, 0]);
      } catch (later) {
        console.log(message + '\\n' + later.message);
      }
    `;
    const [message, later] = printed(t, 'program.mjs', program, [process.execPath], file).split('\n');
    assert.match(message, new RegExp(`${file}: ENOENT: .*; is ${file.split('/').pop()} beside the bundle\\?$`));
    assert.equal(later, `the module could not be loaded: ${message}`);
  }
});
